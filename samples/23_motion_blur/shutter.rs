//! The motion of a piece while the shutter is open: from one pose to another.

use glam::{Affine3A, Mat3A, Quat, Vec3};

common::shader_enum! {
    /// The interpolation of two poses.
    pub enum Between: BETWEEN {
        /// A rotation between both rotations.
        Rotation,
        /// The mean of both matrices, which is smaller.
        Matrix,
    }
}

/// A position and an orientation.
#[derive(Clone, Copy, PartialEq)]
pub struct Pose {
    pub place: Vec3,
    /// A unit quaternion. It says more than the matrix: `-q` is the same rotation, come to by another turn.
    pub rotation: Quat,
}

impl Pose {
    /// The same, written so that the way from another pose is the shorter one.
    pub fn near(self, other: Self) -> Self {
        let is_far = self.rotation.dot(other.rotation) < 0.0;
        Self { rotation: if is_far { -self.rotation } else { self.rotation }, ..self }
    }
}

/// The pose at a part of the way, 0 to 1, as a matrix.
pub fn between([open, close]: [Pose; 2], part: f32, kind: Between) -> Affine3A {
    let translation = open.place + part * (close.place - open.place);
    let matrix = |q: Quat| {
        let matrix3 = Mat3A::from_quat(q);
        Affine3A { matrix3, translation: translation.into() }
    };
    match kind {
        // On the straight way from quaternion to quaternion, and back to length 1: about one axis; evenly if the angle is small.
        Between::Rotation => {
            let mixed = open.rotation + (close.rotation - open.rotation) * part;
            matrix(mixed.normalize())
        }
        Between::Matrix => {
            let [a, b] = [open, close].map(|pose| matrix(pose.rotation).matrix3);
            Affine3A { matrix3: a + (b - a) * part, translation: translation.into() }
        }
    }
}
