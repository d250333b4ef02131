//! Trees of boxes over primitives, which a shader walks to find the few that a ray can hit.

mod binned;
mod builder;
mod check;
mod device_tree;
mod hull;
mod linked;
mod on_device;
mod on_gpu;
mod pushes;
mod quality;
mod quantised;
mod refit;
mod reinsert;
mod scene_on_gpu;
mod subtree;
mod tree;

pub use binned::binned;
pub use builder::Builder;
pub use check::{DEPTH, LEAF, check};
pub use device_tree::{Corners, DeviceTree, MOST_TRIANGLES, Scratch};
pub use hull::has_place;
pub use on_device::{DeviceBuilder, Triangles};
pub use on_gpu::{Placed, RAYS, TRACED, Trees, TreesOnGpu};
pub use quality::{INTERSECTION, TRAVERSAL, bytes_per_primitive, cost, depth};
pub use quantised::{Quantised, quantised};
pub use refit::refit;
pub use reinsert::reinserted;
pub use scene_on_gpu::OwnScene;
pub use tree::{Bounds, Child, Node, Tree};
