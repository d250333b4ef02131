use common::glam::Vec3;
use proptest::prelude::*;

use super::reinserted;
use crate::{Bounds, Child, DEPTH, Node, Tree, binned, check, cost, depth};

fn row(count: u32) -> Vec<Bounds> {
    (0..count).map(|i| Vec3::X * (i * 617 % 1000) as f32).map(|at| (at, at + 0.5)).collect()
}

/// A tree as bad as one that was refitted for long: leaves in the order given, a chain or halves.
fn bad(bounds: &[Bounds], is_chain: bool) -> Tree {
    fn grow(bounds: &[Bounds], is_chain: bool, first: u32, nodes: &mut Vec<Node>) -> Child {
        let around = |(a, b): Bounds, &(c, d): &Bounds| (a.min(c), b.max(d));
        let (low, high) = bounds.iter().fold((Child::NONE.low, Child::NONE.high), around);
        if let [_] = bounds {
            return Child { low, first, high, count: 1 };
        }
        let at = nodes.len();
        nodes.push(Node { children: [Child::NONE; 2] });
        let middle = if is_chain { 1 } else { bounds.len() / 2 };
        let (a, b) = bounds.split_at(middle);
        let a = grow(a, is_chain, first, nodes);
        let b = grow(b, is_chain, first + middle as u32, nodes);
        nodes[at].children = [a, b];
        Child { low, first: at as u32, high, count: 0 }
    }
    let mut nodes = Vec::new();
    grow(bounds, is_chain, 0, &mut nodes);
    Tree { nodes, order: (0..bounds.len() as u32).collect() }
}

#[test]
fn a_bad_tree_becomes_a_good_one() {
    let bounds = row(1000);
    let bad = bad(&bounds, false);
    let better = reinserted(bad.clone(), &bounds, 20);
    check(&better, &bounds).unwrap();
    let [bad, better, binned] = [&bad, &better, &binned(&bounds)].map(cost);
    println!("cost of a bad tree {bad:.1}, after reinsertion {better:.1}; binned {binned:.1}");
    assert!(better < 1.1 * binned && better < 0.1 * bad);
}

#[test]
fn each_round_makes_it_better_or_ends() {
    let bounds = row(777);
    let costs: Vec<f64> =
        (0..8).map(|rounds| cost(&reinserted(bad(&bounds, false), &bounds, rounds))).collect();
    println!("{costs:.2?}");
    assert!(costs.windows(2).all(|pair| pair[1] <= pair[0]));
}

#[test]
fn none_is_deeper_than_the_stack() {
    let bounds = row(DEPTH + 1);
    let chain = bad(&bounds, true);
    assert_eq!(depth(&chain).unwrap(), DEPTH);
    for rounds in 0..5 {
        check(&reinserted(chain.clone(), &bounds, rounds), &bounds).unwrap();
    }
    // Each primitive would best be inserted below all others.
    let nested: Vec<Bounds> =
        (1..5000).map(|i| Vec3::splat(1.01f32.powi(i))).map(|at| (-at, at)).collect();
    let tree = reinserted(binned(&nested), &nested, 10);
    check(&tree, &nested).unwrap();
    println!("nested: depth {}", depth(&tree).unwrap());
}

#[test]
fn leaves_on_the_last_level_stay_leaves() {
    // The last node of a chain holds a leaf of four.
    let bounds = [row(DEPTH - 1), vec![(Vec3::ZERO, Vec3::X * 999.0); 4]].concat();
    let mut chain = bad(&bounds, true);
    chain.nodes.truncate(DEPTH as usize);
    let last = &mut chain.nodes[DEPTH as usize - 1].children[1];
    *last = Child { first: DEPTH - 1 + 1, count: 3, ..*last };
    check(&chain, &bounds).unwrap();
    for rounds in [0, 1, 3] {
        check(&reinserted(chain.clone(), &bounds, rounds), &bounds).unwrap();
    }
}

#[test]
fn few_and_equal_ones_are_no_trouble() {
    for count in [0, 1, 2, 3, 5] {
        let bounds = row(count);
        check(&reinserted(binned(&bounds), &bounds, 3), &bounds).unwrap();
    }
    let same = vec![(Vec3::ONE, Vec3::ONE); 10_000];
    check(&reinserted(binned(&same), &same, 3), &same).unwrap();
}

proptest! {
    #![proptest_config(ProptestConfig { rng_seed: proptest::test_runner::RngSeed::Fixed(32), ..ProptestConfig::with_cases(200) })]

    #[test]
    fn no_primitive_is_lost(corners in prop::collection::vec(prop::array::uniform3(-8i8..8), 2..120), rounds in 0u32..6) {
        let at = |corner: [i8; 3]| Vec3::from(corner.map(f32::from));
        let bounds: Vec<Bounds> = corners.windows(2).map(|pair| (at(pair[0]).min(at(pair[1])), at(pair[0]).max(at(pair[1])))).collect();
        let tree = binned(&bounds);
        let better = reinserted(tree.clone(), &bounds, rounds);
        check(&better, &bounds).map_err(|error| TestCaseError::fail(error.to_string()))?;
    }
}
