//! Images and samplers: the textures of a glTF file.

use std::collections::HashMap;

use anyhow::{Context, Result, anyhow};
use glam::Vec3;
use gltf::json::texture::{MagFilter, Sampler, WrappingMode};
use gltf::json::validation::Checked;
use gltf::json::{Image, Index, Texture as Source};

use super::features::Features;
use super::file::{File, missing, of_gltf};
use super::name;
use super::uri::Uri;
use crate::gpu::{Sampling, Wrap};
use crate::model::limits::Limits;
use crate::model::texture::{self, Remark, Texture};

/// The use of a texture.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Use {
    /// Its colour; and its alpha, for transparency.
    Color,
    /// Its colour, and holes where its alpha is below a threshold.
    Cutout(f32),
    /// Its red, green and blue, which are linear.
    Numbers,
    /// Its red, green and blue, which are a normal.
    Normals,
}

impl Use {
    /// The replacement for a texture that cannot be read, as words of a warning.
    fn instead(self) -> &'static str {
        match self {
            Self::Color | Self::Cutout(_) => "the plain colour stands for it",
            Self::Numbers => "the factors of metalness and roughness alone count",
            Self::Normals => "the surface is smooth",
        }
    }
}

/// A texture of the model.
#[derive(Clone, Copy)]
pub(super) struct Loaded {
    /// Its position in the model.
    pub index: usize,
    /// True if any texel is not opaque.
    pub has_alpha: bool,
}

/// The textures read so far.
pub(super) struct Images<'a> {
    file: &'a File,
    limits: &'a Limits,
    /// Bytes left for texels.
    left: u64,
    pub textures: Vec<Texture>,
    /// The known textures by image, sampling and threshold, which is 0 without holes and infinite for numbers.
    known: HashMap<(usize, Sampling, u32), Option<Loaded>>,
    /// The means so far, by position in `textures`.
    means: HashMap<usize, Vec3>,
}

impl<'a> Images<'a> {
    pub fn new(file: &'a File, limits: &'a Limits) -> Self {
        Self {
            file,
            limits,
            left: limits.texture_bytes,
            textures: Vec::new(),
            known: HashMap::new(),
            means: HashMap::new(),
        }
    }

    /// The position of a texture in the model, if its image can be read.
    pub fn texture(
        &mut self,
        index: Index<Source>,
        for_what: Use,
        features: &mut Features,
    ) -> Option<Loaded> {
        let root = &self.file.root;
        let Some(source) = root.get(index) else {
            let what = || missing("texture", index, &root.textures);
            features.note(for_what.instead(), 1, || format!("{}; {}", what(), for_what.instead()));
            return None;
        };
        let sampling = source.sampler.and_then(|sampler| root.get(sampler));
        let sampling = sampling.map_or_else(Sampling::default, sampling_of);
        let threshold = match for_what {
            Use::Color => 0.0,
            Use::Cutout(threshold) => threshold,
            Use::Numbers | Use::Normals => f32::INFINITY,
        };
        let key = (source.source.value(), sampling, threshold.to_bits());
        if let Some(known) = self.known.get(&key) {
            return *known;
        }
        let loaded = self.read(source.source, for_what.instead(), features).map(|mut texture| {
            if let Use::Cutout(threshold) = for_what {
                cut_at_half(&mut texture.rgba, threshold);
            }
            let has_alpha = texture.rgba.chunks_exact(4).any(|texel| texel[3] < 255);
            let srgb = !matches!(for_what, Use::Numbers | Use::Normals);
            if for_what == Use::Normals && texture::is_grey(&texture.rgba) {
                let (number, what) = (source.source.value(), texture::GREY_NORMALS);
                features.note("grey", 1, || {
                    format!("image {number}: {what}; it is taken as a normal map")
                });
            }
            self.textures.push(Texture { sampling, srgb, ..texture });
            Loaded { index: self.textures.len() - 1, has_alpha }
        });
        self.known.insert(key, loaded);
        loaded
    }

    /// The mean of the red, green and blue of a texture of the model, as they are written.
    pub fn mean(&mut self, texture: usize) -> Vec3 {
        *self.means.entry(texture).or_insert_with(|| {
            let rgba = &self.textures[texture].rgba;
            let mut sum = [0u64; 3];
            for texel in rgba.chunks_exact(4) {
                for (sum, &value) in sum.iter_mut().zip(texel) {
                    *sum += u64::from(value);
                }
            }
            let count = (rgba.len() / 4).max(1) as f64 * 255.0;
            Vec3::from(sum.map(|sum| (sum as f64 / count) as f32))
        })
    }

    /// Decodes an image; a fault is a note.
    fn read(
        &mut self,
        index: Index<Image>,
        instead: &'static str,
        features: &mut Features,
    ) -> Option<Texture> {
        let number = index.value();
        match self.decode(index, features) {
            Ok((texture, remarks)) => {
                for (_, what) in remarks {
                    features.note("remark", 1, || format!("image {number}: {what}"));
                }
                Some(texture)
            }
            Err(error) => {
                let place =
                    if number == NONE { "an image".to_owned() } else { format!("image {number}") };
                features.note(instead, 1, || format!("{place}: {error}; {instead}"));
                None
            }
        }
    }

    fn decode(
        &mut self,
        index: Index<Image>,
        features: &mut Features,
    ) -> Result<(Texture, Vec<Remark>)> {
        let root = &self.file.root;
        let image = root.get(index).with_context(|| match index.value() {
            NONE => "its texture names none that is read, PNG or JPEG".to_owned(),
            _ => missing("image", index, &root.images),
        })?;
        let name = name::of(image.name.as_ref(), "image", index.value());
        let (left, limits) = (&mut self.left, self.limits);
        match (image.buffer_view, &image.uri) {
            (Some(view), _) => {
                let (bytes, _) = self.file.view(view)?;
                texture::decode_bytes(bytes, name, left, limits)
            }
            (None, Some(uri)) => match Uri::of(uri)? {
                Uri::Data(bytes) => texture::decode_bytes(&bytes, name, left, limits),
                Uri::Path(path) => {
                    let named = self.file.folder.find("its URI", &path, None);
                    let named = named.map_err(|error| anyhow!(of_gltf(&error.to_string())))?;
                    if let Some(instead) = &named.instead {
                        let number = index.value();
                        features.note("elsewhere", 1, || {
                            format!(
                                "image {number}: {}; the file of that name beside the model is taken",
                                of_gltf(instead)
                            )
                        });
                    }
                    texture::decode_file(named, left, limits)
                }
            },
            (None, None) => Err(anyhow!("has neither a URI nor a buffer view")),
        }
    }
}

/// The number of an image that is not named, as the parser has it.
const NONE: usize = u32::MAX as usize;

/// The sampling of a texture. Values that glTF does not have count as its default.
fn sampling_of(sampler: &Sampler) -> Sampling {
    let wrap = |mode: &Checked<WrappingMode>| match mode {
        Checked::Valid(WrappingMode::ClampToEdge) => Wrap::Clamp,
        Checked::Valid(WrappingMode::MirroredRepeat) => Wrap::Mirror,
        Checked::Valid(WrappingMode::Repeat) | Checked::Invalid => Wrap::Repeat,
    };
    let nearest = matches!(sampler.mag_filter, Some(Checked::Valid(MagFilter::Nearest)));
    Sampling { u: wrap(&sampler.wrap_s), v: wrap(&sampler.wrap_t), nearest }
}

/// Scales alpha so that a threshold becomes the one half at which the chapters' shaders cut.
fn cut_at_half(rgba: &mut [u8], threshold: f32) {
    if threshold == 0.5 {
        return;
    }
    for texel in rgba.chunks_exact_mut(4) {
        let alpha = f32::from(texel[3]) * 0.5 / threshold;
        // A rounding must not carry a texel over the threshold.
        let is_solid = f32::from(texel[3]) / 255.0 >= threshold;
        let (low, high) = if is_solid { (128.0, 255.0) } else { (0.0, 127.0) };
        texel[3] = alpha.round().clamp(low, high) as u8;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_threshold_becomes_one_half_and_keeps_its_sides() {
        for threshold in [0.01, 0.25, 0.5, 0.75, 0.9961, 1.0] {
            for alpha in 0..=255 {
                let mut texel = [1, 2, 3, alpha];
                cut_at_half(&mut texel, threshold);
                let is_solid = f32::from(alpha) / 255.0 >= threshold;
                assert_eq!(f32::from(texel[3]) / 255.0 >= 0.5, is_solid, "{alpha} at {threshold}");
                assert_eq!(texel[..3], [1, 2, 3]);
            }
        }
    }
}
