//! A tree of boxes: nodes with two children, and the order of primitives that its leaves refer to.

use std::ops::Range;

use common::glam::Vec3;

use crate::hull::Hull;

/// A box: its low and its high corner.
pub type Bounds = (Vec3, Vec3);

common::shader_struct! {
    /// A box, and its contents: a node, or some primitives. 32 bytes.
    pub struct Child {
        /// The low corner.
        pub low: Vec3,
        /// A node's index if `count` is 0, else the first primitive's position in the tree's order.
        pub first: u32,
        /// The high corner.
        pub high: Vec3,
        /// Number of primitives; 0 for a node.
        pub count: u32,
    }
}

common::shader_struct! {
    /// A node: two boxes. 64 bytes, a line of the cache of most processors.
    pub struct Node {
        /// The boxes. A node with one child has [`Child::NONE`] beside it.
        pub children: [Child; 2],
    }
}

impl Child {
    /// Nothing, in a box that no ray meets: inside out by so much that growing does not turn it, and by so little that
    /// all numbers of a walk stay finite. Vulkan leaves open how others compare.
    pub const NONE: Self =
        Self { low: Vec3::splat(1e10), first: u32::MAX, high: Vec3::splat(-1e10), count: 0 };

    /// The node's index, if it is one.
    pub fn node(&self) -> Option<u32> {
        (self.count == 0 && self.first != Self::NONE.first).then_some(self.first)
    }

    /// Returns whether there is nothing in it.
    pub fn is_none(&self) -> bool {
        self.count == 0 && self.first == Self::NONE.first
    }

    /// The positions of a leaf's primitives in the tree's order; of no leaf, none.
    pub fn positions(&self) -> Range<usize> {
        let first = if self.is_none() { 0 } else { self.first as usize };
        first..first + self.count as usize
    }
}

/// A tree: its nodes, the root first, and the primitive at each position that leaves refer to.
#[derive(Clone, Debug)]
pub struct Tree {
    /// At least one: of a tree over nothing both children are [`Child::NONE`].
    pub nodes: Vec<Node>,
    /// The primitives in the order of the leaves, each in just one leaf. Those without a place are left out:
    /// see [`has_place`](crate::has_place).
    pub order: Vec<u32>,
}

impl Tree {
    /// The bounding box of the tree; inside out if it is empty.
    pub fn bounds(&self) -> Bounds {
        Hull::around(self.nodes[0].children.map(|child| (child.low, child.high))).into()
    }

    /// The nodes with all indices shifted, for an array of many trees.
    pub fn placed(&self, first_node: u32, first_primitive: u32) -> impl Iterator<Item = Node> {
        self.nodes.iter().map(move |node| Node {
            children: node.children.map(|child| match child {
                none if none.is_none() => none,
                node if node.count == 0 => Child { first: node.first + first_node, ..node },
                leaf => Child { first: leaf.first + first_primitive, ..leaf },
            }),
        })
    }
}
