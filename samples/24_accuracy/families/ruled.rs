//! Bilinear patches: rays from everywhere, and rays that nearly touch them, pass their edges or run along their lines.

use glam::{DVec3, Vec3};
use reference::random::{Random, f32s};

use super::curved::nearly;
use super::{Draw, Family, on_disc};
use crate::shape::Shape;

/// Twisted, nearly flat, a kite without a twist at one corner, and one with an edge that is a point.
const PATCHES: [[Vec3; 4]; 4] = [
    [
        Vec3::new(-0.9, -0.7, 0.3),
        Vec3::new(0.8, -0.6, -0.5),
        Vec3::new(-0.7, 0.8, -0.4),
        Vec3::new(0.6, 0.9, 0.7),
    ],
    [
        Vec3::new(-0.8, -0.3, -0.6),
        Vec3::new(0.7, -0.4, -0.5),
        Vec3::new(-0.6, 0.5, 0.7),
        Vec3::new(0.9, 0.401, 0.801),
    ],
    [
        Vec3::new(0.0, -0.9, 0.1),
        Vec3::new(0.8, 0.0, -0.3),
        Vec3::new(-0.7, 0.1, 0.2),
        Vec3::new(0.2, 0.7, 0.9),
    ],
    [
        Vec3::new(0.1, -0.8, 0.2),
        Vec3::new(0.1, -0.8, 0.2),
        Vec3::new(-0.7, 0.6, -0.5),
        Vec3::new(0.8, 0.5, 0.4),
    ],
];

/// A strip, two units long and a hundred-thousandth wide, twisted by a quarter of a turn.
const STRIP: [Vec3; 4] = [
    Vec3::new(-1.0, 0.125, -5e-6),
    Vec3::new(1.0, -0.25, 0.0),
    Vec3::new(-1.0, 0.125, 5e-6),
    Vec3::new(1.0, -0.25 + 1e-5, 0.0),
];

fn at(patch: &[Vec3; 4], u: f64, v: f64) -> DVec3 {
    let [a, b, c, d] = patch.map(Vec3::as_dvec3);
    a.lerp(b, u).lerp(c.lerp(d, u), v)
}

/// The directions of u and v.
fn along(patch: &[Vec3; 4], u: f64, v: f64) -> [DVec3; 2] {
    let [a, b, c, d] = patch.map(Vec3::as_dvec3);
    [(b - a).lerp(d - c, v), (c - a).lerp(d - b, u)]
}

pub fn patches(draw: Draw) -> Vec<Family> {
    let shapes = || PATCHES.map(Shape::Patch).to_vec();
    let count = PATCHES.len();
    let inside = |random: &mut Random| [(); 2].map(|()| random.between(0.02, 0.98));
    let afar = |name, distance: f64| {
        Family::new(name, shapes(), draw, &mut move |random, number| {
            let axis = random.unit();
            let origin = f32s(axis * distance);
            (number % count, origin, (on_disc(random, DVec3::ZERO, axis, 1.0) - origin).normalize())
        })
    };
    // A line that touches, along a direction between those of u and v; moved off across the surface.
    let grazed = &mut |random: &mut Random, number: usize| {
        let number = number % 3;
        let [u, v] = inside(random);
        let [along_u, along_v] = along(&PATCHES[number], u, v);
        let side = if random.below(2) == 0 { 1.0 } else { -1.0 };
        let direction = (along_u + side * random.between(0.3, 2.0) * along_v).normalize();
        let target =
            at(&PATCHES[number], u, v) + along_u.cross(along_v).normalize() * nearly(random);
        let origin = f32s(target - 4.0 * direction);
        (number, origin, target - origin)
    };
    // Past an edge, and every fourth ray past a corner.
    let edges = &mut |random: &mut Random, number: usize| {
        let [u, v] = inside(random);
        let end = |random: &mut Random| random.below(2) as f64;
        let target = match random.below(4) {
            0 => at(&PATCHES[number % count], end(random), end(random)),
            1 | 2 => at(&PATCHES[number % count], u, end(random)),
            _ => at(&PATCHES[number % count], end(random), v),
        };
        let origin = f32s(random.unit() * 8.0);
        (number % count, origin, target + random.unit() * nearly(random) - origin)
    };
    // Along a line of the surface, or nearly.
    let lines = &mut |random: &mut Random, number: usize| {
        let number = number % 3;
        let [u, v] = inside(random);
        let patch = &PATCHES[number];
        let [along_u, along_v] = along(patch, u, v);
        let line = if random.below(2) == 0 { along_u } else { along_v };
        let origin = f32s(at(patch, u, v) - line.normalize() * random.between(2.0, 4.0));
        (number, origin, line + random.in_cube() * random.scale(1e-6, 1e-3))
    };
    let skinny = &mut |random: &mut Random, _| {
        let target = at(&STRIP, random.between(-0.1, 1.1), random.between(-0.2, 1.2));
        let origin = f32s(random.unit() * 8.0);
        (0, origin, target - origin)
    };
    vec![
        afar("patch from 10", 10.0),
        afar("patch from 1e4", 1e4),
        Family::new("patch nearly grazed", shapes(), draw, grazed),
        Family::new("patch at its edges", shapes(), draw, edges),
        Family::new("patch along its lines", shapes(), draw, lines),
        Family::new("patch of 1e-5", vec![Shape::Patch(STRIP)], draw, skinny),
    ]
}
