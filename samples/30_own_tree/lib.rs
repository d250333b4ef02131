//! Trees of boxes over primitives: what a shader walks to find the few that a ray can meet.

mod binned;
mod check;
mod hull;
mod linked;
mod on_gpu;
mod quality;
mod quantised;
mod refit;
mod reinsert;
mod scene_on_gpu;
mod subtree;
mod tree;

pub use binned::binned;
pub use check::{DEPTH, LEAF, check};
pub use hull::has_place;
pub use on_gpu::{Corners, Placed, Trees, TreesOnGpu, USAGE};
pub use quality::{INTERSECTION, TRAVERSAL, bytes_per_primitive, cost, depth};
pub use quantised::{Quantised, quantised};
pub use refit::refit;
pub use reinsert::reinserted;
pub use scene_on_gpu::OwnScene;
pub use tree::{Bounds, Child, Node, Tree};
