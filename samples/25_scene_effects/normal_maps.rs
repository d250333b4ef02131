//! Normal maps in a composition: the materials that have one, and the maps of chapter 47.

use anyhow::Result;
use common::model::Texture;
use common::scene::{Material, assets};

use crate::Composition;

/// Names of the project's own normal maps, those of chapter 47.
pub const NORMAL_MAPS: [&str; 2] = ["bevelled", "hammered"];

/// One of [`NORMAL_MAPS`].
///
/// # Errors
/// If its file is missing.
pub(crate) fn own_map(name: &str) -> Result<Texture> {
    let file = format!("{name}.png");
    Texture::of_normals(&assets().join(&file), file)
}

impl Composition {
    /// The materials, if one in use has a normal map; else none, and shaders read none.
    pub fn materials_to_map(&self) -> &[Material] {
        let is_mapped = self.materials_in_use().any(|material| material.normal_texture.is_some());
        if is_mapped { &self.scene.model.materials } else { &[] }
    }
}
