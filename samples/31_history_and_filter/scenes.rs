//! The scenes of this chapter: one to look at, and one whose light is the same everywhere.

use anyhow::Result;
use common::scene::{Camera, Material, Scene, Sun};
use glam::{DVec3, Vec3};

common::shader_enum! {
    /// The names of the scenes.
    pub enum SceneName {
        /// A game of ivory and red pieces.
        Chess,
        /// The same in white that absorbs nothing, under a white sky.
        Furnace,
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

/// The chess set without its polish, Black's pieces painted red.
pub fn chess() -> Result<Scene> {
    let mut scene = Scene::chess()?;
    for material in &mut scene.model.materials {
        (material.specular, material.illumination) = (Vec3::ZERO, 1);
        if material.name == "black" {
            material.base_color = Vec3::new(0.5, 0.035, 0.02);
        }
    }
    scene.camera = Camera::new(DVec3::new(6.4, 2.5, -2.7), DVec3::new(0.2, 0.3, -1.1), 33.0);
    Ok(scene)
}

impl Staged {
    /// The scene of a name, made from `source`.
    pub fn new(name: SceneName, source: &Scene) -> Self {
        let sun = Sun { azimuth: 150.0, elevation: 24.0, radiance: Vec3::new(4.4, 3.5, 2.4) };
        match name {
            SceneName::Chess => Self { scene: source.clone(), sun, sky: Sky::Day },
            SceneName::Furnace => {
                let sun = Sun { radiance: Vec3::ZERO, ..sun };
                Self { scene: white(source), sun, sky: Sky::White }
            }
        }
    }
}

/// A scene in white: surfaces scatter all light.
fn white(source: &Scene) -> Scene {
    let mut scene = source.clone();
    for material in &mut scene.model.materials {
        *material = Material {
            name: material.name.clone(),
            base_color: Vec3::ONE,
            specular: Vec3::ZERO,
            illumination: 1,
            ..Material::default()
        };
    }
    scene
}
