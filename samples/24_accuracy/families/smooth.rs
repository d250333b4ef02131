//! Spheres, capsules, ellipsoids and heightfields.

use std::f64::consts::TAU;

use glam::{DMat3, DVec3, Vec3};
use reference::random::{Random, f32s};

use super::{Draw, Family, from_afar, on_disc};
use crate::shape::{Heightfield, Shape, parts};

pub fn spheres(draw: Draw) -> Vec<Family> {
    let unit = || vec![Shape::Sphere { center: Vec3::ZERO, radius: 1.0 }];
    let afar = |name, distance| {
        Family::new(name, unit(), draw, &mut move |random, _| {
            let (origin, direction) = from_afar(random, distance);
            (0, origin, direction)
        })
    };
    let tangent = &mut |random: &mut Random, number: usize| {
        let axis = random.unit();
        let impact = if number.is_multiple_of(2) { 1.0 - 1e-6 } else { 1.0 + 1e-6 };
        let side = axis.any_orthonormal_vector() * impact;
        let origin = f32s(axis * 10.0 + side);
        (0, origin, -axis)
    };
    let tiny = &mut |random: &mut Random, _| {
        let axis = random.unit();
        let origin = f32s(axis * 1e4);
        (0, origin, (on_disc(random, DVec3::ZERO, axis, 1.1e-4) - origin).normalize())
    };
    let planet = &mut |random: &mut Random, _| {
        let down = random.between(1f64.to_radians(), 90f64.to_radians());
        let around = random.between(0.0, TAU);
        let (out, y) = (down.cos(), -down.sin());
        (0, DVec3::Y, DVec3::new(out * around.cos(), y, out * around.sin()))
    };
    let inside = &mut |random: &mut Random, _| {
        (0, f32s(random.unit() * random.between(0.0, 0.99)), random.unit())
    };
    let small = vec![Shape::Sphere { center: Vec3::ZERO, radius: 1e-4 }];
    let world = vec![Shape::Sphere { center: Vec3::new(0.0, -1e6, 0.0), radius: 1e6 }];
    vec![
        afar("sphere from 10 radii", 10.0),
        afar("sphere from 1e3 radii", 1e3),
        afar("sphere from 1e6 radii", 1e6),
        Family::new("sphere nearly grazed", unit(), draw, tangent),
        Family::new("sphere of 1e-4 from 1e4", small, draw, tiny),
        Family::new("planet of 1e6 from 1 above", world, draw, planet),
        Family::new("sphere from inside", unit(), draw, inside),
    ]
}

pub fn capsules(draw: Draw) -> Vec<Family> {
    let (a, b) = (Vec3::NEG_X, Vec3::X);
    let afar = |name, distance| {
        let shapes = vec![Shape::Capsule { a, b, radius: 0.5 }];
        Family::new(name, shapes, draw, &mut move |random, _| {
            let axis = random.unit();
            let origin = f32s(axis * distance);
            (0, origin, (on_disc(random, DVec3::ZERO, axis, 1.6) - origin).normalize())
        })
    };
    vec![afar("capsule from 10", 10.0), afar("capsule from 1e4", 1e4)]
}

pub fn instances(draw: Draw) -> Vec<Family> {
    const MATRICES: usize = 16;
    // Turned, sheared, mirrored half of the time, stretched by `stretch`, moved by `shift`.
    let family = |name, stretch: f64, shift: f64| {
        let mut random = draw.random(11);
        let matrix = |_| {
            let size =
                DVec3::new(1.0, random.scale(1.0 / stretch, 1.0), random.scale(1.0 / stretch, 1.0));
            let mirror = if random.below(2) == 0 { 1.0 } else { -1.0 };
            let mut linear = DMat3::from_axis_angle(random.unit(), random.between(0.0, 6.0))
                * DMat3::from_diagonal(size * DVec3::new(mirror, 1.0, 1.0));
            linear.y_axis += linear.x_axis * 0.3 / stretch;
            let shift = random.unit() * shift;
            let row = |i: usize| {
                [0, 1, 2, 3].map(|k| (if k < 3 { linear.col(k)[i] } else { shift[i] }) as f32)
            };
            [row(0), row(1), row(2)]
        };
        let matrices: Vec<_> = (0..MATRICES).map(matrix).collect();
        let shapes = matrices.iter().map(|rows| Shape::Instance(*rows)).collect();
        Family::new(name, shapes, draw, &mut |random, number| {
            let shape = number % MATRICES;
            let (linear, translation) = parts(&matrices[shape]);
            let target = translation + linear * random.in_cube() * 0.6;
            let origin = f32s(translation + random.unit() * 8.0);
            (shape, origin, (target - origin).normalize())
        })
    };
    vec![
        family("instance sheared", 4.0, 3.0),
        family("instance 1:1000", 1e3, 3.0),
        family("instance at 1e6", 4.0, 1e6),
    ]
}

pub fn heightfields(draw: Draw) -> Vec<Family> {
    let field = |k: f32, lipschitz: f32| {
        let (f, g) = ([0.11, 0.08], [0.3, 0.2]);
        vec![Shape::Heightfield(Heightfield { k, a: 0.6, f, b: 0.25, g, lipschitz })]
    };
    let family = |name, shapes, degrees: f64, height: f64| {
        Family::new(name, shapes, draw, &mut move |random, _| {
            let around = random.between(0.0, TAU);
            let down = degrees.to_radians();
            let origin = DVec3::new(random.between(-9.0, 9.0), height, random.between(-9.0, 9.0));
            let (out, y) = (down.cos(), -down.sin());
            (0, f32s(origin), DVec3::new(out * around.cos(), y, out * around.sin()))
        })
    };
    vec![
        family("hills at 60°", field(1.0, 1.373_695_8), 60.0, 2.5),
        family("hills at 5°", field(1.0, 1.373_695_8), 5.0, 1.4),
        family("hills at 1°", field(1.0, 1.373_695_8), 1.0, 1.2),
        family("steep ground at 20°", field(8.0, 10.989_566), 20.0, 8.0),
        family("flat ground at 0.2°", field(0.0, 0.0), 0.2, 1.0),
    ]
}
