//! Trees whose triangles have moved since the build.

use common::scene::Vertex;
use own_tree::{Child, DeviceTree, Node};

use super::{Bench, Built, Uploaded, check, shapes, vertex};

#[test]
fn a_refit_fits_what_has_moved_and_leaves_the_shape() {
    let bench = Bench::new();
    let still = shapes::cloth(60, 40);
    let mut moved = still.clone();
    for at in &mut moved.vertices {
        at.z = (3.0 * at.x + at.y).sin();
    }
    let (tree, input) = bench.build(&still);
    let before = Built::read(&tree);
    let vertices: Vec<Vertex> = moved.vertices.iter().map(|at| vertex(*at)).collect();
    input.vertices.write(0, &vertices).unwrap();
    let refit = |cmd| bench.builder.refit(cmd, input.input(), &tree, &bench.scratch);
    bench.gpu.submit(refit).unwrap();
    let after = Built::read(&tree);
    check(&moved, &after);
    assert_eq!(before.original, after.original);
    for (before, after) in before.nodes.iter().zip(&after.nodes) {
        let shape = |node: &Node| node.children.map(|child| (child.first, child.count));
        assert_eq!(shape(before), shape(after));
    }
    bench.is_silent();
}

#[test]
fn a_triangle_that_ceases_to_be_finite_is_in_no_box_after_a_refit() {
    let bench = Bench::new();
    let mut shape = shapes::soup(200, 4);
    let (tree, input) = bench.build(&shape);
    let gone = shape.triangles[17];
    shape.vertices[gone[1] as usize].y = f32::NAN;
    let vertices: Vec<Vertex> = shape.vertices.iter().map(|at| vertex(*at)).collect();
    input.vertices.write(0, &vertices).unwrap();
    let refit = |cmd| bench.builder.refit(cmd, input.input(), &tree, &bench.scratch);
    bench.gpu.submit(refit).unwrap();
    let built = Built::read(&tree);
    let children = built.nodes.iter().flat_map(|node| node.children);
    for child in children {
        match child.count {
            1 if built.original[child.first as usize] == 17 => {
                assert_eq!((child.low, child.high), (Child::NONE.low, Child::NONE.high));
            }
            _ => assert!(child.low.is_finite() && child.high.is_finite()),
        }
    }
    bench.is_silent();
}

#[test]
fn builds_and_refits_in_one_submission_wait_for_each_other() {
    let bench = Bench::new();
    let shapes = [shapes::soup(3000, 21), shapes::cloth(30, 30), shapes::soup(900, 22)];
    let inputs: Vec<_> = shapes.iter().map(|shape| Uploaded::new(&bench.gpu, shape)).collect();
    let trees = inputs.iter().map(|input| DeviceTree::new(&bench.gpu, input.count).unwrap());
    let trees: Vec<_> = trees.collect();
    bench
        .gpu
        .submit(|cmd| {
            for (input, tree) in inputs.iter().zip(&trees) {
                bench.builder.record(cmd, input.input(), tree, &bench.scratch)?;
            }
            bench.builder.refit(cmd, inputs[0].input(), &trees[0], &bench.scratch)
        })
        .unwrap();
    for (shape, tree) in shapes.iter().zip(&trees) {
        check(shape, &Built::read(tree));
    }
    bench.is_silent();
}
