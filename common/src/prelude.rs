//! The names a program needs: `use raybook::prelude::*;`.

pub use crate::app::{Controls, Frame, Playback, Sample, Setup, Variant, Variants};
pub use crate::gpu::{
    AccelerationStructure, Address, Binding, Buffer, BuildOptions, Descriptor, Geometry, Gpu,
    HitGroup, Image, RayTracingPipeline, Requirements, ShaderBindingTable, TextureTable, barrier,
    padded,
};
pub use crate::model::Model;
pub use crate::scene::{
    Camera, CameraBasis, DirectionalLight, Instance, Material, Mesh, Scene, SceneAddresses,
    SceneOnGpu, SceneOptions, Sun, Vertex, boxes_on_gpu, build_top, input_usage, instance_on_gpu,
};
pub use anyhow::Result;
pub use ash::vk;
pub use glam::{Affine3A, DVec3, Mat3, Mat4, Quat, UVec2, UVec3, Vec2, Vec3, Vec3A, Vec4};
