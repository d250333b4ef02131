//! The scenes of this chapter: one to look at, and four whose light is known without a path.

use anyhow::Result;
use common::scene::{Camera, Material, Scene, Sun};
use glam::{DVec3, Vec3};

use super::closed_forms;

common::shader_enum! {
    /// The names of the scenes.
    pub enum SceneName {
        /// A game, with kings and queens of metal.
        Chess,
        /// The same in white that swallows nothing, under a white sky.
        Furnace,
        /// The same with a polish on the white.
        PolishedFurnace,
        /// A room whose surfaces all shine and reflect alike.
        ClosedRoom,
        /// A square that shines, a unit away from one that does not.
        ParallelSquares,
        /// A square that shines at a right angle to one that does not.
        PerpendicularSquares,
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

/// The chess set of metal, the black men painted red.
pub fn chess() -> Result<Scene> {
    let mut scene = Scene::chess_of_metal()?;
    for material in scene.model.materials.iter_mut().filter(|material| material.name == "black") {
        material.base_color = Vec3::new(0.5, 0.035, 0.02);
    }
    scene.camera = Camera::new(DVec3::new(6.4, 2.5, -2.7), DVec3::new(0.2, 0.3, -1.1), 33.0);
    Ok(scene)
}

impl Staged {
    /// The scene of a name; `source` is what those of chess are made from.
    pub fn new(name: SceneName, source: &Scene) -> Self {
        let sun = Sun { azimuth: 150.0, elevation: 24.0, radiance: Vec3::new(4.4, 3.5, 2.4) };
        if name == SceneName::Chess {
            return Self { scene: source.clone(), sun, sky: Sky::Day };
        }
        let (scene, sky) = match name {
            SceneName::Chess | SceneName::Furnace => (white(source, false), Sky::White),
            SceneName::PolishedFurnace => (white(source, true), Sky::White),
            SceneName::ClosedRoom => (closed_forms::room(), Sky::Black),
            SceneName::ParallelSquares => (closed_forms::parallel_squares(), Sky::Black),
            SceneName::PerpendicularSquares => (closed_forms::perpendicular_squares(), Sky::Black),
        };
        // No light but what the closed form has.
        let sun = Sun { radiance: Vec3::ZERO, ..sun };
        Self { scene, sun, sky }
    }
}

/// A scene in white: what a surface does not mirror, it scatters, and it swallows nothing.
fn white(source: &Scene, polished: bool) -> Scene {
    let mut scene = source.clone();
    for material in &mut scene.model.materials {
        *material = Material {
            name: material.name.clone(),
            base_color: Vec3::ONE,
            specular: Vec3::splat(if polished { 0.1 } else { 0.0 }),
            illumination: if polished { 3 } else { 1 },
            ..Material::default()
        };
    }
    scene
}
