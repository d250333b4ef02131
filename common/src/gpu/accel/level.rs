//! The part of an acceleration structure that a top level shares with it: the structure itself.

use std::sync::Arc;

use ash::vk;

use crate::gpu::{Buffer, Gpu};

/// A `VkAccelerationStructureKHR`, freed on drop. Top levels hold their bottom levels, because a device reads both.
pub struct Level {
    /// The Vulkan handle.
    pub handle: vk::AccelerationStructureKHR,
    /// Its address.
    pub address: vk::DeviceAddress,
    /// Bytes it occupies in a buffer.
    pub size: u64,
    /// Its name.
    pub name: String,
    /// The kind of its geometries, if it has any, and their number.
    pub geometries: (Option<vk::GeometryTypeKHR>, u32),
    /// The buffer that contains it, shared with others built with it.
    pub(super) _buffer: Arc<Buffer>,
    pub(super) gpu: Gpu,
}

impl Drop for Level {
    fn drop(&mut self) {
        self.gpu.forget_level(self.address);
        // SAFETY: submissions are waited for, so no trace or build uses it any more.
        unsafe {
            self.gpu.acceleration_structure.destroy_acceleration_structure(self.handle, None);
        }
        self.gpu.count(|statistics| statistics.acceleration_structure_bytes -= self.size);
    }
}
