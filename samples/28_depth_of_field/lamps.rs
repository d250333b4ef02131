//! The scene of this chapter: the chess set in the evening, with strings of lamps before and behind it.

use std::f32::consts::{PI, TAU};

use anyhow::Result;
use common::scene::{Camera, Instance, Material, Mesh, Scene, Vertex};
use glam::{Affine3A, DVec3, Quat, Vec2, Vec3};

/// Where a string begins and ends, how far its middle hangs below, and how many lamps it has.
const STRINGS: [([f32; 3], [f32; 3], f32, u32); 4] = [
    ([-9.0, 4.2, -8.0], [1.0, 3.6, -9.5], 1.4, 19),
    ([0.0, 4.0, -9.0], [9.0, 4.4, -7.0], 1.5, 17),
    ([-8.0, 2.4, -7.0], [8.0, 2.2, -7.5], 1.2, 23),
    ([-1.0, 3.2, 3.4], [4.8, 2.6, 5.6], 0.8, 9),
];
/// The radius of a lamp.
const RADIUS: f32 = 0.07;
/// What lamps send out: one colour after the other.
const COLORS: [Vec3; 3] =
    [Vec3::new(34.0, 20.0, 7.0), Vec3::new(30.0, 12.0, 3.0), Vec3::new(26.0, 22.0, 15.0)];

/// The chess set before a dark wall, seen by White's king, with lamps.
///
/// # Errors
/// If the project's own model is missing or wrong.
pub fn chess() -> Result<Scene> {
    let mut scene = Scene::chess()?;
    let (lamps, wall) = (scene.model.materials.len(), scene.model.materials.len() + COLORS.len());
    let lamp = |color: &Vec3| Material {
        name: "lamp".to_owned(),
        base_color: Vec3::ZERO,
        emission: *color,
        ..Material::default()
    };
    scene.model.materials.extend(COLORS.iter().map(lamp));
    let dark = Vec3::new(0.012, 0.014, 0.022);
    let name = "wall".to_owned();
    scene.model.materials.push(Material { name, base_color: dark, ..Material::default() });

    let ball = scene.model.meshes.len();
    scene.model.meshes.extend([globe(16), square()]);
    for (from, to, sag, count) in STRINGS {
        for i in 0..count {
            let part = (i as f32 + 0.5) / count as f32;
            let hanging = Vec3::NEG_Y * sag * 4.0 * part * (1.0 - part);
            let at = Vec3::from(from).lerp(to.into(), part) + hanging;
            let transform =
                Affine3A::from_scale_rotation_translation(Vec3::splat(RADIUS), Quat::IDENTITY, at);
            let material = lamps + i as usize % COLORS.len();
            scene.instances.push(Instance { mesh: ball, transform, material, record_offset: 0 });
        }
    }
    let transform = Affine3A::from_scale_rotation_translation(
        Vec3::splat(120.0),
        Quat::IDENTITY,
        Vec3::new(0.0, 0.0, -14.0),
    );
    scene.instances.push(Instance { mesh: ball + 1, transform, material: wall, record_offset: 0 });
    scene.camera = Camera::new(DVec3::new(2.7, 1.5, 7.2), DVec3::new(-0.5, 0.7, 0.8), 30.0);
    Ok(scene)
}

/// A ball of radius 1: rings of squares, and what is left of them at the poles.
fn globe(rings: u32) -> Mesh {
    let around = 2 * rings;
    let vertex = |i: u32| {
        let (ring, step) = (i / around, i % around);
        let (height, turn) = (PI * ring as f32 / rings as f32, TAU * step as f32 / around as f32);
        let position =
            Vec3::new(height.sin() * turn.sin(), height.cos(), height.sin() * turn.cos());
        Vertex { position, normal: position, uv: Vec2::ZERO }
    };
    let square = |i: u32| {
        let next = i - i % around + (i + 1) % around;
        [[i, i + around, next], [next, i + around, next + around]]
    };
    Mesh {
        name: "lamp".to_owned(),
        vertices: (0..(rings + 1) * around).map(vertex).collect(),
        triangles: (0..rings * around).flat_map(square).collect(),
        material: 0,
    }
}

/// A unit square around the origin, which faces +z.
fn square() -> Mesh {
    let corners = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)];
    let vertex =
        |(x, y)| Vertex { position: Vec3::new(x, y, 0.0), normal: Vec3::Z, uv: Vec2::ZERO };
    let triangles = vec![[0, 1, 2], [0, 2, 3]];
    Mesh { name: "wall".to_owned(), vertices: corners.map(vertex).into(), triangles, material: 0 }
}
