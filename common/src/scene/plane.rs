//! The plane on the host: in f64, and prepared for the shaders.

use glam::{DVec3, Vec2, Vec3};

use super::Placement;

/// A half-space: its surface is the plane, and its normal points out of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfSpace {
    /// The form in which it is given.
    pub form: PlaneForm,
    /// `<A,B,C>`, of any length but 0.
    pub normal: Vec3,
    /// `D`: the distance of the plane from the world's origin, along the normal.
    pub distance: f32,
    /// A point of the plane, instead of the distance.
    pub point: Vec3,
    /// True if inside and outside are exchanged.
    pub inverse: bool,
}

crate::shader_enum! {
    /// The form in which a plane is given.
    pub enum PlaneForm {
        /// POV-Ray's `plane { <A,B,C>, D }`.
        NormalAndDistance,
        /// A point of the plane, and its normal.
        PointAndNormal,
    }
}

crate::shader_struct! {
    /// The plane in its form for shaders (`shaders/common/plane.glsl`).
    pub struct Plane {
        /// N, pointing to the outside.
        pub normal: Vec3,
        /// D·|N| in two parts: the rounded value, and its rounding error.
        pub distance: Vec2,
        /// The point of the plane nearest to the camera, rounded.
        pub anchor: Vec3,
        /// D·|N| - N·anchor.
        pub rest: f32,
    }
}

impl HalfSpace {
    /// The half-space bounded by the plane `{normal, distance}`.
    pub fn new(normal: Vec3, distance: f32) -> Self {
        let form = PlaneForm::NormalAndDistance;
        Self { form, normal, distance, point: Vec3::ZERO, inverse: false }
    }

    /// The outward normal, and D·|N| of the plane after a scene's placement.
    ///
    /// `None` if the normal is 0, which defines no plane.
    pub fn placed(&self, placement: &Placement) -> Option<(DVec3, f64)> {
        let sign = if self.inverse { -1.0 } else { 1.0 };
        let normal = self.normal.as_dvec3() * sign;
        let distance = match self.form {
            PlaneForm::PointAndNormal => normal.dot(self.point.as_dvec3()),
            PlaneForm::NormalAndDistance => f64::from(self.distance) * sign * normal.length(),
        };
        let placed = distance * placement.size + normal.dot(placement.moved);
        (normal != DVec3::ZERO).then_some((normal, placed))
    }
}

impl Plane {
    /// The plane N·p = D·|N| for shaders whose camera is at `eye`.
    ///
    /// N is scaled by a power of two, which causes no rounding, so that its square is neither 0 nor infinite.
    pub fn new((normal, distance): (DVec3, f64), eye: Vec3) -> Self {
        let scale = normal.abs().max_element().log2().floor().exp2().recip();
        let (normal, distance) = (normal * scale, distance * scale);
        let eye = eye.as_dvec3();
        let foot = eye + normal * ((distance - normal.dot(eye)) / normal.length_squared());
        let anchor = foot.as_vec3();
        let high = distance as f32;
        Self {
            normal: normal.as_vec3(),
            distance: Vec2::new(high, (distance - f64::from(high)) as f32),
            anchor,
            rest: (distance - normal.dot(anchor.as_dvec3())) as f32,
        }
    }
}
