//! Motion from frame to frame: there and back, as a function of the frame's number.

use std::f64::consts::TAU;

use common::scene::{Camera, Instance, Mesh, Scene};
use glam::{Affine3A, DMat3, Mat3A, Vec3};

/// Everything that moves from frame to frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    /// Frames until everything is back where it began.
    pub frames: u32,
    /// The placed meshes that move.
    pub pieces: Vec<Way>,
    /// Degrees by which the camera turns around its target.
    pub orbit: f32,
}

/// The way of a placed mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Way {
    /// Its index among the instances.
    pub instance: usize,
    /// Where it begins.
    pub home: Affine3A,
    /// From there to the other end.
    pub way: Vec3,
    /// Degrees by which it turns around the vertical on the way.
    pub spin: f32,
}

impl Motion {
    /// Most placed meshes of a scene that moves: a pixel has 15 bits for them.
    pub const MOST: usize = 0x7fff;

    /// The part of its way that everything has gone, 0 to 1.
    fn part(&self, frame: u32) -> f64 {
        let turn = f64::from(frame % self.frames) / f64::from(self.frames);
        0.5 - 0.5 * (TAU * turn).cos()
    }

    /// Places the instances as they are in a frame.
    pub fn place(&self, instances: &mut [Instance], frame: u32) {
        let part = self.part(frame);
        for Way { instance, home, way, spin } in &self.pieces {
            let turn = Mat3A::from_rotation_y((part * f64::from(*spin)).to_radians() as f32);
            instances[*instance].transform = Affine3A {
                matrix3: turn * home.matrix3,
                translation: home.translation + glam::Vec3A::from(*way * part as f32),
            };
        }
    }

    /// The camera in a frame.
    pub fn camera(&self, camera: &Camera, frame: u32) -> Camera {
        let degrees = self.part(frame) * f64::from(self.orbit);
        if degrees == 0.0 {
            return *camera;
        }
        let turn = DMat3::from_rotation_y(degrees.to_radians());
        Camera { eye: camera.target + turn * (camera.eye - camera.target), ..*camera }
    }

    /// Boxes around each moving mesh on its whole way.
    pub fn bounds<'a>(&'a self, scene: &'a Scene) -> impl Iterator<Item = (Vec3, Vec3)> + 'a {
        self.pieces.iter().map(|Way { instance, home, way, .. }| {
            let mesh: &Mesh = &scene.model.meshes[scene.instances[*instance].mesh];
            let radius = 1.74 * mesh.reach() * home.matrix3.x_axis.length();
            let from = Vec3::from(home.translation);
            (from.min(from + *way) - radius, from.max(from + *way) + radius)
        })
    }
}
