//! The limits that ray tracing code must heed, read once.

use ash::{Instance, vk};
use serde::{Deserialize, Serialize};

/// Properties of the device that decide sizes, alignments and depths.
///
/// As text, a limit that an older program did not know of may be left out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Limits {
    /// The version of Vulkan that the device has: major, minor, patch.
    pub vulkan: [u32; 3],
    /// Who made the device, by its number at PCI-SIG or Khronos, and its maker's number for it.
    pub vendor_and_device: [u32; 2],
    /// Bytes of an opaque shader group handle (32 on every known device).
    pub shader_group_handle_size: u64,
    /// What the stride of a shader binding table's region is a multiple of.
    pub shader_group_handle_alignment: u64,
    /// What each region's address is a multiple of.
    pub shader_group_base_alignment: u64,
    /// The largest stride of a region.
    pub max_shader_group_stride: u64,
    /// How deep `traceRayEXT` may nest; the pipeline declares how deep it does.
    pub max_ray_recursion_depth: u32,
    /// The most rays of one `vkCmdTraceRaysKHR`.
    pub max_ray_dispatch_invocation_count: u32,
    /// The most invocations of a compute shader's workgroup.
    pub max_compute_work_group_invocations: u32,
    /// What the scratch address of an acceleration structure build is a multiple of.
    pub min_scratch_offset_alignment: u64,
    /// The most instances of a top level.
    pub max_instance_count: u64,
    /// The most primitives of a bottom level.
    pub max_primitive_count: u64,
    /// The largest side of a two-dimensional image.
    pub max_image_dimension: u32,
    /// The largest side of an image that is drawn to.
    pub max_attachment_side: u32,
    /// Bits of a pixel's fraction that the rasteriser rounds a vertex to.
    pub sub_pixel_precision_bits: u32,
    /// The most bytes of push constants.
    pub max_push_constants_size: u32,
    /// The most textures of a table: descriptors that may be written after they are bound.
    pub max_textures: u32,
    /// The most bytes of a buffer that is bound as a descriptor.
    pub max_storage_buffer_range: u64,
    /// The most bytes of a buffer in device memory: by the limits of buffers and of allocations, and by the
    /// memory that there is.
    pub max_buffer_size: u64,
    /// Nanoseconds a tick of a timestamp.
    pub timestamp_period: f32,
    /// The bits of a timestamp that count; none where the queue has no timestamps.
    pub timestamp_mask: u64,
    /// Whether shaders may compute with 64-bit floats, if the sample asks for it.
    pub float64: bool,
    /// Whether rays may skip all triangles or all boxes, if the sample asks for it.
    pub primitive_culling: bool,
    /// Whether a shader may demand that 32-bit floats are rounded to nearest even.
    pub rounding_to_nearest_even: bool,
    /// Whether a shader may demand that signs of zeros, infinities and NaN are kept.
    pub signed_zero_inf_nan: bool,
}

impl Limits {
    /// Whether the queue can write timestamps.
    pub fn has_timestamps(&self) -> bool {
        self.timestamp_mask != 0
    }

    /// Whether a picture may be so large.
    pub fn fits(&self, size: vk::Extent2D) -> bool {
        let rays = u64::from(size.width) * u64::from(size.height);
        size.width.max(size.height) <= self.max_image_dimension
            && rays <= self.max_ray_dispatch_invocation_count.into()
    }

    /// The largest size of the same shape that a picture may have, and at most `size`.
    pub fn fitted(&self, size: vk::Extent2D) -> vk::Extent2D {
        if self.fits(size) {
            return size;
        }
        let [width, height] = [size.width, size.height].map(f64::from);
        let most = f64::from(self.max_ray_dispatch_invocation_count);
        let side = f64::from(self.max_image_dimension);
        let scale = (most / (width * height)).sqrt().min(side / width.max(height));
        let [width, height] = [width, height].map(|side| ((side * scale) as u32).max(1));
        vk::Extent2D { width, height }
    }

    /// Reads the limits of a device that has the ray tracing extensions, and of a queue family.
    pub fn of(instance: &Instance, physical_device: vk::PhysicalDevice, family: u32) -> Self {
        let mut pipeline = vk::PhysicalDeviceRayTracingPipelinePropertiesKHR::default();
        let mut acceleration = vk::PhysicalDeviceAccelerationStructurePropertiesKHR::default();
        let mut vulkan11 = vk::PhysicalDeviceVulkan11Properties::default();
        let mut vulkan12 = vk::PhysicalDeviceVulkan12Properties::default();
        let mut vulkan13 = vk::PhysicalDeviceVulkan13Properties::default();
        let mut properties = vk::PhysicalDeviceProperties2::default()
            .push_next(&mut pipeline)
            .push_next(&mut vulkan11)
            .push_next(&mut vulkan12)
            .push_next(&mut vulkan13)
            .push_next(&mut acceleration);
        // SAFETY: the device belongs to the live instance and has both extensions.
        unsafe { instance.get_physical_device_properties2(physical_device, &mut properties) };
        let core = properties.properties.limits;
        let mut culling = vk::PhysicalDeviceRayTracingPipelineFeaturesKHR::default();
        let mut offered = vk::PhysicalDeviceFeatures2::default().push_next(&mut culling);
        // SAFETY: as above.
        unsafe { instance.get_physical_device_features2(physical_device, &mut offered) };
        let features = offered.features;
        // SAFETY: as above.
        let families =
            unsafe { instance.get_physical_device_queue_family_properties(physical_device) };
        let bits = families[family as usize].timestamp_valid_bits;
        let version = properties.properties.api_version;
        // SAFETY: as above.
        let memory = unsafe { instance.get_physical_device_memory_properties(physical_device) };
        let heaps = memory.memory_heaps_as_slice().iter();
        let heaps = heaps.filter(|heap| heap.flags.contains(vk::MemoryHeapFlags::DEVICE_LOCAL));
        let heap = heaps.map(|heap| heap.size).max().unwrap_or(u64::MAX);
        Self {
            vulkan: [
                vk::api_version_major(version),
                vk::api_version_minor(version),
                vk::api_version_patch(version),
            ],
            vendor_and_device: [properties.properties.vendor_id, properties.properties.device_id],
            shader_group_handle_size: pipeline.shader_group_handle_size.into(),
            shader_group_handle_alignment: pipeline.shader_group_handle_alignment.into(),
            shader_group_base_alignment: pipeline.shader_group_base_alignment.into(),
            max_shader_group_stride: pipeline.max_shader_group_stride.into(),
            max_ray_recursion_depth: pipeline.max_ray_recursion_depth,
            max_ray_dispatch_invocation_count: pipeline.max_ray_dispatch_invocation_count,
            max_compute_work_group_invocations: core.max_compute_work_group_invocations,
            min_scratch_offset_alignment: acceleration
                .min_acceleration_structure_scratch_offset_alignment
                .into(),
            max_instance_count: acceleration.max_instance_count,
            max_primitive_count: acceleration.max_primitive_count,
            max_image_dimension: core.max_image_dimension2_d,
            max_attachment_side: [core.max_framebuffer_width, core.max_framebuffer_height]
                .into_iter()
                .chain(core.max_viewport_dimensions)
                .fold(core.max_image_dimension2_d, u32::min),
            sub_pixel_precision_bits: core.sub_pixel_precision_bits,
            max_push_constants_size: core.max_push_constants_size,
            // Set 0 has resources, too: at most as many as there are push descriptors.
            max_textures: [
                vulkan12.max_per_stage_descriptor_update_after_bind_samplers,
                vulkan12.max_per_stage_descriptor_update_after_bind_sampled_images,
                vulkan12.max_per_stage_update_after_bind_resources.saturating_sub(32),
                vulkan12.max_descriptor_set_update_after_bind_samplers,
                vulkan12.max_descriptor_set_update_after_bind_sampled_images,
                vulkan12.max_update_after_bind_descriptors_in_all_pools,
            ]
            .into_iter()
            .fold(u32::MAX, u32::min),
            max_storage_buffer_range: core.max_storage_buffer_range.into(),
            max_buffer_size: vulkan13
                .max_buffer_size
                .min(vulkan11.max_memory_allocation_size)
                .min(heap),
            timestamp_period: core.timestamp_period,
            timestamp_mask: u64::MAX.checked_shr(64 - bits).unwrap_or(0),
            float64: features.shader_float64 == vk::TRUE,
            primitive_culling: culling.ray_traversal_primitive_culling == vk::TRUE,
            rounding_to_nearest_even: vulkan12.shader_rounding_mode_rte_float32 == vk::TRUE,
            signed_zero_inf_nan: vulkan12.shader_signed_zero_inf_nan_preserve_float32 == vk::TRUE,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_size_that_is_too_large_keeps_its_shape() {
        let limits = Limits {
            max_image_dimension: 16_384,
            max_ray_dispatch_invocation_count: 1 << 26,
            ..Limits::default()
        };
        let size = |width, height| vk::Extent2D { width, height };
        assert_eq!(limits.fitted(size(960, 600)), size(960, 600));
        for wide in [size(16_000, 4_500), size(32_000, 300), size(u32::MAX, u32::MAX)] {
            let fitted = limits.fitted(wide);
            assert!(!limits.fits(wide) && limits.fits(fitted), "{fitted:?}");
            let shape = |size: vk::Extent2D| f64::from(size.width) / f64::from(size.height);
            assert!((shape(fitted) / shape(wide) - 1.0).abs() < 0.01, "{fitted:?}");
        }
        assert_eq!(limits.fitted(size(u32::MAX, 1)).height, 1);
    }
}
