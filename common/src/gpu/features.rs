//! The feature structures of a device, in the chain that Vulkan reads and fills.

use std::ffi::CStr;

use ash::{khr, nv, vk};

/// The feature structures that a chapter may ask for, filled by the device or by a sample's wishes.
#[derive(Clone, Copy, Default)]
pub struct Features {
    pub(super) core: vk::PhysicalDeviceFeatures,
    pub(super) vulkan12: vk::PhysicalDeviceVulkan12Features<'static>,
    pub(super) vulkan13: vk::PhysicalDeviceVulkan13Features<'static>,
    pub(super) acceleration_structure: vk::PhysicalDeviceAccelerationStructureFeaturesKHR<'static>,
    pub(super) ray_tracing_pipeline: vk::PhysicalDeviceRayTracingPipelineFeaturesKHR<'static>,
    pub(super) position_fetch: vk::PhysicalDeviceRayTracingPositionFetchFeaturesKHR<'static>,
    pub(super) ray_query: vk::PhysicalDeviceRayQueryFeaturesKHR<'static>,
    pub(super) executable: vk::PhysicalDevicePipelineExecutablePropertiesFeaturesKHR<'static>,
    pub(super) reorder: vk::PhysicalDeviceRayTracingInvocationReorderFeaturesNV<'static>,
}

impl Features {
    /// Calls `f` with the chain of structures whose extensions `has` confirms.
    ///
    /// A structure of an extension that the device lacks must stay out of the chain.
    pub fn with_chain<R>(
        &mut self,
        has: impl Fn(&CStr) -> bool,
        f: impl FnOnce(&mut vk::PhysicalDeviceFeatures2) -> R,
    ) -> R {
        let Self {
            core,
            vulkan12,
            vulkan13,
            acceleration_structure,
            ray_tracing_pipeline,
            position_fetch,
            ray_query,
            executable,
            reorder,
        } = self;
        // Copies carry the chain, so that no structure keeps a pointer to its neighbour afterwards.
        let mut links = (
            *vulkan12,
            *vulkan13,
            *acceleration_structure,
            *ray_tracing_pipeline,
            *executable,
            *position_fetch,
            *ray_query,
            *reorder,
        );
        let mut root = vk::PhysicalDeviceFeatures2::default()
            .features(*core)
            .push_next(&mut links.0)
            .push_next(&mut links.1);
        if has(khr::acceleration_structure::NAME) {
            root = root.push_next(&mut links.2);
        }
        if has(khr::ray_tracing_pipeline::NAME) {
            root = root.push_next(&mut links.3);
        }
        if has(khr::pipeline_executable_properties::NAME) {
            root = root.push_next(&mut links.4);
        }
        if has(khr::ray_tracing_position_fetch::NAME) {
            root = root.push_next(&mut links.5);
        }
        if has(khr::ray_query::NAME) {
            root = root.push_next(&mut links.6);
        }
        if has(nv::ray_tracing_invocation_reorder::NAME) {
            root = root.push_next(&mut links.7);
        }
        let result = f(&mut root);
        *core = root.features;
        let unlinked = std::ptr::null_mut();
        *vulkan12 = vk::PhysicalDeviceVulkan12Features { p_next: unlinked, ..links.0 };
        *vulkan13 = vk::PhysicalDeviceVulkan13Features { p_next: unlinked, ..links.1 };
        *acceleration_structure =
            vk::PhysicalDeviceAccelerationStructureFeaturesKHR { p_next: unlinked, ..links.2 };
        *ray_tracing_pipeline =
            vk::PhysicalDeviceRayTracingPipelineFeaturesKHR { p_next: unlinked, ..links.3 };
        *executable = vk::PhysicalDevicePipelineExecutablePropertiesFeaturesKHR {
            p_next: unlinked,
            ..links.4
        };
        *position_fetch =
            vk::PhysicalDeviceRayTracingPositionFetchFeaturesKHR { p_next: unlinked, ..links.5 };
        *ray_query = vk::PhysicalDeviceRayQueryFeaturesKHR { p_next: unlinked, ..links.6 };
        *reorder =
            vk::PhysicalDeviceRayTracingInvocationReorderFeaturesNV { p_next: unlinked, ..links.7 };
        result
    }
}
