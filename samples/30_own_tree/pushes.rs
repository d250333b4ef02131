//! Push constants of each pass of a build.

use common::gpu::Address;
use common::scene::Vertex;

use crate::device_tree::{Bounds, Corners, Extent};
use crate::tree::Node;

common::shader_struct! {
    /// For `extent.comp`.
    pub(crate) struct Reduce {
        pub vertices: Address<Vertex>,
        pub triangles: Address,
        pub extents: Address<Extent>,
        pub count: u32,
        pub shares: u32,
        pub is_last: u32,
    }
}

common::shader_struct! {
    /// For `morton.comp`.
    pub(crate) struct Code {
        pub vertices: Address<Vertex>,
        pub triangles: Address,
        pub extents: Address<Extent>,
        pub keys: Address,
        pub values: Address,
        pub count: u32,
    }
}

common::shader_struct! {
    /// For the parts of a step of the sort.
    pub(crate) struct Sort {
        pub keys: Address,
        pub values: Address,
        pub sorted_keys: Address,
        pub sorted_values: Address,
        pub counts: Address,
        pub totals: Address,
        pub count: u32,
        pub share_length: u32,
        pub shares: u32,
        pub shift: u32,
    }
}

common::shader_struct! {
    /// For `hierarchy.comp`.
    pub(crate) struct Hierarchy {
        pub keys: Address,
        pub extents: Address<Extent>,
        pub nodes: Address<Node>,
        pub ends: Address,
        pub nodes_count: u32,
    }
}

common::shader_struct! {
    /// For `leaves.comp`.
    pub(crate) struct Leaves {
        pub vertices: Address<Vertex>,
        pub triangles: Address,
        pub original: Address,
        pub corners: Address<Corners>,
        pub boxes: Address<Bounds>,
        pub count: u32,
    }
}

common::shader_struct! {
    /// For `pyramid.comp`.
    pub(crate) struct Level {
        pub boxes: Address<Bounds>,
        pub count: u32,
    }
}

common::shader_struct! {
    /// For `fit.comp`.
    pub(crate) struct Fit {
        pub nodes: Address<Node>,
        pub ends: Address,
        pub boxes: Address<Bounds>,
        pub nodes_count: u32,
        pub count: u32,
    }
}
