//! What shaders read of a scene, by address: the same structures as in `shaders/common/scene.glsl`.

use glam::Vec3;

use super::{Material, Vertex};
use crate::gpu::Address;

common::shader_struct! {
    /// Where a shader finds the mesh and the material of an instance.
    pub struct InstanceRecord {
        /// Address of the mesh's [`Vertex`] array.
        pub vertices: Address<Vertex>,
        /// Address of its triangles, three `u32` each, in the model's order.
        pub triangles: Address,
        /// Address of the permutation: primitive `i` of the build is triangle `original[i]`.
        pub original: Address,
        /// Which [`MaterialRecord`].
        pub material: u32,
        /// Which mesh of the model.
        pub mesh: u32,
    }
}

common::shader_struct! {
    /// A [`Material`] as shaders read it.
    pub struct MaterialRecord {
        /// Diffuse reflectance, linear RGB.
        pub base_color: Vec3,
        /// 1 is opaque, 0 is not there.
        pub opacity: f32,
        /// Specular reflectance, linear RGB.
        pub specular: Vec3,
        /// Exponent of the highlight.
        pub shininess: f32,
        /// Emitted radiance, linear RGB.
        pub emission: Vec3,
        /// Which texture multiplies the base colour; -1 for none.
        pub base_texture: i32,
        /// Which texture's alpha multiplies the opacity; -1 for none.
        pub opacity_texture: i32,
        /// The illumination model of the MTL file.
        pub illumination: u32,
    }
}

common::shader_struct! {
    /// Addresses of a scene's arrays, for push constants.
    pub struct SceneAddresses {
        /// Of the [`InstanceRecord`] array, indexed by `gl_InstanceCustomIndexEXT`.
        pub instances: Address<InstanceRecord>,
        /// Of the [`MaterialRecord`] array.
        pub materials: Address<MaterialRecord>,
    }
}

impl From<&Material> for MaterialRecord {
    fn from(material: &Material) -> Self {
        let number = |texture: Option<usize>| texture.map_or(-1, |index| index as i32);
        Self {
            base_color: material.base_color,
            opacity: material.opacity,
            specular: material.specular,
            shininess: material.shininess,
            emission: material.emission,
            base_texture: number(material.base_texture),
            opacity_texture: number(material.opacity_texture),
            illumination: material.illumination,
        }
    }
}
