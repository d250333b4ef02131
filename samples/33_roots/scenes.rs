//! The scenes of this chapter, and a view of each.

use common::model::Model;
use common::scene::Camera;
use glam::{DVec3, Vec3};

use super::tori::{Torus, chain, first_material};

common::shader_enum! {
    /// The scenes.
    pub enum SceneKind { Chain, Ring }
}

/// The square of White's king, around which the chain lies.
const KING: Vec3 = Vec3::new(0.5, 0.0, 3.5);

/// A view that shows a scene; `distance` is that of *ring*, in its radii.
pub fn camera(scene: SceneKind, distance: f32) -> Camera {
    match scene {
        SceneKind::Chain => {
            Camera::new(DVec3::new(-2.3, 2.3, 8.0), DVec3::new(0.2, 0.82, 3.2), 31.0)
        }
        SceneKind::Ring => {
            let distance = f64::from(distance);
            let eye = DVec3::new(1.0, 2.2, 3.0).normalize() * distance;
            Camera::new(eye, DVec3::ZERO, (2.0 * (1.3 / distance).atan()).to_degrees())
        }
    }
}

/// The tori of a scene; `tube` is the radius of the tube of *ring*, whose own radius is 1.
///
/// The model has the tori's materials behind its own.
pub fn tori(scene: SceneKind, tube: f32, model: &Model) -> Vec<Torus> {
    let first = first_material(model);
    match scene {
        SceneKind::Chain => {
            let mut tori = chain(KING, 0.74, [0.15, 0.042], first);
            // A hoop of wire that leans against the king, and a fat ring on an empty square.
            let aside = Vec3::new(-0.98, 0.0, 0.2);
            let low = KING + 1.25 * aside + 0.012 * Vec3::Y;
            let high = KING + 0.24 * aside + 0.95 * Vec3::Y;
            let axis = (high - low).cross(Vec3::Y.cross(aside));
            let (center, major) = (0.5 * (low + high), 0.5 * (high - low).length());
            tori.push(Torus { center, axis, major, minor: 0.011, material: first });
            let (center, axis) = (Vec3::new(-0.78, 0.15, 2.5), Vec3::Y);
            tori.push(Torus { center, axis, major: 0.23, minor: 0.15, material: first + 1 });
            tori
        }
        SceneKind::Ring => {
            let axis = Vec3::new(0.25, 1.0, 0.125);
            vec![Torus { center: Vec3::ZERO, axis, major: 1.0, minor: tube, material: first + 2 }]
        }
    }
}
