//! The camera of a glTF file.

use glam::DVec3;
use gltf::json::camera::Type;
use gltf::json::validation::Checked;

use super::features::Features;
use super::file::File;
use super::nodes::Placed;
use crate::scene::camera::Camera;

/// The first camera of a scene that has perspective, looking about as far as the middle of the scene.
pub(super) fn first(
    file: &File,
    placed: &[Placed],
    middle: DVec3,
    features: &mut Features,
) -> Option<Camera> {
    let mut found = None;
    for Placed { node, transform, number } in placed {
        let Some(index) = node.camera else { continue };
        let Some(camera) = file.root.get(index) else {
            features
                .note("camera", 1, || format!("node {number} names a camera that is not there"));
            continue;
        };
        let perspective = camera.perspective.as_ref();
        let Some(perspective) =
            perspective.filter(|_| !matches!(camera.type_, Checked::Valid(Type::Orthographic)))
        else {
            features.note("orthographic", 1, || {
                format!("camera {} is orthographic, and is left out", index.value())
            });
            continue;
        };
        if found.is_some() {
            features.note("cameras", 1, || {
                "has several cameras; the first of the scene is shown".to_owned()
            });
            continue;
        }
        let axis = |axis: DVec3| axis.normalize_or_zero();
        let (eye, up) = (transform.w_axis.truncate(), axis(transform.y_axis.truncate()));
        let forward = -axis(transform.z_axis.truncate());
        let range = Camera::FIELD_OF_VIEW;
        let fov_y = f64::from(perspective.yfov).to_degrees();
        let is_right = eye.is_finite() && forward != DVec3::ZERO && up != DVec3::ZERO;
        if !(is_right && fov_y > 0.0 && fov_y < 180.0) {
            features.note("camera", 1, || {
                let number = index.value();
                format!(
                    "camera {number} has a field of view or a place that is wrong, and is left out"
                )
            });
            continue;
        }
        let fov_y = fov_y.clamp((*range.start()).into(), (*range.end()).into());
        // Orbiting turns around the target.
        let far = (middle - eye).dot(forward);
        let distance = if far > 0.0 { far } else { 1.0 };
        found = Some(Camera { eye, target: eye + distance * forward, up, fov_y });
    }
    found
}
