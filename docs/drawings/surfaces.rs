//! Normals of a squashed surface, points of a disk, and the slopes that a normal map paints.

use std::f64::consts::TAU;

use glam::{DMat2, DVec2};

use crate::sheet::Anchor::{Middle, Start};
use crate::sheet::{BLUE, BROWN, LEAF, LINE, Point, RED, SEA, SOFT, Sheet, WHITE};

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

/// A flat surface with a mapped normal, whose mirrored ray goes below it; and the steps that have these normals, between
/// whose facets the same ray goes back and forth.
pub fn slope_and_wall() -> String {
    let mut s =
        Sheet::new([840, 300], "Slopes and walls: a flat surface that has the mapped normals");
    let tilt = 30f64.to_radians();
    // Down is positive. The slope descends to the right, and the wall looks to the left.
    let slope = DVec2::new(tilt.sin(), -tilt.cos());
    let wall = -DVec2::X;
    let coming = DVec2::new(0.75, 0.66).normalize();
    let mirrored = |ray: DVec2, normal: DVec2| ray - 2.0 * ray.dot(normal) * normal;

    let hit = DVec2::new(200.0, 170.0);
    s.polygon(&[[40.0, 170.0], [360.0, 170.0], [360.0, 260.0], [40.0, 260.0]], BLUE, LINE);
    for x in [80.0, 140.0, 200.0, 260.0, 320.0] {
        let from = DVec2::new(x, 170.0);
        s.line(&[point(from), point(from + 42.0 * slope)], SEA, 2.0);
    }
    s.arrow(&[point(hit - 130.0 * coming), point(hit)]);
    let down = mirrored(coming, slope);
    s.line(&[point(hit), point(hit + 110.0 * down)], RED, 2.0);
    s.note([236.0, 228.0], Start, "its mirrored ray");
    s.say([200.0, 284.0], Middle, "painted: the ray goes below the surface");

    let (left, top, width) = (440.0, 150.0, 120.0);
    let height = width * tilt.tan();
    let mut outline = vec![[left, top + 110.0], [left, top]];
    for step in 1..=3 {
        let x = left + width * f64::from(step);
        outline.extend([[x, top + height], [x, top]]);
    }
    outline.push([left + 3.0 * width, top + 110.0]);
    s.polygon(&outline, BLUE, LINE);
    for step in 0..3 {
        let from = DVec2::new(left + width * (f64::from(step) + 0.22), top + 0.22 * height);
        s.line(&[point(from), point(from + 42.0 * slope)], SEA, 2.0);
        let from = DVec2::new(left + width * f64::from(step + 1), top + 0.4 * height);
        s.line(&[point(from), point(from + 26.0 * wall)], BROWN, 2.0);
    }
    let first = DVec2::new(left + 1.42 * width, top + 0.42 * height);
    let right = mirrored(coming, slope);
    let at_wall = first + right * ((left + 2.0 * width - first.x) / right.x);
    let back = mirrored(right, wall);
    // The slope is where the distance along its normal from its upper end is 0.
    let end = DVec2::new(left + width, top);
    let again = at_wall - back * ((at_wall - end).dot(slope) / back.dot(slope));
    let out = mirrored(back, slope);
    s.arrow(&[point(first - 130.0 * coming), point(first)]);
    s.line(&[point(first), point(at_wall), point(again)], LEAF, 2.0);
    s.arrow(&[point(again), point(again + 130.0 * out)]);
    s.note([left + 3.0 * width + 8.0, top + 0.5 * height], Start, "wall");
    s.note([left + 16.0, top + height + 16.0], Start, "slope");
    s.say([left + 1.5 * width, 284.0], Middle, "steps: slope, wall, slope again, and out");
    s.svg()
}
