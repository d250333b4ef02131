//! Compaction: structures are copied into a buffer of the size that they turned out to need.

use anyhow::Result;
use ash::vk;

use super::AccelerationStructure;
use super::place::place;
use crate::gpu::{Gpu, barrier};

/// The same structures, one after the other in a buffer of the size that they turned out to need.
///
/// # Errors
/// If memory is short or the device fails.
pub(super) fn compacted(
    gpu: &Gpu,
    built: &[AccelerationStructure],
) -> Result<Vec<AccelerationStructure>> {
    let sizes = sizes(gpu, built)?;
    let small = place(gpu, built.iter().map(|one| one.plan.clone()).collect(), &sizes)?;
    gpu.submit(|cmd| {
        for (large, small) in built.iter().zip(&small) {
            let info = vk::CopyAccelerationStructureInfoKHR::default()
                .src(large.handle)
                .dst(small.handle)
                .mode(vk::CopyAccelerationStructureModeKHR::COMPACT);
            // SAFETY: both structures outlive the submission; the source allows compaction.
            unsafe { gpu.acceleration_structure.cmd_copy_acceleration_structure(cmd, &info) };
        }
        barrier::between_builds(gpu, cmd);
        barrier::build_to_trace(gpu, cmd);
        Ok(())
    })?;
    Ok(small)
}

fn sizes(gpu: &Gpu, built: &[AccelerationStructure]) -> Result<Vec<u64>> {
    let query = vk::QueryType::ACCELERATION_STRUCTURE_COMPACTED_SIZE_KHR;
    let count = built.len() as u32;
    let info = vk::QueryPoolCreateInfo::default().query_type(query).query_count(count);
    let handles: Vec<_> = built.iter().map(|one| one.handle).collect();
    let mut sizes = vec![0u64; built.len()];
    // SAFETY: the pool is destroyed below, after the submission is done.
    unsafe {
        let pool = gpu.device.create_query_pool(&info, None)?;
        let result = gpu
            .submit(|cmd| {
                gpu.device.cmd_reset_query_pool(cmd, pool, 0, count);
                gpu.acceleration_structure
                    .cmd_write_acceleration_structures_properties(cmd, &handles, query, pool, 0);
                Ok(())
            })
            .and_then(|()| {
                let flags = vk::QueryResultFlags::TYPE_64 | vk::QueryResultFlags::WAIT;
                Ok(gpu.device.get_query_pool_results(pool, 0, &mut sizes, flags)?)
            });
        gpu.device.destroy_query_pool(pool, None);
        result?;
    }
    Ok(sizes)
}
