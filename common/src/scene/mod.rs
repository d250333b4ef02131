//! What is rendered: camera, lights, meshes and materials from OBJ files, the chess world, its upload.

pub mod board;
mod camera;
mod chess;
mod effects;
mod file;
mod light;
mod material;
mod mesh;
mod mtl;
pub mod obj;
mod obj_check;
mod placement;
pub mod plane;
mod records;
mod text;
mod texture;
mod upload;
mod warnings;
mod world;

pub use camera::{Camera, CameraBasis};
pub use chess::assets;
pub use effects::{Effect, Effects, Finding, findings, needed};
pub use file::{
    BoardPlane, Box, Composition, Face, Heightfield, MAX_LIGHTS, SceneLight, Solid, Sphere,
};
pub use light::{DirectionalLight, Light, PointLight, Sun};
pub use material::Material;
pub use mesh::{Mesh, Vertex};
pub use obj::Model;
pub use placement::Placement;
pub use records::{InstanceRecord, MaterialRecord, SHARED_STRUCTS, SceneAddresses};
pub use texture::Texture;
pub use upload::{SceneOnGpu, SceneOptions, build_top, input_usage, transform};
pub use world::{Instance, Scene};
