//! The pole of the flag.

use std::f32::consts::TAU;

use common::scene::Mesh;
use glam::Vec2;

use super::turned::turned;

/// A pole at height 0, with a ball on it.
pub fn pole(height: f32, material: usize) -> Mesh {
    let ball = |angle: f32| {
        let (sin, cos) = angle.sin_cos();
        (Vec2::new(0.15 * cos, height + 0.1 + 0.15 * sin), Vec2::new(cos, sin))
    };
    let foot = [(0.5, 0.0), (0.5, 0.08), (0.07, 0.2)];
    let foot = foot.windows(2).flat_map(|ends| {
        let [a, b] = [ends[0], ends[1]].map(Vec2::from);
        let normal = (b - a).perp().normalize() * -1.0;
        [(a, normal), (b, normal)]
    });
    let foot: Vec<_> = foot.collect();
    let shaft = [0.2, height].map(|y| (Vec2::new(0.06, y), Vec2::X));
    let ball = (0..=12).map(|i| ball(TAU * (-0.25 + 0.5 * i as f32 / 12.0)));
    turned("pole", foot.into_iter().chain(shaft).chain(ball), 32, material)
}
