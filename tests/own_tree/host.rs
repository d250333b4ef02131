//! Builds on the host, over what the chapter shows, and how long they take.

use std::hint::black_box;
use std::time::Instant;

use own_tree::{binned, bytes_per_primitive, check, cost, depth, quantised, refit, reinserted};

use crate::scenes;

#[test]
fn every_triangle_of_the_chess_set_lies_in_its_tree() {
    for triangles in scenes::chess() {
        let bounds = triangles.bounds();
        let tree = binned(&bounds);
        check(&tree, &bounds).unwrap();
        check(&reinserted(tree.clone(), &bounds, 2), &bounds).unwrap();
        assert_eq!(quantised(&tree.nodes).unwrap().len(), tree.nodes.len());
        let (cost, depth, bytes) = (cost(&tree), depth(&tree), bytes_per_primitive(&tree));
        println!(
            "{:14} {:7} triangles: cost {cost:.1}, depth {depth}, {bytes:.0} bytes each",
            triangles.name,
            bounds.len()
        );
    }
}

#[test]
#[ignore = "by hand: takes times"]
fn times_of_builds() {
    println!(
        "primitives  binned  reinserted(1)  refit  quantised: ms; cost, cost reinserted(1), depth, bytes"
    );
    for count in [1_000, 10_000, 100_000, 1_000_000] {
        let bounds = scenes::random_triangles(count).bounds();
        let (build, mut tree) = best(5, || binned(black_box(&bounds)));
        let (again, better) = best(1, || reinserted(tree.clone(), &bounds, 1));
        let (boxes, ()) = best(5, || refit(black_box(&mut tree), &bounds));
        let (packing, _) = best(5, || quantised(black_box(&tree.nodes)).unwrap());
        println!(
            "{count:10} {build:8.2} {again:9.1} {boxes:8.2} {packing:8.2}; {:6.2} {:6.2} {} {:.1}",
            cost(&tree),
            cost(&better),
            depth(&tree),
            bytes_per_primitive(&tree)
        );
    }
    for triangles in scenes::chess() {
        let bounds = triangles.bounds();
        let (build, _) = best(5, || binned(black_box(&bounds)));
        println!("{:10} {build:8.2} {}", bounds.len(), triangles.name);
    }
}

/// The shortest of some times, in milliseconds, and what was made.
fn best<T>(times: u32, mut make: impl FnMut() -> T) -> (f64, T) {
    let mut run = || {
        let start = Instant::now();
        let made = make();
        (start.elapsed().as_secs_f64() * 1e3, made)
    };
    let mut best = run();
    for _ in 1..times {
        best = [run(), best].into_iter().min_by(|a, b| a.0.total_cmp(&b.0)).expect("two");
    }
    best
}
