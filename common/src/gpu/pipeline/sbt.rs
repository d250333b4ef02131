//! The shader binding table: it selects the shaders for a ray, and carries the data of each record.
//!
//! Four regions (raygen, miss, hit, callable), each an array of records with a fixed stride. A record is a group's
//! opaque handle and the bytes after it, which the shader reads as `shaderRecordEXT`. The device's limits
//! determine where a region may begin and how long a record must be; getting that wrong works on some vendors'
//! devices and loses the device on others, so the arithmetic is separate and tested with the limits of several.

use std::sync::{Mutex, PoisonError};

use anyhow::{Result, ensure};
use ash::vk;

use crate::gpu::check::table::Table;
use crate::gpu::{Buffer, Gpu, Limits, RayTracingPipeline, barrier};

/// A region of the table's buffer, in bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Region {
    /// From the start of the buffer.
    pub offset: u64,
    /// From one record to the next.
    pub stride: u64,
    /// The size of all its records; 0 for a region without any.
    pub size: u64,
}

/// The regions of a table, in the order of `vkCmdTraceRaysKHR`: raygen, miss, hit, callable.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SbtLayout {
    /// The four regions.
    pub regions: [Region; 4],
    /// Bytes of the whole buffer.
    pub size: u64,
}

/// Lays out regions of `records[r]` records, each with at most `data[r]` bytes after its handle.
///
/// A stride is a multiple of `shaderGroupHandleAlignment`; a region begins at a multiple of
/// `shaderGroupBaseAlignment`; the raygen region holds one record and its size equals its stride
/// (`VUID-vkCmdTraceRaysKHR-size-04023`).
///
/// # Errors
/// If a record is longer than `maxShaderGroupStride`.
pub fn layout(limits: &Limits, records: [usize; 4], data: [usize; 4]) -> Result<SbtLayout> {
    let mut result = SbtLayout::default();
    for (region, slot) in result.regions.iter_mut().enumerate() {
        let bytes = u64::from(limits.shader_group_handle_size) + data[region] as u64;
        let stride = bytes.next_multiple_of(limits.shader_group_handle_alignment.into());
        ensure!(
            stride <= limits.max_shader_group_stride.into(),
            "a shader record of {bytes} bytes is longer than the device's {}",
            limits.max_shader_group_stride
        );
        if records[region] > 0 {
            let offset = result.size.next_multiple_of(limits.shader_group_base_alignment.into());
            let size = stride * records[region] as u64;
            *slot = Region { offset, stride, size };
            result.size = offset + size;
        }
    }
    Ok(result)
}

/// The index of the hit record a ray uses, by the formula of the specification.
///
/// `instanceShaderBindingTableRecordOffset + geometryIndex × sbtRecordStride + sbtRecordOffset`
/// (Vulkan specification, "Hit Shader Binding Table").
pub fn hit_record(
    instance_offset: u32,
    geometry: u32,
    trace_stride: u32,
    trace_offset: u32,
) -> u32 {
    instance_offset + geometry * trace_stride + trace_offset
}

/// One record: a group of the pipeline, and the bytes after its handle.
#[derive(Clone, Debug, Default)]
pub struct Record {
    /// The group's position among the groups of its kind, in the pipeline's order.
    pub group: usize,
    /// The data the shader reads as `shaderRecordEXT`.
    pub data: Vec<u8>,
}

/// One record per group, without data.
fn one_each(groups: usize) -> Vec<Record> {
    (0..groups).map(|group| Record { group, data: Vec::new() }).collect()
}

/// A table in device memory.
pub struct ShaderBindingTable {
    /// The layout of its regions.
    pub layout: SbtLayout,
    /// The regions' addresses, as `vkCmdTraceRaysKHR` takes them: raygen, miss, hit, callable.
    pub regions: [vk::StridedDeviceAddressRegionKHR; 4],
    /// The first pixel in the raygen shader's record, once all recorded commands are done.
    first: Mutex<vk::Offset2D>,
    buffer: Buffer,
    gpu: Gpu,
}

impl ShaderBindingTable {
    /// A table with one record for each group of the pipeline, in order, without data.
    ///
    /// ```no_run
    /// use raybook::prelude::*;
    ///
    /// fn table(gpu: &Gpu, pipeline: &RayTracingPipeline) -> Result<ShaderBindingTable> {
    ///     ShaderBindingTable::new(gpu, pipeline)
    /// }
    ///
    /// /// Traces the part of the picture in `frame.area` with the bound pipeline.
    /// fn trace(table: &ShaderBindingTable, frame: &Frame) {
    ///     table.trace(frame.cmd, frame.area);
    /// }
    /// ```
    ///
    /// # Errors
    /// If memory is short.
    pub fn new(gpu: &Gpu, pipeline: &RayTracingPipeline) -> Result<Self> {
        Self::with_hit_records(gpu, pipeline, &one_each(pipeline.groups[2]))
    }

    /// A table whose hit region contains the records in `hit`, several per group if need be.
    ///
    /// # Errors
    /// If a record names a group that the pipeline does not have, is too long, or memory is short.
    pub fn with_hit_records(
        gpu: &Gpu,
        pipeline: &RayTracingPipeline,
        hit: &[Record],
    ) -> Result<Self> {
        let longest = hit.iter().map(|record| record.data.len()).max().unwrap_or(0);
        let [raygen, miss, _, callable] = pipeline.groups.map(one_each);
        let records = [&raygen[..], &miss, hit, &callable];
        // The raygen record contains the first pixel of a launch.
        let data = [size_of::<[u32; 2]>(), 0, longest, 0];
        let layout = layout(&gpu.limits, records.map(<[_]>::len), data)?;
        let handle_size = gpu.limits.shader_group_handle_size as usize;
        let total: usize = pipeline.groups.iter().sum();
        let (extension, size) = (&gpu.ray_tracing_pipeline, total * handle_size);
        let (handle, total) = (pipeline.handle, total as u32);
        // SAFETY: the pipeline is alive and has this many groups.
        let handles =
            unsafe { extension.get_ray_tracing_shader_group_handles(handle, 0, total, size)? };
        let mut bytes = vec![0u8; layout.size as usize];
        let mut first_group = 0;
        for ((records, region), count) in records.iter().zip(layout.regions).zip(pipeline.groups) {
            for (index, Record { group, data }) in (0..).zip(*records) {
                ensure!(
                    *group < count,
                    "a shader record names group {group}; the pipeline has {count} of its kind"
                );
                let handle = &handles[(first_group + group) * handle_size..][..handle_size];
                let record = &mut bytes[(region.offset + index * region.stride) as usize..];
                record[..handle_size].copy_from_slice(handle);
                record[handle_size..][..data.len()].copy_from_slice(data);
            }
            first_group += count;
        }
        pipeline.knows_hit_records(hit);
        let (desc, groups) = (pipeline.desc.clone(), pipeline.groups);
        let hit = hit.iter().map(|record| record.group).collect();
        gpu.count(|statistics| statistics.tables.push(Table { desc, groups, hit }));
        let usage = vk::BufferUsageFlags::SHADER_BINDING_TABLE_KHR
            | vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS;
        let name = format!("{} shader binding table", pipeline.desc.name);
        let buffer = Buffer::with_data(gpu, &name, &bytes, usage)?;
        let regions = layout.regions.map(|Region { offset, stride, size }| {
            let device_address = if size > 0 { buffer.address + offset } else { 0 };
            vk::StridedDeviceAddressRegionKHR { device_address, stride, size }
        });
        Ok(Self { layout, regions, first: Mutex::default(), buffer, gpu: gpu.clone() })
    }

    /// Replaces the data of one hit record for the traces recorded into `cmd` from here on; its group stays the same.
    ///
    /// # Errors
    /// If there is no such record, or the data is longer than the record or not whole `u32`s.
    pub fn write_hit_data(&self, cmd: vk::CommandBuffer, record: usize, data: &[u8]) -> Result<()> {
        let Region { offset, stride, size } = self.layout.regions[2];
        let handle = u64::from(self.gpu.limits.shader_group_handle_size);
        let start = record as u64 * stride;
        ensure!(
            start < size,
            "the table has {} hit records, none with number {record}",
            size / stride.max(1)
        );
        ensure!(
            data.len() as u64 <= stride - handle,
            "{} bytes do not fit a record's {}",
            data.len(),
            stride - handle
        );
        ensure!(data.len().is_multiple_of(4), "{} bytes are no whole number of u32", data.len());
        self.update(cmd, offset + start + handle, data);
        Ok(())
    }

    fn update(&self, cmd: vk::CommandBuffer, at: u64, data: &[u8]) {
        barrier::trace_to_table_update(&self.gpu, cmd);
        // SAFETY: cmd is being recorded; the table outlives the submission and has room for the data,
        // whose length and place are multiples of 4 and which a record's largest stride keeps short.
        unsafe { self.gpu.device.cmd_update_buffer(cmd, self.buffer.handle, at, data) };
        barrier::table_update_to_trace(&self.gpu, cmd);
    }

    /// Records one ray per pixel of `area`, from the raygen group.
    ///
    /// A launch counts from 0: the raygen shader's record contains the area's first pixel, two `u32`, for it to add.
    pub fn trace(&self, cmd: vk::CommandBuffer, area: vk::Rect2D) {
        let [raygen, miss, hit, callable] = &self.regions;
        let vk::Rect2D { offset, extent: vk::Extent2D { width, height } } = area;
        let mut first = self.first.lock().unwrap_or_else(PoisonError::into_inner);
        // A picture in one piece changes nothing, so it needs no barrier.
        if *first != offset {
            *first = offset;
            let handle = u64::from(self.gpu.limits.shader_group_handle_size);
            let at = self.layout.regions[0].offset + handle;
            self.update(cmd, at, bytemuck::cast_slice(&[offset.x, offset.y]));
        }
        let extension = &self.gpu.ray_tracing_pipeline;
        // SAFETY: the pipeline and its descriptors are bound, and the table outlives the submission.
        unsafe { extension.cmd_trace_rays(cmd, raygen, miss, hit, callable, width, height, 1) };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Handle size, handle alignment, base alignment, largest stride, as drivers report them.
    const VENDORS: [(&str, [u32; 4]); 4] = [
        ("NVIDIA", [32, 32, 64, 4096]),
        ("AMD (RADV)", [32, 16, 32, 16_384]),
        ("Intel (ANV)", [32, 16, 64, 65_535]),
        ("an extreme of the specification", [32, 64, 4096, 4096]),
    ];

    fn limits([size, alignment, base, stride]: [u32; 4]) -> Limits {
        let mut limits = Limits::default();
        limits.ray_tracing_pipeline.shader_group_handle_size = size;
        limits.ray_tracing_pipeline.shader_group_handle_alignment = alignment;
        limits.ray_tracing_pipeline.shader_group_base_alignment = base;
        limits.ray_tracing_pipeline.max_shader_group_stride = stride;
        limits
    }

    #[test]
    fn every_vendor_gets_aligned_regions_that_do_not_overlap() {
        for (vendor, numbers) in VENDORS {
            let limits = limits(numbers);
            for records in [[1, 1, 1, 0], [1, 2, 7, 3], [1, 0, 1, 0], [1, 5, 100, 9]] {
                for data in [[0; 4], [0, 0, 4, 0], [0, 12, 33, 1]] {
                    let layout = layout(&limits, records, data).unwrap();
                    let [size, alignment, base, _] = numbers.map(u64::from);
                    let mut end = 0;
                    for (r, region) in layout.regions.iter().enumerate() {
                        if records[r] == 0 {
                            assert_eq!(*region, Region::default(), "{vendor}");
                            continue;
                        }
                        assert_eq!(region.offset % base, 0, "{vendor}");
                        assert_eq!(region.stride % alignment, 0, "{vendor}");
                        assert!(region.stride >= size + data[r] as u64);
                        assert_eq!(region.size, region.stride * records[r] as u64, "{vendor}");
                        assert!(region.offset >= end, "{vendor}: regions overlap");
                        end = region.offset + region.size;
                    }
                    assert_eq!(layout.size, end, "{vendor}");
                    assert_eq!(
                        layout.regions[0].size, layout.regions[0].stride,
                        "{vendor}: raygen"
                    );
                }
            }
        }
    }

    #[test]
    fn a_table_on_nvidia_limits_by_hand() {
        let layout = layout(&limits(VENDORS[0].1), [1, 2, 2, 0], [0, 0, 16, 0]).unwrap();
        assert_eq!(layout.regions[0], Region { offset: 0, stride: 32, size: 32 });
        assert_eq!(layout.regions[1], Region { offset: 64, stride: 32, size: 64 });
        assert_eq!(layout.regions[2], Region { offset: 128, stride: 64, size: 128 });
        assert_eq!(layout.size, 256);
    }

    #[test]
    fn a_record_longer_than_the_device_allows_is_refused() {
        let limits = limits(VENDORS[0].1);
        assert!(layout(&limits, [1, 1, 1, 0], [0, 0, 4064, 0]).is_ok());
        let error = layout(&limits, [1, 1, 1, 0], [0, 0, 4065, 0]).unwrap_err().to_string();
        assert!(error.contains("4097 bytes"), "{error}");
    }

    #[test]
    fn the_hit_record_formula_is_the_specification_s() {
        assert_eq!(hit_record(4, 0, 1, 0), 4);
        assert_eq!(hit_record(4, 2, 2, 1), 9);
    }
}
