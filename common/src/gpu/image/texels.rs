//! Textures: images whose texels come from the host, many in one copy.

use anyhow::{Result, ensure};
use ash::vk;

use super::{Gpu, Image};
use crate::gpu::staging::Staging;

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
        let images: Vec<_> = all.iter().map(|one| blank(gpu, one)).collect::<Result<_>>()?;
        let mut staging = Staging::new(gpu, all.iter().map(|one| one.rgba.len()).sum())?;
        for (image, texels) in images.iter().zip(all) {
            staging.fill_image(image, texels.rgba)?;
        }
        staging.submit()?;
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
