//! The feature structures of a device, in the chain that Vulkan reads and fills.

use std::ffi::CStr;

use ash::{khr, vk};

use super::newer::{FmaFeatures, INVOCATION_REORDER, ReorderFeatures, SHADER_FMA};
use crate::gpu::accel::micromap_extension::{
    AddressCommandsFeatures, DEVICE_ADDRESS_COMMANDS, MicromapFeatures, OPACITY_MICROMAP,
};

/// The feature structures a chapter may use, as the device reports them or as they are enabled.
#[derive(Clone, Copy, Default)]
#[allow(missing_docs, reason = "they are Vulkan's")]
pub struct Features {
    pub core: vk::PhysicalDeviceFeatures,
    pub vulkan12: vk::PhysicalDeviceVulkan12Features<'static>,
    pub vulkan13: vk::PhysicalDeviceVulkan13Features<'static>,
    pub acceleration_structure: vk::PhysicalDeviceAccelerationStructureFeaturesKHR<'static>,
    pub ray_tracing_pipeline: vk::PhysicalDeviceRayTracingPipelineFeaturesKHR<'static>,
    pub position_fetch: vk::PhysicalDeviceRayTracingPositionFetchFeaturesKHR<'static>,
    pub ray_query: vk::PhysicalDeviceRayQueryFeaturesKHR<'static>,
    pub address_commands: AddressCommandsFeatures,
    pub micromap: MicromapFeatures,
    pub clock: vk::PhysicalDeviceShaderClockFeaturesKHR<'static>,
    pub fma: FmaFeatures,
    pub reorder: ReorderFeatures,
    pub executable: vk::PhysicalDevicePipelineExecutablePropertiesFeaturesKHR<'static>,
}

impl Features {
    /// The chain of the structures whose extensions `has` confirms: a structure must not be in the chain if the
    /// device lacks its extension.
    ///
    /// Call it once: afterwards the structures contain pointers to their neighbours in the chain.
    pub(in crate::gpu) fn chain(
        &mut self,
        has: impl Fn(&CStr) -> bool,
    ) -> vk::PhysicalDeviceFeatures2<'_> {
        let mut chain = vk::PhysicalDeviceFeatures2::default()
            .features(self.core)
            .push_next(&mut self.vulkan12)
            .push_next(&mut self.vulkan13);
        if has(khr::acceleration_structure::NAME) {
            chain = chain.push_next(&mut self.acceleration_structure);
        }
        if has(khr::ray_tracing_pipeline::NAME) {
            chain = chain.push_next(&mut self.ray_tracing_pipeline);
        }
        if has(khr::ray_tracing_position_fetch::NAME) {
            chain = chain.push_next(&mut self.position_fetch);
        }
        if has(khr::ray_query::NAME) {
            chain = chain.push_next(&mut self.ray_query);
        }
        if has(DEVICE_ADDRESS_COMMANDS) {
            chain = chain.push_next(&mut self.address_commands);
        }
        if has(OPACITY_MICROMAP) {
            chain = chain.push_next(&mut self.micromap);
        }
        if has(khr::shader_clock::NAME) {
            chain = chain.push_next(&mut self.clock);
        }
        if has(INVOCATION_REORDER) {
            chain = chain.push_next(&mut self.reorder);
        }
        if has(SHADER_FMA) {
            chain = chain.push_next(&mut self.fma);
        }
        if has(khr::pipeline_executable_properties::NAME) {
            chain = chain.push_next(&mut self.executable);
        }
        chain
    }
}
