//! Recomputes boxes after primitives have moved, while the tree keeps its shape.

use crate::hull::Hull;
use crate::tree::{Bounds, Child, Node, Tree};

/// Gives a tree over moved primitives the boxes that they need: as tight as before, but no longer around
/// neighbours, if those have parted. Nodes may lie in any order.
///
/// A primitive whose box is finite no more is met no more, until it has one again; one that had no place when
/// the tree was built gets none.
///
/// # Panics
/// If a primitive of the tree is not in `bounds`, or a node is reached twice.
pub fn refit(tree: &mut Tree, bounds: &[Bounds]) {
    let Tree { nodes, order } = tree;
    for at in upward(nodes) {
        for side in 0..2 {
            let child = nodes[at as usize].children[side];
            let hull = match child.node() {
                Some(node) => Hull::around(nodes[node as usize].children.map(bounds_of)),
                None => Hull::around(order[child.positions()].iter().map(|&i| bounds[i as usize])),
            };
            let is_empty = hull == Hull::EMPTY;
            let (low, high) = if is_empty { bounds_of(Child::NONE) } else { hull.into() };
            nodes[at as usize].children[side] = Child { low, high, ..child };
        }
    }
}

/// Indices of the nodes, each after those below it.
fn upward(nodes: &[Node]) -> Vec<u32> {
    let mut found = Vec::with_capacity(nodes.len());
    found.push(0);
    let mut next = 0;
    while let Some(&at) = found.get(next) {
        assert!(found.len() <= nodes.len(), "a node is reached twice");
        found.extend(nodes[at as usize].children.iter().filter_map(Child::node));
        next += 1;
    }
    found.reverse();
    found
}

fn bounds_of(child: Child) -> Bounds {
    (child.low, child.high)
}

#[cfg(test)]
mod tests {
    use common::glam::Vec3;

    use super::refit;
    use crate::{Bounds, Child, binned, check, cost};

    fn cubes(count: u32, place: impl Fn(u32) -> Vec3) -> Vec<Bounds> {
        (0..count).map(|i| (place(i) - 0.25, place(i) + 0.25)).collect()
    }

    #[test]
    fn the_boxes_follow_what_moves() {
        let mut tree = binned(&cubes(100, |i| Vec3::X * i as f32));
        let moved = cubes(100, |i| Vec3::new(3.0, (i % 7) as f32, -(i as f32)));
        assert!(check(&tree, &moved).is_err());
        refit(&mut tree, &moved);
        check(&tree, &moved).unwrap();
    }

    #[test]
    fn what_has_not_moved_has_the_same_boxes() {
        let bounds = cubes(1000, |i| Vec3::new((i % 10) as f32, (i / 100) as f32, (i % 77) as f32));
        let built = binned(&bounds);
        let mut tree = built.clone();
        refit(&mut tree, &bounds);
        let bytes = |nodes| common::bytemuck::cast_slice::<_, u8>(nodes).to_vec();
        assert_eq!(bytes(&tree.nodes), bytes(&built.nodes));
    }

    #[test]
    fn who_is_lost_for_a_while_is_found_again() {
        let bounds = cubes(9, |i| Vec3::Y * i as f32);
        let built = binned(&bounds);
        let mut tree = built.clone();
        for lost in [
            vec![(Vec3::NAN, Vec3::NAN); 9],
            [bounds[..4].to_vec(), vec![(Vec3::ZERO, Vec3::INFINITY); 5]].concat(),
        ] {
            refit(&mut tree, &lost);
            assert!(cost(&tree).is_finite());
            let boxes = tree.nodes.iter().flat_map(|node| &node.children);
            assert!(boxes.clone().all(|child| child.low.abs().max_element() <= Child::NONE.low.x));
            assert!(boxes.clone().any(|child| child.low == Child::NONE.low));
        }
        refit(&mut tree, &bounds);
        check(&tree, &bounds).unwrap();
        assert_eq!(cost(&tree), cost(&built));
    }

    #[test]
    fn a_tree_of_neighbours_that_part_becomes_a_bad_one() {
        let mut tree = binned(&cubes(1000, |i| Vec3::X * i as f32));
        let shuffled = cubes(1000, |i| Vec3::X * (i * 617 % 1000) as f32);
        refit(&mut tree, &shuffled);
        check(&tree, &shuffled).unwrap();
        assert!(cost(&tree) > 10.0 * cost(&binned(&shuffled)));
    }
}
