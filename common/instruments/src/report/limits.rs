//! The limits of a device that chapters depend on, for reports and report cards.

use ash::vk;
use common::gpu::Gpu;
use serde::{Deserialize, Serialize};

/// Properties of the device that determine sizes, alignments and depths.
///
/// In JSON, a limit may be missing if an older program wrote it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Limits {
    /// The device's Vulkan version: major, minor, patch.
    pub vulkan: [u32; 3],
    /// The device's maker, by its PCI-SIG or Khronos number, and the maker's number for the device.
    pub vendor_and_device: [u32; 2],
    /// Bytes of an opaque shader group handle (32 on every known device); this and other values of ray tracing are
    /// 0 on a device without it.
    pub shader_group_handle_size: u64,
    /// Alignment of the stride of a shader binding table's region.
    pub shader_group_handle_alignment: u64,
    /// Alignment of each region's address.
    pub shader_group_base_alignment: u64,
    /// The largest stride of a region.
    pub max_shader_group_stride: u64,
    /// The maximum nesting of `traceRayEXT`; the pipeline declares its own depth.
    pub max_ray_recursion_depth: u32,
    /// The most rays of one `vkCmdTraceRaysKHR`.
    pub max_ray_dispatch_invocation_count: u32,
    /// The most invocations of a compute shader's workgroup.
    pub max_compute_work_group_invocations: u32,
    /// Alignment of the scratch address of an acceleration structure build.
    pub min_scratch_offset_alignment: u64,
    /// The most instances of a top level.
    pub max_instance_count: u64,
    /// The most primitives of a bottom level.
    pub max_primitive_count: u64,
    /// The largest side of a two-dimensional image.
    pub max_image_dimension: u32,
    /// The largest side of an image that is drawn to.
    pub max_attachment_side: u32,
    /// Bits of subpixel precision, to which the rasteriser rounds a vertex.
    pub sub_pixel_precision_bits: u32,
    /// The most bytes of push constants.
    pub max_push_constants_size: u32,
    /// The largest table of textures: descriptors that may be updated after they are bound.
    pub max_textures: u32,
    /// The largest buffer bound as a descriptor, in bytes.
    pub max_storage_buffer_range: u64,
    /// The largest buffer in device memory, in bytes: by the limits for buffers and allocations, and by the
    /// available memory.
    pub max_buffer_size: u64,
    /// Nanoseconds per tick of a timestamp.
    pub timestamp_period: f32,
    /// Number of valid bits of a timestamp; 0 if the queue has no timestamps.
    pub timestamp_mask: u64,
    /// True if shaders may use 64-bit floats, if the sample requests them.
    pub float64: bool,
    /// True if rays may skip all triangles or all boxes, if the sample requests it.
    pub primitive_culling: bool,
    /// True if a shader may require 32-bit floats to be rounded to nearest even.
    pub rounding_to_nearest_even: bool,
    /// True if a shader may require signs of zeros, infinities and NaN to be preserved.
    pub signed_zero_inf_nan: bool,
}

impl Limits {
    /// The limits of an open device.
    pub fn of(gpu: &Gpu) -> Self {
        let mut culling = vk::PhysicalDeviceRayTracingPipelineFeaturesKHR::default();
        let mut offered = vk::PhysicalDeviceFeatures2::default();
        if gpu.limits.has_ray_tracing() {
            offered = offered.push_next(&mut culling);
        }
        // SAFETY: the device belongs to the live instance, and has the extension whose structure is chained.
        unsafe {
            gpu.vulkan.instance.get_physical_device_features2(gpu.physical_device, &mut offered);
        }
        let float64 = offered.features.shader_float64 == vk::TRUE;
        let (properties, limits) = (&gpu.properties, &gpu.limits);
        let (core, version) = (&limits.core, properties.api_version);
        let (acceleration, floats) = (&limits.acceleration_structure, &limits.vulkan12);
        Self {
            vulkan: [
                vk::api_version_major(version),
                vk::api_version_minor(version),
                vk::api_version_patch(version),
            ],
            vendor_and_device: [properties.vendor_id, properties.device_id],
            shader_group_handle_size: limits.shader_group_handle_size.into(),
            shader_group_handle_alignment: limits.shader_group_handle_alignment.into(),
            shader_group_base_alignment: limits.shader_group_base_alignment.into(),
            max_shader_group_stride: limits.max_shader_group_stride.into(),
            max_ray_recursion_depth: limits.max_ray_recursion_depth,
            max_ray_dispatch_invocation_count: limits.max_ray_dispatch_invocation_count,
            max_compute_work_group_invocations: core.max_compute_work_group_invocations,
            min_scratch_offset_alignment: limits.min_scratch_offset_alignment(),
            max_instance_count: acceleration.max_instance_count,
            max_primitive_count: acceleration.max_primitive_count,
            max_image_dimension: core.max_image_dimension2_d,
            max_attachment_side: limits.max_attachment_side(),
            sub_pixel_precision_bits: core.sub_pixel_precision_bits,
            max_push_constants_size: core.max_push_constants_size,
            max_textures: limits.max_textures(),
            max_storage_buffer_range: core.max_storage_buffer_range.into(),
            max_buffer_size: limits.max_buffer_size(),
            timestamp_period: core.timestamp_period,
            timestamp_mask: u64::MAX.checked_shr(64 - limits.timestamp_bits).unwrap_or(0),
            float64,
            primitive_culling: culling.ray_traversal_primitive_culling == vk::TRUE,
            rounding_to_nearest_even: floats.shader_rounding_mode_rte_float32 == vk::TRUE,
            signed_zero_inf_nan: floats.shader_signed_zero_inf_nan_preserve_float32 == vk::TRUE,
        }
    }
}
