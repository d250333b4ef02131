//! Promises of every tree, whoever built it.

use anyhow::{Context, Result, ensure};
use common::glam::Vec3;

use crate::hull::has_place;
use crate::quality::depth;
use crate::tree::{Bounds, Child, Tree};

/// The most nodes that a walk passes on its way down: a stack of as many entries never overflows.
pub const DEPTH: u32 = 48;

/// The most primitives in a leaf.
pub const LEAF: u32 = 8;

/// Checks that a tree keeps its promises: each primitive that has a place lies in just one leaf, each box holds all
/// that lies below it, each node is reached in just one way, and depth and leaves have their bounds.
///
/// # Errors
/// The first promise that is broken, and where.
pub fn check(tree: &Tree, bounds: &[Bounds]) -> Result<()> {
    let Tree { nodes, order } = tree;
    ensure!(!nodes.is_empty(), "a tree has a root");
    let mut found = Found::new(tree, bounds)?;
    let mut stack =
        vec![(0, 1, Child { low: -Vec3::INFINITY, high: Vec3::INFINITY, ..Child::NONE })];
    while let Some((at, level, above)) = stack.pop() {
        ensure!(at < nodes.len(), "node {at} is named, and there are {}", nodes.len());
        ensure!(!std::mem::replace(&mut found.nodes[at], true), "node {at} is reached twice");
        ensure!(level <= DEPTH, "node {at} is on level {level}, beyond {DEPTH}");
        for child in &nodes[at].children {
            let inside = is_empty(child) || holds(&above, &(child.low, child.high));
            ensure!(inside, "a box of node {at} is not within that of its parent: {child:?}");
            match child.node() {
                Some(node) => stack.push((node as usize, level + 1, *child)),
                None => found.add_leaf(at, child)?,
            }
        }
    }
    let missed = found.nodes.iter().position(|&found| !found);
    ensure!(missed.is_none(), "node {} of {} is not reached", missed.unwrap_or(0), nodes.len());
    let missed = found.positions.iter().position(|&found| !found);
    ensure!(missed.is_none(), "position {} of {} is in no leaf", missed.unwrap_or(0), order.len());
    Ok(())
}

/// Checks that all numbers of a tree over so many primitives lead somewhere, and each way down ends. Bytes that a
/// device wrote may hold any numbers: this comes before they are followed. [`check`] also looks at the boxes.
///
/// # Errors
/// The first number that is wrong, and where.
pub(crate) fn check_links(tree: &Tree, primitives: usize) -> Result<()> {
    let Tree { nodes, order } = tree;
    for (at, child) in
        nodes.iter().enumerate().flat_map(|(at, n)| n.children.iter().map(move |c| (at, c)))
    {
        let (named, count) = match child.node() {
            Some(node) => (node as usize + 1, nodes.len()),
            None => (child.positions().end, order.len()),
        };
        ensure!(named <= count, "a child of node {at} leads beyond the tree: {child:?}");
    }
    let wrong = order.iter().find(|&&primitive| primitive as usize >= primitives);
    ensure!(wrong.is_none(), "primitive {} of {primitives} has a position", wrong.unwrap_or(&0));
    depth(tree).map(drop)
}

/// Findings of a check so far.
struct Found<'a> {
    order: &'a [u32],
    bounds: &'a [Bounds],
    nodes: Vec<bool>,
    positions: Vec<bool>,
}

impl<'a> Found<'a> {
    fn new(Tree { nodes, order }: &'a Tree, bounds: &'a [Bounds]) -> Result<Self> {
        let mut missing: Vec<bool> = bounds.iter().map(has_place).collect();
        for (position, &primitive) in order.iter().enumerate() {
            let missing = missing.get_mut(primitive as usize);
            ensure!(
                missing.is_some_and(std::mem::take),
                "primitive {primitive}, at position {position}, is there twice or has no place"
            );
        }
        let lost = missing.iter().position(|&missing| missing);
        ensure!(lost.is_none(), "primitive {} is in no place", lost.unwrap_or(0));
        let (nodes, positions) = (vec![false; nodes.len()], vec![false; order.len()]);
        Ok(Self { order, bounds, nodes, positions })
    }

    fn add_leaf(&mut self, at: usize, leaf: &Child) -> Result<()> {
        ensure!(leaf.count <= LEAF, "a leaf of node {at} holds {}, beyond {LEAF}", leaf.count);
        for position in leaf.positions() {
            let found = self.positions.get_mut(position);
            let found = found.with_context(|| format!("node {at}: position {position} is none"))?;
            ensure!(!std::mem::replace(found, true), "position {position} is in two leaves");
            let primitive = self.order[position];
            let inside = holds(leaf, &self.bounds[primitive as usize]);
            ensure!(inside, "primitive {primitive} is not within its leaf's box, of node {at}");
        }
        Ok(())
    }
}

fn is_empty(child: &Child) -> bool {
    child.is_none() || child.low.x > child.high.x
}

fn holds(child: &Child, (low, high): &Bounds) -> bool {
    child.low.cmple(*low).all() && child.high.cmpge(*high).all()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Node, binned, cost, quantised};

    /// A row of cubes, and a tree over them.
    fn row() -> (Tree, Vec<Bounds>) {
        let cubes = (0..20).map(|i| Vec3::X * i as f32).map(|at| (at, at + 0.5));
        let cubes: Vec<Bounds> = cubes.collect();
        (binned(&cubes), cubes)
    }

    /// The message about a row whose tree was damaged.
    fn said(damage: impl Fn(&mut Tree)) -> String {
        let (mut tree, cubes) = row();
        damage(&mut tree);
        check(&tree, &cubes).expect_err("no tree any more").to_string()
    }

    fn leaf(tree: &mut Tree) -> &mut Child {
        let mut children = tree.nodes.iter_mut().flat_map(|node| &mut node.children);
        children.find(|child| child.count > 0).expect("a leaf")
    }

    #[test]
    fn a_broken_promise_is_named() {
        assert!(said(|tree| tree.order[3] = tree.order[4]).contains("twice"));
        assert!(said(|tree| tree.order[3] = 20).contains("primitive 20"));
        assert!(said(|tree| tree.order.truncate(19)).contains("in no place"));
        assert!(said(|tree| leaf(tree).high.x -= 0.125).contains("within its leaf's box"));
        assert!(said(|tree| leaf(tree).high.x += 99.0).contains("within that of its parent"));
        assert!(said(|tree| *leaf(tree) = Child::NONE).contains("is in no leaf"));
        assert!(said(|tree| leaf(tree).count = 9).contains("beyond 8"));
        assert!(said(|tree| tree.nodes.push(tree.nodes[1])).contains("is not reached"));
        assert!(said(|tree| tree.nodes[0].children[0].first = 99).contains("node 99"));
        assert!(
            said(|tree| tree.nodes[1].children[0] = tree.nodes[0].children[0])
                .contains("reached twice")
        );
    }

    /// A tree of such bytes; ends in an error, or is a tree.
    fn read_back(nodes: usize, order: usize, mut word: impl FnMut() -> u32) -> Result<()> {
        let mut tree =
            Tree { nodes: vec![Node { children: [Child::NONE; 2] }; nodes], order: vec![0; order] };
        let words: &mut [u32] = common::bytemuck::cast_slice_mut(&mut tree.nodes);
        words.fill_with(&mut word);
        tree.order.fill_with(&mut word);
        let checked = check_links(&tree, order);
        // A walk through any bytes ends.
        assert!(
            depth(&tree).is_err()
                || checked.is_ok()
                || depth(&tree).is_ok_and(|d| d as usize <= nodes)
        );
        let _ = (quantised(&tree.nodes), cost(&tree));
        checked
    }

    #[test]
    fn what_a_device_wrote_is_followed_to_an_end_whatever_it_is() {
        for count in [1, 2, 1000] {
            let zeros = read_back(count, count + 1, || 0).expect_err("a node is its own child");
            assert!(zeros.to_string().contains("node 0 is reached twice"), "{zeros}");
            assert!(read_back(count, count + 1, || u32::MAX).is_err());
            let mut random = 1u32;
            for bits in [1, 2, 10, 32] {
                for _ in 0..200 {
                    let word = || {
                        random = random.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
                        random.swap_bytes() >> (32 - bits)
                    };
                    let _ = read_back(count, count + 1, word);
                }
            }
        }
        let (tree, cubes) = row();
        check_links(&tree, cubes.len()).unwrap();
        assert!(check_links(&tree, cubes.len() - 1).is_err());
    }

    #[test]
    fn a_box_that_holds_more_than_it_must_is_none_the_worse() {
        let (mut tree, cubes) = row();
        for child in &mut tree.nodes[0].children {
            (child.low, child.high) = (child.low - 1.0, child.high + 1.0);
        }
        check(&tree, &cubes).unwrap();
    }

    #[test]
    fn a_tree_may_be_as_deep_as_the_stack_and_no_deeper() {
        for (levels, may) in [(DEPTH, true), (DEPTH + 1, false)] {
            let cubes: Vec<Bounds> = (0..levels).map(|_| (Vec3::ZERO, Vec3::ONE)).collect();
            let child = |first, count| Child { low: Vec3::ZERO, first, high: Vec3::ONE, count };
            let chain = (0..levels).map(|i| Node {
                children: [child(i, 1), if i + 1 < levels { child(i + 1, 0) } else { Child::NONE }],
            });
            let tree = Tree { nodes: chain.collect(), order: (0..levels).collect() };
            assert_eq!(check(&tree, &cubes).is_ok(), may);
        }
    }
}
