//! Declarations missing in ash 0.38: `VK_KHR_opacity_micromap` (Vulkan 1.4.351) and the extension it depends on,
//! `VK_KHR_device_address_commands` (1.4.346), as in `vulkan_core.h` of 1.4.359.
//!
//! Vulkan specification, chapters "Micromap" and "Acceleration Structures"; unused declarations are omitted.

use std::ffi::{CStr, c_void};
use std::ptr;

use ash::vk;

use crate::gpu::device::chained::chained;

/// The extension of [`MicromapFeatures`].
pub const OPACITY_MICROMAP: &CStr = c"VK_KHR_opacity_micromap";
/// The extension of [`AddressCommandsFeatures`] and [`CreateInfo2`].
pub const DEVICE_ADDRESS_COMMANDS: &CStr = c"VK_KHR_device_address_commands";

/// `VK_ACCELERATION_STRUCTURE_TYPE_OPACITY_MICROMAP_KHR`.
pub const TYPE: vk::AccelerationStructureTypeKHR =
    vk::AccelerationStructureTypeKHR::from_raw(1_000_623_000);
/// `VK_GEOMETRY_TYPE_MICROMAP_KHR`.
pub const GEOMETRY_TYPE: vk::GeometryTypeKHR = vk::GeometryTypeKHR::from_raw(1_000_623_000);
/// `VK_OPACITY_MICROMAP_FORMAT_4_STATE_KHR`: two bits per part.
pub const FORMAT_4_STATE: u16 = 2;
/// Alignment of a build's `data` and `triangleArray` (VUID-vkCmdBuildAccelerationStructuresKHR-micromap-11552).
pub const INPUT_ALIGNMENT: u64 = 128;

chained! {
    /// `VkPhysicalDeviceDeviceAddressCommandsFeaturesKHR`.
    AddressCommandsFeatures = 1_000_318_006 { device_address_commands: vk::Bool32 = 0 }
}
chained! {
    /// `VkPhysicalDeviceOpacityMicromapFeaturesKHR`.
    MicromapFeatures = 1_000_623_000 { micromap: vk::Bool32 = 0 }
}
chained! {
    /// `VkPhysicalDeviceOpacityMicromapPropertiesKHR`.
    MicromapProperties = 1_000_623_001 {
        max_opacity2_state_subdivision_level: u32 = 0,
        max_opacity4_state_subdivision_level: u32 = 0,
        max_opacity_lossy4_state_subdivision_level: u32 = 0,
        max_micromap_triangles: u64 = 0,
    }
}
chained! {
    /// `VkAccelerationStructureCreateInfo2KHR`: the structure is created at an address rather than in a buffer.
    CreateInfo2 = 1_000_318_015 {
        create_flags: u32 = 0,
        address: vk::DeviceAddress = 0,
        size: vk::DeviceSize = 0,
        address_flags: u32 = 0,
        ty: vk::AccelerationStructureTypeKHR = TYPE,
    }
}
chained! {
    /// `VkAccelerationStructureGeometryMicromapDataKHR`, in the chain of a build's only geometry.
    MicromapData = 1_000_623_002 {
        usage_counts_count: u32 = 0,
        p_usage_counts: *const MicromapUsage = ptr::null(),
        pp_usage_counts: *const *const MicromapUsage = ptr::null(),
        data: vk::DeviceAddress = 0,
        triangle_array: vk::DeviceAddress = 0,
        triangle_array_stride: vk::DeviceSize = size_of::<MicromapTriangle>() as u64,
    }
}
chained! {
    /// `VkAccelerationStructureTrianglesOpacityMicromapKHR`, in the chain of a bottom level's triangles.
    TrianglesMicromap = 1_000_623_003 {
        index_type: vk::IndexType = vk::IndexType::UINT32,
        index_buffer: vk::DeviceAddress = 0,
        index_stride: vk::DeviceSize = size_of::<u32>() as u64,
        base_triangle: u32 = 0,
        micromap: vk::AccelerationStructureKHR = vk::AccelerationStructureKHR::null(),
    }
}

/// `VkMicromapUsageKHR`: the number of triangles of a micromap with this level and format.
#[repr(C)]
#[derive(Clone, Copy)]
#[allow(missing_docs, reason = "they are Vulkan's")]
pub struct MicromapUsage {
    pub count: u32,
    pub subdivision_level: u32,
    pub format: u32,
}

/// `VkMicromapTriangleKHR`: the position and number of the states of one triangle.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
#[allow(missing_docs, reason = "they are Vulkan's")]
pub struct MicromapTriangle {
    pub data_offset: u32,
    pub subdivision_level: u16,
    pub format: u16,
}

/// `vkCreateAccelerationStructure2KHR`.
pub type CreateAccelerationStructure2 = unsafe extern "system" fn(
    vk::Device,
    *const CreateInfo2,
    *const vk::AllocationCallbacks<'_>,
    *mut vk::AccelerationStructureKHR,
) -> vk::Result;

// SAFETY: each begins as every structure of a chain, and the specification lets it stand in these, here and below.
unsafe impl vk::ExtendsPhysicalDeviceFeatures2 for AddressCommandsFeatures {}
// SAFETY: as above.
unsafe impl vk::ExtendsDeviceCreateInfo for AddressCommandsFeatures {}
// SAFETY: as above.
unsafe impl vk::ExtendsPhysicalDeviceFeatures2 for MicromapFeatures {}
// SAFETY: as above.
unsafe impl vk::ExtendsDeviceCreateInfo for MicromapFeatures {}
// SAFETY: as above.
unsafe impl vk::ExtendsPhysicalDeviceProperties2 for MicromapProperties {}
