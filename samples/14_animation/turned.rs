//! Surfaces of revolution: a table, and any other profile.

use std::f32::consts::TAU;

use common::scene::{Mesh, Vertex};
use glam::{Vec2, Vec3};

/// The height of the table, on which the board and everything next to it are placed.
pub const TABLE: f32 = -0.34;

/// A round table top, whose upper side is at height 0.
pub fn table(radius: f32, material: usize) -> Mesh {
    let rim = |angle: f32| {
        let (sin, cos) = angle.sin_cos();
        (Vec2::new(radius + 0.12 * cos, -0.12 + 0.12 * sin), Vec2::new(cos, sin))
    };
    let top = [(Vec2::ZERO, Vec2::Y), (Vec2::new(radius, 0.0), Vec2::Y)];
    let edge = (0..=8).map(|i| rim(TAU * (0.25 - 0.5 * i as f32 / 8.0)));
    turned("table", top.into_iter().chain(edge), 96, material)
}

/// Turns a profile about the y axis: pairs of radius and height, each with its normal. Where two neighbours are at
/// one place, the surface has an edge.
pub fn turned(
    name: &str,
    profile: impl Iterator<Item = (Vec2, Vec2)>,
    sides: u32,
    material: usize,
) -> Mesh {
    let mut vertices = Vec::new();
    for (at, normal) in profile {
        for side in 0..=sides {
            // The last is the first, to the bit: no gap is left between them.
            let (sin, cos) = (TAU * (side % sides) as f32 / sides as f32).sin_cos();
            let round = |flat: Vec2| Vec3::new(flat.x * cos, flat.y, flat.x * sin);
            let uv = Vec2::new(side as f32 / sides as f32, at.y);
            vertices.push(Vertex { position: round(at), normal: round(normal), uv });
        }
    }
    let (row, rows) = (sides + 1, vertices.len() as u32 / (sides + 1));
    let cells = (1..rows).flat_map(|ring| (0..sides).map(move |side| ring * row + side));
    let triangles = cells.flat_map(|above| {
        let [a, b, c, d] = [above - row, above - row + 1, above + 1, above];
        [[a, c, b], [a, d, c]]
    });
    let triangles = triangles.collect();
    Mesh { name: name.to_owned(), vertices, triangles, material }
}
