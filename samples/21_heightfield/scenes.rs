//! The scenes of this chapter: one landscape, as steep as you like, and where it is looked at from.

use anyhow::Result;
use common::scene::board::Board;
use common::scene::plane::HalfSpace;
use common::scene::{Camera, Instance, Material, PointLight, Scene, Sun};
use glam::{DVec3, Vec3, Vec3A};

use crate::ground::{Landscape, MIDDLE};

/// The names of the presets, in the order of their numbers.
pub const PRESETS: [&str; 5] = ["hills", "from above", "near ground", "steep", "flat"];

/// The ground, how it is lit and looked at, and the plane beside it.
pub struct Preset {
    /// The ground.
    pub landscape: Landscape,
    /// The view.
    pub camera: Camera,
    /// The sun.
    pub sun: Sun,
    /// The lamp.
    pub lamp: PointLight,
    /// The sun shines (0), the lamp (1), or both (2).
    pub light: u32,
    /// The lake is the surface of this.
    pub plane: HalfSpace,
    /// What it looks like.
    pub board: Board,
}

/// The chess set of metal without its board, on the middle hill.
pub fn chess() -> Result<Scene> {
    let mut scene = Scene::chess_of_metal()?;
    let Scene { model, instances, .. } = &mut scene;
    let name = |instance: &Instance| model.meshes[instance.mesh].name.as_str();
    instances.retain(|instance| {
        !["board", "screen"].iter().any(|given_up| name(instance).starts_with(given_up))
    });
    for instance in instances {
        instance.transform.translation += Vec3A::from(MIDDLE);
    }
    Ok(scene)
}

// ANCHOR: reflection
/// What part of the light a material mirrors when looked at straight: the specular colour, if the
/// illumination model reflects (`illum 3`).
pub fn reflection(material: &Material) -> Vec3 {
    if material.illumination >= 3 { material.specular } else { Vec3::ZERO }
}
// ANCHOR_END: reflection

impl Preset {
    // ANCHOR: presets
    /// The preset of a number. The lake is high enough to hide where the ground ends: there the hills
    /// are 0 high, and the ridges 0.12·k.
    pub fn new(number: u32) -> Self {
        let (k, rings, lake, eye, target, field) = match number {
            // 5 degrees down, from afar.
            0 => (1.0, 6, 0.45, [-10.0, 5.6, 48.0], [7.4, 1.1, 0.0], 12.0),
            // 60 degrees.
            1 => (1.0, 6, 0.45, [2.5, 17.0, 7.5], [7.6, 1.0, -0.3], 38.0),
            // 1 degree, by one who stands on the next hill.
            2 => (1.0, 6, 0.45, [-10.0, 2.6, 19.0], [8.0, 2.15, 0.0], 18.0),
            3 => (14.0, 3, 1.8, [-44.0, 30.0, 44.0], [8.0, 15.0, 0.0], 38.0),
            // From a height of 1.
            _ => (0.0, 25, -1.0, [8.0, 1.0, 7.0], [8.0, 0.8, -3.0], 30.0),
        };
        Self {
            landscape: Landscape { k, rings },
            camera: Camera::new(DVec3::from(eye), DVec3::from(target), field),
            sun: Sun { azimuth: 270.0, elevation: 17.0, radiance: Vec3::new(5.6, 3.9, 2.3) },
            lamp: PointLight { position: Vec3::new(8.0, 6.0, 3.0), ..PointLight::default() },
            light: 0,
            plane: HalfSpace::new(Vec3::Y, lake),
            board: Board {
                light: Vec3::new(0.02, 0.05, 0.055),
                dark: Vec3::new(0.02, 0.05, 0.055),
                specular: 0.03,
                roughness: 0.3,
                reflection: 0.04,
                checker: 2,
                ..Board::default()
            },
        }
    }
    // ANCHOR_END: presets
}
