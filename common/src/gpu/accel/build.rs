//! Builds of many structures at once: one buffer for them, one for their scratch, one submission.

use std::ops::Range;
use std::time::Instant;

use anyhow::{Context, Result};
use ash::vk;

use super::place::{OFFSET_ALIGNMENT, place, together};
use super::plan::Plan;
use super::{AccelerationStructure, BuildOptions, Input, compaction};
use crate::gpu::memory::buffer::offsets;
use crate::gpu::queries::Queries;
use crate::gpu::{Buffer, Geometry, Gpu, barrier};

/// The most bytes of structures and scratch in one batch: enough to keep a device busy, little enough that the
/// memory freed by compaction does not matter. A larger structure is built alone.
const MOST_BYTES: u64 = 64 << 20;

impl AccelerationStructure {
    /// Builds a structure from each input, many at a time, because a single small build does not keep a device
    /// busy, and in few buffers, because each buffer costs time and memory.
    ///
    /// # Errors
    /// As [`AccelerationStructure::bottom`].
    pub fn build(gpu: &Gpu, inputs: &[Input], options: BuildOptions) -> Result<Vec<Self>> {
        let plans = inputs.iter().map(|input| Plan::new(gpu, *input, options));
        let plans: Vec<_> = plans.collect::<Result<_>>()?;
        let mut all = Vec::with_capacity(inputs.len());
        for range in batches(&plans, gpu.limits.min_scratch_offset_alignment()) {
            all.extend(build_batch(gpu, &plans[range], options.compact)?);
        }
        Ok(all)
    }
}

/// Splits the plans into consecutive batches whose structures and scratch fit together.
fn batches(plans: &[Plan], scratch_alignment: u64) -> Vec<Range<usize>> {
    let mut all: Vec<Range<usize>> = Vec::new();
    let mut bytes = 0;
    for (index, Plan { sizes, .. }) in plans.iter().enumerate() {
        let needed = sizes.acceleration_structure_size.next_multiple_of(OFFSET_ALIGNMENT)
            + sizes.build_scratch_size.next_multiple_of(scratch_alignment);
        bytes += needed;
        match all.last_mut() {
            Some(last) if bytes <= MOST_BYTES => last.end = index + 1,
            _ => {
                all.push(index..index + 1);
                bytes = needed;
            }
        }
    }
    all
}

/// Structures that share their memory, built at the same time, and compacted if requested.
fn build_batch(gpu: &Gpu, plans: &[Plan], compact: bool) -> Result<Vec<AccelerationStructure>> {
    let sizes: Vec<_> = plans.iter().map(|plan| plan.sizes.acceleration_structure_size).collect();
    let built = place(gpu, plans.to_vec(), &sizes)?;
    // The builds of a batch may run concurrently, so each needs scratch of its own.
    let scratches = plans.iter().map(|plan| plan.sizes.build_scratch_size);
    let (offsets, room) = offsets(scratches, gpu.limits.min_scratch_offset_alignment());
    let scratch = scratch_buffer(gpu, room)?;
    let builds = built.iter().zip(offsets).map(|(structure, offset)| Build {
        structure,
        geometries: &structure.plan.geometries,
        scratch: scratch.address + offset,
    });
    let builds: Vec<_> = builds.collect();
    let small = compact.then(|| Queries::new(gpu, compaction::SIZE, built.len() as u32));
    let small = small.transpose()?;
    let start = Instant::now();
    gpu.submit(|cmd| {
        record(gpu, cmd, vk::BuildAccelerationStructureModeKHR::BUILD, &builds);
        if let Some(small) = &small {
            compaction::ask(small, cmd, &built);
        }
        Ok(())
    })
    .with_context(|| format!("cannot build {}", together(plans)))?;
    gpu.count(|statistics| statistics.build_time += start.elapsed());
    match small {
        Some(small) => compaction::compacted(gpu, &built, &small.results()?),
        None => Ok(built),
    }
}

/// A buffer for the scratch of builds.
pub(super) fn scratch_buffer(gpu: &Gpu, size: u64) -> Result<Buffer> {
    let usage = vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS;
    Buffer::new(gpu, "scratch", size, usage)
}

/// A build or an update of a structure.
pub(super) struct Build<'a> {
    pub(super) structure: &'a AccelerationStructure,
    pub(super) geometries: &'a [Geometry],
    /// Address of its scratch.
    pub(super) scratch: vk::DeviceAddress,
}

/// Records builds or updates that do not depend on each other, each with scratch of its own.
pub(super) fn record(
    gpu: &Gpu,
    cmd: vk::CommandBuffer,
    mode: vk::BuildAccelerationStructureModeKHR,
    builds: &[Build],
) {
    let geometries = builds.iter().map(|build| build.structure.plan.described(build.geometries));
    let geometries: Vec<_> = geometries.collect();
    // ANCHOR: update
    let infos = builds.iter().zip(&geometries).map(|(build, geometries)| {
        let AccelerationStructure { plan, handle, .. } = build.structure;
        let mut info = plan.info(geometries).mode(mode).dst_acceleration_structure(*handle);
        if mode == vk::BuildAccelerationStructureModeKHR::UPDATE {
            info = info.src_acceleration_structure(*handle);
        }
        info.scratch_data(vk::DeviceOrHostAddressKHR { device_address: build.scratch })
    });
    // ANCHOR_END: update
    let infos: Vec<_> = infos.collect();
    let ranges: Vec<_> = builds.iter().map(|build| ranges(build.geometries)).collect();
    let ranges: Vec<_> = ranges.iter().map(Vec::as_slice).collect();
    barrier::trace_to_build(gpu, cmd);
    barrier::between_builds(gpu, cmd);
    // SAFETY: every address in infos belongs to a buffer that outlives the submission.
    unsafe { gpu.acceleration_structure.cmd_build_acceleration_structures(cmd, &infos, &ranges) };
    barrier::between_builds(gpu, cmd);
    barrier::build_to_trace(gpu, cmd);
}

fn ranges(geometries: &[Geometry]) -> Vec<vk::AccelerationStructureBuildRangeInfoKHR> {
    let range = vk::AccelerationStructureBuildRangeInfoKHR::default();
    geometries.iter().map(|geometry| range.primitive_count(geometry.count())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn planned(size: u64, build_scratch: u64) -> Plan {
        let sizes = vk::AccelerationStructureBuildSizesInfoKHR::default()
            .acceleration_structure_size(size)
            .build_scratch_size(build_scratch);
        let (name, options) = ("one".into(), BuildOptions::default());
        Plan { name, options, geometries: Vec::new(), sizes }
    }

    #[test]
    fn neighbours_share_a_batch_as_long_as_they_fit() {
        let half = MOST_BYTES / 4;
        let plans = [planned(half, half), planned(half, half), planned(1, 1), planned(1, 1)];
        assert_eq!(batches(&plans, 256), [0..2, 2..4]);
    }

    #[test]
    fn what_fits_no_batch_is_built_alone() {
        let plans = [planned(1, 1), planned(2 * MOST_BYTES, 1), planned(1, 1)];
        assert_eq!(batches(&plans, 256), [0..1, 1..2, 2..3]);
        assert_eq!(batches(&[], 256), []);
    }
}
