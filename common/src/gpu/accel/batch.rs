//! Builds of many structures at a time: one buffer for them, one for their scratch, one submission.

use std::ops::Range;
use std::sync::Arc;
use std::time::Instant;

use anyhow::{Context, Result};
use ash::vk;

use super::{
    AccelerationStructure, BuildOptions, Input, Plan, compaction, flags, ranges, record_builds,
    scratch_buffer,
};
use crate::gpu::{Buffer, Gpu};

/// How many bytes structures and scratch of one batch may take together: enough to keep a device busy,
/// little enough that what compaction leaves behind is no burden. A structure that takes more is built alone.
const MOST_BYTES: u64 = 64 << 20;

/// What the offset of a structure in its buffer must be a multiple of.
const OFFSET_ALIGNMENT: u64 = 256;

/// Builds structures from their names and inputs, in batches; compacted if the options say so.
pub(super) fn build(
    gpu: &Gpu,
    inputs: &[(&str, Input)],
    options: BuildOptions,
) -> Result<Vec<AccelerationStructure>> {
    let plans: Vec<_> =
        inputs.iter().map(|(name, input)| plan(gpu, name, input, options)).collect();
    let mut all = Vec::with_capacity(inputs.len());
    for range in batches(&plans, gpu.limits.min_scratch_offset_alignment) {
        let built = build_batch(gpu, &inputs[range.clone()], &plans[range])?;
        all.extend(if options.compact { compaction::compacted(gpu, &built)? } else { built });
    }
    Ok(all)
}

fn plan(gpu: &Gpu, name: &str, input: &Input, options: BuildOptions) -> Plan {
    let geometries = input.described();
    let info = vk::AccelerationStructureBuildGeometryInfoKHR::default()
        .ty(input.level())
        .flags(flags(options))
        .mode(vk::BuildAccelerationStructureModeKHR::BUILD)
        .geometries(&geometries);
    let mut sizes = vk::AccelerationStructureBuildSizesInfoKHR::default();
    // SAFETY: info and counts describe the same geometries.
    unsafe {
        gpu.acceleration_structure.get_acceleration_structure_build_sizes(
            vk::AccelerationStructureBuildTypeKHR::DEVICE,
            &info,
            &input.counts(),
            &mut sizes,
        );
    }
    Plan {
        name: name.to_owned(),
        options,
        shape: input.shape(),
        size: sizes.acceleration_structure_size,
        build_scratch: sizes.build_scratch_size,
        update_scratch: sizes.update_scratch_size,
    }
}

/// Neighbours whose structures and scratch fit a batch together.
fn batches(plans: &[Plan], scratch_alignment: u64) -> Vec<Range<usize>> {
    let mut all: Vec<Range<usize>> = Vec::new();
    let mut bytes = 0;
    for (index, plan) in plans.iter().enumerate() {
        let needed = plan.size.next_multiple_of(OFFSET_ALIGNMENT)
            + plan.build_scratch.next_multiple_of(scratch_alignment);
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

fn build_batch(
    gpu: &Gpu,
    inputs: &[(&str, Input)],
    plans: &[Plan],
) -> Result<Vec<AccelerationStructure>> {
    let sizes: Vec<_> = plans.iter().map(|plan| plan.size).collect();
    let built = lay_out(gpu, plans.to_vec(), &sizes)?;

    // The builds of a batch may run at the same time, so none may write to the scratch of another.
    let scratches = plans.iter().map(|plan| plan.build_scratch);
    let (offsets, room) = offsets(scratches, gpu.limits.min_scratch_offset_alignment);
    let scratch = scratch_buffer(gpu, room)?;
    let described: Vec<_> = inputs.iter().map(|(_, input)| input.described()).collect();
    let infos = built.iter().zip(&described).zip(offsets).map(|((built, geometries), offset)| {
        vk::AccelerationStructureBuildGeometryInfoKHR::default()
            .ty(built.plan.shape.level())
            .flags(flags(built.plan.options))
            .mode(vk::BuildAccelerationStructureModeKHR::BUILD)
            .geometries(geometries)
            .dst_acceleration_structure(built.handle)
            .scratch_data(vk::DeviceOrHostAddressKHR { device_address: scratch.address + offset })
    });
    let infos: Vec<_> = infos.collect();
    let ranges: Vec<_> = inputs.iter().map(|(_, input)| ranges(&input.counts())).collect();
    let ranges: Vec<_> = ranges.iter().map(Vec::as_slice).collect();
    let start = Instant::now();
    gpu.submit(|cmd| {
        record_builds(gpu, cmd, &infos, &ranges);
        Ok(())
    })
    .with_context(|| format!("cannot build {}", together(plans)))?;
    gpu.count(|statistics| statistics.build_time += start.elapsed());
    Ok(built)
}

/// Structures of the sizes given in one new buffer, not built yet.
pub(super) fn lay_out(
    gpu: &Gpu,
    plans: Vec<Plan>,
    sizes: &[u64],
) -> Result<Vec<AccelerationStructure>> {
    let usage = vk::BufferUsageFlags::ACCELERATION_STRUCTURE_STORAGE_KHR
        | vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS;
    let (offsets, room) = offsets(sizes.iter().copied(), OFFSET_ALIGNMENT);
    let buffer = Buffer::aligned(gpu, &together(&plans), room, usage, OFFSET_ALIGNMENT)?;
    let buffer = Arc::new(buffer);
    let placed = plans.into_iter().zip(sizes).zip(offsets);
    placed.map(|((plan, &size), offset)| place(gpu, plan, size, &buffer, offset)).collect()
}

fn place(
    gpu: &Gpu,
    plan: Plan,
    size: u64,
    buffer: &Arc<Buffer>,
    offset: u64,
) -> Result<AccelerationStructure> {
    let info = vk::AccelerationStructureCreateInfoKHR::default()
        .ty(plan.shape.level())
        .buffer(buffer.handle)
        .offset(offset)
        .size(size);
    // SAFETY: the buffer has room there and lives as long as the structure.
    let handle = unsafe { gpu.acceleration_structure.create_acceleration_structure(&info, None)? };
    let info =
        vk::AccelerationStructureDeviceAddressInfoKHR::default().acceleration_structure(handle);
    // SAFETY: the structure is alive.
    let address =
        unsafe { gpu.acceleration_structure.get_acceleration_structure_device_address(&info) };
    gpu.name_object(handle, &plan.name);
    gpu.count(|statistics| statistics.acceleration_structure_bytes += size);
    Ok(AccelerationStructure {
        handle,
        address,
        size,
        plan,
        _buffer: buffer.clone(),
        gpu: gpu.clone(),
    })
}

/// Where parts of these sizes lie one after the other, each at a multiple of `alignment`, and what they take.
fn offsets(sizes: impl Iterator<Item = u64>, alignment: u64) -> (Vec<u64>, u64) {
    let mut end = 0u64;
    let offsets = sizes.map(|size| {
        let offset = end.next_multiple_of(alignment);
        end = offset + size;
        offset
    });
    (offsets.collect(), end)
}

fn together(plans: &[Plan]) -> String {
    match plans {
        [one] => one.name.clone(),
        [first, others @ ..] => format!("{} and {} more", first.name, others.len()),
        [] => String::from("nothing"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn planned(size: u64, build_scratch: u64) -> Plan {
        let shape = Input::Instances(0, 1).shape();
        let (name, options) = ("one".into(), BuildOptions::default());
        Plan { name, options, shape, size, build_scratch, update_scratch: 0 }
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

    #[test]
    fn every_part_begins_where_it_may_and_ends_before_the_next() {
        assert_eq!(offsets([1, 256, 300, 7].into_iter(), 256), (vec![0, 256, 512, 1024], 1031));
    }
}
