//! Textures: images whose texels come from the host, many in one copy.

use anyhow::{Result, ensure};
use ash::vk;

use super::{Buffer, Gpu, Image, whole};

/// What a texture holds.
#[derive(Clone, Copy)]
pub struct Texels<'a> {
    /// What messages call it.
    pub name: &'a str,
    /// Texels in a row, and rows.
    pub extent: vk::Extent2D,
    /// Four bytes a texel, rows from the top.
    pub rgba: &'a [u8],
    /// Whether RGB is sRGB encoded.
    pub srgb: bool,
}

impl Image {
    /// Textures, ready to be sampled: their texels go through one staging buffer, in bands of rows where they
    /// are larger than that.
    ///
    /// # Errors
    /// If texels are not four bytes a pixel, a side is out of range, or memory is short.
    pub fn textures(gpu: &Gpu, all: &[Texels]) -> Result<Vec<Self>> {
        use vk::ImageLayout as Layout;
        let images: Vec<_> = all.iter().map(|one| blank(gpu, one)).collect::<Result<_>>()?;
        let change = |from, to| {
            gpu.submit(|cmd| {
                images.iter().for_each(|image| image.transition(cmd, from, to));
                Ok(())
            })
        };
        change(Layout::UNDEFINED, Layout::TRANSFER_DST_OPTIMAL)?;
        let size = all.iter().map(|one| one.rgba.len() as u64).sum::<u64>();
        let mut upload =
            Upload { gpu, staging: Buffer::staging(gpu, size)?, staged: 0, bands: Vec::new() };
        for (image, texels) in images.iter().zip(all) {
            upload.push(image, texels)?;
        }
        upload.copy()?;
        change(Layout::TRANSFER_DST_OPTIMAL, Layout::SHADER_READ_ONLY_OPTIMAL)?;
        Ok(images)
    }
}

fn blank(gpu: &Gpu, texels: &Texels) -> Result<Image> {
    let Texels { name, extent, rgba, srgb } = *texels;
    let needed = 4 * extent.width as usize * extent.height as usize;
    ensure!(rgba.len() == needed, "texture '{name}' has {} bytes, not {needed}", rgba.len());
    let format = if srgb { vk::Format::R8G8B8A8_SRGB } else { vk::Format::R8G8B8A8_UNORM };
    let usage = vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST;
    Image::new(gpu, name, extent, format, format, usage)
}

/// Bands of rows on their way to images in `TRANSFER_DST_OPTIMAL`.
struct Upload<'a> {
    gpu: &'a Gpu,
    staging: Buffer,
    /// Bytes that wait in the staging buffer, and where they belong.
    staged: usize,
    bands: Vec<(vk::Image, vk::BufferImageCopy)>,
}

impl Upload<'_> {
    fn push(&mut self, image: &Image, texels: &Texels) -> Result<()> {
        let row = 4 * texels.extent.width as usize;
        let mut left = texels.rgba;
        while !left.is_empty() {
            let rows = (self.staging.size as usize - self.staged) / row;
            if rows == 0 {
                self.copy()?;
                continue;
            }
            let (band, later) = left.split_at((rows * row).min(left.len()));
            self.staging.mapped_bytes()[self.staged..][..band.len()].copy_from_slice(band);
            let first = (texels.rgba.len() - left.len()) / row;
            self.bands.push((image.handle, self.region(first, band.len() / row, texels.extent)));
            self.staged += band.len();
            left = later;
        }
        Ok(())
    }

    fn region(&self, first: usize, rows: usize, extent: vk::Extent2D) -> vk::BufferImageCopy {
        let layers = vk::ImageSubresourceLayers::default()
            .aspect_mask(whole().aspect_mask)
            .layer_count(whole().layer_count);
        vk::BufferImageCopy::default()
            .buffer_offset(self.staged as u64)
            .image_subresource(layers)
            .image_offset(vk::Offset3D { x: 0, y: first as i32, z: 0 })
            .image_extent(vk::Extent3D { width: extent.width, height: rows as u32, depth: 1 })
    }

    fn copy(&mut self) -> Result<()> {
        self.gpu.submit(|cmd| {
            for (image, band) in &self.bands {
                // SAFETY: the staging buffer and the images outlive the submission.
                unsafe {
                    self.gpu.device.cmd_copy_buffer_to_image(
                        cmd,
                        self.staging.handle,
                        *image,
                        vk::ImageLayout::TRANSFER_DST_OPTIMAL,
                        &[*band],
                    );
                }
            }
            Ok(())
        })?;
        self.bands.clear();
        self.staged = 0;
        Ok(())
    }
}
