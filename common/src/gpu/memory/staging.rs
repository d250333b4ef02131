//! Staging: bytes on their way to the device and back, through a buffer that the host has mapped.

use anyhow::Result;
use ash::vk::{self, ImageLayout as Layout};
use gpu_allocator::MemoryLocation;

use crate::gpu::memory::image;
use crate::gpu::{Buffer, Gpu, Image, barrier};

/// How many bytes a staging buffer has at most: what is larger goes in parts, and memory does not hold it twice.
const MOST: usize = 32 << 20;

/// How an image is left: ready to be sampled.
const SAMPLED: Layout = Layout::SHADER_READ_ONLY_OPTIMAL;

/// A mapped buffer, and the copies from it that wait to be submitted: many in one submission.
pub(in crate::gpu) struct Staging {
    gpu: Gpu,
    buffer: Buffer,
    /// Bytes that wait in it.
    used: usize,
    /// Where they belong.
    to_buffers: Vec<(vk::Buffer, vk::BufferCopy)>,
    to_images: Vec<(vk::Image, Layout, vk::BufferImageCopy)>,
}

impl Staging {
    /// As large as all that is to be copied, but no larger than a few copies one after the other need.
    pub(in crate::gpu) fn new(gpu: &Gpu, bytes: usize) -> Result<Self> {
        let size = bytes.min(MOST) as u64;
        let buffer = Buffer::mapped(gpu, "staging", size, MemoryLocation::CpuToGpu)?;
        Ok(Self { gpu: gpu.clone(), buffer, used: 0, to_buffers: vec![], to_images: vec![] })
    }

    /// Copies bytes to a buffer, `offset` bytes from its start, with the next submission.
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

    /// Copies texels of four bytes to a new image, to be sampled after the next submission, in bands of rows where
    /// they are too many. Where texels wait, no bytes of a buffer may: a texel lies at a multiple of 4.
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
            // A band that another follows takes all the room: the next one finds the image as this one left it.
            let before = if number == 0 { Layout::UNDEFINED } else { SAMPLED };
            self.to_images.push((image.handle, before, region));
        }
        Ok(())
    }

    /// Puts bytes into the buffer, after a submission if there is no room; where.
    fn put(&mut self, bytes: &[u8]) -> Result<u64> {
        if self.used + bytes.len() > self.buffer.size as usize {
            self.submit()?;
        }
        let start = self.used;
        self.used += bytes.len();
        self.buffer.mapped_bytes()[start..self.used].copy_from_slice(bytes);
        Ok(start as u64)
    }

    /// Copies all that waits, and waits for it.
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

/// A mapped buffer with the bytes that `copy` puts there; what it reads, it has to wait for.
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
