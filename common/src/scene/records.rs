//! A scene's data, read by shaders by address: the same structures as in `shaders/common/scene.glsl`.

use glam::Vec3;

use super::{Material, Vertex};
use crate::gpu::Address;

common::shader_struct! {
    /// The mesh and material of an instance, for shaders.
    pub struct InstanceRecord {
        /// Address of the mesh's [`Vertex`] array.
        pub vertices: Address<Vertex>,
        /// Address of its triangles, three `u32` each, in the model's order.
        pub triangles: Address,
        /// Address of the permutation: primitive `i` of the build is triangle `original[i]`.
        pub original: Address,
        /// Index of its [`MaterialRecord`].
        pub material: u32,
        /// Index of the mesh in the model.
        pub mesh: u32,
    }
}

common::shader_struct! {
    /// A [`Material`] in its form for shaders.
    pub struct MaterialRecord {
        /// Diffuse reflectance, linear RGB.
        pub base_color: Vec3,
        /// 1 is opaque, 0 is invisible.
        pub opacity: f32,
        /// Specular reflectance, linear RGB.
        pub specular: Vec3,
        /// Exponent of the highlight.
        pub shininess: f32,
        /// Emitted radiance, linear RGB.
        pub emission: Vec3,
        /// Index of the texture that multiplies the base colour; -1 for none.
        pub base_texture: i32,
        /// Index of the texture whose alpha multiplies the opacity; -1 for none.
        pub opacity_texture: i32,
        /// The illumination model of the MTL file.
        pub illumination: u32,
    }
}

common::shader_struct! {
    /// Addresses of a scene's arrays, for push constants.
    pub struct SceneAddresses {
        /// The address of the [`InstanceRecord`] array, indexed by `gl_InstanceCustomIndexEXT`.
        pub instances: Address<InstanceRecord>,
        /// The address of the [`MaterialRecord`] array.
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
