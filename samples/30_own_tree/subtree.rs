//! A part of a tree that is done, and whether it is better as one leaf.

use crate::hull::Hull;
use crate::quality::{INTERSECTION, TRAVERSAL};
use crate::tree::{Bounds, Child, Node, Tree};

/// The most primitives that a builder of ours puts into a leaf.
pub(crate) const FOLDED: u32 = 4;

/// A part of a tree: what its parent has to know of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Subtree {
    /// The box around it.
    pub hull: Hull,
    /// The index of its node; none for a leaf.
    pub node: Option<u32>,
    /// The position of its first primitive in the tree's order.
    pub first: u32,
    /// Number of primitives.
    pub count: u32,
    /// The heuristic's cost, times half the surface area that it is the cost for.
    pub cost: f64,
}

impl Subtree {
    /// All of it in one leaf.
    pub fn leaf(hull: Hull, first: u32, count: u32) -> Self {
        let cost = INTERSECTION * f64::from(count) * hull.half_area();
        Self { hull, node: None, first, count, cost }
    }

    /// Two that lie beside each other, under the node `at`, below which `nodes` holds theirs and no others.
    /// Where a leaf is no dearer, and holds no more than `most`, that is what they become.
    pub fn join(nodes: &mut Vec<Node>, at: usize, children: [Self; 2], most: u32) -> Self {
        let [a, b] = children;
        let leaf = Self::leaf(a.hull.join(&b.hull), a.first, a.count + b.count);
        let cost = TRAVERSAL * leaf.hull.half_area() + a.cost + b.cost;
        if leaf.count <= most && leaf.cost <= cost {
            nodes.truncate(at);
            return leaf;
        }
        nodes[at] = Node { children: children.map(Child::from) };
        Self { node: Some(at as u32), cost, ..leaf }
    }
}

impl From<Subtree> for Child {
    fn from(Subtree { hull, node, first, count, .. }: Subtree) -> Self {
        let (low, high) = Bounds::from(hull);
        match node {
            Some(first) => Self { low, first, high, count: 0 },
            None if count == 0 => Self::NONE,
            None => Self { low, first, high, count },
        }
    }
}

impl Subtree {
    /// The tree that is this, at the root of `nodes`.
    pub fn into_tree(self, mut nodes: Vec<Node>, order: Vec<u32>) -> Tree {
        if self.node.is_none() {
            nodes.push(Node { children: [self.into(), Child::NONE] });
        }
        Tree { nodes, order }
    }
}
