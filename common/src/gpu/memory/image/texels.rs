//! Textures: images with texels from the host, many in one copy.

use anyhow::{Result, ensure};
use ash::vk;

use super::{Gpu, Image, mipmaps};
use crate::gpu::Sampling;
use crate::gpu::memory::staging::Staging;

/// The contents of a texture.
#[derive(Clone, Copy)]
pub struct Texels<'a> {
    /// A name for messages.
    pub name: &'a str,
    /// Texels in a row, and rows.
    pub extent: vk::Extent2D,
    /// Four bytes per texel, rows from top to bottom: four channels, or two half floats.
    pub rgba: &'a [u8],
    /// True if RGB is sRGB encoded.
    pub srgb: bool,
    /// True for two half floats, red and green. Blue and alpha are then 1.
    pub halves: bool,
    /// Filter, and continuation beyond the edges.
    pub sampling: Sampling,
}

impl Image {
    /// Textures, ready to be sampled: their texels go through one staging buffer, in bands of rows if they are
    /// larger than that. With `mipmaps`, each has all mip levels, made on the device.
    ///
    /// # Errors
    /// If texels are not four bytes each, a side is out of range, or memory is short.
    pub fn textures(gpu: &Gpu, all: &[Texels], mipmaps: bool) -> Result<Vec<Self>> {
        let blank = |one| blank(gpu, one, mipmaps);
        let images: Vec<_> = all.iter().map(blank).collect::<Result<_>>()?;
        let mut staging = Staging::new(gpu, all.iter().map(|one| one.rgba.len()).sum())?;
        for (image, texels) in images.iter().zip(all) {
            staging.fill_image(image, texels.rgba)?;
        }
        staging.submit()?;
        if mipmaps {
            mipmaps::make(gpu, &images)?;
        }
        Ok(images)
    }
}

fn blank(gpu: &Gpu, texels: &Texels, mipmaps: bool) -> Result<Image> {
    let Texels { name, extent, rgba, srgb, halves, .. } = *texels;
    let needed = 4 * extent.width as usize * extent.height as usize;
    ensure!(rgba.len() == needed, "texture '{name}' has {} bytes, not {needed}", rgba.len());
    // Every device samples and blits these formats with a linear filter.
    let format = match (halves, srgb) {
        (true, _) => vk::Format::R16G16_SFLOAT,
        (_, true) => vk::Format::R8G8B8A8_SRGB,
        _ => vk::Format::R8G8B8A8_UNORM,
    };
    let usage = vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST;
    if !mipmaps {
        return Image::new(gpu, name, extent, format, format, usage, 1);
    }
    let usage = usage | vk::ImageUsageFlags::TRANSFER_SRC;
    Image::new(gpu, name, extent, format, format, usage, mipmaps::levels(extent))
}
