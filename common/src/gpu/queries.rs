//! Queries: numbers the device writes while it works, and the host reads afterwards.

use anyhow::Result;
use ash::vk;

use super::Gpu;

/// A `VkQueryPool` of one kind, freed on drop.
pub(super) struct Queries {
    pub(super) handle: vk::QueryPool,
    count: u32,
    pub(super) gpu: Gpu,
}

impl Queries {
    pub(super) fn new(gpu: &Gpu, kind: vk::QueryType, count: u32) -> Result<Self> {
        let info = vk::QueryPoolCreateInfo::default().query_type(kind).query_count(count);
        // SAFETY: the device is alive; the pool is destroyed on drop.
        let handle = unsafe { gpu.device.create_query_pool(&info, None)? };
        gpu.name_object(handle, &format!("queries: {kind:?}"));
        Ok(Self { handle, count, gpu: gpu.clone() })
    }

    /// Resets the queries, so that the commands that follow in `cmd` can write them.
    pub(super) fn reset(&self, cmd: vk::CommandBuffer) {
        // SAFETY: cmd is being recorded, and the pool is alive until its submission is done.
        unsafe { self.gpu.device.cmd_reset_query_pool(cmd, self.handle, 0, self.count) };
    }

    /// The values of all queries, written by a completed submission.
    pub(super) fn results(&self) -> Result<Vec<u64>> {
        let mut results = vec![0; self.count as usize];
        let flags = vk::QueryResultFlags::TYPE_64 | vk::QueryResultFlags::WAIT;
        // SAFETY: the pool is alive, and there is room for a result of each query.
        unsafe { self.gpu.device.get_query_pool_results(self.handle, 0, &mut results, flags)? };
        Ok(results)
    }
}

impl Drop for Queries {
    fn drop(&mut self) {
        // SAFETY: submissions are waited for.
        unsafe { self.gpu.device.destroy_query_pool(self.handle, None) };
    }
}
