//! Declarations missing in ash 0.38, of extensions without calls: `VK_KHR_shader_fma` (Vulkan 1.4.330) and
//! `VK_EXT_ray_tracing_invocation_reorder` (1.4.333), as in `vulkan_core.h`.

use std::ffi::{CStr, c_void};
use std::ptr;

use ash::vk;

use super::chained::chained;

/// The extension of [`FmaFeatures`].
pub const SHADER_FMA: &CStr = c"VK_KHR_shader_fma";
/// The extension of [`ReorderFeatures`].
pub const INVOCATION_REORDER: &CStr = c"VK_EXT_ray_tracing_invocation_reorder";

chained! {
    /// `VkPhysicalDeviceShaderFmaFeaturesKHR`: for floats of which width SPIR-V may use `OpFmaKHR`, which rounds once.
    FmaFeatures = 1_000_579_000 {
        shader_fma_float16: vk::Bool32 = vk::FALSE,
        shader_fma_float32: vk::Bool32 = vk::FALSE,
        shader_fma_float64: vk::Bool32 = vk::FALSE,
    }
}
chained! {
    /// `VkPhysicalDeviceRayTracingInvocationReorderFeaturesEXT`: whether threads may change places between two rays.
    ReorderFeatures = 1_000_581_000 { ray_tracing_invocation_reorder: vk::Bool32 = vk::FALSE }
}

// SAFETY: each begins as every structure of a chain, and the specification lets it stand in these, here and below.
unsafe impl vk::ExtendsPhysicalDeviceFeatures2 for FmaFeatures {}
// SAFETY: as above.
unsafe impl vk::ExtendsDeviceCreateInfo for FmaFeatures {}
// SAFETY: as above.
unsafe impl vk::ExtendsPhysicalDeviceFeatures2 for ReorderFeatures {}
// SAFETY: as above.
unsafe impl vk::ExtendsDeviceCreateInfo for ReorderFeatures {}
