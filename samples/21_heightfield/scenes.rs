//! The scenes of this chapter: one landscape, as steep as you like, and where it is looked at from.

use anyhow::Result;
use common::scene::{Camera, Instance, Material, Scene, Sun};
use glam::{DAffine3, DQuat, DVec3, Vec3, Vec3A};

use super::ground::{Landscape, MIDDLE};

common::shader_enum! {
    /// The names of the presets.
    pub enum PresetName { Hills, FromAbove, NearGround, Steep, Flat }
}

/// The ground, and how it is lit and looked at.
pub struct Preset {
    /// The ground.
    pub landscape: Landscape,
    /// The view.
    pub camera: Camera,
    /// The sun.
    pub sun: Sun,
}

/// The chess set without its board, on the middle hill.
pub fn chess() -> Result<Scene> {
    let mut scene = Scene::chess()?;
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

/// The longest side of a model from a file: a few pieces wide, in sight of each preset.
const MODEL: f64 = 2.0;

/// A model from a file, on the middle hill, whatever its unit of length and its place in the file.
pub fn framed(mut scene: Scene) -> Scene {
    let (low, high) = scene.bounds();
    let (low, high) = (low.as_dvec3(), high.as_dvec3());
    let longest = (high - low).max_element();
    let size = if longest > 0.0 { MODEL / longest } else { 1.0 };
    let foot = DVec3::new(0.5 * (low.x + high.x), low.y, 0.5 * (low.z + high.z));
    let place = DAffine3::from_scale_rotation_translation(
        DVec3::splat(size),
        DQuat::IDENTITY,
        MIDDLE.as_dvec3() - size * foot,
    );
    for instance in &mut scene.instances {
        instance.transform = place.as_affine3a();
    }
    scene
}

/// The material of the ground. Its colour varies from place to place and is computed in `terrain.rchit`.
pub fn earth() -> Material {
    Material { name: "earth".to_owned(), shininess: 1.0, ..Material::default() }
}

impl Preset {
    /// The preset of a name.
    pub fn new(name: PresetName) -> Self {
        let (k, rings, eye, target, field) = match name {
            // 5 degrees down, from afar.
            PresetName::Hills => (1.0, 6, [-10.0, 5.6, 48.0], [7.4, 1.1, 0.0], 12.0),
            // 60 degrees.
            PresetName::FromAbove => (1.0, 6, [2.5, 17.0, 7.5], [7.6, 1.0, -0.3], 38.0),
            // 1 degree, for a viewer on the next hill.
            PresetName::NearGround => (1.0, 6, [-10.0, 2.6, 19.0], [8.0, 2.15, 0.0], 18.0),
            PresetName::Steep => (14.0, 3, [-44.0, 30.0, 44.0], [8.0, 15.0, 0.0], 38.0),
            // From a height of 1.
            PresetName::Flat => (0.0, 25, [8.0, 1.0, 7.0], [8.0, 0.8, -3.0], 30.0),
        };
        Self {
            landscape: Landscape { k, rings },
            camera: Camera::new(DVec3::from(eye), DVec3::from(target), field),
            sun: Sun { azimuth: 270.0, elevation: 17.0, radiance: Vec3::new(5.6, 3.9, 2.3) },
        }
    }
}
