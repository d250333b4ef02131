//! The list of every surface that a ray crosses: so many hits for each ray, in device memory.

use anyhow::{Result, ensure};
use ash::vk;
use common::gpu::{Buffer, Gpu};

/// Capacity of a ray's list of hits; `push.glsl` has the same number.
pub const MAX_HITS: u32 = 32;

common::shader_struct! {
    /// A surface that a ray crossed.
    pub struct ListedHit { instance: u32, triangle: u32, t: f32 }
}

/// A list for so many rays.
///
/// # Errors
/// If the device has no room for it in one buffer.
pub fn list(gpu: &Gpu, rays: u64) -> Result<Buffer> {
    let most = gpu.limits.max_buffer_size() / size(1);
    ensure!(
        rays <= most,
        "a list of all hits takes {} bytes per pixel: {} has room for {most} pixels, not for {rays}; \
         a smaller picture fits",
        size(1),
        gpu.name
    );
    let usage = vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS;
    Buffer::new(gpu, "hits", size(rays), usage)
}

/// Bytes of a list for so many rays.
pub fn size(rays: u64) -> u64 {
    rays * u64::from(MAX_HITS) * size_of::<ListedHit>() as u64
}
