//! A ball of triangles.

use std::f32::consts::TAU;

use common::scene::Mesh;
use glam::Vec2;

use super::turned::turned;

/// Rows of a ball's cells from pole to pole; around it are twice as many.
pub const ROWS: u32 = 32;

/// A ball at height 0. Its vertices are on the sphere, and its triangles inside.
pub fn ball(radius: f32, material: usize) -> Mesh {
    let ring = |i: u32| {
        let (sin, cos) = (TAU * (i as f32 / ROWS as f32 - 0.5) / 2.0).sin_cos();
        (radius * Vec2::new(cos, 1.0 + sin), Vec2::new(cos, sin))
    };
    turned("ball", (0..=ROWS).map(ring), 2 * ROWS, material)
}
