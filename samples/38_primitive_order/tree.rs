//! The tree of a builder that takes boxes as they come: the first half of the list, and the second.

use common::gpu::order::Bounds;
use glam::Vec3;

common::shader_struct! {
    /// A box of the tree.
    pub struct Node {
        pub low: Vec3,
        pub high: Vec3,
        /// The node that comes after all that this box holds.
        pub next: u32,
    }
}

// ANCHOR: tree
/// Each box before those that it holds. Its first half comes right behind it; a ray that misses the box
/// goes on at `next`.
pub fn nodes(bounds: &[Bounds]) -> Vec<Node> {
    let mut nodes = Vec::new();
    if !bounds.is_empty() {
        grow(bounds, &mut nodes);
    }
    nodes
}

fn grow(bounds: &[Bounds], nodes: &mut Vec<Node>) -> Bounds {
    let at = nodes.len();
    nodes.push(Node { low: Vec3::ZERO, high: Vec3::ZERO, next: 0 });
    let (low, high) = match bounds {
        [one] => *one,
        _ => {
            let (first, second) = bounds.split_at(bounds.len().div_ceil(2));
            let (a, b) = (grow(first, nodes), grow(second, nodes));
            (a.0.min(b.0), a.1.max(b.1))
        }
    };
    nodes[at] = Node { low, high, next: nodes.len() as u32 };
    (low, high)
}
// ANCHOR_END: tree

/// Expected number of boxes tested against a random line that meets the root: the root, and the two halves of each
/// box that it meets. It meets a box within another as often as their surface areas say: the surface area
/// heuristic.
pub fn expected_tests(nodes: &[Node]) -> f64 {
    let area = |node: &Node| {
        let side = (node.high - node.low).as_dvec3();
        side.x * side.y + side.y * side.z + side.z * side.x
    };
    let halved = nodes.iter().enumerate().filter(|(i, node)| node.next as usize > i + 1);
    let all: f64 = halved.map(|(_, node)| area(node)).sum();
    nodes.first().map_or(0.0, |root| 1.0 + 2.0 * all / area(root))
}
