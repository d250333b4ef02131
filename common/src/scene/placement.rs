//! The placement of a whole scene: scaled and moved in f64, and rounded once at the end.

use glam::{Affine3A, DVec3};

use super::{Camera, Instance, Scene};

crate::shader_enum! {
    /// The scale of a scene, for experiments with rounding errors.
    pub enum Size {
        /// A thousandth.
        Small = "0.001",
        /// Unchanged.
        Usual = "1",
        /// A thousand times.
        Large = "1000",
    }
    /// The distance of a scene from the origin.
    pub enum Moved {
        /// Unchanged.
        Not = "0",
        /// 10000 units, along all axes.
        Far = "10000",
        /// A million units, in the same direction.
        Farther = "1000000",
    }
}

const FAR: DVec3 = DVec3::new(6000.0, 4800.0, 6400.0);

/// A change of scale about the origin, then a move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Scale factor.
    pub size: f64,
    /// The new position of the origin, in world units.
    pub moved: DVec3,
}

impl Default for Placement {
    /// The scene unchanged.
    fn default() -> Self {
        Self { size: 1.0, moved: DVec3::ZERO }
    }
}

impl Placement {
    /// A placement with this scale and distance.
    pub fn new(size: Size, moved: Moved) -> Self {
        let size = match size {
            Size::Small => 1e-3,
            Size::Usual => 1.0,
            Size::Large => 1e3,
        };
        let moved = match moved {
            Moved::Not => DVec3::ZERO,
            Moved::Far => FAR,
            Moved::Farther => 100.0 * FAR,
        };
        Self { size, moved }
    }

    /// The scene with its instances and its camera moved; the meshes stay unchanged.
    pub fn scene(&self, scene: &Scene) -> Scene {
        let instances = scene.instances.iter().map(|instance| self.instance(instance)).collect();
        Scene { model: scene.model.clone(), instances, camera: self.camera(&scene.camera) }
    }

    fn instance(&self, instance: &Instance) -> Instance {
        let Affine3A { matrix3, translation } = instance.transform;
        let axis = |axis: glam::Vec3A| (axis.as_dvec3() * self.size).as_vec3a();
        let matrix3 = glam::Mat3A::from_cols(
            axis(matrix3.x_axis),
            axis(matrix3.y_axis),
            axis(matrix3.z_axis),
        );
        let translation = self.point(translation.as_dvec3()).as_vec3a();
        Instance { transform: Affine3A { matrix3, translation }, ..*instance }
    }

    /// The camera moved with the scene, so that it shows the same view.
    pub fn camera(&self, camera: &Camera) -> Camera {
        Camera { eye: self.point(camera.eye), target: self.point(camera.target), ..*camera }
    }

    fn point(&self, point: DVec3) -> DVec3 {
        point * self.size + self.moved
    }
}
