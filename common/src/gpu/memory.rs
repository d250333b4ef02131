//! The memory of a buffer or an image.

pub mod arrays;
pub mod buffer;
pub mod image;
pub mod sampling;
pub mod staging;
pub mod texture;

use std::mem;

use anyhow::{Result, anyhow};
use ash::vk;
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::{Allocation, AllocationCreateDesc, AllocationScheme};

use super::Gpu;

/// A share of a `VkDeviceMemory`, freed on drop: the resource bound to it must be destroyed first.
pub(super) struct Memory {
    pub(super) allocation: Allocation,
    gpu: Gpu,
}

impl Memory {
    /// Memory that meets the requirements: for a buffer if `linear`, else for an image.
    pub(super) fn new(
        gpu: &Gpu,
        name: &str,
        requirements: vk::MemoryRequirements,
        location: MemoryLocation,
        linear: bool,
    ) -> Result<Self> {
        let allocation_scheme = AllocationScheme::GpuAllocatorManaged;
        let wanted =
            AllocationCreateDesc { name, requirements, location, linear, allocation_scheme };
        let allocator = gpu.allocator.lock();
        let mut allocator = allocator.map_err(|_| anyhow!("an allocating thread panicked"))?;
        Ok(Self { allocation: allocator.allocate(&wanted)?, gpu: gpu.clone() })
    }
}

impl Drop for Memory {
    fn drop(&mut self) {
        if let Ok(mut allocator) = self.gpu.allocator.lock() {
            // Freeing fails only for memory of another allocator.
            let _ = allocator.free(mem::take(&mut self.allocation));
        }
    }
}
