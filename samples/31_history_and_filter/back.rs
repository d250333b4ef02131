//! Motion back to the last frame.

use glam::{Affine3A, DAffine3, Vec3};

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

/// A transform in 64 bits.
pub fn in_64_bits(transform: &Affine3A) -> DAffine3 {
    DAffine3 {
        matrix3: glam::Mat3::from(transform.matrix3).as_dmat3(),
        translation: glam::Vec3::from(transform.translation).as_dvec3(),
    }
}

/// The same, rounded.
pub fn in_32_bits(transform: &DAffine3) -> Affine3A {
    Affine3A::from_mat3_translation(transform.matrix3.as_mat3(), transform.translation.as_vec3())
}
