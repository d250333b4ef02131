//! What is rendered: camera, lights, meshes and materials from OBJ files, the chess world, its upload.

pub mod board;
mod camera;
mod chess;
mod index;
mod light;
mod limits;
mod material;
mod mesh;
mod meshes;
mod mtl;
pub mod obj;
mod obj_check;
mod placement;
pub mod plane;
mod records;
mod tally;
pub mod text;
mod texture;
mod upload;
mod warnings;
mod world;

pub use camera::{Camera, CameraBasis};
pub use chess::{assets, place_position};
pub use light::{DirectionalLight, DiskLight, Light, LightKind, PointLight, Sun};
pub use material::Material;
pub use mesh::{Mesh, REACH, Vertex};
pub use meshes::triangle_order;
pub use obj::Model;
pub use placement::{Moved, Placement, Size};
pub use records::{InstanceRecord, MaterialRecord, SceneAddresses};
pub use texture::Texture;
pub use upload::{
    SceneOnGpu, SceneOptions, boxes_on_gpu, build_top, input_usage, instance_bytes,
    instance_on_gpu, transform,
};
pub use world::{Instance, Scene, moved_bounds};
