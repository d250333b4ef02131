//! Everything that moves: a function of the frame's number alone.

use std::f64::consts::TAU;

use common::scene::{Camera, Scene, Sun};
use glam::{Affine3A, DAffine3, DMat3, DVec3};

use super::back::{in_32_bits, in_64_bits};

common::shader_enum! {
    /// The things that move.
    pub enum Motion { Still, Camera, Sun, Piece, All }
}

/// Degrees per frame that the camera turns around its target.
const CAMERA: f64 = 0.25;
/// Degrees per frame that the sun turns around the vertical.
const SUN: f64 = 0.08;
/// Frames in which the piece goes ahead; then it rests for as many, comes back, and rests again.
const WAY: u32 = 48;

impl Motion {
    /// The camera at a frame.
    pub fn camera(self, camera: &Camera, frame: u32) -> Camera {
        if !matches!(self, Self::Camera | Self::All) {
            return *camera;
        }
        let turn = DMat3::from_rotation_y((CAMERA * f64::from(frame)).to_radians());
        Camera { eye: camera.target + turn * (camera.eye - camera.target), ..*camera }
    }

    /// The sun at a frame.
    pub fn sun(self, sun: &Sun, frame: u32) -> Sun {
        if !matches!(self, Self::Sun | Self::All) {
            return *sun;
        }
        let azimuth = f64::from(sun.azimuth) + SUN * f64::from(frame);
        Sun { azimuth: azimuth.rem_euclid(360.0) as f32, ..*sun }
    }

    /// Tests whether pieces move.
    pub fn moves_pieces(self) -> bool {
        matches!(self, Self::Piece | Self::All)
    }

    /// The transform of the moving piece at a frame; `home` is where it starts. On its `way` along z it turns half
    /// around.
    pub fn piece(self, home: &Affine3A, way: f64, frame: u32) -> Affine3A {
        if !self.moves_pieces() {
            return *home;
        }
        let part = part(frame);
        let turn = DMat3::from_rotation_y(part * 0.5 * TAU);
        let home = in_64_bits(home);
        let moved = DAffine3 {
            matrix3: turn * home.matrix3,
            translation: home.translation + part * way * DVec3::Z,
        };
        in_32_bits(&moved)
    }
}

/// The part of its way that the piece has gone.
fn part(frame: u32) -> f64 {
    let (leg, step) = (frame / WAY % 4, f64::from(frame % WAY) / f64::from(WAY));
    let smooth = 0.5 - 0.5 * (0.5 * TAU * step).cos();
    match leg {
        0 => smooth,
        1 => 1.0,
        2 => 1.0 - smooth,
        _ => 0.0,
    }
}

/// The moving instance of a scene: Black's queen, or else the last one.
pub fn moving(scene: &Scene) -> usize {
    let is_queen = |index: &usize| {
        let instance = &scene.instances[*index];
        scene.model.meshes[instance.mesh].name == "queen"
            && scene.model.materials[instance.material].name == "black"
    };
    let last = scene.instances.len() - 1;
    (0..=last).find(is_queen).unwrap_or(last)
}

/// The length of its way: a square of the chess board, or a twelfth of another scene's longest side.
pub fn way(scene: &Scene) -> f64 {
    if scene.model.meshes[scene.instances[moving(scene)].mesh].name == "queen" {
        return 1.0;
    }
    let (low, high) = scene.bounds();
    f64::from((high - low).max_element()) / 12.0
}
