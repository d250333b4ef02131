//! 38_primitive_order: every order gives the same picture, and its effect on the tree.

use common::gpu::ShaderEnum;
use common::gpu::order::Bounds;
use common::scene::{Camera, Scene};
use glam::{DVec3, Vec3};
use serde_json::{Map, Value};

use run::primary_hits::{answer, rays};
use run::{Chapter, expected, same_colors, same_hits};

#[allow(dead_code)]
#[path = "../../samples/38_primitive_order/order.rs"]
mod order;
#[allow(dead_code)]
#[path = "../../samples/38_primitive_order/tree.rs"]
pub mod tree;

use crate::intersection::{scenes, shapes};
use order::Order;
use scenes::SceneKind;
use tree::Node;

const NAME: &str = "38_primitive_order";
const SIZE: &str = "120x75";
/// The number of spheres in the chapter.
const COUNT: u32 = 10_000;

fn chapter(size: &str) -> Chapter {
    Chapter::new(NAME).size(size)
}

/// The name of an order.
fn word(order: Order) -> &'static str {
    Order::LAYOUT.words[order as usize]
}

/// The boxes around the spheres of the random ball.
fn ball() -> Vec<Bounds> {
    let mut chess = Scene::chess().unwrap();
    chess.model.materials.extend(shapes::materials());
    let shapes = scenes::shapes(SceneKind::RandomBall, COUNT, &chess.model, &chess.instances);
    shapes.spheres.iter().map(shapes::Sphere::bounds).collect()
}

fn in_order(order: Order, bounds: &[Bounds]) -> Vec<Bounds> {
    order.of(bounds).into_iter().map(|i| bounds[i as usize]).collect()
}

#[test]
fn the_picture_repeats() {
    Chapter::new(NAME).repeats();
}

#[test]
fn every_order_gives_the_same_picture() {
    orders_give_the_same_picture(&["scene=grid", "count=1000"], &["copies in order=off"]);
}

#[test]
#[ignore = "nightly: a larger scene; quick: primitive_order::every_order_gives_the_same_picture"]
fn every_order_gives_the_same_picture_of_a_ball() {
    orders_give_the_same_picture(&[], &COPIES);
}

#[test]
#[ignore = "nightly: copies, too; quick: primitive_order::copies_change_no_pixel"]
fn every_order_of_copies_gives_the_same_picture() {
    orders_give_the_same_picture(&["scene=grid", "count=1000"], &COPIES);
}

const COPIES: [&str; 2] = ["copies in order=off", "copies in order=on"];

fn orders_give_the_same_picture(scene: &[&str], copies: &[&str]) {
    for copies in copies {
        let view = |show, order| {
            chapter(SIZE).sets(scene).sets(&[show]).set("order", order).sets(&[copies]).picture()
        };
        let [colors, hits] = ["show=picture", "show=hit"].map(|show| view(show, "given"));
        for order in Order::ALL.iter().map(|&order| word(order)) {
            let what = format!("{scene:?}, {copies}: {order} and as given");
            same_colors(&what, NAME, &view("show=picture", order), &colors);
            same_hits(&what, NAME, &view("show=hit", order), &hits);
        }
    }
}

/// A plinth is on the board, a tower is made of boxes: distances are equal except for rounding.
#[test]
fn where_shapes_touch_order_changes_only_ties() {
    let view = |order| chapter(SIZE).sets(&["scene=chess", "show=hit", order]).picture();
    let (ordered, given) = (view("order=halves"), view("order=given"));
    let (mut ties, mut others) = (0, 0);
    for (a, b) in ordered.pixels.iter().zip(&given.pixels).filter(|(a, b)| a[..3] != b[..3]) {
        let tie = (a[2] - b[2]).abs() <= 16.0 / 16_777_216.0 * a[2];
        if tie { ties += 1 } else { others += 1 }
    }
    println!("{ties} ties");
    assert!(others == 0 && ties < 20, "{ties} ties, {others} others");
}

#[test]
fn copies_change_no_pixel() {
    for show in ["picture", "hit", "shadow origin", "place in order"] {
        let show = format!("show={show}");
        let view =
            |copies| chapter(SIZE).sets(&["scene=grid", "count=1000", &show, copies]).picture();
        let (list, copies) = (view("copies in order=off"), view("copies in order=on"));
        same_colors(&show, NAME, &copies, &list);
    }
}

#[test]
fn every_order_is_a_permutation() {
    let broken = [(Vec3::NAN, Vec3::ONE), (Vec3::ZERO, Vec3::INFINITY), (Vec3::ONE, Vec3::ONE)];
    let some = [&ball()[..500], &broken].concat();
    for bounds in [&some[..], &some[..1], &[(Vec3::ONE, Vec3::ONE); 7], &[]] {
        for &order in Order::ALL {
            let mut numbers = order.of(bounds);
            numbers.sort_unstable();
            assert!(numbers.into_iter().eq(0..bounds.len() as u32), "{}", word(order));
        }
    }
}

/// Sixteen points per side, a thousandth of the cube from the corners of the curves' cells.
fn lattice() -> Vec<[i32; 3]> {
    let side = 0..16;
    let line = |x: i32, y: i32| side.clone().map(move |z| [x, y, z]);
    side.clone()
        .flat_map(|x| side.clone().flat_map(move |y| line(x, y).collect::<Vec<_>>()))
        .collect()
}

#[test]
fn hilberts_curve_goes_from_neighbour_to_neighbour_and_mortons_jumps() {
    let points = lattice();
    let bounds: Vec<Bounds> = points
        .iter()
        .map(|&point| Vec3::from_array(point.map(|x| x as f32)))
        .map(|point| (point, point))
        .collect();
    let steps = |order: Order| {
        let visited: Vec<_> = order.of(&bounds).into_iter().map(|i| points[i as usize]).collect();
        let step = |pair: &[[i32; 3]]| (0..3).map(|k| (pair[0][k] - pair[1][k]).abs()).sum::<i32>();
        visited.windows(2).map(step).collect::<Vec<_>>()
    };
    assert!(steps(Order::Hilbert).into_iter().all(|step| step == 1));
    // From the last cell of one half to the first of the other: 1 along x, and back along y and z.
    let longest = steps(Order::Morton).into_iter().max();
    assert_eq!(longest, Some(1 + 15 + 15));
    // Eight in a row are the corners of a cube.
    let morton = Order::Morton.of(&bounds);
    for eight in morton.chunks(8) {
        let cubes: Vec<_> = eight.iter().map(|&i| points[i as usize].map(|x| x / 2)).collect();
        assert!(cubes.iter().all(|cube| *cube == cubes[0]), "{eight:?}");
    }
}

/// Walks the tree and compares each box with those inside it; returns the primitives' boxes in order.
fn leaves(nodes: &[Node]) -> Vec<Bounds> {
    let mut found = Vec::new();
    for (i, node) in nodes.iter().enumerate() {
        let next = node.next as usize;
        assert!(next > i && next <= nodes.len(), "{i}: {next}");
        let held = &nodes[i + 1..next];
        assert!(held.iter().all(|n| n.low.cmpge(node.low).all() && n.high.cmple(node.high).all()));
        if held.is_empty() {
            found.push((node.low, node.high));
        }
    }
    found
}

#[test]
fn the_tree_halves_the_list() {
    let bounds = &ball()[..1000];
    for count in [1, 2, 3, 7, 1000] {
        let nodes = tree::nodes(&bounds[..count]);
        assert_eq!(nodes.len(), 2 * count - 1);
        assert_eq!(leaves(&nodes), bounds[..count]);
        if count > 1 {
            // k boxes have a tree of 2k - 1 nodes, numbered from 1.
            assert_eq!(nodes[1].next as usize / 2, count.div_ceil(2));
        }
    }
    assert!(tree::nodes(&[]).is_empty());
}

/// The random lines assumed by the formula: through two points of a sphere around the root. A uniformly
/// distributed line hits everything inside with the same probability.
#[test]
fn the_expected_tests_are_what_lines_find() {
    let bounds = in_order(Order::Morton, &ball()[..300]);
    let nodes = tree::nodes(&bounds);
    let root = &nodes[0];
    let middle = (root.low + root.high).as_dvec3() * 0.5;
    let radius = (root.high - root.low).as_dvec3().length() * 0.5;
    let mut state = 1u32;
    let mut random = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(state >> 8) / f64::from(1 << 24)
    };
    let mut on_sphere = || {
        let (y, turn) = (2.0 * random() - 1.0, std::f64::consts::TAU * random());
        let across = (1.0 - y * y).sqrt();
        middle + radius * DVec3::new(across * turn.cos(), y, across * turn.sin())
    };
    let (mut lines, mut tests) = (0, 0);
    while lines < 20_000 {
        let (from, to) = (on_sphere(), on_sphere());
        if meets(root, from, to - from, 1.0) {
            lines += 1;
            tests += tested(&nodes, from, to - from, 1.0);
        }
    }
    let (found, expected) = (tests as f64 / lines as f64, tree::expected_tests(&nodes));
    println!("{found:.2} found, {expected:.2} expected");
    // The mean of 20,000 counts with a deviation of half of it is accurate to a third of a percent.
    assert!((found / expected - 1.0).abs() < 0.015, "{found} {expected}");
}

/// Returns whether a ray hits a node's box before `end`.
fn meets(node: &Node, origin: DVec3, direction: DVec3, end: f64) -> bool {
    let (low, high) = (node.low.as_dvec3() - origin, node.high.as_dvec3() - origin);
    let (a, b) = (low / direction, high / direction);
    let (enter, leave) = (a.min(b).max_element(), a.max(b).min_element());
    enter <= leave && leave >= 0.0 && enter <= end
}

/// The number of boxes a ray is tested against.
pub fn tested(nodes: &[Node], origin: DVec3, direction: DVec3, end: f64) -> usize {
    tested_leaves(nodes, origin, direction, end).0
}

/// The same, and the primitives whose boxes it hits, in the order of the list.
pub fn tested_leaves(
    nodes: &[Node],
    origin: DVec3,
    direction: DVec3,
    end: f64,
) -> (usize, Vec<usize>) {
    let (mut i, mut tests, mut leaves, mut met) = (0, 0, 0, Vec::new());
    while let Some(node) = nodes.get(i) {
        tests += 1;
        let next = node.next as usize;
        let meets = meets(node, origin, direction, end);
        // A box of k primitives and those in it are 2k - 1 nodes.
        let primitives = (next - i).div_ceil(2);
        if meets && primitives == 1 {
            met.push(leaves);
        }
        let skipped = !meets || primitives == 1;
        leaves += if skipped { primitives } else { 0 };
        i = if skipped { next } else { i + 1 };
    }
    (tests, met)
}

#[test]
fn better_orders_are_expected_to_test_fewer_boxes() {
    let bounds = ball();
    let mut held = Map::new();
    for &order in Order::ALL {
        let expected = tree::expected_tests(&tree::nodes(&in_order(order, &bounds)));
        println!("{}: {expected:.1}", word(order));
        held.insert(word(order).replace(' ', "-"), expected.into());
    }
    let of = |name: &str| held[name].as_f64().unwrap();
    assert!(of("chance") > 2.0 * of("along-x"));
    assert!(of("along-x") > 2.0 * of("Morton"));
    assert!(of("Morton") > of("Hilbert") && of("Hilbert") > of("halves"));
    // The ball's spheres are in the order of a random generator.
    assert!((of("given") / of("chance") - 1.0).abs() < 0.1);
    expected::hold_exact("38_primitive_order/expected", Value::Object(held));
}

#[test]
fn the_view_counts_what_the_tree_costs_each_ray() {
    let bounds = ball();
    let camera = scenes::camera(SceneKind::RandomBall, Camera::default(), COUNT);
    let [hits, directions] =
        ["show=hit", "show=ray direction"].map(|show| chapter(SIZE).sets(&[show]).picture());
    let mut held = Map::new();
    for &order in Order::ALL {
        let nodes = tree::nodes(&in_order(order, &bounds));
        let set = format!("order={}", word(order));
        let counted = chapter(SIZE).sets(&[&set]).sets(&["show=box tests"]).picture();
        let mean = counted.pixels.iter().map(|pixel| f64::from(pixel[3])).sum::<f64>()
            / counted.pixels.len() as f64;
        let (mut ours, mut theirs) = (0.0, 0.0);
        for ((ray, hit), count) in
            rays(&camera, &directions).zip(&hits.pixels).zip(&counted.pixels).step_by(7)
        {
            let end = answer(hit).map_or(1e30, |hit| hit.t.into());
            ours += tested(&nodes, ray.origin, ray.direction, end) as f64;
            theirs += f64::from(count[3]);
        }
        // At a box's edge 32 bits and 64 may differ, which decides whether both halves of the box are tested.
        assert!((theirs / ours - 1.0).abs() < 1e-3, "{set}: {theirs}, {ours} in 64 bits");
        println!("{set}: {mean:.1} tests a ray");
        held.insert(word(order).replace(' ', "-"), mean.into());
    }
    expected::hold("38_primitive_order/tests", Value::Object(held));
}
