//! The limits that ray tracing code must respect, in Vulkan's own structures, read once.

use std::ffi::CStr;
use std::ops::Deref;
use std::ptr;

use ash::{Instance, khr, vk};

use crate::gpu::ADDRESS_ALIGNMENT;
use crate::gpu::accel::micromap_extension::{MicromapProperties, OPACITY_MICROMAP};

/// Properties of the device that determine sizes, alignments and depths; those of ray tracing pipelines are
/// accessible without the name of their structure.
#[derive(Clone, Copy, Default)]
pub struct Limits {
    /// Those of Vulkan 1.0.
    pub core: vk::PhysicalDeviceLimits,
    /// Those of Vulkan 1.1.
    pub vulkan11: vk::PhysicalDeviceVulkan11Properties<'static>,
    /// Those of Vulkan 1.2.
    pub vulkan12: vk::PhysicalDeviceVulkan12Properties<'static>,
    /// Those of Vulkan 1.3.
    pub vulkan13: vk::PhysicalDeviceVulkan13Properties<'static>,
    /// Those of acceleration structures; zeros where the device has none.
    pub acceleration_structure: vk::PhysicalDeviceAccelerationStructurePropertiesKHR<'static>,
    /// Those of ray tracing pipelines; zeros where the device has none.
    pub ray_tracing_pipeline: vk::PhysicalDeviceRayTracingPipelinePropertiesKHR<'static>,
    /// Those of opacity micromaps; zeros where the device has none.
    pub micromap: MicromapProperties,
    /// Bytes of the largest heap of device memory.
    pub largest_heap: u64,
    /// Number of valid bits of a timestamp; 0 if the queue has no timestamps.
    pub timestamp_bits: u32,
}

impl Deref for Limits {
    type Target = vk::PhysicalDeviceRayTracingPipelinePropertiesKHR<'static>;

    fn deref(&self) -> &Self::Target {
        &self.ray_tracing_pipeline
    }
}

impl Limits {
    /// Reads the limits of a device with Vulkan 1.3 and the extensions that `has` confirms, without those of its queue.
    pub fn of(
        instance: &Instance,
        physical_device: vk::PhysicalDevice,
        has: impl Fn(&CStr) -> bool,
    ) -> Self {
        let mut all = Self::default();
        let mut properties = vk::PhysicalDeviceProperties2::default()
            .push_next(&mut all.vulkan11)
            .push_next(&mut all.vulkan12)
            .push_next(&mut all.vulkan13);
        if has(khr::acceleration_structure::NAME) {
            properties = properties.push_next(&mut all.acceleration_structure);
        }
        if has(khr::ray_tracing_pipeline::NAME) {
            properties = properties.push_next(&mut all.ray_tracing_pipeline);
        }
        if has(OPACITY_MICROMAP) {
            properties = properties.push_next(&mut all.micromap);
        }
        // SAFETY: the device belongs to the live instance and has what the chain is of, here and below.
        unsafe { instance.get_physical_device_properties2(physical_device, &mut properties) };
        // The stored structures must not keep pointers to their former neighbours in the chain.
        let mut link = properties.p_next.cast::<vk::BaseOutStructure>();
        // SAFETY: the structures of the chain are alive.
        while let Some(structure) = unsafe { link.as_mut() } {
            link = std::mem::replace(&mut structure.p_next, ptr::null_mut());
        }
        all.core = properties.properties.limits;
        // SAFETY: as above.
        let memory = unsafe { instance.get_physical_device_memory_properties(physical_device) };
        let heaps = memory.memory_heaps_as_slice().iter();
        let heaps = heaps.filter(|heap| heap.flags.contains(vk::MemoryHeapFlags::DEVICE_LOCAL));
        all.largest_heap = heaps.map(|heap| heap.size).max().unwrap_or(u64::MAX);
        all
    }

    /// True if the device has ray tracing pipelines, all of which allow at least one ray.
    pub fn has_ray_tracing(&self) -> bool {
        self.max_ray_recursion_depth > 0
    }

    /// The most pixels of a picture: the limit of rays in one trace, if the device can trace.
    pub fn max_pixels(&self) -> u64 {
        if self.has_ray_tracing() {
            self.max_ray_dispatch_invocation_count.into()
        } else {
            u64::from(self.core.max_image_dimension2_d).pow(2)
        }
    }

    /// True if the queue can write timestamps.
    pub fn has_timestamps(&self) -> bool {
        self.timestamp_bits != 0
    }

    /// Alignment of the scratch address of an acceleration structure build.
    pub fn min_scratch_offset_alignment(&self) -> u64 {
        self.acceleration_structure.min_acceleration_structure_scratch_offset_alignment.into()
    }

    /// Alignment of any buffer's address, sufficient for whatever begins at the start of a buffer, including the
    /// scratch of a build and a region of a shader binding table.
    pub fn address_alignment(&self) -> u64 {
        let region = self.shader_group_base_alignment.into();
        ADDRESS_ALIGNMENT.max(self.min_scratch_offset_alignment()).max(region)
    }

    /// The largest side of an image that is drawn to.
    pub fn max_attachment_side(&self) -> u32 {
        let drawn = self.core.max_framebuffer_width.min(self.core.max_framebuffer_height);
        let sides = self.core.max_viewport_dimensions;
        sides.into_iter().fold(drawn.min(self.core.max_image_dimension2_d), u32::min)
    }

    /// The largest table of textures: descriptors that may be updated after they are bound.
    pub fn max_textures(&self) -> u32 {
        let all = &self.vulkan12;
        // Set 0 also has resources: at most as many as there are push descriptors.
        let resources = all.max_per_stage_update_after_bind_resources.saturating_sub(32);
        resources
            .min(all.max_per_stage_descriptor_update_after_bind_samplers)
            .min(all.max_per_stage_descriptor_update_after_bind_sampled_images)
            .min(all.max_descriptor_set_update_after_bind_samplers)
            .min(all.max_descriptor_set_update_after_bind_sampled_images)
            .min(all.max_update_after_bind_descriptors_in_all_pools)
    }

    /// The largest buffer in device memory, in bytes: by the limits for buffers and allocations, and by the
    /// available memory.
    pub fn max_buffer_size(&self) -> u64 {
        let most = self.vulkan13.max_buffer_size.min(self.vulkan11.max_memory_allocation_size);
        most.min(self.largest_heap)
    }

    /// True if a picture may have this size.
    pub fn fits(&self, size: vk::Extent2D) -> bool {
        let pixels = u64::from(size.width) * u64::from(size.height);
        size.width.max(size.height) <= self.core.max_image_dimension2_d
            && pixels <= self.max_pixels()
    }

    /// The largest size of the same shape that a picture may have, at most `size`.
    pub fn fitted(&self, size: vk::Extent2D) -> vk::Extent2D {
        if self.fits(size) {
            return size;
        }
        let [width, height] = [size.width, size.height].map(f64::from);
        let most = self.max_pixels() as f64;
        let side = f64::from(self.core.max_image_dimension2_d);
        let scale = (most / (width * height)).sqrt().min(side / width.max(height));
        let [width, height] = [width, height].map(|side| ((side * scale) as u32).max(1));
        vk::Extent2D { width, height }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_size_that_is_too_large_keeps_its_shape() {
        let mut limits = Limits::default();
        limits.core.max_image_dimension2_d = 16_384;
        limits.ray_tracing_pipeline.max_ray_recursion_depth = 1;
        limits.ray_tracing_pipeline.max_ray_dispatch_invocation_count = 1 << 26;
        let size = |width, height| vk::Extent2D { width, height };
        assert_eq!(limits.fitted(size(960, 600)), size(960, 600));
        for wide in [size(16_000, 4_500), size(32_000, 300), size(u32::MAX, u32::MAX)] {
            let fitted = limits.fitted(wide);
            assert!(!limits.fits(wide) && limits.fits(fitted), "{fitted:?}");
            let shape = |size: vk::Extent2D| f64::from(size.width) / f64::from(size.height);
            assert!((shape(fitted) / shape(wide) - 1.0).abs() < 0.01, "{fitted:?}");
        }
        assert_eq!(limits.fitted(size(u32::MAX, 1)).height, 1);
        // Without tracing, the limit of rays does not apply.
        limits.ray_tracing_pipeline = Default::default();
        assert!(limits.fits(size(16_384, 16_384)) && !limits.fits(size(16_385, 1)));
        assert_eq!(limits.fitted(size(32_768, 32_768)), size(16_384, 16_384));
    }
}
