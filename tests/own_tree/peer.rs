//! Our trees beside those of a library: obvhs.

use common::glam::{Vec3, Vec3A};
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::{build_bvh2, build_bvh2_from_tris};
use obvhs::{BvhBuildParams, aabb::Aabb};
use own_tree::{Bounds, Child, INTERSECTION, Node, TRAVERSAL, Tree, binned, check, cost, reinserted};

use crate::scenes::{self, Triangle};

/// Rounds of reinsertion after which ours is compared.
pub const ROUNDS: u32 = 8;

/// A library's tree as one of ours, so that it is measured by the same few lines.
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
    let boxes: Vec<Aabb> = bounds.iter().map(|&(low, high)| Aabb::new(low.into(), high.into())).collect();
    converted(&build_bvh2(&boxes, preset, &mut Default::default()))
}

/// It may cut large triangles into several boxes, which our trees do not.
fn over_triangles(triangles: &[Triangle], preset: BvhBuildParams) -> Tree {
    let triangle = |corners: &Triangle| {
        let [v0, v1, v2] = corners.map(Vec3A::from);
        obvhs::triangle::Triangle { v0, v1, v2 }
    };
    let triangles: Vec<_> = triangles.iter().map(triangle).collect();
    converted(&build_bvh2_from_tris(&triangles, preset, &mut Default::default()))
}

/// Costs: theirs at their fastest, ours, ours with reinsertion, theirs at their slowest.
fn costs(bounds: &[Bounds]) -> [f64; 4] {
    let ours = binned(bounds);
    let better = reinserted(ours.clone(), bounds, ROUNDS);
    for tree in [&ours, &better] {
        check(tree, bounds).unwrap();
    }
    let fastest = over_boxes(bounds, BvhBuildParams::fastest_build());
    let slowest = over_boxes(bounds, BvhBuildParams::very_slow_build());
    check(&slowest, bounds).unwrap();
    [&fastest, &ours, &better, &slowest].map(cost)
}

#[test]
fn ours_are_better_than_their_fastest_and_near_their_best() {
    println!("cost: {TRAVERSAL} a node, {INTERSECTION} a primitive");
    let mut lists: Vec<(String, Vec<Bounds>, Option<f64>)> = Vec::new();
    for triangles in scenes::chess().into_iter().chain([scenes::random_triangles(100_000)]) {
        let cut = cost(&over_triangles(&triangles.list, BvhBuildParams::very_slow_build()));
        lists.push((triangles.name.clone(), triangles.bounds(), Some(cut)));
    }
    lists.push(("10,000 spheres".to_owned(), scenes::spheres(10_000), None));
    println!("{:24} primitives fastest  binned reinserted very slow  and cut", "over");
    let mut worst = [f64::INFINITY, 0.0f64];
    for (name, bounds, cut) in lists {
        let [fastest, ours, better, slowest] = costs(&bounds);
        let cut = cut.map_or(String::new(), |cut| format!("{cut:8.2}"));
        println!(
            "{name:24} {:10} {fastest:7.2} {ours:7.2} {better:10.2} {slowest:9.2} {cut}",
            bounds.len()
        );
        worst = [worst[0].min(fastest / ours), worst[1].max(better / slowest)];
    }
    println!("fastest / binned at least {:.3}, reinserted / very slow at most {:.3}", worst[0], worst[1]);
    assert!(worst[0] > 1.0 && worst[1] <= 1.1);
}
