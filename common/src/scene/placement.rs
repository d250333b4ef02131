//! Where a whole scene stands: scaled and moved, worked out in f64 and rounded once at the end.

use glam::{Affine3A, DVec3};

use super::{Camera, Instance, Scene};

crate::shader_enum! {
    /// How many times as large a scene is, to find out what rounding makes of it.
    pub enum Size {
        /// A thousandth.
        Small = "0.001",
        /// As it is.
        Usual = "1",
        /// A thousand times.
        Large = "1000",
    }
    /// How far a scene is from the origin.
    pub enum Moved {
        /// As it is.
        Not = "0",
        /// 10000 units, and no axis is spared.
        Far = "10000",
    }
}

const FAR: DVec3 = DVec3::new(6000.0, 4800.0, 6400.0);

/// A change of scale about the origin, then a move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// How many times as large.
    pub size: f64,
    /// Where the origin goes, in the world's units.
    pub moved: DVec3,
}

impl Default for Placement {
    /// The scene as it is.
    fn default() -> Self {
        Self { size: 1.0, moved: DVec3::ZERO }
    }
}

impl Placement {
    /// A scene so large, and so far away.
    pub fn new(size: Size, moved: Moved) -> Self {
        let size = match size {
            Size::Small => 1e-3,
            Size::Usual => 1.0,
            Size::Large => 1e3,
        };
        Self { size, moved: if moved == Moved::Far { FAR } else { DVec3::ZERO } }
    }

    /// The scene with its instances and its camera there; the meshes stay as they are.
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

    /// A camera that sees there what this one sees here.
    pub fn camera(&self, camera: &Camera) -> Camera {
        Camera { eye: self.point(camera.eye), target: self.point(camera.target), ..*camera }
    }

    fn point(&self, point: DVec3) -> DVec3 {
        point * self.size + self.moved
    }
}
