//! A material.

use glam::Vec3;

/// The appearance of a surface, in the terms of an MTL file.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// The name, after `newmtl`.
    pub name: String,
    /// Diffuse reflectance, linear RGB (`Kd`); multiplies the base texture.
    pub base_color: Vec3,
    /// Specular reflectance, linear RGB (`Ks`).
    pub specular: Vec3,
    /// Exponent of the highlight (`Ns`).
    pub shininess: f32,
    /// Emitted radiance, linear RGB (`Ke`).
    pub emission: Vec3,
    /// 1 is opaque, 0 is invisible (`d`, or else 1 - `Tr`).
    pub opacity: f32,
    /// The number of the illumination model, 0 to 9 (`illum`).
    pub illumination: u32,
    /// Index of refraction (`Ni`).
    pub refraction: f32,
    /// Transmitted part of the light, linear RGB (`Tf`).
    pub transmission: Vec3,
    /// The texture whose RGB multiplies `base_color`, by position in the model (`map_Kd`).
    pub base_texture: Option<usize>,
    /// The texture whose alpha multiplies `opacity`, by position in the model (`map_d`).
    pub opacity_texture: Option<usize>,
    /// True if that alpha is how much of the surface there is; else it says where the surface has holes.
    pub blended: bool,
    /// The texture of normals in the frame of the texture coordinates, by position in the model (`norm`, `map_Bump`):
    /// linear, x to the right of the image, y up, z out of the surface.
    pub normal_texture: Option<usize>,
    /// Multiplies x and y of these normals (`-bm`).
    pub normal_scale: f32,
    /// Its metalness and roughness, if the file has them (`Pm`, `Pr`).
    pub microfacet: Option<Microfacet>,
}

/// A surface of microfacets by metalness and roughness, as in glTF 2.0, section 3.9.
#[derive(Clone, Debug, PartialEq)]
pub struct Microfacet {
    /// Linear RGB: what a metal reflects head-on, and what any other surface scatters. Multiplies the base texture.
    pub color: Vec3,
    /// 0 is smooth, 1 is rough: the square root of GGX's alpha.
    pub roughness: f32,
    /// 1 is metal, 0 is an insulator.
    pub metallic: f32,
    /// The texture whose green, linear, multiplies the roughness, by position in the model (`map_Pr`).
    pub roughness_texture: Option<usize>,
    /// The texture whose blue, linear, multiplies the metalness, by position in the model (`map_Pm`).
    pub metallic_texture: Option<usize>,
}

impl Default for Microfacet {
    /// As rough as can be, and no metal.
    fn default() -> Self {
        Self {
            color: Vec3::splat(0.5),
            roughness: 1.0,
            metallic: 0.0,
            roughness_texture: None,
            metallic_texture: None,
        }
    }
}

impl Material {
    /// The textures that are named.
    pub fn textures(&mut self) -> impl Iterator<Item = &mut Option<usize>> {
        let microfacet = self.microfacet.iter_mut().flat_map(|microfacet| {
            [&mut microfacet.roughness_texture, &mut microfacet.metallic_texture]
        });
        [&mut self.base_texture, &mut self.opacity_texture, &mut self.normal_texture]
            .into_iter()
            .chain(microfacet)
    }

    /// True if rays may pass through part of the surface.
    pub fn has_cutout(&self) -> bool {
        self.opacity < 1.0 || self.opacity_texture.is_some()
    }

    /// True if light passes through the body or the sheet, as its illumination model says.
    pub fn is_glass(&self) -> bool {
        matches!(self.illumination, 4 | 6 | 7 | 9)
    }

    /// True if the surface reflects its surroundings: the illumination model says so, and its reflectance is not 0.
    pub fn is_mirror(&self) -> bool {
        self.illumination >= 3 && self.specular.max_element() > 0.0
    }
}

impl Default for Material {
    /// A mid-grey matte.
    fn default() -> Self {
        Self {
            name: "default".to_owned(),
            base_color: Vec3::splat(0.5),
            specular: Vec3::ZERO,
            shininess: 0.0,
            emission: Vec3::ZERO,
            opacity: 1.0,
            illumination: 1,
            refraction: 1.0,
            transmission: Vec3::ONE,
            base_texture: None,
            opacity_texture: None,
            blended: false,
            normal_texture: None,
            normal_scale: 1.0,
            microfacet: None,
        }
    }
}
