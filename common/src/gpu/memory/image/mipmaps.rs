//! Mipmaps: each level of a texture is made from the one before, on the device.

use anyhow::Result;
use ash::vk::{self, ImageLayout as Layout};

use super::{Gpu, Image, transition_level};

/// Number of mip levels, from the full size down to one texel.
pub(super) fn levels(extent: vk::Extent2D) -> u32 {
    extent.width.max(extent.height).max(1).ilog2() + 1
}

// ANCHOR: make
/// Fills all levels but the first, which holds texels ready to be sampled.
///
/// Each texel becomes the mean of two by two of the level before. A blit decodes sRGB before it filters, so the mean
/// is one of light. Every queue with graphics can blit the formats of textures with a linear filter (Vulkan
/// specification, *Required Format Support*); a compute shader could not write sRGB everywhere.
pub(super) fn make(gpu: &Gpu, textures: &[Image]) -> Result<()> {
    gpu.submit(|cmd| {
        for image in textures {
            for level in 1..image.levels {
                halve(gpu, cmd, image, level);
            }
        }
        Ok(())
    })
}

/// Makes a level from the one before. Afterwards, both can be sampled.
fn halve(gpu: &Gpu, cmd: vk::CommandBuffer, image: &Image, level: u32) {
    let (from, to) = (Layout::TRANSFER_SRC_OPTIMAL, Layout::TRANSFER_DST_OPTIMAL);
    let sampled = Layout::SHADER_READ_ONLY_OPTIMAL;
    let region = vk::ImageBlit::default()
        .src_subresource(layer(level - 1))
        .src_offsets(corners(image.extent, level - 1))
        .dst_subresource(layer(level))
        .dst_offsets(corners(image.extent, level));
    let handle = image.handle;
    transition_level(gpu, cmd, handle, level - 1, [sampled, from]);
    transition_level(gpu, cmd, handle, level, [Layout::UNDEFINED, to]);
    let filter = vk::Filter::LINEAR;
    // SAFETY: both levels are in the layouts named, and the image outlives the submission, which is waited for.
    unsafe { gpu.device.cmd_blit_image(cmd, handle, from, handle, to, &[region], filter) };
    transition_level(gpu, cmd, handle, level - 1, [from, sampled]);
    transition_level(gpu, cmd, handle, level, [to, sampled]);
}
// ANCHOR_END: make

/// The whole of a level: half as large as the one before, rounded down, but at least 1.
fn corners(extent: vk::Extent2D, level: u32) -> [vk::Offset3D; 2] {
    let side = |side: u32| (side >> level).max(1) as i32;
    let end = vk::Offset3D { x: side(extent.width), y: side(extent.height), z: 1 };
    [vk::Offset3D::default(), end]
}

fn layer(level: u32) -> vk::ImageSubresourceLayers {
    vk::ImageSubresourceLayers { mip_level: level, ..super::COPY.image_subresource }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_go_down_to_one_texel() {
        let of = |width, height| levels(vk::Extent2D { width, height });
        assert_eq!([of(1, 1), of(2, 1), of(256, 256), of(3, 1000)], [1, 2, 9, 10]);
        let extent = vk::Extent2D { width: 3, height: 1000 };
        let ends = [0, 1, 9].map(|level| corners(extent, level)[1]);
        assert_eq!(ends.map(|end| [end.x, end.y, end.z]), [[3, 1000, 1], [1, 500, 1], [1, 1, 1]]);
    }
}
