use std::ops::Range;

use common::glam::Vec3;
use proptest::prelude::*;
use reference::rational::rational;

use super::{Quantised, REACH, quantised};
use crate::{Bounds, Child, Node, binned, check};

/// A corner's coordinate as any device that conforms may find it: the exact sum, rounded up or down, and to
/// zero where it is subnormal.
fn found(node: &Quantised, axis: usize, byte: usize) -> [f32; 3] {
    let step = f32::from_bits((node.steps >> (8 * axis) & 0xff) << 23);
    assert!(step.is_normal() && !node.origin[axis].is_subnormal(), "{node:?}");
    let q = f32::from(node.boxes[axis].to_le_bytes()[byte]);
    assert!((q * step).is_finite() && f64::from(q * step) == f64::from(q) * f64::from(step));
    let exact = rational(node.origin[axis].into()) + rational((q * step).into());
    let near = node.origin[axis] + q * step;
    let (down, up) = match rational(near.into()).cmp(&exact) {
        std::cmp::Ordering::Equal => (near, near),
        std::cmp::Ordering::Less => (near, near.next_up()),
        std::cmp::Ordering::Greater => (near.next_down(), near),
    };
    [down, up, if near.abs() < f32::MIN_POSITIVE { 0.0 } else { near }]
}

fn node(boxes: [Option<Bounds>; 2]) -> Node {
    let child = |(low, high)| Child { low, first: 7, high, count: 3 };
    Node { children: boxes.map(|bounds| bounds.map_or(Child::NONE, child)) }
}

/// Checks that each box contains the one it represents, and that a box around nothing contains nothing.
fn holds(exact: &Node) -> bool {
    let packed = quantised(&[*exact]).unwrap()[0];
    let held = exact.children.iter().enumerate().all(|(side, child)| {
        (0..3).all(|axis| {
            let (low, high) = (found(&packed, axis, side), found(&packed, axis, side + 2));
            if child.low.x > child.high.x {
                low.iter().all(|low| high.iter().all(|high| low > high))
            } else {
                low.iter().all(|&low| low <= child.low[axis])
                    && high.iter().all(|&high| high >= child.high[axis])
            }
        })
    });
    let same = |(a, b): (&Child, &Child)| (a.first, a.count) == (b.first, b.count);
    held && exact.children.iter().zip(&packed.children()).all(same)
}

#[test]
fn a_node_has_36_bytes() {
    assert_eq!(size_of::<Quantised>(), 36);
}

#[test]
fn flat_huge_tiny_and_subnormal_boxes_are_held() {
    let tiny = f32::from_bits(1);
    let least = f32::MIN_POSITIVE;
    let numbers = [
        0.0,
        -0.0,
        1.0,
        1.0f32.next_up(),
        1.0f32.next_down(),
        1e9,
        1e9f32.next_up(),
        255.0,
        256.0,
        1e30,
        REACH,
        1e-18,
        1e-30,
        least,
        least.next_down(),
        least.next_up(),
        1.5 * least,
        2.0 * least,
        tiny,
        3.0 * tiny,
    ];
    let numbers: Vec<f32> = numbers.into_iter().flat_map(|x: f32| [x, -x]).collect();
    let spans = numbers.iter().flat_map(|&a| numbers.iter().map(move |&b| (a.min(b), a.max(b))));
    let spans: Vec<(f32, f32)> = spans.collect();
    // Beside each other: every pair of spans along x, flat along y, and a neighbour's along z.
    for (i, &(low, high)) in spans.iter().enumerate() {
        for &(a, b) in spans.iter().skip(i % 101).step_by(101) {
            let one = (Vec3::new(low, low, a), Vec3::new(high, low, b));
            let other = (Vec3::new(a, b, low), Vec3::new(b, b, low));
            assert!(holds(&node([Some(one), Some(other)])), "{one:?} {other:?}");
            assert!(holds(&node([Some(one), None])), "{one:?}");
        }
    }
    assert!(holds(&node([None, None])));
}

#[test]
fn whoever_is_beyond_reach_is_refused() {
    let bounds = (Vec3::ZERO, Vec3::X * REACH.next_up());
    assert!(quantised(&[node([Some(bounds), None])]).is_err());
    let mut crowded = node([Some((Vec3::ZERO, Vec3::ONE)), None]);
    crowded.children[0].count = 9;
    assert!(quantised(&[crowded]).is_err());
}

#[test]
fn a_tree_of_them_is_a_tree() {
    let at = |i: u32| Vec3::new((i * 617 % 1000) as f32, (i * 37 % 91) as f32, 1e4 + i as f32);
    let bounds: Vec<Bounds> = (0..1000).map(|i| (at(i), at(i) + 0.7)).collect();
    let mut tree = binned(&bounds);
    let packed = quantised(&tree.nodes).unwrap();
    // Children may stick out of a parent's box by a step of their own. So that of each is as large as both.
    tree.nodes = packed.iter().map(|node| Node { children: node.children() }).collect();
    for at in (0..tree.nodes.len()).rev() {
        for side in 0..2 {
            let child = tree.nodes[at].children[side];
            if let Some(node) = child.node() {
                let [a, b] = tree.nodes[node as usize].children;
                let low = child.low.min(a.low).min(b.low);
                let high = child.high.max(a.high).max(b.high);
                tree.nodes[at].children[side] = Child { low, high, ..child };
            }
        }
    }
    check(&tree, &bounds).unwrap();
}

#[test]
fn a_box_grows_by_no_more_than_two_steps() {
    for (low, high) in [(0.0, 255.0), (1e9, 1e9 + 6400.0), (-3.0, 7.0), (1e-20, 1e-18)] {
        let exact = node([Some((Vec3::splat(low), Vec3::splat(high))), None]);
        let packed = quantised(&[exact]).unwrap()[0];
        let [child, _] = packed.children();
        let step = f32::from_bits((packed.steps & 0xff) << 23);
        assert!(step <= ((high - low) / 127.0).max(high - high.next_down()), "{step}");
        assert!(child.high.x - child.low.x <= high - low + 2.0 * step, "{child:?}");
    }
}

fn span(exponents: Range<i32>) -> impl Strategy<Value = (f32, f32)> {
    let number = (exponents, 1f32..2.0, any::<bool>())
        .prop_map(|(e, x, up)| 2f64.powi(e) as f32 * if up { x } else { -x });
    let near = (number.clone(), -300i32..300).prop_map(|(x, ulps)| {
        let bits = x.to_bits() as i32;
        (x, f32::from_bits(bits.saturating_add(ulps).max(0) as u32 | x.to_bits() & 1 << 31))
    });
    let far = (number.clone(), number);
    prop_oneof![near, far].prop_map(|(a, b)| (a.min(b), a.max(b)))
}

fn any_box() -> impl Strategy<Value = Bounds> {
    prop::array::uniform3(prop_oneof![span(-149..125), span(-3..3), span(-149..-120)]).prop_map(
        |spans| (Vec3::from(spans.map(|span| span.0)), Vec3::from(spans.map(|span| span.1))),
    )
}

proptest! {
    #![proptest_config(ProptestConfig { rng_seed: proptest::test_runner::RngSeed::Fixed(31), ..ProptestConfig::with_cases(5000) })]

    #[test]
    fn a_box_is_held_however_sums_are_rounded(a in any_box(), b in prop::option::of(any_box())) {
        prop_assume!(a.1.max_element() <= REACH);
        prop_assert!(holds(&node([Some(a), b])));
    }
}
