//! The sampling of textures: between texels, and beyond edges.

use ash::vk;

/// The way a texture is read between its texels and beyond its edges. The default repeats it, and blends four texels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Sampling {
    /// Beyond the left and right edge.
    pub u: Wrap,
    /// Beyond the upper and lower edge.
    pub v: Wrap,
    /// True if the nearest texel counts, rather than a blend of four.
    pub nearest: bool,
}

/// The continuation of a texture beyond its edges.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Wrap {
    /// It starts again.
    #[default]
    Repeat,
    /// Every second copy is mirrored.
    Mirror,
    /// The texels of the edge go on.
    Clamp,
}

impl Sampling {
    /// The sampler. With `mipmaps`, a lookup between two levels blends them.
    pub(super) fn info(self, mipmaps: bool) -> vk::SamplerCreateInfo<'static> {
        let filter = if self.nearest { vk::Filter::NEAREST } else { vk::Filter::LINEAR };
        let info = vk::SamplerCreateInfo::default()
            .mag_filter(filter)
            .min_filter(filter)
            .address_mode_u(self.u.mode())
            .address_mode_v(self.v.mode());
        if !mipmaps {
            return info;
        }
        info.mipmap_mode(vk::SamplerMipmapMode::LINEAR).max_lod(vk::LOD_CLAMP_NONE)
    }
}

impl Wrap {
    fn mode(self) -> vk::SamplerAddressMode {
        match self {
            Self::Repeat => vk::SamplerAddressMode::REPEAT,
            Self::Mirror => vk::SamplerAddressMode::MIRRORED_REPEAT,
            Self::Clamp => vk::SamplerAddressMode::CLAMP_TO_EDGE,
        }
    }
}
