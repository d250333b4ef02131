//! Our trees next to those of a library: obvhs.

use common::glam::{Vec3, Vec3A};
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::{build_bvh2, build_bvh2_from_tris};
use obvhs::{BvhBuildParams, aabb::Aabb};
use own_tree::{
    Bounds, Child, INTERSECTION, Node, TRAVERSAL, Tree, binned, check, cost, reinserted,
};

use crate::scenes::{self, Triangle};

/// The number of rounds of reinsertion before the comparison.
pub const ROUNDS: u32 = 8;

/// Converts a library's tree to ours, so that both are measured by the same code.
fn converted(theirs: &Bvh2) -> Tree {
    fn child(theirs: &Bvh2, at: u32, nodes: &mut Vec<Node>) -> Child {
        let node = &theirs.nodes[at as usize];
        let (low, high) = (Vec3::from(node.aabb().min), Vec3::from(node.aabb().max));
        if node.prim_count > 0 {
            return Child { low, first: node.first_index, high, count: node.prim_count };
        }
        let at = nodes.len();
        nodes.push(Node { children: [Child::NONE; 2] });
        nodes[at].children = [0, 1].map(|side| child(theirs, node.first_index + side, nodes));
        Child { low, first: at as u32, high, count: 0 }
    }
    let mut nodes = Vec::new();
    let root = child(theirs, 0, &mut nodes);
    if nodes.is_empty() {
        nodes.push(Node { children: [root, Child::NONE] });
    }
    Tree { nodes, order: theirs.primitive_indices.clone() }
}

fn over_boxes(bounds: &[Bounds], preset: BvhBuildParams) -> Tree {
    let boxes: Vec<Aabb> =
        bounds.iter().map(|&(low, high)| Aabb::new(low.into(), high.into())).collect();
    converted(&build_bvh2(&boxes, preset, &mut Default::default()))
}

/// The library may cut large triangles into several boxes, which our trees do not.
fn over_triangles(triangles: &[Triangle], preset: BvhBuildParams) -> Tree {
    let triangle = |corners: &Triangle| {
        let [v0, v1, v2] = corners.map(Vec3A::from);
        obvhs::triangle::Triangle { v0, v1, v2 }
    };
    let triangles: Vec<_> = triangles.iter().map(triangle).collect();
    converted(&build_bvh2_from_tris(&triangles, preset, &mut Default::default()))
}

/// Their slowest preset, with leaves chosen by our cost function. By default a node costs as much as three
/// primitives there, which makes leaves larger.
fn slowest() -> BvhBuildParams {
    let collapse_traversal_cost = (TRAVERSAL / INTERSECTION) as f32;
    BvhBuildParams { collapse_traversal_cost, ..BvhBuildParams::very_slow_build() }
}

/// Costs: their fastest, ours, ours with reinsertion, their slowest by default and with our cost function.
fn costs(bounds: &[Bounds]) -> [f64; 5] {
    let ours = binned(bounds);
    let better = reinserted(ours.clone(), bounds, ROUNDS);
    let fastest = over_boxes(bounds, BvhBuildParams::fastest_build());
    let best = over_boxes(bounds, BvhBuildParams::very_slow_build());
    let fair = over_boxes(bounds, slowest());
    for tree in [&ours, &better, &fastest, &best, &fair] {
        check(tree, bounds).unwrap();
    }
    [&fastest, &ours, &better, &best, &fair].map(cost)
}

#[test]
fn ours_are_better_than_their_fastest_and_near_their_best() {
    println!("cost: {TRAVERSAL} a node, {INTERSECTION} a primitive");
    let mut lists: Vec<(String, Vec<Bounds>, f64)> = Vec::new();
    for triangles in scenes::chess().into_iter().chain([scenes::random_triangles(100_000)]) {
        let cut = cost(&over_triangles(&triangles.list, slowest()));
        lists.push((triangles.name.clone(), triangles.bounds(), cut));
    }
    lists.push(("10,000 spheres".to_owned(), scenes::spheres(10_000), f64::INFINITY));
    println!("primitives fastest  binned reinserted | very slow, by our costs, cut: over");
    let mut least = f64::INFINITY;
    let mut most = 0.0f64;
    for (name, bounds, cut) in lists {
        let [fastest, ours, better, best, fair] = costs(&bounds);
        println!(
            "{:10} {fastest:7.2} {ours:7.2} {better:10.2} | {best:9.2} {fair:13.2} {cut:4.2}: {name}",
            bounds.len()
        );
        least = least.min(fastest / ours);
        most = most.max(better / best.min(fair).min(cut));
    }
    println!("fastest / binned: at least {least:.3}; reinserted / their best: at most {most:.3}");
    assert!(least > 1.0 && most <= 1.1);
}
