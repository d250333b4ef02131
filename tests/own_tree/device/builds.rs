//! Trees right after a build.

use common::scene::Scene;
use glam::Vec3;
use instruments::arithmetic::Arithmetic;
use own_tree::{DeviceTree, Node, Scratch};

use super::karras::{NOT_FINITE, codes, hierarchy};
use super::shapes::{self, Shape};
use super::{Bench, Uploaded, box_of};

#[test]
fn every_triangle_is_in_one_leaf_and_every_box_is_exact_whatever_the_number() {
    let bench = Bench::new();
    for count in [0, 1, 2, 3, 4, 5, 7, 8, 9, 63, 64, 65, 100, 1000, 2048, 2049, 30_000] {
        bench.checked(&shapes::soup(count, count));
    }
}

#[test]
fn no_triangle_is_lost_in_any_order() {
    let bench = Bench::new();
    let mesh = shapes::cloth(40, 30);
    for shape in [mesh.clone(), mesh.clone().reversed(), mesh.shuffled(7)] {
        bench.checked(&shape);
    }
}

#[test]
fn every_mesh_of_the_chess_set_gets_its_tree() {
    let bench = Bench::new();
    for mesh in Scene::chess().unwrap().model.meshes {
        let vertices = mesh.vertices.iter().map(|vertex| vertex.position).collect();
        bench.checked(&Shape { name: mesh.name, vertices, triangles: mesh.triangles });
    }
}

#[test]
fn what_is_hard_to_sort_ends_in_bounded_depth() {
    let bench = Bench::new();
    let deep = |shape: &Shape| {
        let built = bench.checked(shape);
        depth(&built.nodes)
    };
    // Their codes are equal, so that the positions give a balanced tree: 2^17 are more than that.
    assert_eq!(deep(&shapes::in_one_place(100_000)), 17);
    assert_eq!(deep(&shapes::in_one_place(3)), 2);
    // Each at half the distance of the previous one: the tree is a list of one level per bit, and then
    // balanced below.
    assert!(deep(&shapes::halving(1000)) <= 40);
    for scale in [1e9, 1e38, 1e-18, 1e-36] {
        bench.checked(&shapes::soup(500, 3).scaled(scale));
    }
    bench.checked(&shapes::flat(500));
    // One direction spans the whole range of floats.
    bench.checked(&shapes::soup(500, 3).stretched(Vec3::new(3.4e38, 1.0, 1e-30)));
}

#[test]
fn triangles_that_are_not_finite_are_left_out_and_change_nothing_else() {
    let bench = Bench::new();
    let whole = shapes::soup(300, 11);
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        for step in [1, 2, 7, 299] {
            let mut shape = whole.clone();
            for triangle in shape.triangles.iter().step_by(step) {
                shape.vertices[triangle[step % 3] as usize][step % 3] = bad;
            }
            let built = bench.checked(&shape);
            let mut rest = shape.clone();
            rest.triangles.retain(|triangle| box_of(shape.corners(*triangle)).is_some());
            let without = bench.checked(&rest);
            let used = without.nodes.len();
            assert_eq!(
                bytemuck::cast_slice::<_, u8>(&built.nodes[..used]),
                bytemuck::cast_slice::<_, u8>(&without.nodes)
            );
        }
    }
}

#[test]
fn the_hierarchy_is_that_of_a_plain_host_on_the_same_codes() {
    let bench = Bench::new();
    let mut broken = shapes::soup(3000, 5);
    broken.vertices[100].x = f32::NAN;
    for shape in [
        shapes::soup(2, 1),
        shapes::soup(3000, 2),
        shapes::cloth(50, 40).shuffled(3),
        shapes::in_one_place(1000),
        shapes::halving(200),
        broken,
    ] {
        let built = bench.checked(&shape);
        let codes = codes(&shape);
        let mut order: Vec<u32> = (0..codes.len() as u32).collect();
        order.sort_by_key(|&triangle| codes[triangle as usize]);
        assert_eq!(
            built.original, order,
            "{}: sorted, and the same ones in their order",
            shape.name
        );
        let keys = order.iter().map(|&triangle| codes[triangle as usize]);
        let keys: Vec<u32> = keys.filter(|&code| code != NOT_FINITE).collect();
        for (index, expected) in hierarchy(&keys).into_iter().enumerate() {
            let found = built.nodes[index].children.map(|child| (child.first, child.count == 1));
            assert_eq!(found, expected, "{}: node {index}", shape.name);
        }
    }
}

#[test]
fn the_same_triangles_give_the_same_bytes() {
    let bench = Bench::new();
    for shape in [shapes::soup(10_000, 9), shapes::in_one_place(5000)] {
        let first = bench.checked(&shape);
        for _ in 0..3 {
            assert_eq!(bench.checked(&shape).bytes(), first.bytes());
        }
    }
}

#[test]
fn boxes_are_exact_in_the_worst_arithmetic() {
    if !run::has_worst_arithmetic() {
        return;
    }
    let bench = Bench::with(Arithmetic::WorstByPlace);
    let mut broken = shapes::soup(500, 8);
    broken.vertices[100].x = f32::NAN;
    for shape in [shapes::soup(3000, 2), shapes::cloth(30, 20), shapes::halving(300), broken] {
        bench.checked(&shape);
    }
    bench.checked(&shapes::soup(500, 3).scaled(1e9));
}

#[test]
#[ignore = "by hand: takes 2 GB of memory"]
fn more_triangles_than_one_row_of_workgroups_has_invocations_for() {
    let (bench, count) = (Bench::new(), 65_535 * 64 + 1000);
    let scratch = Scratch::new(&bench.gpu, count).unwrap();
    Bench { scratch, ..bench }.checked(&shapes::soup(count, 1));
}

#[test]
fn what_does_not_fit_is_refused_in_one_line() {
    let bench = Bench::new();
    let input = Uploaded::new(&bench.gpu, &shapes::soup(10, 1));
    let scratch = Scratch::new(&bench.gpu, 9).unwrap();
    let refused = |tree: &DeviceTree, scratch: &Scratch| {
        let record = |cmd| bench.builder.record(cmd, input.input(), tree, scratch);
        bench.gpu.submit(record).unwrap_err().to_string()
    };
    let [ten, eleven] = [10, 11].map(|count| DeviceTree::new(&bench.gpu, count).unwrap());
    assert_eq!(refused(&eleven, &bench.scratch), "a tree of 11 triangles cannot be built from 10");
    assert_eq!(
        refused(&ten, &scratch),
        "scratch memory for 9 triangles is too small for a tree of 10"
    );
    let error = DeviceTree::new(&bench.gpu, 1 << 30).err().unwrap().to_string();
    assert!(error.starts_with("1073741824 triangles are too many"), "{error}");
}

/// The number of nodes on the longest path from the root.
fn depth(nodes: &[Node]) -> u32 {
    let mut open = vec![(0, 1)];
    let mut deepest = 0;
    while let Some((index, depth)) = open.pop() {
        deepest = deepest.max(depth);
        for child in nodes[index as usize].children {
            if child.count == 0 && child.low.x <= child.high.x {
                open.push((child.first, depth + 1));
            }
        }
    }
    deepest
}
