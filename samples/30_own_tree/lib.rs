//! Trees of boxes over primitives: what a shader walks to find the few that a ray can meet.

mod median;
mod on_gpu;
mod scene_on_gpu;
mod tree;

pub use median::median;
pub use on_gpu::{Corners, Placed, Trees, TreesOnGpu, USAGE};
pub use scene_on_gpu::OwnScene;
pub use tree::{Bounds, Child, Node, Tree};
