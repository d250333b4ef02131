//! Decay of a tree of boxes that is only updated: measured by the surface area heuristic on the host, so that
//! the result is the same everywhere.
//!
//! The cost of a tree is the sum of the probabilities that a ray hits a node: its area over the root's
//! (MacDonald and Booth 1990). The tree halves the list in the samples' order.

use common::gpu::order::{Bounds, kd_median};
use common::model::{Model, obj};
use common::scene::assets;
use glam::Vec3;
use run::expected;
use serde_json::json;

use super::motion::KINDS;
use super::{cloth, opera};

fn union((a, b): Bounds, (c, d): Bounds) -> Bounds {
    (a.min(c), b.max(d))
}

fn area((low, high): Bounds) -> f64 {
    let side = (high - low).as_dvec3();
    side.x * side.y + side.y * side.z + side.z * side.x
}

/// The box of a tree of a list, and the sum of all nodes' areas.
fn tree(list: &[u32], boxes: &[Bounds]) -> (Bounds, f64) {
    if let [one] = list {
        let leaf = boxes[*one as usize];
        return (leaf, area(leaf));
    }
    let (left, right) = list.split_at(list.len().div_ceil(2));
    let (left, right) = (tree(left, boxes), tree(right, boxes));
    let whole = union(left.0, right.0);
    (whole, left.1 + right.1 + area(whole))
}

/// The cost of a tree built for some boxes and updated to others.
fn cost(built: &[Bounds], now: &[Bounds]) -> f64 {
    let (root, sum) = tree(&kd_median(built), now);
    sum / area(root)
}

/// The cost of an updated tree relative to a rebuilt one.
fn decay(built: &[Bounds], now: &[Bounds]) -> f64 {
    cost(built, now) / cost(now, now)
}

fn triangles(frame: u32) -> Vec<Bounds> {
    let corners: Vec<Vec3> = cloth::corners(frame, 48).iter().map(|at| at.as_vec3()).collect();
    let around = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|index| corners[index as usize]);
        (a.min(b).min(c), a.max(b).max(c))
    };
    cloth::triangles(48).iter().map(around).collect()
}

fn pieces(frame: u32) -> Vec<Bounds> {
    let model: Model = obj::load(&assets().join("chess.obj")).unwrap();
    let opera = opera();
    let boxes = opera.at(frame).map(|piece| {
        let name = KINDS[piece.kind];
        let mesh = model.meshes.iter().find(|mesh| mesh.name == name).unwrap();
        let corners = mesh.vertices.iter().map(|vertex| piece.at.transform_point3(vertex.position));
        corners.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(a, b), at| (a.min(at), b.max(at)))
    });
    boxes.collect()
}

/// Rounds 1 plus a small number to thousandths, as printed on pages.
fn rounded(factor: f64) -> f64 {
    (1000.0 * factor).round() / 1000.0
}

#[test]
fn a_tree_decays_as_its_boxes_move_apart_and_not_with_the_number_of_updates() {
    // Built while it waves, then updated: each wave is like the last.
    let waving =
        [1, 8, 15, 30, 60, 240].map(|frames| decay(&triangles(480), &triangles(480 + frames)));
    // Built folded, then updated while it unfolds.
    let unfolding = [30, 60, 120, 240, 480].map(|frame| decay(&triangles(0), &triangles(frame)));
    let game = [240, 480, 960, 1824].map(|frame| decay(&pieces(0), &pieces(frame)));
    println!("waving {waving:.3?}\nunfolding {unfolding:.3?}\ngame {game:.3?}");
    assert!(waving.iter().all(|factor| (factor - 1.0).abs() < 0.05), "{waving:?}");
    assert!(unfolding.is_sorted() && unfolding[4] > 1.5, "{unfolding:?}");
    assert!(game.is_sorted() && game[3] > 2.0, "{game:?}");
    let [w1, w8, w15, w30, w60, w240] = waving.map(rounded);
    let [u30, u60, u120, u240, u480] = unfolding.map(rounded);
    let [g240, g480, g960, g1824] = game.map(rounded);
    expected::hold_exact(
        "14_animation/decay",
        json!({
            "waving_1": w1, "waving_8": w8, "waving_15": w15, "waving_30": w30, "waving_60": w60,
            "waving_240": w240,
            "unfolding_30": u30, "unfolding_60": u60, "unfolding_120": u120, "unfolding_240": u240,
            "unfolding_480": u480,
            "game_240": g240, "game_480": g480, "game_960": g960, "game_1824": g1824,
        }),
    );
}
