//! The scene to render: camera, lights, meshes, materials, the chess world, and their upload.

pub mod board;
pub(crate) mod camera;
mod chess;
mod inside_out;
pub(crate) mod light;
mod look;
pub mod material;
pub mod mesh;
mod meshes;
mod placement;
pub mod plane;
mod records;
mod top_level;
mod upload;
pub(crate) mod world;

pub use camera::{Camera, CameraBasis};
pub use chess::{assets, place_position};
pub use light::{DirectionalLight, DiskLight, Light, LightKind, LightSource, PointLight, Sun};
pub use look::Look;
pub use material::{Material, Microfacet};
pub use mesh::{Mesh, REACH, Vertex};
pub use meshes::triangle_order;
pub use placement::{Moved, Placement, Size};
pub use records::{InstanceRecord, MaterialRecord, SceneAddresses};
pub use top_level::{build_top, build_updatable_top};
pub use upload::{
    SceneOnGpu, SceneOptions, boxes_on_gpu, input_usage, instance_bytes, instance_on_gpu, transform,
};
pub use world::{Instance, Scene, moved_bounds};
