//! Rough metal in a composition: the materials that have microfacets.

use common::scene::{Material, Microfacet};

use crate::{Composition, is_glass};

/// Tests whether a material is one of microfacets. Glass is not, whatever its roughness.
pub fn is_rough(material: &Material) -> bool {
    material.microfacet.is_some() && !is_glass(material)
}

/// A texture of a material's roughness or metalness, by position in the model, if it has one.
pub fn rough_textures(material: &Material) -> Option<usize> {
    let microfacet = material.microfacet.as_ref().filter(|_| is_rough(material))?;
    microfacet.roughness_texture.or(microfacet.metallic_texture)
}

/// Lets the microfacets' colour be the material's, because hit shaders report that one, and lets no mirror be below
/// them.
pub(crate) fn roughen(material: &mut Material) {
    if let Some(Microfacet { color, .. }) = material.microfacet {
        material.base_color = color;
        material.illumination = material.illumination.min(2);
    }
}

impl Composition {
    /// The microfacets of each material, if any material in use has some; shaders read no others.
    pub fn microfacets_to_read(&self) -> Vec<Option<&Microfacet>> {
        if self.materials_in_use().any(is_rough) {
            let materials = self.scene.model.materials.iter();
            materials.map(|m| m.microfacet.as_ref().filter(|_| is_rough(m))).collect()
        } else {
            Vec::new()
        }
    }
}
