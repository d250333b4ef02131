//! A pinhole camera: the origin and directions of rays.

use std::ops::RangeInclusive;

use glam::{DVec3, Vec3};

/// A camera in world space, in f64: the basis for shaders is rounded once, at the end.
///
/// ```
/// use raybook::prelude::*;
///
/// let camera = Camera::new(DVec3::new(0.0, 0.0, 2.0), DVec3::ZERO, 90.0);
/// // For the push constants of a picture that is twice as wide as it is high.
/// let basis: CameraBasis = camera.basis(2.0);
/// assert_eq!(basis.forward, Vec3::NEG_Z);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// The origin of rays.
    pub eye: DVec3,
    /// The point in the middle of the picture.
    pub target: DVec3,
    /// The up direction; need not be perpendicular to the view.
    pub up: DVec3,
    /// Angle between the top and the bottom of the picture, in degrees.
    pub fov_y: f64,
}

common::shader_struct! {
    /// The basis from which a shader computes the ray of a pixel: `direction = forward + x·right + y·up`, with x
    /// and y from -1 to 1 across the picture.
    pub struct CameraBasis {
        /// The eye.
        pub origin: Vec3,
        /// Half the picture's width, at distance 1.
        pub right: Vec3,
        /// Half the picture's height, at distance 1.
        pub up: Vec3,
        /// The middle of the picture, at distance 1.
        pub forward: Vec3,
    }
}

impl Default for Camera {
    fn default() -> Self {
        Self::new(DVec3::new(0.0, 0.0, 5.0), DVec3::ZERO, 45.0)
    }
}

impl Camera {
    /// The range of `fov_y`: from a telescope's to a wide-angle lens's.
    pub const FIELD_OF_VIEW: RangeInclusive<f32> = 1e-4..=150.0;

    /// A camera that looks from `eye` at `target`, y up, with a vertical field of view in degrees.
    pub fn new(eye: DVec3, target: DVec3, fov_y: f64) -> Self {
        Self { eye, target, up: DVec3::Y, fov_y }
    }

    /// True if eye and target are far enough apart to define a direction.
    pub fn looks_somewhere(&self) -> bool {
        (self.target - self.eye).try_normalize().is_some()
    }

    /// The unit vectors right, up and forward.
    ///
    /// If the view is parallel to `up` or has no length, any perpendicular basis is used, so that no setting
    /// produces a NaN.
    pub fn axes(&self) -> [DVec3; 3] {
        let forward = (self.target - self.eye).try_normalize().unwrap_or(DVec3::NEG_Z);
        let right = forward
            .cross(self.up)
            .try_normalize()
            .unwrap_or_else(|| forward.any_orthonormal_vector());
        [right, right.cross(forward), forward]
    }

    /// True if a camera jumps between two pictures, as at a cut, instead of moving: it turns by more than half its
    /// field of view, or its eye moves by more than half the distance to its target.
    pub fn is_cut_from(&self, before: &Self) -> bool {
        let [_, _, now] = self.axes();
        let [_, _, then] = before.axes();
        let turned = now.angle_between(then).to_degrees();
        let moved = self.eye.distance(before.eye);
        turned > 0.5 * before.fov_y || moved > 0.5 * before.eye.distance(before.target)
    }

    /// The basis for a picture whose width is `aspect` times its height.
    pub fn basis(&self, aspect: f64) -> CameraBasis {
        let [right, up, forward] = self.axes();
        let half_height = (self.fov_y.to_radians() / 2.0).tan();
        CameraBasis {
            origin: self.eye.as_vec3(),
            right: (right * half_height * aspect).as_vec3(),
            up: (up * half_height).as_vec3(),
            forward: forward.as_vec3(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_basis_spans_the_field_of_view() {
        let basis = Camera::new(DVec3::new(0.0, 0.0, 2.0), DVec3::ZERO, 90.0).basis(2.0);
        assert_eq!(basis.forward, Vec3::NEG_Z);
        assert!((basis.up - Vec3::Y).length() < 1e-6, "{basis:?}");
        assert!((basis.right - 2.0 * Vec3::X).length() < 1e-6, "{basis:?}");
    }

    #[test]
    fn a_cut_is_a_turn_or_a_move_that_no_frame_of_a_movement_makes() {
        let before = Camera::new(DVec3::new(0.0, 0.0, 4.0), DVec3::ZERO, 40.0);
        let turned = |degrees: f64| {
            let (sin, cos) = degrees.to_radians().sin_cos();
            Camera { target: before.eye - 4.0 * DVec3::new(sin, 0.0, cos), ..before }
        };
        let moved = |by: DVec3| Camera { eye: before.eye + by, target: by, ..before };
        assert!(!before.is_cut_from(&before));
        assert!(!turned(19.0).is_cut_from(&before) && turned(21.0).is_cut_from(&before));
        for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
            assert!(
                !moved(1.9 * axis).is_cut_from(&before) && moved(2.1 * axis).is_cut_from(&before)
            );
        }
    }

    #[test]
    fn looking_straight_up_or_nowhere_still_gives_a_basis() {
        for target in [DVec3::Y, DVec3::NEG_Y, DVec3::ZERO] {
            let [right, up, forward] = Camera::new(DVec3::ZERO, target, 45.0).axes();
            for axis in [right, up, forward] {
                assert!((axis.length() - 1.0).abs() < 1e-12, "{target}: {axis}");
            }
            assert!(right.dot(up).abs() + up.dot(forward).abs() < 1e-12);
        }
    }
}
