//! Quality of a tree: the surface area heuristic, depth, memory.

use std::mem;

use anyhow::{Result, ensure};

use crate::hull::Hull;
use crate::tree::{Child, Tree};

/// Cost of a visit to a node: two boxes. The unit of all costs.
pub const TRAVERSAL: f64 = 1.0;

/// Cost of a test of a primitive.
pub const INTERSECTION: f64 = 1.0;

/// Expected cost of a random line that meets the root's box: [`TRAVERSAL`] for each node that it visits,
/// [`INTERSECTION`] for each primitive of a leaf that it visits. It meets a box within another as often as their
/// surface areas say (Goldsmith and Salmon 1987, MacDonald and Booth 1990).
///
/// 0 where the root's box has no surface.
pub fn cost(tree: &Tree) -> f64 {
    let area = |child: &Child| Hull::from((child.low, child.high)).half_area();
    let all = tree.nodes.iter().flat_map(|node| &node.children);
    let below: f64 = all
        .filter(|child| child.low.x <= child.high.x)
        .map(|child| match child.count {
            0 => TRAVERSAL * area(child),
            count => INTERSECTION * f64::from(count) * area(child),
        })
        .sum();
    let root = Hull::from(tree.bounds()).half_area();
    let is_some = tree.nodes[0].children.iter().any(|child| child.low.x <= child.high.x);
    if is_some && root > 0.0 { TRAVERSAL + below / root } else { 0.0 }
}

/// Number of nodes on the longest way from the root, the root among them: the most entries that the stack of a walk
/// needs.
///
/// # Errors
/// If a child names a missing node, or a node is reached twice: then this is not a tree, and a way down may not end.
pub fn depth(tree: &Tree) -> Result<u32> {
    let count = tree.nodes.len();
    let mut is_reached = vec![false; count];
    let mut deepest = 0;
    let mut stack = vec![(0, 1)];
    while let Some((at, level)) = stack.pop() {
        let node = at as usize;
        ensure!(node < count, "node {at} is named, and there are {count}");
        ensure!(!mem::replace(&mut is_reached[node], true), "node {at} is reached twice");
        deepest = level.max(deepest);
        let below = tree.nodes[node].children.iter().filter_map(Child::node);
        stack.extend(below.map(|node| (node, level + 1)));
    }
    Ok(deepest)
}

/// Bytes of a primitive's part of nodes and order. 0 for a tree over nothing.
pub fn bytes_per_primitive(tree: &Tree) -> f64 {
    let bytes = size_of_val(tree.nodes.as_slice()) + size_of_val(tree.order.as_slice());
    if tree.order.is_empty() { 0.0 } else { bytes as f64 / tree.order.len() as f64 }
}
