//! Compaction: a structure is copied into a buffer of the size that it turned out to need.

use anyhow::Result;
use ash::vk;

use super::AccelerationStructure;
use crate::gpu::barrier;

impl AccelerationStructure {
    /// The same structure in a buffer of the size that it turned out to need.
    ///
    /// # Errors
    /// If memory is short or the device fails.
    pub(super) fn compacted(self) -> Result<Self> {
        let gpu = &self.gpu;
        let size = self.compacted_size()?;
        let mut small = Self::empty(gpu, &self.name, self.shape.clone(), self.options, size)?;
        small.build_size = self.build_size;
        small.build_scratch = self.build_scratch;
        small.update_scratch = self.update_scratch;
        let info = vk::CopyAccelerationStructureInfoKHR::default()
            .src(self.handle)
            .dst(small.handle)
            .mode(vk::CopyAccelerationStructureModeKHR::COMPACT);
        gpu.submit(|cmd| {
            // SAFETY: both structures outlive the submission; the source allows compaction.
            unsafe { gpu.acceleration_structure.cmd_copy_acceleration_structure(cmd, &info) };
            barrier::between_builds(gpu, cmd);
            barrier::build_to_trace(gpu, cmd);
            Ok(())
        })?;
        Ok(small)
    }

    fn compacted_size(&self) -> Result<u64> {
        let gpu = &self.gpu;
        let info = vk::QueryPoolCreateInfo::default()
            .query_type(vk::QueryType::ACCELERATION_STRUCTURE_COMPACTED_SIZE_KHR)
            .query_count(1);
        // SAFETY: the pool is destroyed below, after the submission is done.
        unsafe {
            let pool = gpu.device.create_query_pool(&info, None)?;
            let mut size = [0u64];
            let result = gpu
                .submit(|cmd| {
                    gpu.device.cmd_reset_query_pool(cmd, pool, 0, 1);
                    gpu.acceleration_structure.cmd_write_acceleration_structures_properties(
                        cmd,
                        &[self.handle],
                        vk::QueryType::ACCELERATION_STRUCTURE_COMPACTED_SIZE_KHR,
                        pool,
                        0,
                    );
                    Ok(())
                })
                .and_then(|()| {
                    let flags = vk::QueryResultFlags::TYPE_64 | vk::QueryResultFlags::WAIT;
                    Ok(gpu.device.get_query_pool_results(pool, 0, &mut size, flags)?)
                });
            gpu.device.destroy_query_pool(pool, None);
            result?;
            Ok(size[0])
        }
    }
}
