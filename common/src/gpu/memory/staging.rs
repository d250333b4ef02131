//! Staging: transfers to and from the device through a mapped buffer.

use anyhow::Result;
use ash::vk::{self, ImageLayout as Layout};
use gpu_allocator::MemoryLocation;

use crate::gpu::memory::image;
use crate::gpu::{Buffer, Gpu, Image, barrier};

/// The largest staging buffer, in bytes. Larger data is copied in parts, so that memory does not hold it twice.
const MOST: usize = 32 << 20;

/// The final layout of an image: ready to be sampled.
const SAMPLED: Layout = Layout::SHADER_READ_ONLY_OPTIMAL;

/// A mapped buffer, and the copies from it still to be submitted, many in one submission.
pub(in crate::gpu) struct Staging {
    gpu: Gpu,
    buffer: Buffer,
    /// Bytes in use.
    used: usize,
    /// Destinations of the bytes.
    to_buffers: Vec<(vk::Buffer, vk::BufferCopy)>,
    to_images: Vec<(vk::Image, Layout, vk::BufferImageCopy)>,
}

impl Staging {
    /// A buffer as large as the data to be copied, but at most `MOST` bytes: more is copied in parts.
    pub(in crate::gpu) fn new(gpu: &Gpu, bytes: usize) -> Result<Self> {
        let size = bytes.min(MOST) as u64;
        let buffer = Buffer::mapped(gpu, "staging", size, MemoryLocation::CpuToGpu)?;
        Ok(Self { gpu: gpu.clone(), buffer, used: 0, to_buffers: vec![], to_images: vec![] })
    }

    /// Copies bytes to a buffer, at `offset` bytes, with the next submission.
    pub(in crate::gpu) fn fill_buffer(
        &mut self,
        buffer: &Buffer,
        offset: u64,
        bytes: &[u8],
    ) -> Result<()> {
        for (number, part) in bytes.chunks(MOST).enumerate() {
            let dst_offset = offset + (number * MOST) as u64;
            let size = part.len() as u64;
            let region = vk::BufferCopy { src_offset: self.put(part)?, dst_offset, size };
            self.to_buffers.push((buffer.handle, region));
        }
        Ok(())
    }

    /// Copies texels of four bytes each to a new image, to be sampled after the next submission, in bands of rows
    /// if they do not fit. Texels and buffer data must not wait together: a texel's offset must be a multiple of
    /// 4.
    pub(in crate::gpu) fn fill_image(&mut self, image: &Image, rgba: &[u8]) -> Result<()> {
        let row = 4 * image.extent.width as usize;
        let rows = MOST / row;
        for (number, band) in rgba.chunks(rows * row).enumerate() {
            let height = (band.len() / row) as u32;
            let region = vk::BufferImageCopy {
                buffer_offset: self.put(band)?,
                image_offset: vk::Offset3D { x: 0, y: (number * rows) as i32, z: 0 },
                image_extent: vk::Extent3D { height, ..image.extent.into() },
                ..image::COPY
            };
            // A band followed by another fills the buffer, so each later one is in another submission and finds
            // the layout left by this one.
            let before = if number == 0 { Layout::UNDEFINED } else { SAMPLED };
            self.to_images.push((image.handle, before, region));
        }
        Ok(())
    }

    /// Puts bytes into the buffer, after a submission if there is no room; returns their offset.
    fn put(&mut self, bytes: &[u8]) -> Result<u64> {
        if self.used + bytes.len() > self.buffer.size as usize {
            self.submit()?;
        }
        let start = self.used;
        self.used += bytes.len();
        self.buffer.mapped_bytes()[start..self.used].copy_from_slice(bytes);
        Ok(start as u64)
    }

    /// Submits all waiting copies and waits for them.
    pub(in crate::gpu) fn submit(&mut self) -> Result<()> {
        let (gpu, from) = (&self.gpu, self.buffer.handle);
        gpu.submit(|cmd| {
            let layout = Layout::TRANSFER_DST_OPTIMAL;
            for &(to, region) in &self.to_buffers {
                // SAFETY: all buffers and images outlive the submission, which is waited for, here and below.
                unsafe { gpu.device.cmd_copy_buffer(cmd, from, to, &[region]) };
            }
            for &(to, before, region) in &self.to_images {
                image::transition(gpu, cmd, to, before, layout);
                // SAFETY: as above.
                unsafe { gpu.device.cmd_copy_buffer_to_image(cmd, from, to, layout, &[region]) };
                image::transition(gpu, cmd, to, layout, SAMPLED);
            }
            barrier::after_upload(gpu, cmd);
            Ok(())
        })?;
        self.to_buffers.clear();
        self.to_images.clear();
        self.used = 0;
        Ok(())
    }
}

/// A mapped buffer with the bytes that `copy` writes; `copy` must include barriers for its sources.
pub(in crate::gpu) fn read_back(
    gpu: &Gpu,
    name: &str,
    bytes: u64,
    copy: impl FnOnce(vk::CommandBuffer, vk::Buffer),
) -> Result<Buffer> {
    let buffer = Buffer::mapped(gpu, name, bytes, MemoryLocation::GpuToCpu)?;
    gpu.submit(|cmd| {
        copy(cmd, buffer.handle);
        barrier::after_readback(gpu, cmd);
        Ok(())
    })?;
    Ok(buffer)
}
