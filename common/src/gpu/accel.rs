//! Acceleration structures: bottom levels of triangles or boxes, top levels of instances.
//!
//! A build needs three sizes from the driver (structure, build scratch, update scratch), a buffer for
//! the structure and one for the scratch. Compaction copies a structure into a buffer of the size that
//! it turned out to need; an update moves primitives without changing which there are.

mod compaction;
mod input;
mod update;

use std::time::Instant;

use anyhow::{Context, Result, ensure};
use ash::vk;

use super::geometry::Geometry;
use super::{Buffer, Gpu, barrier};
pub use input::Input;
use input::Shape;

/// What a build may cost and allow later.
#[derive(Clone, Copy, Default)]
pub struct BuildOptions {
    /// Allow [`AccelerationStructure::update`], which a driver may pay for with memory and with a tree that is
    /// slower to trace.
    pub updatable: bool,
    /// Copy the result into a buffer of just the size it needs.
    pub compact: bool,
    /// Let hit shaders ask for the corners of its triangles; needs `VK_KHR_ray_tracing_position_fetch`.
    pub data_access: bool,
}

/// A `VkAccelerationStructureKHR` of either level with its buffer, freed on drop.
pub struct AccelerationStructure {
    /// The Vulkan handle.
    pub handle: vk::AccelerationStructureKHR,
    /// What an instance names a bottom level by.
    pub address: vk::DeviceAddress,
    /// Bytes of its buffer.
    pub size: u64,
    /// Bytes that a build needs beside it.
    pub build_scratch: u64,
    /// Bytes that an update needs beside it.
    pub update_scratch: u64,
    name: String,
    options: BuildOptions,
    shape: Shape,
    /// Bytes that a build in its place would take: more than it has, once it is compacted.
    build_size: u64,
    _buffer: Buffer,
    gpu: Gpu,
}

impl AccelerationStructure {
    /// Builds a bottom level from geometries, whose order is their `gl_GeometryIndexEXT`.
    ///
    /// # Errors
    /// If there are more primitives than the device allows, or memory is short.
    pub fn bottom(
        gpu: &Gpu,
        name: &str,
        input: &[Geometry],
        options: BuildOptions,
    ) -> Result<Self> {
        let total: u64 = input.iter().map(|geometry| u64::from(geometry.count())).sum();
        let limit = gpu.limits.max_primitive_count;
        ensure!(total <= limit, "'{name}' has {total} primitives; {} takes {limit}", gpu.name);
        let built = Self::build(gpu, name, Input::Geometries(input), options)?;
        if options.compact { built.compacted() } else { Ok(built) }
    }

    /// Builds a top level from a buffer of `count` `VkAccelerationStructureInstanceKHR`.
    ///
    /// The bottom levels that the instances name must stay alive as long as it is traced.
    ///
    /// # Errors
    /// As [`AccelerationStructure::bottom`].
    pub fn top(
        gpu: &Gpu,
        name: &str,
        instances: &Buffer,
        count: u32,
        options: BuildOptions,
    ) -> Result<Self> {
        let limit = gpu.limits.max_instance_count;
        ensure!(
            u64::from(count) <= limit,
            "'{name}' has {count} instances; {} takes {limit}",
            gpu.name
        );
        Self::build(gpu, name, Input::Instances(instances.address, count), options)
    }

    fn build(gpu: &Gpu, name: &str, input: Input, options: BuildOptions) -> Result<Self> {
        let (geometries, counts) = (input.described(), input.counts());
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
                &counts,
                &mut sizes,
            );
        }
        let size = sizes.acceleration_structure_size;
        let mut built = Self::empty(gpu, name, input.shape(), options, size)?;
        built.build_scratch = sizes.build_scratch_size;
        built.update_scratch = sizes.update_scratch_size;
        let scratch = scratch_buffer(gpu, sizes.build_scratch_size)?;
        let info = info
            .dst_acceleration_structure(built.handle)
            .scratch_data(vk::DeviceOrHostAddressKHR { device_address: scratch.address });
        let start = Instant::now();
        gpu.submit(|cmd| {
            record_build(gpu, cmd, info, &counts);
            Ok(())
        })
        .with_context(|| format!("cannot build '{name}'"))?;
        gpu.count(|statistics| statistics.build_time += start.elapsed());
        Ok(built)
    }

    fn empty(
        gpu: &Gpu,
        name: &str,
        shape: Shape,
        options: BuildOptions,
        size: u64,
    ) -> Result<Self> {
        let usage = vk::BufferUsageFlags::ACCELERATION_STRUCTURE_STORAGE_KHR
            | vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS;
        // An acceleration structure's offset in memory must be a multiple of 256 bytes.
        let buffer = Buffer::aligned(gpu, name, size, usage, 256)?;
        let info = vk::AccelerationStructureCreateInfoKHR::default()
            .ty(shape.level())
            .buffer(buffer.handle)
            .size(size);
        // SAFETY: the buffer is large enough and lives beside the structure.
        let handle =
            unsafe { gpu.acceleration_structure.create_acceleration_structure(&info, None)? };
        let info =
            vk::AccelerationStructureDeviceAddressInfoKHR::default().acceleration_structure(handle);
        // SAFETY: the structure is alive.
        let address =
            unsafe { gpu.acceleration_structure.get_acceleration_structure_device_address(&info) };
        gpu.name_object(handle, name);
        gpu.count(|statistics| statistics.acceleration_structure_bytes += size);
        Ok(Self {
            handle,
            address,
            size,
            build_scratch: 0,
            update_scratch: 0,
            name: name.to_owned(),
            options,
            shape,
            build_size: size,
            _buffer: buffer,
            gpu: gpu.clone(),
        })
    }
}

impl Drop for AccelerationStructure {
    fn drop(&mut self) {
        // SAFETY: submissions are waited for, so no trace or build uses it any more.
        unsafe {
            self.gpu.acceleration_structure.destroy_acceleration_structure(self.handle, None);
        }
        self.gpu.count(|statistics| statistics.acceleration_structure_bytes -= self.size);
    }
}

fn flags(options: BuildOptions) -> vk::BuildAccelerationStructureFlagsKHR {
    use vk::BuildAccelerationStructureFlagsKHR as Flags;
    let mut flags = Flags::PREFER_FAST_TRACE;
    if options.updatable {
        flags |= Flags::ALLOW_UPDATE;
    }
    if options.compact {
        flags |= Flags::ALLOW_COMPACTION;
    }
    if options.data_access {
        flags |= Flags::ALLOW_DATA_ACCESS;
    }
    flags
}

fn scratch_buffer(gpu: &Gpu, size: u64) -> Result<Buffer> {
    let usage = vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS;
    Buffer::aligned(gpu, "scratch", size, usage, gpu.limits.min_scratch_offset_alignment)
}

fn record_build(
    gpu: &Gpu,
    cmd: vk::CommandBuffer,
    info: vk::AccelerationStructureBuildGeometryInfoKHR,
    counts: &[u32],
) {
    let ranges: Vec<_> = counts
        .iter()
        .map(|&count| vk::AccelerationStructureBuildRangeInfoKHR::default().primitive_count(count))
        .collect();
    barrier::trace_to_build(gpu, cmd);
    barrier::between_builds(gpu, cmd);
    // SAFETY: every address in info belongs to a buffer that outlives the submission.
    unsafe {
        gpu.acceleration_structure.cmd_build_acceleration_structures(cmd, &[info], &[&ranges]);
    }
    barrier::between_builds(gpu, cmd);
    barrier::build_to_trace(gpu, cmd);
}
