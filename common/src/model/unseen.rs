//! Materials of which nothing would be seen as their file has them.

use glam::Vec3;

use super::warnings::{Kind, Warnings};
use crate::scene::material::Material;

/// Places in an MTL file of the statements that may hide one material.
#[derive(Default)]
pub(crate) struct Places {
    /// `Kd`.
    pub color: Option<String>,
    /// `d` or `Tr` with which nothing is seen.
    pub opacity: Option<String>,
    /// `illum` of glass.
    pub glass: Option<String>,
    /// The last statement of a texture, with its keyword.
    pub texture: Option<String>,
    /// The statement of the normal map, likewise.
    pub normals: Option<String>,
    /// True if `Pr` says how rough it is.
    pub has_roughness: bool,
}

impl Places {
    /// Changes a material so that it is seen, with a warning for each change.
    pub fn show(self, material: &mut Material, warnings: &mut Warnings) {
        let Self { color, opacity, glass, has_roughness, .. } = self;
        // Written where there is none.
        if material.refraction == 0.0 {
            material.refraction = 1.0;
        }
        if let Some(place) = glass.filter(|_| material.refraction == 1.0) {
            let model = material.illumination;
            let cure = "for glass, write Ni 1.5";
            let what = if material.transmission == Vec3::ONE {
                // The model that differs from it by the glass alone.
                material.illumination = 3;
                format!(
                    "illum {model} is glass, of which nothing is seen with Ni 1 and Tf 1; illum 3 is taken; {cure}"
                )
            } else {
                format!("illum {model} is glass, of which only Tf is seen with Ni 1; {cure}")
            };
            warnings.add_many(Kind::Glass, 1, || format!("{place}: {what}"));
        }
        let is_glass = material.is_glass();
        if material.opacity == 0.0 {
            material.opacity = 1.0;
            if let Some(place) = opacity.filter(|_| !is_glass) {
                let what = "nothing is seen of a material with d 0 or Tr 1, which some programs write for \
                            an opaque one; it is shown opaque; to hide it, write d 0.001";
                warnings.add_many(Kind::Opacity, 1, || format!("{place}: {what}"));
            }
        }
        if material.base_texture.is_some() {
            match color {
                // The texture is used unchanged rather than multiplied by the default grey.
                None => material.base_color = Vec3::ONE,
                Some(place) if material.base_color == Vec3::ZERO => {
                    material.base_color = Vec3::ONE;
                    let what = "Kd 0 makes the texture of map_Kd black; the texture is shown as it is; for \
                                black, leave map_Kd out";
                    warnings.add_many(Kind::Black, 1, || format!("{place}: {what}"));
                }
                Some(_) => {}
            }
        }
        if let Some(microfacet) = &mut material.microfacet {
            microfacet.color = material.base_color;
            if !has_roughness {
                microfacet.roughness = roughness(material.shininess);
            }
            // A texture replaces the number, because exporters write both.
            if microfacet.roughness_texture.is_some() {
                microfacet.roughness = 1.0;
            }
            if microfacet.metallic_texture.is_some() {
                microfacet.metallic = 1.0;
            }
        }
    }
}

/// The roughness of the GGX highlight as wide as the Blinn-Phong one of an exponent (Walter et al. 2007, by Karis
/// 2013).
fn roughness(exponent: f32) -> f32 {
    (2.0 / (exponent + 2.0)).sqrt().sqrt()
}
