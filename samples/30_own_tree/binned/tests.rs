use common::glam::Vec3;
use proptest::prelude::*;

use super::{FOLDED, GRAIN, binned, binned_on};
use crate::{Bounds, Child, DEPTH, Tree, check, cost, depth};

/// A hash of a number (splitmix64), as a number from 0 to 1.
fn chance(i: u64) -> f32 {
    let z = (i + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ z >> 31) >> 40) as f32 / (1 << 24) as f32
}

/// Random cubes, of a thirtieth of the cube that contains them.
fn crowd(count: u64) -> Vec<Bounds> {
    let at = |i| Vec3::new(chance(3 * i), chance(3 * i + 1), chance(3 * i + 2));
    (0..count).map(|i| (at(i), at(i) + 0.03)).collect()
}

fn bytes(tree: &Tree) -> (&[u8], &[u32]) {
    (common::bytemuck::cast_slice(&tree.nodes), &tree.order)
}

fn checked(bounds: &[Bounds]) -> Tree {
    let tree = binned(bounds);
    check(&tree, bounds).unwrap();
    tree
}

/// Boxes without size in two places or more that are a power of two away from the origin.
fn exponentials(each: usize) -> Vec<Bounds> {
    let places = (-149..128).map(|exponent| Vec3::new(2f64.powi(exponent) as f32, 0.0, 0.0));
    places.flat_map(|at| vec![(at, at); each]).collect()
}

#[test]
fn any_number_of_threads_builds_the_same_bytes() {
    let bounds = crowd(40 * GRAIN as u64);
    let one = binned_on(&bounds, FOLDED, 1);
    check(&one, &bounds).unwrap();
    for threads in [2, 3, 7, 64] {
        assert!(bytes(&binned_on(&bounds, FOLDED, threads)) == bytes(&one), "{threads} threads");
    }
}

#[test]
fn nothing_one_and_two_have_a_root() {
    let tree = checked(&[]);
    assert_eq!((tree.nodes.len(), tree.order.len(), cost(&tree)), (1, 0, 0.0));
    let far = |i: f32| (Vec3::splat(i), Vec3::splat(i + 0.5));
    let tree = checked(&[far(0.0)]);
    assert_eq!((tree.nodes.len(), cost(&tree)), (1, 2.0));
    let [Child { count: 1, .. }, none] = tree.nodes[0].children else { panic!("{tree:?}") };
    assert_eq!((none.low, none.high, none.count), (Child::NONE.low, Child::NONE.high, 0));
    let tree = checked(&[far(0.0), far(9.0)]);
    assert_eq!(tree.nodes.len(), 1);
    assert!(tree.nodes[0].children.iter().all(|child| child.count == 1));
}

#[test]
fn a_hundred_thousand_in_one_place_are_halved() {
    let tree = checked(&vec![(Vec3::ZERO, Vec3::ONE); 100_000]);
    assert_eq!(depth(&tree).unwrap(), 15);
    let tree = checked(&vec![(Vec3::splat(1e9), Vec3::splat(1e9)); 100_000]);
    assert_eq!(depth(&tree).unwrap(), 15);
    // About one middle, all of other sizes.
    let around = |i: u64| Vec3::splat(1.0 + i as f32);
    let tree = checked(&(0..100_000).map(|i| (-around(i), around(i))).collect::<Vec<_>>());
    assert!(depth(&tree).unwrap() <= 17);
}

#[test]
fn who_is_not_finite_or_inside_out_has_no_place() {
    let mut bounds = crowd(1000);
    bounds[7].0.x = f32::NAN;
    bounds[8].1.y = f32::INFINITY;
    bounds[9] = (Vec3::NEG_INFINITY, Vec3::INFINITY);
    bounds[10] = (Vec3::ONE, Vec3::ZERO);
    bounds[11] = (Vec3::NAN, Vec3::NAN);
    let tree = checked(&bounds);
    assert_eq!(tree.order.len(), 995);
    assert!(!tree.order.iter().any(|i| (7..12).contains(i)));
    let nobody = checked(&vec![(Vec3::NAN, Vec3::ZERO); 9]);
    assert_eq!((nobody.nodes.len(), nobody.order.len()), (1, 0));
}

#[test]
fn what_is_spaced_exponentially_is_no_deeper_than_the_stack() {
    for each in [1, 40, 1000] {
        let tree = checked(&exponentials(each));
        assert!(depth(&tree).unwrap() <= DEPTH, "{}", depth(&tree).unwrap());
    }
    // Along a diagonal, in boxes that grow with it, and backwards.
    let mut bounds: Vec<Bounds> =
        exponentials(100).iter().map(|&(at, _)| (Vec3::ZERO, Vec3::splat(at.x))).collect();
    bounds.reverse();
    assert!(depth(&checked(&bounds)).unwrap() > 15);
}

#[test]
fn a_plane_that_leaves_too_many_on_a_side_gives_way() {
    // Each plane parts the last few places from all others: without the bound, a level for each 4 exponents.
    let bounds = exponentials(1000);
    let tree = checked(&bounds);
    assert!(depth(&tree).unwrap() > DEPTH - 12, "no test of the bound: {}", depth(&tree).unwrap());
}

#[test]
fn the_largest_and_the_smallest_numbers_end_well() {
    for scale in [1e9, 1e30, f32::MAX, 1e-18, 1e-30, 1e-38, f32::from_bits(1)] {
        let boxes = crowd(5000).into_iter().map(|(low, high)| (low * scale, high * scale));
        let mirrored = |(low, high): Bounds| [(low, high), (-high, -low)];
        let bounds: Vec<Bounds> = boxes
            .flat_map(mirrored)
            .map(|(low, high)| (low.max(Vec3::MIN), high.min(Vec3::MAX)))
            .collect();
        let tree = checked(&bounds);
        assert!(depth(&tree).unwrap() < 40, "{scale}: {}", depth(&tree).unwrap());
    }
}

#[test]
fn the_scale_does_not_change_the_tree() {
    let bounds = crowd(2000);
    let at_scale = |scale: f32| -> Vec<Bounds> {
        bounds.iter().map(|&(low, high)| (low * scale, high * scale)).collect()
    };
    let order = binned(&bounds).order;
    for exponent in [-80, -60, 30, 100] {
        assert!(binned(&at_scale(2f32.powi(exponent))).order == order, "2^{exponent}");
    }
}

#[test]
fn a_plane_goes_between_two_heaps() {
    let heap =
        |i: u64| Vec3::new(if i.is_multiple_of(2) { 0.0 } else { 10.0 }, chance(i), chance(i + 99));
    let bounds: Vec<Bounds> = (0..1000).map(|i| (heap(i), heap(i) + 0.1)).collect();
    let [a, b] = checked(&bounds).nodes[0].children;
    assert!(a.high.x < 1.0 && b.low.x > 9.0, "{a:?} {b:?}");
}

#[test]
fn a_leaf_is_made_where_it_is_no_dearer() {
    // Three in one place: a node costs more than it saves. Three apart: it saves most.
    let together = checked(&[(Vec3::ZERO, Vec3::ONE); 3]);
    assert_eq!((together.nodes.len(), cost(&together)), (1, 4.0));
    let apart: Vec<Bounds> =
        [0.0, 5.0, 9.0].map(|x| (Vec3::X * x, Vec3::X * x + Vec3::ONE)).to_vec();
    assert_eq!(checked(&apart).nodes.len(), 2);
}

/// A number of any size, with many that are equal.
fn coordinate() -> impl Strategy<Value = f32> {
    prop_oneof![
        4 => (-4i8..4).prop_map(f32::from),
        4 => -1f32..1.0,
        1 => proptest::num::f32::ANY,
        1 => Just(1e9),
    ]
}

fn any_box() -> impl Strategy<Value = Bounds> {
    let corner = || prop::array::uniform3(coordinate()).prop_map(Vec3::from);
    prop_oneof![
        4 => (corner(), corner()).prop_map(|(a, b)| (a.min(b), a.max(b))),
        1 => (corner(), corner()),
        1 => corner().prop_map(|at| (at, at)),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { rng_seed: proptest::test_runner::RngSeed::Fixed(30), ..ProptestConfig::with_cases(100) })]

    #[test]
    fn no_primitive_is_lost_whatever_the_boxes(bounds in prop::collection::vec(any_box(), 0..300)) {
        check(&binned(&bounds), &bounds).map_err(|error| TestCaseError::fail(error.to_string()))?;
    }

    #[test]
    fn no_primitive_is_lost_in_any_order(
        shuffled in prop::collection::vec(any_box(), 1..40).prop_shuffle(),
        copies in 1usize..20,
    ) {
        let bounds = shuffled.repeat(copies);
        check(&binned(&bounds), &bounds).map_err(|error| TestCaseError::fail(error.to_string()))?;
    }
}
