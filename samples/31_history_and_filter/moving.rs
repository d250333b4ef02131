//! Everything that moves: a function of the frame's number alone.

use std::f64::consts::TAU;

use common::scene::{Camera, Scene, Sun};
use glam::{Affine3A, DAffine3, DMat3, DVec3, Vec3};

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

common::shader_struct! {
    /// The rigid motion that takes a piece from where it is to where it was: the columns of a matrix.
    pub struct Back {
        x: Vec3,
        y: Vec3,
        z: Vec3,
        origin: Vec3,
    }
}

impl Back {
    /// From one transform to another: computed in 64 bits, and rounded once. Between equal ones it changes no bit.
    pub fn new(from: &Affine3A, to: &Affine3A) -> Self {
        let back = in_32_bits(&(in_64_bits(to) * in_64_bits(from).inverse()));
        let back = if from == to { Affine3A::IDENTITY } else { back };
        let columns = back.matrix3;
        Self {
            x: columns.x_axis.into(),
            y: columns.y_axis.into(),
            z: columns.z_axis.into(),
            origin: back.translation.into(),
        }
    }
}

fn in_64_bits(transform: &Affine3A) -> DAffine3 {
    DAffine3 {
        matrix3: glam::Mat3::from(transform.matrix3).as_dmat3(),
        translation: glam::Vec3::from(transform.translation).as_dvec3(),
    }
}

fn in_32_bits(transform: &DAffine3) -> Affine3A {
    Affine3A::from_mat3_translation(transform.matrix3.as_mat3(), transform.translation.as_vec3())
}
