//! Boxes, planes and triangles.

use glam::{DVec3, Vec3};
use reference::random::{Random, f32s};

use super::{Draw, Family, on_disc};
use crate::shape::Shape;

pub fn boxes(draw: Draw) -> Vec<Family> {
    let unit = || vec![Shape::Box { low: Vec3::NEG_ONE, high: Vec3::ONE }];
    let afar = |name, distance| {
        Family::new(name, unit(), draw, &mut move |random, _| {
            let axis = random.unit();
            let origin = f32s(axis * distance);
            (0, origin, (on_disc(random, DVec3::ZERO, axis, 1.6) - origin).normalize())
        })
    };
    // Along a wall, exactly in its plane: the box is closed, so all of these are hits.
    let wall = &mut |random: &mut Random, number: usize| {
        let (a, b, c) = (number % 3, (number + 1) % 3, (number + 2) % 3);
        let mut origin = DVec3::ZERO;
        origin[a] = if number.is_multiple_of(2) { 1.0 } else { -1.0 };
        origin[b] = 10.0;
        origin[c] = random.between(-0.9, 0.9);
        let mut target = origin;
        target[b] = 0.0;
        target[c] = random.between(-0.9, 0.9);
        (0, f32s(origin), f32s(target) - f32s(origin))
    };
    let inside = &mut |random: &mut Random, _| (0, f32s(random.in_cube() * 0.99), random.unit());
    vec![
        afar("box from 10", 10.0),
        Family::new("box along a wall", unit(), draw, wall),
        afar("box from 1e4", 1e4),
        Family::new("box from inside", unit(), draw, inside),
    ]
}

pub fn planes(draw: Draw) -> Vec<Family> {
    const PLANES: usize = 16;
    // Sixteen planes of any normal, the camera at some height above a point near the foot of each.
    let family = |name, distance: f64, sine: fn(&mut Random) -> f64| {
        let mut random = draw.random(7);
        let normals: Vec<DVec3> =
            (0..PLANES).map(|_| f32s(random.unit() * random.scale(0.1, 10.0))).collect();
        let plane = |n: &DVec3| Shape::Plane { normal: n.as_vec3(), distance: distance as f32 };
        Family::new(name, normals.iter().map(plane).collect(), draw, &mut |random, number| {
            let shape = number % PLANES;
            let n = normals[shape].normalize();
            let height = random.between(0.5, 2.0);
            let origin = f32s(n * (distance + height) + 3.0 * n.any_orthonormal_vector());
            let sine = sine(random);
            let along = on_disc(random, DVec3::ZERO, n, 1.0).normalize();
            (shape, origin, along * (1.0 - sine * sine).sqrt() - n * sine)
        })
    };
    vec![
        family("plane from 1 above", 1.0, |random| random.between(0.05, 1.0)),
        family("plane at 1e6", 1e6, |random| random.between(0.05, 1.0)),
        family("plane grazed at 1e-3", 1.0, |random| random.between(0.5e-3, 2e-3)),
        family("plane grazed at 1e-6", 1.0, |random| random.between(0.5e-6, 2e-6)),
    ]
}

/// A bumpy ball of `2·n²` triangles, closed: every ray through its middle hits it.
fn ball(n: usize) -> Vec<[Vec3; 3]> {
    let at = |i: usize, j: usize| {
        let (u, v) = (i as f64 / n as f64, (j % n) as f64 / n as f64);
        let (polar, around) = (u * std::f64::consts::PI, v * std::f64::consts::TAU);
        // The poles are one point each.
        let around = if i == 0 || i == n { 0.0 } else { around };
        let radius = 1.0 + 0.1 * (5.0 * polar).sin() * (3.0 * around).cos();
        let y = if i == n { -1.0 } else { polar.cos() };
        let side = if i == n { 0.0 } else { polar.sin() };
        (DVec3::new(side * around.cos(), y, side * around.sin()) * radius).as_vec3()
    };
    let cells = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
    let quad = |(i, j)| {
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        let both = [[a, b, c], [a, c, d]];
        both.into_iter().filter(|[a, b, c]| a != b && b != c && c != a)
    };
    cells.flat_map(quad).collect()
}

pub fn triangles(draw: Draw) -> Vec<Family> {
    let mesh = ball(16);
    let shapes = || vec![Shape::Triangles(mesh.clone())];
    // Aimed at a point of a triangle: inside it, on an edge, or at a corner.
    let aimed = |name, weights: fn(&mut Random) -> [f64; 3]| {
        Family::new(name, shapes(), draw, &mut |random, _| {
            let triangle = mesh[random.below(mesh.len())];
            let w = weights(random);
            let target: DVec3 = (0..3).map(|k| triangle[k].as_dvec3() * w[k]).sum();
            let axis = (target.normalize() + 0.5 * random.unit()).normalize();
            let origin = f32s(target + axis * 5.0);
            (0, origin, f32s(target) - origin)
        })
    };
    vec![
        aimed("triangles inside", |random| {
            let (a, b) = (random.between(0.05, 0.5), random.between(0.05, 0.4));
            [1.0 - a - b, a, b]
        }),
        aimed("triangles at edges", |random| {
            let a = random.between(0.0, 1.0);
            [1.0 - a, a, 0.0]
        }),
        aimed("triangles at corners", |_| [1.0, 0.0, 0.0]),
        far_ball(draw),
        far_plane(draw),
    ]
}

/// A ball of radius 2 far from the origin, seen from close by: none of the rays at it may pass through.
/// The place is that of Embree's WatertightTest (`verify.cpp`).
fn far_ball(draw: Draw) -> Family {
    let center = DVec3::new(148_376.0, 1234.0, -223_423.0);
    let moved = |v: Vec3| (v.as_dvec3() * 2.0 + center).as_vec3();
    let mesh: Vec<_> = ball(16).into_iter().map(|triangle| triangle.map(moved)).collect();
    Family::new("triangles far away", vec![Shape::Triangles(mesh)], draw, &mut |random, _| {
        let origin = f32s(center + random.unit() * 6.0);
        (0, origin, f32s(center + random.in_cube()) - origin)
    })
}

/// A plane of triangles as far away, seen from 3 in front of its middle at a slant: after the other half of
/// Embree's WatertightTest.
fn far_plane(draw: Draw) -> Family {
    const CELLS: usize = 16;
    const AT: f64 = 148_376.0;
    let corner = |i: usize, j: usize| {
        let along = |i: usize| 12.0 * i as f64 / CELLS as f64 - 6.0;
        // Not quite flat, because otherwise no plane could separate the edges.
        let bump = ((5 * i + 3 * j) % 7) as f64 / 64.0;
        DVec3::new(AT + bump, along(i), along(j)).as_vec3()
    };
    let quad = |cell: usize| {
        let (i, j) = (cell / CELLS, cell % CELLS);
        let [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
        [[a, b, c], [a, c, d]]
    };
    let mesh: Vec<_> = (0..CELLS * CELLS).flat_map(quad).collect();
    // Its border is the end of the plane: beyond, a miss is right.
    let is_inside = |triangle: &&[Vec3; 3]| {
        triangle.iter().all(|corner| corner.y.abs().max(corner.z.abs()) < 6.0)
    };
    let inner: Vec<[Vec3; 3]> = mesh.iter().filter(is_inside).copied().collect();
    Family::new(
        "triangles of a far plane",
        vec![Shape::Triangles(mesh)],
        draw,
        &mut |random, number| {
            // At an edge or a corner, as well as rounding allows.
            let triangle = inner[random.below(inner.len())];
            let share = if number % 2 == 0 { random.between(0.0, 1.0) } else { 0.0 };
            let target = triangle[0].as_dvec3().lerp(triangle[1].as_dvec3(), share);
            let origin = DVec3::new(AT - 3.0, 0.0, 0.0);
            (0, origin, f32s(target) - origin)
        },
    )
}
