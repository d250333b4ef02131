//! What ash 0.38 does not know of `VK_KHR_opacity_micromap` (Vulkan 1.4.351) and of the extension that it is built
//! on, `VK_KHR_device_address_commands` (1.4.346): as in `vulkan_core.h` of 1.4.359.
//!
//! Vulkan specification, chapters "Micromap" and "Acceleration Structures"; what is not used here is left out.

use std::ffi::{CStr, c_void};
use std::ptr;

use ash::vk;

/// The name of the extension that [`MicromapFeatures`] belongs to.
pub const OPACITY_MICROMAP: &CStr = c"VK_KHR_opacity_micromap";
/// The name of the extension that [`AddressCommandsFeatures`] and [`CreateInfo2`] belong to.
pub const DEVICE_ADDRESS_COMMANDS: &CStr = c"VK_KHR_device_address_commands";

/// `VK_ACCELERATION_STRUCTURE_TYPE_OPACITY_MICROMAP_KHR`.
pub const TYPE: vk::AccelerationStructureTypeKHR =
    vk::AccelerationStructureTypeKHR::from_raw(1_000_623_000);
/// `VK_GEOMETRY_TYPE_MICROMAP_KHR`.
pub const GEOMETRY_TYPE: vk::GeometryTypeKHR = vk::GeometryTypeKHR::from_raw(1_000_623_000);
/// `VK_OPACITY_MICROMAP_FORMAT_4_STATE_KHR`: two bits a part.
pub const FORMAT_4_STATE: u16 = 2;
/// What the addresses of a build's `data` and `triangleArray` are a multiple of
/// (VUID-vkCmdBuildAccelerationStructuresKHR-micromap-11552).
pub const INPUT_ALIGNMENT: u64 = 128;

/// A structure of a chain, all of whose numbers are 0 at first.
macro_rules! chained {
    ($(#[$about:meta])* $name:ident = $kind:literal { $($field:ident: $type:ty = $zero:expr),* $(,)? }) => {
        $(#[$about])*
        #[repr(C)]
        #[derive(Clone, Copy)]
        #[allow(missing_docs, reason = "they are Vulkan's")]
        pub struct $name {
            pub s_type: vk::StructureType,
            pub p_next: *mut c_void,
            $(pub $field: $type),*
        }

        impl Default for $name {
            fn default() -> Self {
                let s_type = vk::StructureType::from_raw($kind);
                Self { s_type, p_next: ptr::null_mut(), $($field: $zero),* }
            }
        }

        // SAFETY: its pointers are used in calls that are given the whole chain.
        unsafe impl Send for $name {}
        // SAFETY: as above.
        unsafe impl Sync for $name {}
    };
}

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
    /// `VkAccelerationStructureCreateInfo2KHR`: the structure lies at an address, and no longer in a buffer.
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

/// `VkMicromapUsageKHR`: how many triangles of a micromap have this level and format.
#[repr(C)]
#[derive(Clone, Copy)]
#[allow(missing_docs, reason = "they are Vulkan's")]
pub struct MicromapUsage {
    pub count: u32,
    pub subdivision_level: u32,
    pub format: u32,
}

/// `VkMicromapTriangleKHR`: where the states of one triangle lie, and how many they are.
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
