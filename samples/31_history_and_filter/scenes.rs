//! The scenes of this chapter: two to look at, and one whose light is the same everywhere.

use std::iter;

use anyhow::{Context, Result};
use common::scene::{Camera, Instance, Material, Scene, Sun, assets};
use glam::{Affine3A, DVec3, Vec3};

use super::motion::{KINDS, SIDES};
use super::turned::{self, TABLE};
use super::{leg, legs};

common::shader_enum! {
    /// The names of the scenes.
    pub enum SceneName {
        /// A game of ivory and red pieces.
        Chess,
        /// The whole game of 14, on its table.
        Game,
        /// The first one in white that absorbs nothing, under a white sky.
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
    /// The scene of a name, made from `source`; for a game, there may be another one.
    pub fn new(name: SceneName, source: &Scene, game: Option<&Game>) -> Self {
        let sun = Sun { azimuth: 150.0, elevation: 24.0, radiance: Vec3::new(4.4, 3.5, 2.4) };
        match name {
            SceneName::Chess => Self { scene: source.clone(), sun, sky: Sky::Day },
            SceneName::Game => {
                let scene = game.map_or(source, |game| &game.scene).clone();
                Self { scene, sun, sky: Sky::Day }
            }
            SceneName::Furnace => {
                let sun = Sun { radiance: Vec3::ZERO, ..sun };
                Self { scene: white(source), sun, sky: Sky::White }
            }
        }
    }
}

/// A game, and the set that it is played with: the pieces are the last instances, in their order.
pub struct Game {
    pub scene: Scene,
    pub legs: leg::Motion,
}

impl Game {
    /// Morphy's game at the opera, in which no pawn becomes another piece.
    ///
    /// # Errors
    /// If the file of the game is wrong, or a piece is missing in the set.
    pub fn new(set: &Scene) -> Result<Self> {
        let legs = legs::open(&assets().join("games/opera.legs"))?;
        let mut scene = set.clone();
        let Scene { model, instances, .. } = &mut scene;
        instances.retain(|instance| model.meshes[instance.mesh].name.starts_with("board"));
        let base_color = Vec3::new(0.028, 0.075, 0.068);
        let felt = Material { name: "felt".to_owned(), base_color, ..Material::default() };
        model.meshes.push(turned::table(9.6, model.materials.len()));
        model.materials.push(felt);
        let table = ("table", "felt", Affine3A::from_translation(TABLE * Vec3::Y));
        let pieces = legs.at(0).map(|it| (KINDS[it.kind], SIDES[it.side], it.at));
        for (mesh, material, transform) in iter::once(table).chain(pieces) {
            let mesh = model.meshes.iter().position(|it| it.name == mesh);
            let material = model.materials.iter().position(|it| it.name == material);
            let (mesh, material) = mesh.zip(material).context("the set is not whole")?;
            instances.push(Instance { mesh, transform, material, record_offset: 0 });
        }
        scene.camera = Camera::new(DVec3::new(7.2, 5.6, 7.0), DVec3::new(0.0, 0.3, 0.4), 38.0);
        Ok(Self { scene, legs })
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
