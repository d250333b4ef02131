//! A material of glTF in the terms of today's chapters: a diffuse colour, a highlight, a mirror, glass, emission.
//!
//! Metal and roughness are kept as they are, and approximated for chapters that do not show them: a smooth metal
//! becomes a mirror of its colour, a rough one a matte surface of it.

use glam::{Vec2, Vec3, Vec4};
use gltf::json::extensions::material::Volume;
use gltf::json::extensions::texture::TextureTransform;
use gltf::json::material::{AlphaMode, Material as Source, NormalTexture};
use gltf::json::texture::Info;
use gltf::json::validation::Checked;

use super::features::Features;
use super::image::{Images, Use};
use super::{name, range};
use crate::model::mtl_value::BUMPIEST;
use crate::model::text::quoted;
use crate::scene::material::{Material, Microfacet};

/// The roughness below which a surface reflects an image.
const MIRROR: f32 = 0.25;
/// The part of the light that glass and plastic reflect head-on.
const DIELECTRIC: f32 = 0.04;
/// The largest exponent of a highlight: that of a roughness of 0.01.
const SHARPEST: f32 = 2e8;

/// The part of its colour that a mirror of metal also scatters. It has none, but in the chapters without mirrors it would
/// be black.
const BELOW: f32 = 0.2;
/// The largest colour of a surface of which little is seen in light.
const DARK: f32 = 0.01;

/// Illumination models of an MTL file.
const HIGHLIGHT: u32 = 2;
const REFLECTION: u32 = 3;
const SHEET: u32 = 4;
const BODY: u32 = 7;

/// The texture coordinates that a material reads: a set of the mesh, and what is done to it.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct Coordinates {
    /// The number of the set.
    pub set: u32,
    /// True if a texture reads them.
    pub is_read: bool,
    /// True if only the normal map reads them.
    pub are_of_normals: bool,
    offset: Vec2,
    rotation: f32,
    scale: Vec2,
}

impl Default for Coordinates {
    fn default() -> Self {
        Self {
            set: 0,
            is_read: false,
            are_of_normals: false,
            offset: Vec2::ZERO,
            rotation: 0.0,
            scale: Vec2::ONE,
        }
    }
}

impl Coordinates {
    /// Those of a texture (`KHR_texture_transform`).
    fn of_texture(info: &Info) -> Self {
        let transform = info.extensions.as_ref().and_then(|all| all.texture_transform.as_ref());
        Self::of_set(info.tex_coord, transform)
    }

    fn of_set(set: u32, transform: Option<&TextureTransform>) -> Self {
        let Some(transform) = transform else {
            return Self { set, is_read: true, ..Self::default() };
        };
        Self {
            set: transform.tex_coord.unwrap_or(set),
            is_read: true,
            are_of_normals: false,
            offset: Vec2::from(transform.offset.0),
            rotation: transform.rotation.0,
            scale: Vec2::from(transform.scale.0),
        }
    }

    /// Scales a point, turns it counter-clockwise as seen with v upwards, and moves it.
    pub fn of(&self, uv: Vec2) -> Vec2 {
        let (sin, cos) = self.rotation.sin_cos();
        let Vec2 { x, y } = uv * self.scale;
        self.offset + Vec2::new(cos * x + sin * y, cos * y - sin * x)
    }
}

/// A material, and the texture coordinates it reads.
#[derive(Clone, Default)]
pub(super) struct Look {
    pub material: Material,
    pub coordinates: Coordinates,
}

/// The values of metallic-roughness, or of specular-glossiness in its terms.
struct Values<'a> {
    color: Vec4,
    texture: Option<&'a Info>,
    metallic: f32,
    roughness: f32,
    /// Reflectance head-on; else it follows from the others.
    specular: Option<Vec3>,
    /// Position in the model: roughness is in green, metalness in blue.
    texture_of_both: Option<usize>,
}

impl Look {
    /// The material that glTF gives to a primitive without one.
    pub fn of_none() -> Self {
        let material =
            Material { name: "default".to_owned(), base_color: Vec3::ONE, ..Material::default() };
        Self { material, ..Self::default() }
    }

    /// Material `number` of a file; `moved` is the texture transform of its normal map.
    pub fn of(
        source: &Source,
        number: usize,
        moved: Option<&TextureTransform>,
        images: &mut Images,
        features: &mut Features,
    ) -> Self {
        let name = name::of(source.name.as_ref(), "material", number);
        let place = || format!("material {number}, {},", quoted(&name));
        range::check(source, features, &place());
        let values = Values::of(source, images, features);
        let color = values.color.truncate().clamp(Vec3::ZERO, Vec3::ONE);
        let microfacet = Microfacet {
            color,
            roughness: values.roughness.clamp(0.0, 1.0),
            metallic: values.metallic.clamp(0.0, 1.0),
            roughness_texture: values.texture_of_both,
            metallic_texture: values.texture_of_both,
        };
        // For chapters that approximate them, one value replaces the texture.
        let mean = values.texture_of_both.map_or(Vec3::ONE, |texture| images.mean(texture));
        let (roughness, metallic) = (microfacet.roughness * mean.y, microfacet.metallic * mean.z);
        let is_mirror = roughness < MIRROR && metallic > 0.5 || roughness < 0.05;
        let reflectance = Vec3::splat(DIELECTRIC).lerp(color, metallic);
        let mut material = Material {
            base_color: if is_mirror { color * (1.0 - (1.0 - BELOW) * metallic) } else { color },
            specular: match values.specular {
                Some(specular) => specular.clamp(Vec3::ZERO, Vec3::ONE),
                None if is_mirror => reflectance,
                // A rough metal's reflection is as its colour, which the matte surface shows.
                None => Vec3::splat(DIELECTRIC),
            },
            shininess: exponent(roughness),
            illumination: if is_mirror { REFLECTION } else { HIGHLIGHT },
            // A reflectance of its own is not among the terms of metalness.
            microfacet: values.specular.is_none().then_some(microfacet),
            name: name.clone(),
            ..Material::default()
        };
        let mut look = Self::default();
        let both = source.pbr_metallic_roughness.metallic_roughness_texture.as_ref();
        let both = both.filter(|_| values.texture_of_both.is_some());
        // All textures of a material read the same coordinates.
        if let Some(info) = values.texture.or(both) {
            look.coordinates = Coordinates::of_texture(info);
        }
        set_alpha(&mut material, source, &values, images, features, &place());
        set_glass(&mut material, source, features, &place());
        if set_emission(&mut material, source, images, features, &place()) {
            look.coordinates =
                source.emissive_texture.as_ref().map_or(look.coordinates, Coordinates::of_texture);
        }
        if let Some(map) = &source.normal_texture {
            let coordinates = Coordinates::of_set(map.tex_coord, moved);
            if set_normals(&mut material, map, images, features, &place()) {
                look.share(coordinates, features, &place());
            }
        }
        if source.extensions.as_ref().is_some_and(|all| all.unlit.is_some()) {
            features.note("unlit", 1, || format!("{} is unlit; it is shown in light", place()));
        }
        Self { material, ..look }
    }

    /// Lets a normal map read the coordinates of the other textures; without another texture, its own are the
    /// material's.
    fn share(&mut self, own: Coordinates, features: &mut Features, place: &str) {
        if !self.coordinates.is_read {
            self.coordinates = Coordinates { are_of_normals: true, ..own };
        } else if self.coordinates != own {
            features.note("normal", 1, || {
                format!("{place} has a normal map with texture coordinates of its own; those of its colour count")
            });
        }
    }
}

impl<'a> Values<'a> {
    fn of(source: &'a Source, images: &mut Images, features: &mut Features) -> Self {
        let extensions = source.extensions.as_ref();
        if let Some(old) = extensions.and_then(|all| all.pbr_specular_glossiness.as_ref()) {
            return Self {
                color: Vec4::from(old.diffuse_factor.0),
                texture: old.diffuse_texture.as_ref(),
                metallic: 0.0,
                roughness: 1.0 - old.glossiness_factor.0,
                specular: Some(Vec3::from(old.specular_factor.0)),
                texture_of_both: None,
            };
        }
        let pbr = &source.pbr_metallic_roughness;
        let both = pbr.metallic_roughness_texture.as_ref();
        let both = both.and_then(|info| images.texture(info.index, Use::Numbers, features));
        Self {
            color: Vec4::from(pbr.base_color_factor.0),
            texture: pbr.base_color_texture.as_ref(),
            metallic: pbr.metallic_factor.0,
            roughness: pbr.roughness_factor.0,
            specular: None,
            texture_of_both: both.map(|texture| texture.index),
        }
    }
}

/// The exponent of a Blinn-Phong highlight as wide as the GGX one of a roughness (Walter et al. 2007, by Karis
/// 2013): 2 / roughness^4 - 2.
fn exponent(roughness: f32) -> f32 {
    (2.0 / roughness.powi(4).max(1e-30) - 2.0).clamp(0.0, SHARPEST)
}

/// The texture of the colour, and holes or transparency by its alpha.
fn set_alpha(
    material: &mut Material,
    source: &Source,
    values: &Values,
    images: &mut Images,
    features: &mut Features,
    place: &str,
) {
    let alpha = values.color.w.clamp(0.0, 1.0);
    let mode = match source.alpha_mode {
        Checked::Valid(mode) => mode,
        Checked::Invalid => AlphaMode::Opaque,
    };
    let cutoff = source.alpha_cutoff.map_or(0.5, |cutoff| cutoff.0);
    let needed = if alpha > 0.0 { cutoff / alpha } else { f32::INFINITY };
    let has_holes = mode == AlphaMode::Mask && needed > 0.0;
    let for_what = if has_holes { Use::Cutout(needed) } else { Use::Color };
    let texture = values.texture.and_then(|info| images.texture(info.index, for_what, features));
    material.base_texture = texture.map(|texture| texture.index);
    let is_alpha = |texture: &super::image::Loaded| texture.has_alpha.then_some(texture.index);
    match mode {
        AlphaMode::Opaque => {}
        AlphaMode::Mask if !has_holes => {}
        AlphaMode::Mask => {
            material.opacity_texture = texture.as_ref().and_then(is_alpha);
            if material.opacity_texture.is_none() && needed > 1.0 {
                features.note("hidden", 1, || {
                    format!("{place} cuts all of its surface away; it is shown whole")
                });
            }
        }
        AlphaMode::Blend => {
            material.opacity_texture = texture.as_ref().and_then(is_alpha);
            material.blended = true;
            material.opacity = alpha;
            if alpha == 0.0 {
                material.opacity = 1.0;
                features.note("clear", 1, || {
                    format!("{place} has the alpha 0, of which nothing is seen; it is shown opaque")
                });
            }
        }
    }
}

/// The normal map. Returns true if it can be read.
fn set_normals(
    material: &mut Material,
    map: &NormalTexture,
    images: &mut Images,
    features: &mut Features,
    place: &str,
) -> bool {
    let texture = images.texture(map.index, Use::Normals, features);
    material.normal_texture = texture.map(|texture| texture.index);
    let (scale, most) = (map.scale, BUMPIEST);
    if scale.abs() > most {
        features.note("bumps", 1, || {
            format!("{place} has the scale {scale:e} of its normal map, more than {most}; {most} is taken")
        });
    }
    material.normal_scale = scale.clamp(-most, most);
    material.normal_texture.is_some()
}

/// Glass: a sheet by `KHR_materials_transmission`, a body if it has a volume.
fn set_glass(material: &mut Material, source: &Source, features: &mut Features, place: &str) {
    let Some(extensions) = &source.extensions else { return };
    let index = extensions.ior.as_ref().map_or(1.5, |ior| ior.ior.0);
    let Some(transmission) = &extensions.transmission else { return };
    let factor = transmission.transmission_factor.0.clamp(0.0, 1.0);
    if transmission.transmission_texture.is_some() {
        features.note("transmission", 1, || {
            format!("{place} has a texture of its transmission; its factor counts everywhere")
        });
    }
    if factor < 0.5 {
        return;
    }
    let volume = extensions.volume.as_ref().filter(|volume| volume.thickness_factor.0 > 0.0);
    material.illumination = if volume.is_some() { BODY } else { SHEET };
    material.refraction = if index >= 1.0 { index } else { 1.5 };
    material.transmission = match volume {
        Some(volume) => through_a_unit(volume),
        None => material.base_color,
    };
    material.specular = Vec3::splat(DIELECTRIC);
}

/// The part of the light that comes through one unit of a body.
fn through_a_unit(volume: &Volume) -> Vec3 {
    let color = Vec3::from(volume.attenuation_color.0).clamp(Vec3::splat(1e-6), Vec3::ONE);
    let distance = volume.attenuation_distance.0;
    if distance > 0.0 { color.powf(1.0 / distance) } else { Vec3::ONE }
}

/// The surface's own light. Returns true if its texture replaces the surface's colour.
fn set_emission(
    material: &mut Material,
    source: &Source,
    images: &mut Images,
    features: &mut Features,
    place: &str,
) -> bool {
    let strength = source.extensions.as_ref().and_then(|all| all.emissive_strength.as_ref());
    let strength = strength.map_or(1.0, |strength| strength.emissive_strength.0);
    let emission = Vec3::from(source.emissive_factor.0) * strength;
    if emission == Vec3::ZERO || !emission.is_finite() {
        return false;
    }
    let Some(info) = &source.emissive_texture else {
        material.emission = emission.max(Vec3::ZERO);
        return false;
    };
    // A label or a screen: nothing would be seen of it without its light.
    let is_dark = material.base_color.max_element() < DARK && material.base_texture.is_none();
    let texture = if is_dark { images.texture(info.index, Use::Color, features) } else { None };
    let instead = if texture.is_some() { "is its colour instead" } else { "is left out" };
    features.note("emission", 1, || format!("{place} shines by a texture, which {instead}"));
    let Some(texture) = texture else { return false };
    material.base_texture = Some(texture.index);
    material.base_color = Vec3::ONE;
    true
}
