//! Declarations missing in ash 0.38: `VK_KHR_shader_fma` (Vulkan 1.4.330), as in `vulkan_core.h`.

use std::ffi::{CStr, c_void};
use std::ptr;

use ash::vk;

/// The extension of [`FmaFeatures`].
pub const SHADER_FMA: &CStr = c"VK_KHR_shader_fma";

/// `VkPhysicalDeviceShaderFmaFeaturesKHR`: for floats of which width SPIR-V may use `OpFmaKHR`, which rounds once.
#[repr(C)]
#[derive(Clone, Copy)]
#[allow(missing_docs, reason = "they are Vulkan's")]
pub struct FmaFeatures {
    pub s_type: vk::StructureType,
    pub p_next: *mut c_void,
    pub shader_fma_float16: vk::Bool32,
    pub shader_fma_float32: vk::Bool32,
    pub shader_fma_float64: vk::Bool32,
}

impl Default for FmaFeatures {
    fn default() -> Self {
        Self {
            s_type: vk::StructureType::from_raw(1_000_579_000),
            p_next: ptr::null_mut(),
            shader_fma_float16: vk::FALSE,
            shader_fma_float32: vk::FALSE,
            shader_fma_float64: vk::FALSE,
        }
    }
}

// SAFETY: its pointer is used only in calls that receive the whole chain.
unsafe impl Send for FmaFeatures {}
// SAFETY: as above.
unsafe impl Sync for FmaFeatures {}
// SAFETY: it begins as every structure of a chain, and the specification lets it stand in these two.
unsafe impl vk::ExtendsPhysicalDeviceFeatures2 for FmaFeatures {}
// SAFETY: as above.
unsafe impl vk::ExtendsDeviceCreateInfo for FmaFeatures {}
