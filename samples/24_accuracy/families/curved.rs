//! Cylinders, cones and quadrics: rays from everywhere, and rays that nearly touch, miss or run along them.

use std::f64::consts::TAU;

use glam::{DVec3, Vec3};
use reference::random::{Random, f32s};

use super::{Draw, Family, on_disc};
use crate::shape::{Cone, Shape};

/// Off by up to a millionth to either side, most often by far less.
pub fn nearly(random: &mut Random) -> f64 {
    let side = if random.below(2) == 0 { 1.0 } else { -1.0 };
    side * random.scale(1e-9, 1e-6)
}

/// The same cone closed, and open.
fn both(a: Vec3, b: Vec3, radii: [f32; 2]) -> Vec<Shape> {
    [true, false].map(|is_closed| Shape::Cone(Cone { a, b, radii, is_closed })).to_vec()
}

/// From a point of a cone, by its height from 0 to 1 and its angle, scaled away from the axis.
fn point(axis: [Vec3; 2], radii: [f64; 2], height: f64, angle: f64, out: f64) -> DVec3 {
    let [a, b] = axis.map(Vec3::as_dvec3);
    let along = (b - a).normalize();
    let u = along.any_orthonormal_vector();
    let v = along.cross(u);
    let radius = radii[0] + (radii[1] - radii[0]) * height;
    a + (b - a) * height + out * radius * (angle.cos() * u + angle.sin() * v)
}

/// A leaning axis, of no simple length.
const LEANING: [Vec3; 2] = [Vec3::new(-0.75, -0.5, 0.125), Vec3::new(0.75, 0.625, -0.25)];

pub fn cones(draw: Draw) -> Vec<Family> {
    let [a, b] = LEANING;
    let afar = |name, radii: [f32; 2], distance: f64| {
        Family::new(name, both(a, b, radii), draw, &mut move |random, number| {
            let axis = random.unit();
            let origin = f32s(axis * distance);
            let target = on_disc(random, DVec3::ZERO, axis, 1.4);
            (number % 2, origin, (target - origin).normalize())
        })
    };
    // Across the axis at a distance of nearly a radius, so that the line nearly touches the side.
    let grazed = &mut |random: &mut Random, number: usize| {
        let (height, angle) = (random.between(0.0, 1.0), random.between(0.0, TAU));
        let target = point(LEANING, [0.5; 2], height, angle, 1.0 + nearly(random));
        let middle = point(LEANING, [0.5; 2], height, angle, 0.0);
        let along = (b - a).as_dvec3().normalize();
        let across = (target - middle).cross(along).normalize();
        let direction = across + along * random.between(-2.0, 2.0);
        let origin = f32s(target - 8.0 * direction.normalize());
        (number % 2, origin, target - origin)
    };
    let rims = &mut |random: &mut Random, number: usize| {
        let end = random.below(2) as f64;
        let angle = random.between(0.0, TAU);
        let target = point(LEANING, [0.5; 2], end, angle, 1.0 + nearly(random));
        let origin = f32s(random.unit() * 8.0);
        (number % 2, origin, target - origin)
    };
    let thin = &mut |random: &mut Random, number: usize| {
        let height = random.between(0.0, 1.0);
        let target =
            point(LEANING, [1.1e-6; 2], height, random.between(0.0, TAU), random.between(0.0, 1.0));
        let origin = f32s(random.unit() * 8.0);
        (number % 2, origin, target - origin)
    };
    let inside = &mut |random: &mut Random, number: usize| {
        let mut within = |out| {
            let (height, angle) = (random.between(0.0, 1.0), random.between(0.0, TAU));
            point(LEANING, [0.5; 2], height, angle, out)
        };
        let (origin, target) = (within(0.9), within(0.5));
        (number % 2, f32s(origin), target - origin)
    };
    // Parallel to a line of the side, or nearly.
    let lines = &mut |random: &mut Random, number: usize| {
        let angle = random.between(0.0, TAU);
        let [start, end] =
            [0.0, 1.0].map(|height| point(LEANING, [0.5, 0.125], height, angle, 1.0));
        let origin =
            point(LEANING, [0.5; 2], -2.0, random.between(0.0, TAU), random.between(0.0, 1.5));
        let direction = (end - start).normalize() + random.in_cube() * nearly(random);
        (number % 2, f32s(origin), direction)
    };
    let apex = &mut |random: &mut Random, number: usize| {
        let target = b.as_dvec3() + random.unit() * nearly(random);
        let origin = f32s(random.unit() * 8.0);
        (number % 2, origin, target - origin)
    };
    vec![
        afar("cylinder from 10", [0.5; 2], 10.0),
        afar("cylinder from 1e4", [0.5; 2], 1e4),
        Family::new("cylinder nearly grazed", both(a, b, [0.5; 2]), draw, grazed),
        Family::new("cylinder at its rims", both(a, b, [0.5; 2]), draw, rims),
        Family::new("cylinder of 1e-6", both(a, b, [1e-6; 2]), draw, thin),
        Family::new("cylinder from inside", both(a, b, [0.5; 2]), draw, inside),
        afar("cone from 10", [0.5, 0.125], 10.0),
        Family::new("cone along its side", both(a, b, [0.5, 0.125]), draw, lines),
        Family::new("cone at its apex", both(a, b, [0.5, 0.0]), draw, apex),
    ]
}

/// An ellipsoid, a hyperboloid of one sheet, one of two, a cone and a paraboloid; each turned, by mixed products.
const QUADRICS: [[f32; 10]; 5] = [
    [1.5, 2.0, 4.0, 0.25, -0.5, 0.75, 0.125, 0.0, -0.25, -1.0],
    [4.0, -1.0, 3.0, 0.0, 0.5, 1.0, 0.0, 0.25, 0.0, -0.5],
    [-4.0, 2.0, -3.0, 0.25, 0.0, 1.0, 0.0, 0.25, 0.0, -0.25],
    [3.0, -1.5, 2.0, 0.5, 0.25, 0.0, 0.0, 0.0, 0.0, 0.0],
    [1.0, 0.25, 2.0, 0.0, 0.0, 1.0, 0.25, -1.0, 0.0, -0.25],
];

fn gradient(q: &[f32; 10], p: DVec3) -> DVec3 {
    let [a, b, c, d, e, f, g, h, i, _] = q.map(f64::from);
    let x = 2.0 * a * p.x + f * p.y + e * p.z + g;
    let y = 2.0 * b * p.y + f * p.x + d * p.z + h;
    let z = 2.0 * c * p.z + e * p.x + d * p.y + i;
    DVec3::new(x, y, z)
}

/// The polynomial's values along a line: its coefficients.
fn along(q: &[f32; 10], o: DVec3, d: DVec3) -> [f64; 3] {
    let linear = gradient(q, DVec3::ZERO);
    let half = |p: DVec3| (gradient(q, p) - linear).dot(p) / 2.0;
    [half(d), gradient(q, o).dot(d), half(o) + linear.dot(o) + f64::from(q[9])]
}

pub fn quadrics(draw: Draw) -> Vec<Family> {
    let shapes = || QUADRICS.map(Shape::Quadric).to_vec();
    let count = QUADRICS.len();
    let afar = |name, distance: f64| {
        Family::new(name, shapes(), draw, &mut move |random, number| {
            let axis = random.unit();
            let origin = f32s(axis * distance);
            (number % count, origin, (on_disc(random, DVec3::ZERO, axis, 1.2) - origin).normalize())
        })
    };
    // A line that touches: from outside to a point of the surface, along a direction across the gradient.
    let grazed = &mut |random: &mut Random, number: usize| {
        let q = &QUADRICS[number % count];
        loop {
            let (o, d) = (random.unit() * 2.0, random.unit());
            let [a, b, c] = along(q, o, d);
            let discriminant = b * b - 4.0 * a * c;
            if discriminant < 0.0 || a.abs() < 0.1 {
                continue;
            }
            let p = o + d * ((-b - discriminant.sqrt()) / (2.0 * a));
            let normal = gradient(q, p);
            if p.length() > 4.0 || normal.length() < 0.1 {
                continue;
            }
            let tangent = normal.cross(random.unit()).normalize();
            let origin = f32s(p - 8.0 * tangent);
            return (number % count, origin, p + normal.normalize() * nearly(random) - origin);
        }
    };
    // A direction in which the polynomial has no square, or nearly.
    let asymptotes = &mut |random: &mut Random, number: usize| {
        let q = &QUADRICS[1 + number % (count - 1)];
        let origin = f32s(random.unit() * random.between(0.5, 6.0));
        if q == &QUADRICS[4] {
            // A paraboloid has its axis alone.
            let off = random.in_cube() * nearly(random);
            return (4, origin, DVec3::new(0.5, -1.0, 0.0) + off);
        }
        loop {
            let (u, v) = (random.unit(), random.unit());
            let linear = gradient(q, DVec3::ZERO);
            let form = |p: DVec3, w: DVec3| (gradient(q, p) - linear).dot(w) / 2.0;
            let (a, b, c) = (form(v, v), 2.0 * form(u, v), form(u, u));
            let discriminant = b * b - 4.0 * a * c;
            if discriminant < 0.0 || a.abs() < 0.1 {
                continue;
            }
            let direction = u + v * ((-b - discriminant.sqrt()) / (2.0 * a));
            return (1 + number % (count - 1), origin, direction.normalize());
        }
    };
    let apex = &mut |random: &mut Random, _| {
        let origin = f32s(random.unit() * 8.0);
        (3, origin, random.unit() * nearly(random) - origin)
    };
    vec![
        afar("quadric from 10", 10.0),
        afar("quadric from 1e4", 1e4),
        Family::new("quadric nearly grazed", shapes(), draw, grazed),
        Family::new("quadric along an asymptote", shapes(), draw, asymptotes),
        Family::new("quadric near its apex", shapes(), draw, apex),
    ]
}
