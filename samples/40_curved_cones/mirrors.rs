//! Surfaces that bend a cone: a ball that is a mirror, a hollow mirror, and a ball of glass, on the floor of tiles.

use std::f32::consts::{FRAC_PI_2, PI, TAU};

use anyhow::Result;
use common::scene::{Camera, Instance, Material, Mesh, Scene, Vertex};
use glam::{Affine3A, DVec3, Quat, Vec2, Vec3};

use crate::floor;

/// The numbers of illumination models in an MTL file: one that reflects, and one that is seen through.
const MIRROR: u32 = 3;
const GLASS: u32 = 6;

/// The three on the floor, in place of the chess set.
pub fn scene() -> Result<Scene> {
    let mut scene = floor::chess()?;
    let ground = scene.bounds().0.y;
    let model = &mut scene.model;
    scene.instances.retain(|instance| model.materials[instance.material].name == "floor");
    let first = model.meshes.len();
    // Silver, and glass that is bright whatever it weakens.
    let kinds = [("mirror", MIRROR, Vec3::new(0.97, 0.96, 0.92)), ("glass", GLASS, Vec3::ONE)];
    let materials = kinds.map(|(name, illumination, specular)| {
        let (name, base_color) = (name.to_owned(), Vec3::ZERO);
        model.materials.push(Material {
            name,
            base_color,
            specular,
            illumination,
            ..Material::default()
        });
        model.materials.len() - 1
    });
    model.meshes.extend([cap("ball", PI, 64, materials[0]), cap("dish", 0.42, 16, materials[0])]);
    let turned = Quat::from_rotation_x(-FRAC_PI_2 + 0.1);
    for (mesh, material, radius, turned, middle) in [
        (first, materials[0], 1.0, Quat::IDENTITY, Vec3::new(-2.2, ground + 1.0, 0.2)),
        (first + 1, materials[0], 3.0, turned, Vec3::new(0.0, ground + 1.15, 1.4)),
        (first, materials[1], 0.8, Quat::IDENTITY, Vec3::new(1.9, ground + 0.8, 1.2)),
    ] {
        let size = Vec3::splat(radius);
        let transform = Affine3A::from_scale_rotation_translation(size, turned, middle);
        scene.instances.push(Instance { mesh, transform, material, record_offset: 0 });
    }
    scene.camera = Camera::new(DVec3::new(0.3, 2.3, 8.6), DVec3::new(-0.1, 0.45, 0.0), 36.0);
    Ok(scene)
}

/// The part of the unit sphere whose directions make at most the angle `opening` with the y axis; the corners'
/// normals are the sphere's.
fn cap(name: &str, opening: f32, rows: u32, material: usize) -> Mesh {
    let sides = 2 * rows.max(32);
    let vertex = |i: u32| {
        let (sin, cos) = (opening * (i / sides) as f32 / rows as f32).sin_cos();
        let round = Vec2::from_angle(TAU * (i % sides) as f32 / sides as f32);
        let position = Vec3::new(sin * round.x, cos, sin * round.y);
        Vertex { position, normal: position, uv: Vec2::ZERO }
    };
    let cell = |i: u32| {
        let next = i / sides * sides + (i + 1) % sides;
        [[i, next, next + sides], [i, next + sides, i + sides]]
    };
    Mesh {
        name: name.to_owned(),
        vertices: (0..(rows + 1) * sides).map(vertex).collect(),
        triangles: (0..rows * sides).flat_map(cell).collect(),
        material,
    }
}
