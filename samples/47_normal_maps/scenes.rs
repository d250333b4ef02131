//! The scenes of this chapter: hammered royals on a bevelled board, and surfaces whose light is known.

use anyhow::Result;
use common::Setup;
use common::model::{Model, Texture};
use common::scene::{
    Camera, Instance, Look, Material, Mesh, Microfacet, Scene, Sun, Vertex, assets,
};
use glam::{Affine3A, DVec3, Vec2, Vec3};

use super::rough_scenes::{self, Sky, Staged, microfacets};

common::shader_enum! {
    /// The names of the scenes.
    pub enum SceneName {
        /// Hammered kings and queens on a bevelled board.
        Chess,
        /// A hammered plate, seen from low down.
        Plate,
        /// Five hammered white spheres of metal, from smooth to rough, under a white sky.
        Furnace,
        /// A plate whose left half has the texture coordinates of the right one, mirrored.
        Halves,
    }
}

/// The normal maps of this chapter, which come after the textures of the scene that is opened.
const MAPS: [&str; 2] = ["bevelled.png", "hammered.png"];
const BEVELLED: usize = 0;
const HAMMERED: usize = 1;

/// The scene to begin with, and this chapter's normal maps. A material that has a normal map and no microfacets becomes an
/// insulator of its colour, as rough as its highlight is wide.
///
/// # Errors
/// If a file is missing or wrong.
pub fn open(setup: &Setup) -> Result<Scene> {
    let looks = [Look::Mirror, Look::Microfacet, Look::NormalMap];
    let mut scene = setup.scene_with(&looks, chess)?;
    for material in &mut scene.model.materials {
        if material.normal_texture.is_some() {
            let (color, roughness) = (material.base_color, highlight(material.shininess));
            let plain = || Microfacet { color, roughness, ..Microfacet::default() };
            material.microfacet.get_or_insert_with(plain);
        }
    }
    for name in MAPS {
        let texture = Texture::of_normals(&assets().join(name), name.to_owned())?;
        scene.model.textures.push(texture);
    }
    Ok(scene)
}

/// The roughness of the GGX highlight as wide as the Blinn-Phong one of an exponent (Walter et al. 2007, by Karis
/// 2013).
fn highlight(exponent: f32) -> f32 {
    (2.0 / (exponent + 2.0)).sqrt().sqrt()
}

/// The royals of 45, hammered, on bevelled squares.
fn chess() -> Result<Scene> {
    let mut scene = rough_scenes::chess()?;
    let Model { meshes, materials, textures, .. } = &mut scene.model;
    for material in materials.iter_mut() {
        let (map, scale) = match material.name.as_str() {
            "gold" | "silver" => (HAMMERED, 1.0),
            "board_light" | "board_dark" => (BEVELLED, 1.0),
            _ => continue,
        };
        material.normal_texture = Some(textures.len() + map);
        material.normal_scale = scale;
    }
    // Twice as many dents around a piece as the map is wide, so that they are about round.
    for mesh in meshes.iter_mut().filter(|mesh| matches!(mesh.name.as_str(), "king" | "queen")) {
        mesh.vertices.iter_mut().for_each(|vertex| vertex.uv.x *= 2.0);
    }
    Ok(scene)
}

/// The scene of a name; `source` is the one that [`open`] returned.
pub fn staged(name: SceneName, source: &Scene) -> Staged {
    let map = source.model.textures.len() - MAPS.len() + HAMMERED;
    match name {
        SceneName::Chess => Staged::new(rough_scenes::SceneName::Chess, source),
        SceneName::Plate => Staged { scene: plate(map), sun: sun(60.0, 25.0, 3.0), sky: Sky::Day },
        SceneName::Furnace => {
            Staged { scene: furnace(map), sun: sun(0.0, 90.0, 0.0), sky: Sky::White }
        }
        SceneName::Halves => Staged { scene: halves(map), sun: sun(0.0, 25.0, 3.0), sky: Sky::Day },
    }
}

/// A white sun.
fn sun(azimuth: f32, elevation: f32, radiance: f32) -> Sun {
    Sun { azimuth, elevation, radiance: Vec3::splat(radiance) }
}

/// Silver with a normal map.
fn mapped(name: &str, color: Vec3, roughness: f32, map: usize, scale: f32) -> Material {
    Material {
        normal_texture: Some(map),
        normal_scale: scale,
        ..microfacets(name, color, roughness, 1.0)
    }
}

/// Five white spheres of 45 with dents.
fn furnace(map: usize) -> Scene {
    let mut scene = rough_scenes::spheres(1.0);
    for material in &mut scene.model.materials {
        (material.normal_texture, material.normal_scale) = (Some(map), 2.0);
    }
    for vertex in &mut scene.model.meshes[0].vertices {
        vertex.uv *= Vec2::new(4.0, 2.0);
    }
    scene
}

/// A plate of silver and a ball on it.
fn plate(map: usize) -> Scene {
    let silver = Vec3::new(0.972, 0.96, 0.915);
    let mut scene = rough_scenes::spheres(0.0);
    let ball = scene.model.meshes.swap_remove(0);
    let red = microfacets("ball", Vec3::new(0.6, 0.06, 0.03), 0.3, 0.0);
    let instance = |mesh: usize, at: Vec3| Instance {
        mesh,
        transform: Affine3A::from_translation(at),
        material: mesh,
        record_offset: 0,
    };
    Scene {
        model: Model {
            meshes: vec![quads(&[[-6.0, 6.0]], 0.5), ball],
            materials: vec![mapped("plate", silver, 0.1, map, 2.0), red],
            ..Model::default()
        },
        instances: vec![instance(0, Vec3::ZERO), instance(1, Vec3::new(0.7, 1.0, -1.5))],
        camera: Camera::new(DVec3::new(0.0, 0.7, 6.5), DVec3::new(0.0, 0.35, 0.0), 32.0),
    }
}

/// A plate of gold of which both halves show the same part of the map.
fn halves(map: usize) -> Scene {
    let gold = Vec3::new(1.0, 0.782, 0.344);
    Scene {
        model: Model {
            meshes: vec![quads(&[[-2.0, 0.0], [0.0, 2.0]], 0.25)],
            materials: vec![mapped("halves", gold, 0.35, map, 2.0)],
            ..Model::default()
        },
        instances: vec![Instance {
            mesh: 0,
            transform: Affine3A::IDENTITY,
            material: 0,
            record_offset: 0,
        }],
        camera: Camera::new(DVec3::new(0.0, 5.5, 4.0), DVec3::ZERO, 33.0),
    }
}

/// Squares in the plane y = 0 from these x to those, as deep as they are wide on both sides of z = 0. Texture
/// coordinates grow by `tiles` per unit, on the left of x = 0 to the left.
fn quads(spans: &[[f32; 2]], tiles: f32) -> Mesh {
    let mut mesh =
        Mesh { name: "plate".to_owned(), vertices: vec![], triangles: vec![], material: 0 };
    for &[low, high] in spans {
        let deep = low.abs().max(high);
        let first = mesh.vertices.len() as u32;
        let is_mirrored = high <= 0.0;
        for (x, z) in [(low, deep), (high, deep), (high, -deep), (low, -deep)] {
            let u = if is_mirrored { -x } else { x };
            let uv = Vec2::new(u, z) * tiles;
            mesh.vertices.push(Vertex { position: Vec3::new(x, 0.0, z), normal: Vec3::Y, uv });
        }
        mesh.triangles.extend([[0, 1, 2], [0, 2, 3]].map(|t: [u32; 3]| t.map(|i| first + i)));
    }
    mesh
}
