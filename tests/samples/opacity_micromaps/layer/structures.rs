//! The extension's structures, transcribed independently from `vulkan_core.h` of 1.4.359: the framework has
//! its own, so that a mistake in one is not repeated in the other.

use std::ffi::c_void;

use ash::vk;

pub const FEATURES: i32 = 1_000_623_000;
pub const PROPERTIES: i32 = 1_000_623_001;
pub const MICROMAP_DATA: i32 = 1_000_623_002;
pub const TRIANGLES_MICROMAP: i32 = 1_000_623_003;
pub const ADDRESS_COMMANDS_FEATURES: i32 = 1_000_318_006;
pub const CREATE_INFO_2: i32 = 1_000_318_015;
/// `VK_ACCELERATION_STRUCTURE_TYPE_OPACITY_MICROMAP_KHR`, and `VK_GEOMETRY_TYPE_MICROMAP_KHR`.
pub const MICROMAP: i32 = 1_000_623_000;
/// `VK_PIPELINE_CREATE_RAY_TRACING_OPACITY_MICROMAP_BIT_KHR`.
pub const PIPELINE_FLAG: u32 = 0x0100_0000;
/// `VK_BUILD_ACCELERATION_STRUCTURE_…`: compaction, fast trace, fast build, lossy.
pub const BUILD_FLAGS: u32 = 0x2 | 0x4 | 0x8 | 0x400;

/// The layout of either extension's features.
#[repr(C)]
pub struct Feature {
    pub kind: i32,
    pub next: *mut c_void,
    pub on: vk::Bool32,
}

#[repr(C)]
pub struct Properties {
    pub kind: i32,
    pub next: *mut c_void,
    pub two_state_level: u32,
    pub four_state_level: u32,
    pub lossy_level: u32,
    pub triangles: u64,
}

#[repr(C)]
pub struct CreateInfo2 {
    pub kind: i32,
    pub next: *const c_void,
    pub flags: u32,
    pub address: u64,
    pub size: u64,
    pub address_flags: u32,
    pub structure: i32,
}

#[repr(C)]
pub struct MicromapData {
    pub kind: i32,
    pub next: *const c_void,
    pub usage_count: u32,
    pub usages: *const UsageError,
    pub usage_pointers: *const *const UsageError,
    pub data: u64,
    pub triangles: u64,
    pub stride: u64,
}

#[repr(C)]
#[derive(Clone, Copy)]
pub struct UsageError {
    pub count: u32,
    pub level: u32,
    pub format: u32,
}

#[repr(C)]
#[derive(Clone, Copy)]
pub struct Triangle {
    pub offset: u32,
    pub level: u16,
    pub format: u16,
}

#[repr(C)]
pub struct TrianglesMicromap {
    pub kind: i32,
    pub next: *mut c_void,
    pub index_type: i32,
    pub indices: u64,
    pub stride: u64,
    pub base: u32,
    pub micromap: vk::AccelerationStructureKHR,
}
