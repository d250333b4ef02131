//! Normals of a squashed surface, and points of a disk.

use std::f64::consts::TAU;

use glam::{DMat2, DVec2};

use crate::sheet::Anchor::{Middle, Start};
use crate::sheet::{BLUE, BROWN, LINE, Point, RED, SEA, SOFT, Sheet, WHITE};

fn point(p: DVec2) -> Point {
    p.to_array()
}

/// A circle with its normals; then squashed, with its normals by the matrix and by the inverse transpose.
pub fn squashed_normals() -> String {
    let mut s = Sheet::new([840, 300], "Squash a surface, and its normals turn the other way");
    let squash = DMat2::from_diagonal(DVec2::new(1.0, 0.35));
    let ways = [
        ("the mesh", DMat2::IDENTITY, DMat2::IDENTITY, SEA),
        ("normals by the matrix L: wrong", squash, squash, RED),
        ("by its inverse transpose: right", squash, squash.inverse().transpose(), SEA),
    ];
    for (i, (name, places, normals, color)) in ways.into_iter().enumerate() {
        let middle = DVec2::new(150.0 + 270.0 * i as f64, 150.0);
        let on = |turn: f64| places * (70.0 * DVec2::from_angle(turn));
        let outline: Vec<Point> =
            (0..64).map(|k| point(middle + on(TAU * f64::from(k) / 64.0))).collect();
        s.polygon(&outline, BLUE, LINE);
        for turn in (0..12).map(|k| TAU * (f64::from(k) + 0.5) / 12.0) {
            let from = middle + on(turn);
            let normal = (normals * DVec2::from_angle(turn)).normalize();
            let along = (places * DVec2::from_angle(turn + TAU / 4.0)).normalize();
            s.line(&[point(from - 11.0 * along), point(from + 11.0 * along)], SOFT, 1.2);
            s.line(&[point(from), point(from + 34.0 * normal)], color, 2.0);
            s.dot(point(from), 2.5, LINE);
        }
        s.say([middle.x, 280.0], Middle, name);
    }
    s.svg()
}

/// Sixteen points of a disk: at random, and on the spiral of `shaders/common/disk.glsl`.
pub fn disk_points() -> String {
    let mut s = Sheet::new([840, 300], "Sixteen points of a lamp's disk");
    const COUNT: u32 = 16;
    // A linear congruential generator (Knuth's MMIX); this seed leaves a typical gap.
    let mut state = 41_u64;
    let mut random = || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let chance: Vec<DVec2> =
        (0..COUNT).map(|_| random().sqrt() * DVec2::from_angle(TAU * random())).collect();
    let spiral = |i: f64| {
        let radius = ((i + 0.5) / f64::from(COUNT)).sqrt();
        radius * DVec2::from_angle(TAU * 0.618_033_989 * i)
    };
    let seeds: Vec<DVec2> = (0..COUNT).map(|i| spiral(f64::from(i))).collect();
    let sets = [("at random: gaps and clusters", chance), ("on a spiral: evenly spread", seeds)];
    for (i, (name, points)) in sets.into_iter().enumerate() {
        let middle = DVec2::new(180.0 + 260.0 * i as f64, 158.0);
        s.circle(point(middle), 96.0, WHITE, LINE);
        for p in points {
            s.dot(point(middle + 96.0 * p), 4.5, BROWN);
        }
        s.say([middle.x, 280.0], Middle, name);
    }
    let lines = [
        "Each point is turned from the one",
        "before by 0.618 of a turn, and its",
        "distance grows with the square root",
        "of its number, so that every ring",
        "of the same area gets as many.",
    ];
    for (row, line) in lines.into_iter().enumerate() {
        s.say([580.0, 116.0 + 20.0 * row as f64], Start, line);
    }
    s.svg()
}
