//! Trees of boxes over primitives: what a shader walks to find the few that a ray can meet.

mod tree;

pub use tree::{Bounds, Child, Node, Tree};
