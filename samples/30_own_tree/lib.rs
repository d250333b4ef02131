//! Trees of boxes over primitives: what a shader walks to find the few that a ray can meet.

mod device_tree;
mod on_device;
mod pushes;
mod tree;

pub use device_tree::{Corners, DeviceTree, MOST_TRIANGLES, Scratch};
pub use on_device::{DeviceBuilder, Triangles};
pub use tree::{Bounds, Child, Node, Tree};
