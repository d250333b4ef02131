//! The scenes of this chapter: a row of royals to look at, and spheres whose light is known.

use std::f32::consts::PI;

use anyhow::{Context, Result};
use common::model::Model;
use common::scene::{
    Camera, Instance, Material, Mesh, Microfacet, Scene, Sun, Vertex, place_position,
};
use glam::{Affine3A, DVec3, Vec2, Vec3};

common::shader_enum! {
    /// The names of the scenes.
    pub enum SceneName {
        /// Kings and queens of gold and silver on a polished board.
        Chess,
        /// Five white spheres of metal, from smooth to rough, under one light.
        Spheres,
        /// The same under a white sky.
        Furnace,
        /// White insulators under a white sky.
        InsulatorFurnace,
    }
    /// The light of a ray that hits nothing.
    pub enum Sky: SKY { Day, White, Black }
}

/// A scene with its camera and its lights.
pub struct Staged {
    /// The placed meshes, and the view.
    pub scene: Scene,
    /// The sun.
    pub sun: Sun,
    /// The sky.
    pub sky: Sky,
}

/// The royals are in the fifth row.
const POSITION: &str = "8/8/1p1n1p2/8/1KqKqK2/8/8/8";

/// The roughness of each royal, from left to right.
const ROYALS: [f32; 5] = [0.05, 0.15, 0.3, 0.5, 0.8];

/// The roughness of the spheres, from left to right.
const ROUGHNESSES: [f32; 5] = [0.1, 0.325, 0.55, 0.775, 1.0];

/// A row of kings and queens of metal, each rougher than the one before, and what they can mirror.
pub fn chess() -> Result<Scene> {
    let mut scene = Scene::chess()?;
    let meshes = &scene.model.meshes;
    scene.instances.retain(|instance| meshes[instance.mesh].name.starts_with("board"));
    place_position(&scene.model, POSITION, &mut scene.instances)?;
    let Model { meshes, materials, .. } = &mut scene.model;
    // Reflectances as in `Scene::chess_of_metal`.
    let (gold, silver) = (Vec3::new(1.0, 0.782, 0.344), Vec3::new(0.972, 0.96, 0.915));
    let mut roughnesses = ROYALS.into_iter();
    for instance in &mut scene.instances {
        if matches!(meshes[instance.mesh].name.as_str(), "king" | "queen") {
            let roughness = roughnesses.next().context("more royals than roughnesses")?;
            let is_white = materials[instance.material].name == "white";
            let (name, color) = if is_white { ("gold", gold) } else { ("silver", silver) };
            instance.material = materials.len();
            materials.push(microfacets(name, color, roughness, 1.0));
        }
    }
    for material in materials.iter_mut().filter(|material| material.microfacet.is_none()) {
        let (color, roughness) = match material.name.as_str() {
            "black" => (Vec3::new(0.02, 0.13, 0.08), 0.3),
            _ => (material.base_color, 0.18),
        };
        *material = microfacets(&material.name, color, roughness, 0.0);
    }
    scene.camera = Camera::new(DVec3::new(-2.1, 1.75, 6.5), DVec3::new(-0.5, 0.68, 0.0), 31.5);
    Ok(scene)
}

impl Staged {
    /// The scene of a name; `source` is that of chess.
    pub fn new(name: SceneName, source: &Scene) -> Self {
        let (metallic, sky) = match name {
            SceneName::Chess => {
                let radiance = Vec3::new(4.4, 3.5, 2.4);
                let sun = Sun { azimuth: 300.0, elevation: 35.0, radiance };
                return Self { scene: source.clone(), sun, sky: Sky::Day };
            }
            SceneName::Spheres => (1.0, Sky::Black),
            SceneName::Furnace => (1.0, Sky::White),
            SceneName::InsulatorFurnace => (0.0, Sky::White),
        };
        // The direction (0.5, 0.7, 0.5), in degrees around and above the horizon.
        let elevation = (0.7 / 0.5f32.hypot(0.5)).atan().to_degrees();
        let radiance = if sky == Sky::Black { Vec3::ONE } else { Vec3::ZERO };
        let sun = Sun { azimuth: 45.0, elevation, radiance };
        Self { scene: spheres(metallic), sun, sky }
    }
}

/// A material of microfacets.
pub fn microfacets(name: &str, color: Vec3, roughness: f32, metallic: f32) -> Material {
    let microfacet =
        Microfacet { color, roughness, metallic, roughness_texture: None, metallic_texture: None };
    Material { name: name.to_owned(), microfacet: Some(microfacet), ..Material::default() }
}

/// Five spheres of radius 1 side by side.
pub fn spheres(metallic: f32) -> Scene {
    let materials = ROUGHNESSES.map(|roughness| {
        microfacets(&format!("roughness {roughness}"), Vec3::ONE, roughness, metallic)
    });
    let instance = |i: usize| Instance {
        mesh: 0,
        transform: Affine3A::from_translation(Vec3::new(2.2 * (i as f32 - 2.0), 0.0, 0.0)),
        material: i,
        record_offset: 0,
    };
    Scene {
        model: Model {
            meshes: vec![sphere(128, 64)],
            materials: materials.into(),
            ..Model::default()
        },
        instances: (0..5).map(instance).collect(),
        camera: Camera::new(DVec3::new(0.0, 0.0, 14.0), DVec3::ZERO, 20.0),
    }
}

/// The unit sphere, of so many segments around and from pole to pole.
fn sphere(around: u32, down: u32) -> Mesh {
    let vertex = |i: u32| {
        let (column, row) = (i % (around + 1), i / (around + 1));
        let uv = Vec2::new(column as f32 / around as f32, row as f32 / down as f32);
        let (sine, cosine) = (2.0 * PI * uv.x).sin_cos();
        let (radius, height) = (PI * uv.y).sin_cos();
        let normal = Vec3::new(radius * sine, height, radius * cosine).normalize();
        Vertex { position: normal, normal, uv }
    };
    let quad = |i: u32| {
        let (column, row) = (i % around, i / around);
        let [a, c] = [row, row + 1].map(|row| row * (around + 1) + column);
        [[a, c, c + 1], [a, c + 1, a + 1]]
    };
    let triangles = (0..around * down).flat_map(quad);
    // At a pole two corners of each quad are one point.
    let triangles = triangles.filter(|t| {
        let is_in = |row: u32, i: u32| i / (around + 1) == row;
        let has_no_area =
            is_in(0, t[0]) && is_in(0, t[2]) || is_in(down, t[1]) && is_in(down, t[2]);
        !has_no_area
    });
    Mesh {
        name: "sphere".to_owned(),
        vertices: (0..(around + 1) * (down + 1)).map(vertex).collect(),
        triangles: triangles.collect(),
        material: 0,
    }
}
