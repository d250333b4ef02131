//! The scene of this chapter: the chess set in the evening, with garlands of lamps before and behind it.

use std::f32::consts::{PI, TAU};

use anyhow::Result;
use common::scene::{Camera, Instance, Material, Mesh, Scene, Vertex};
use glam::{Affine3A, DVec3, Quat, Vec2, Vec3};

/// Lamps on a string.
struct Garland {
    from: [f32; 3],
    to: [f32; 3],
    /// Drop of the middle below the ends.
    sag: f32,
    lamps: u32,
    /// The radius of a lamp.
    radius: f32,
}

const GARLANDS: [Garland; 3] = [
    Garland { from: [-10.5, 2.9, 5.2], to: [1.8, 3.6, -8.3], sag: 1.1, lamps: 13, radius: 0.09 },
    Garland { from: [-18.5, 1.5, 2.3], to: [-1.5, 2.6, -16.5], sag: 1.5, lamps: 14, radius: 0.14 },
    Garland { from: [0.4, 2.1, 6.4], to: [4.8, 2.12, 2.0], sag: 0.15, lamps: 8, radius: 0.022 },
];
/// Colours of the lamps, one after the other.
const COLORS: [Vec3; 3] =
    [Vec3::new(12.0, 7.0, 2.6), Vec3::new(11.0, 4.2, 1.0), Vec3::new(10.0, 8.4, 6.0)];

/// The chess set in a dark dome, without the screen, with lamps around it; White's king is looked at.
///
/// # Errors
/// If the project's own model is missing or wrong.
pub fn chess() -> Result<Scene> {
    let mut scene = Scene::chess()?;
    let meshes = &scene.model.meshes;
    scene.instances.retain(|instance| !meshes[instance.mesh].name.starts_with("screen"));
    let (first, night) = (scene.model.materials.len(), scene.model.materials.len() + COLORS.len());
    let lamp = |color: &Vec3| Material {
        name: "lamp".to_owned(),
        base_color: Vec3::ZERO,
        emission: *color,
        ..Material::default()
    };
    scene.model.materials.extend(COLORS.iter().map(lamp));
    let dark = Vec3::new(0.03, 0.034, 0.06);
    let name = "night".to_owned();
    scene.model.materials.push(Material { name, base_color: dark, ..Material::default() });

    let ball = scene.model.meshes.len();
    scene.model.meshes.push(globe(16));
    for Garland { from, to, sag, lamps, radius } in GARLANDS {
        for i in 0..lamps {
            let part = (i as f32 + 0.5) / lamps as f32;
            let hanging = Vec3::NEG_Y * sag * 4.0 * part * (1.0 - part);
            let at = Vec3::from(from).lerp(to.into(), part) + hanging;
            let transform =
                Affine3A::from_scale_rotation_translation(Vec3::splat(radius), Quat::IDENTITY, at);
            let material = first + i as usize % COLORS.len();
            scene.instances.push(Instance { mesh: ball, transform, material, record_offset: 0 });
        }
    }
    let transform = Affine3A::from_scale(Vec3::splat(40.0));
    scene.instances.push(Instance { mesh: ball, transform, material: night, record_offset: 0 });
    scene.camera = Camera::new(DVec3::new(5.5, 1.75, 6.8), DVec3::new(1.1, 0.95, 2.8), 29.0);
    Ok(scene)
}

/// A ball of radius 1: rings of squares, each two triangles, and one of them at the poles.
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
        let upper = (i >= around).then_some([i, i + around, next]);
        let lower = (i + around < rings * around).then_some([next, i + around, next + around]);
        upper.into_iter().chain(lower)
    };
    Mesh {
        name: "lamp".to_owned(),
        vertices: (0..(rings + 1) * around).map(vertex).collect(),
        triangles: (0..rings * around).flat_map(square).collect(),
        material: 0,
    }
}
