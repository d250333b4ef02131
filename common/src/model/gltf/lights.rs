//! The lights of a glTF file (`KHR_lights_punctual`).

use glam::{DVec3, Vec3};
use gltf::json::extensions::scene::khr_lights_punctual::Type;
use gltf::json::validation::Checked;

use super::features::Features;
use super::file::File;
use super::nodes::Placed;
use crate::scene::light::{LightSource, PointLight, Sun};

/// The largest factor between lights and the sun of the chapters at which lights are not scaled.
const USUAL: f32 = 20.0;

/// The lights of a scene, in its order.
///
/// glTF gives them in lux and candela, to which a camera's exposure belongs. Without one, lights far from the
/// brightness of the chapters' sun are scaled together, so that the brightest is as bright at `middle`.
pub(super) fn of_scene(
    file: &File,
    placed: &[Placed],
    middle: DVec3,
    features: &mut Features,
) -> Vec<LightSource> {
    let mut lights = Vec::new();
    for Placed { node, transform, number } in placed {
        let light = node.extensions.as_ref().and_then(|all| all.khr_lights_punctual.as_ref());
        let Some(index) = light.map(|light| light.light) else { continue };
        let Some(light) = file.root.get(index) else {
            features.note("light", 1, || format!("node {number} names a light that is not there"));
            continue;
        };
        let strength = Vec3::from(light.color) * light.intensity;
        let place = transform.w_axis.truncate().as_vec3();
        let towards = transform.z_axis.truncate().normalize_or_zero().as_vec3();
        if !strength.is_finite() || strength.min_element() < 0.0 || !place.is_finite() {
            features.note("light", 1, || {
                format!(
                    "light {} has a strength or place that is wrong, and is left out",
                    index.value()
                )
            });
            continue;
        }
        if strength == Vec3::ZERO {
            continue;
        }
        let lamp = LightSource::Point(PointLight { position: place, intensity: strength });
        lights.push(match light.type_ {
            // It shines along its own -z.
            Checked::Valid(Type::Directional) if towards != Vec3::ZERO => {
                LightSource::Directional { direction: towards, radiance: strength }
            }
            Checked::Valid(Type::Point) => lamp,
            Checked::Valid(Type::Spot) => {
                features.note("spot", 1, || {
                    format!("light {} is a spot; it shines all around", index.value())
                });
                lamp
            }
            Checked::Valid(Type::Directional) | Checked::Invalid => {
                features.note("light", 1, || {
                    format!("light {} has no kind or direction, and is left out", index.value())
                });
                continue;
            }
        });
    }
    scale(&mut lights, middle.as_vec3(), features);
    lights
}

/// Scales lights that are far too bright or too dark.
fn scale(lights: &mut [LightSource], middle: Vec3, features: &mut Features) {
    let arriving = |light: &LightSource| match light {
        LightSource::Directional { radiance, .. } => radiance.max_element(),
        LightSource::Point(lamp) => {
            lamp.intensity.max_element() / lamp.position.distance_squared(middle).max(1e-12)
        }
    };
    let brightest = lights.iter().map(arriving).fold(0.0, f32::max);
    let usual = Sun::default().radiance.max_element();
    let factor = usual / brightest;
    if (1.0 / USUAL..=USUAL).contains(&factor) || !factor.is_normal() {
        return;
    }
    features.note("exposure", 1, || {
        format!(
            "lights its middle with {brightest:.3e} lux, and says nothing of a camera's exposure; all its lights \
             are taken times {factor:.3e}"
        )
    });
    for light in lights {
        match light {
            LightSource::Directional { radiance, .. } => *radiance *= factor,
            LightSource::Point(lamp) => lamp.intensity *= factor,
        }
    }
}
