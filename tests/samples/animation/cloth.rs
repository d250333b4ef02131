//! The flag's formula in 64 bits, to compare the compute shader with.

use std::f64::consts::TAU;

use common::scene::{Mesh, Vertex};
use glam::{Affine3A, DVec2, DVec3, Mat3A, Vec2, Vec3, Vec3A};

/// The foot of its pole.
pub const POLE: Vec3 = Vec3::new(5.7, -0.34, -5.2);
const SIZE: DVec2 = DVec2::new(4.2, 2.6);

/// The transform from the cloth's space to the world.
pub fn place() -> Affine3A {
    let translation = Vec3A::from(POLE + (6.4 - 0.25) * Vec3::Y);
    Affine3A { matrix3: Mat3A::from_rotation_y(2.9), translation }
}

/// The vertices of a cloth this many cells wide at a frame, row by row.
pub fn corners(frame: u32, across: u32) -> Vec<DVec3> {
    let down = (2 * across).div_ceil(3);
    let seconds = f64::from(frame) / 60.0;
    let open = (seconds / 4.0).min(1.0);
    let open = open * open * (3.0 - 2.0 * open);
    let gust = 0.8 + 0.25 * (1.3 * seconds).sin();
    let swing = 1.9 + (gust - 1.9) * open;
    let mut corners = Vec::new();
    for y in 0..=down {
        let v = f64::from(y) / f64::from(down);
        let mut at = DVec2::ZERO;
        for x in 0..=across {
            let u = f64::from(x) / f64::from(across);
            corners.push(DVec3::new(at.x, -SIZE.y * (v + 0.12 * u * u), at.y));
            let middle = (f64::from(x) + 0.5) / f64::from(across);
            let angle = swing * (TAU * (2.5 * middle - 0.9 * seconds + 0.3 * v)).sin();
            at += SIZE.x / f64::from(across) * DVec2::new(angle.cos(), angle.sin());
        }
    }
    corners
}

/// The three vertices of each triangle.
pub fn triangles(across: u32) -> Vec<[u32; 3]> {
    let down = (2 * across).div_ceil(3);
    let corner = |x, y| y * (across + 1) + x;
    let cells = (0..down).flat_map(|y| (0..across).map(move |x| (x, y)));
    let triangles = cells.flat_map(|(x, y)| {
        let [a, b, c, d] = [corner(x, y), corner(x, y + 1), corner(x + 1, y + 1), corner(x + 1, y)];
        [[a, b, c], [a, c, d]]
    });
    triangles.collect()
}

/// The cloth as a mesh.
pub fn mesh(frame: u32, across: u32) -> Mesh {
    let vertex = |at: DVec3| Vertex { position: at.as_vec3(), normal: Vec3::Z, uv: Vec2::ZERO };
    let vertices = corners(frame, across).into_iter().map(vertex).collect();
    Mesh { name: "flag".to_owned(), vertices, triangles: triangles(across), material: 0 }
}

#[test]
fn no_swing_stretches_a_row() {
    for frame in [0, 77, 240, 1300] {
        let corners = corners(frame, 48);
        for pair in corners.chunks(49).flat_map(|row| row.windows(2)) {
            let [a, b] = [pair[0], pair[1]].map(|at| DVec2::new(at.x, at.z));
            assert!((a.distance(b) - SIZE.x / 48.0).abs() < 1e-12, "{frame}");
        }
    }
}
