//! A tree of boxes: nodes with two children, and the order of primitives that its leaves count on.

use common::glam::Vec3;

/// A box: its low and its high corner.
pub type Bounds = (Vec3, Vec3);

common::shader_struct! {
    /// A box, and what lies in it: a node, or some primitives. 32 bytes.
    pub struct Child {
        /// The low corner.
        pub low: Vec3,
        /// A node's index if `count` is 0, else the first primitive's position in the tree's order.
        pub first: u32,
        /// The high corner.
        pub high: Vec3,
        /// How many primitives; 0 for a node.
        pub count: u32,
    }
}

common::shader_struct! {
    /// A node: two boxes. 64 bytes, one line of most caches.
    pub struct Node {
        /// The boxes. A node with one child has [`Child::NONE`] beside it.
        pub children: [Child; 2],
    }
}

impl Child {
    /// A box that no ray meets.
    pub const NONE: Self =
        Self { low: Vec3::INFINITY, first: 0, high: Vec3::NEG_INFINITY, count: 0 };
}

/// A tree: its nodes, the root first, and which primitive lies at each position that leaves name.
#[derive(Clone, Debug)]
pub struct Tree {
    /// At least one: of a tree over nothing both children are [`Child::NONE`].
    pub nodes: Vec<Node>,
    /// A permutation of the primitives: each lies in just one leaf.
    pub order: Vec<u32>,
}
