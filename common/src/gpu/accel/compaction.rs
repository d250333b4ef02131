//! Compaction: copies structures into a buffer of the size they turned out to need.

use anyhow::Result;
use ash::vk;

use super::AccelerationStructure;
use super::place::place;
use crate::gpu::queries::Queries;
use crate::gpu::{Gpu, barrier};

/// The query for the compacted size of a structure.
pub(super) const SIZE: vk::QueryType = vk::QueryType::ACCELERATION_STRUCTURE_COMPACTED_SIZE_KHR;

/// Records queries for the compacted sizes of structures built earlier in `cmd`.
pub(super) fn ask(sizes: &Queries, cmd: vk::CommandBuffer, built: &[AccelerationStructure]) {
    let (extension, pool) = (&sizes.gpu.acceleration_structure, sizes.handle);
    let handles: Vec<_> = built.iter().map(|one| one.handle).collect();
    sizes.reset(cmd);
    // SAFETY: structures and queries outlive the submission; each structure has a query of its own.
    unsafe {
        extension.cmd_write_acceleration_structures_properties(cmd, &handles, SIZE, pool, 0);
    }
}

/// The same structures, one after the other in a buffer, each of its compacted size.
///
/// # Errors
/// If memory is short or the device fails.
pub(super) fn compacted(
    gpu: &Gpu,
    built: &[AccelerationStructure],
    sizes: &[u64],
) -> Result<Vec<AccelerationStructure>> {
    let small = place(gpu, built.iter().map(|one| one.plan.clone()).collect(), sizes)?;
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
