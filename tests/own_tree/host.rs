//! Builds on the host, for the chapter's scene.

use own_tree::{binned, bytes_per_primitive, check, cost, depth, quantised, reinserted};

use crate::scenes;

#[test]
fn every_triangle_of_the_chess_set_lies_in_its_tree() {
    for triangles in scenes::chess() {
        let bounds = triangles.bounds();
        let tree = binned(&bounds);
        check(&tree, &bounds).unwrap();
        check(&reinserted(tree.clone(), &bounds, 2), &bounds).unwrap();
        assert_eq!(quantised(&tree.nodes).unwrap().len(), tree.nodes.len());
        let (cost, depth, bytes) = (cost(&tree), depth(&tree).unwrap(), bytes_per_primitive(&tree));
        println!(
            "{:14} {:7} triangles: cost {cost:.1}, depth {depth}, {bytes:.0} bytes each",
            triangles.name,
            bounds.len()
        );
    }
}
