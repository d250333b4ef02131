//! The normal map of a material, in its form for shaders.

use common::scene::Material;

common::shader_struct! {
    /// A material's normal map.
    pub struct NormalMapRecord {
        /// Index of the texture of normals; -1 for none.
        pub number: i32,
        /// Multiplies x and y of its normals.
        pub scale: f32,
    }
}

impl NormalMapRecord {
    /// The record of a material, if it is to have one; `strength` multiplies its slopes.
    pub fn new(material: Option<&Material>, strength: f32) -> Self {
        let texture = material.and_then(|material| material.normal_texture);
        Self {
            number: texture.map_or(-1, |index| index as i32),
            scale: material.map_or(0.0, |material| material.normal_scale * strength),
        }
    }
}
