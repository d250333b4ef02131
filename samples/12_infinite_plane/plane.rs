//! The plane on the host: in f64, and prepared for the shaders.

use common::scene::Placement;
use glam::{DVec2, DVec3, Vec2, Vec3};

/// A half-space: its surface is the plane, and its normal points out of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// How it is given: [`NORMAL_AND_DISTANCE`] or [`POINT_AND_NORMAL`].
    pub form: u32,
    /// `<A,B,C>`, of any length but 0.
    pub normal: Vec3,
    /// `D`: how far the plane is from the world's origin, along the normal.
    pub distance: f32,
    /// A point of the plane, instead of the distance.
    pub point: Vec3,
    /// Whether inside and outside are exchanged.
    pub inverse: bool,
}

/// POV-Ray's `plane { <A,B,C>, D }`.
pub const NORMAL_AND_DISTANCE: u32 = 0;
/// A point of the plane, and its normal.
pub const POINT_AND_NORMAL: u32 = 1;

common::shader_struct! {
    /// The plane as shaders get it (`shaders/common/plane.glsl`).
    pub struct PlaneRecord {
        /// N, pointing to the outside.
        pub normal: Vec3,
        /// D·|N| in two parts, the second what rounding the first left over.
        pub distance: Vec2,
        /// The point of the plane that is nearest to the camera, rounded.
        pub anchor: Vec3,
        /// D·|N| - N·anchor.
        pub rest: f32,
    }
}

common::shader_struct! {
    /// How the plane looks, as shaders get it.
    #[derive(PartialEq)]
    pub struct PlaneLook {
        /// Colour of the light squares, linear RGB.
        pub light: Vec3,
        /// Colour of the dark ones.
        pub dark: Vec3,
        /// Colour of the plane seen from inside, where that is shown.
        pub inner: Vec3,
        /// Strength of the highlight.
        pub specular: f32,
        /// Exponent of the highlight.
        pub shininess: f32,
        /// What part of the light is mirrored, looked at straight.
        pub reflection: f32,
        /// 0 averaged over the pixel, 1 at its middle, 2 no checker.
        pub checker: u32,
        /// Length of a square's side.
        pub square: f32,
    }
}

impl Plane {
    /// The plane `{normal, distance}`.
    pub fn new(normal: Vec3, distance: f32) -> Self {
        let form = NORMAL_AND_DISTANCE;
        Self { form, normal, distance, point: Vec3::ZERO, inverse: false }
    }

    /// The normal that points out, and D·|N| of the plane where a scene's placement puts it.
    ///
    /// `None` if the normal is 0: there is no such plane.
    pub fn placed(&self, placement: &Placement) -> Option<(DVec3, f64)> {
        let sign = if self.inverse { -1.0 } else { 1.0 };
        let normal = self.normal.as_dvec3() * sign;
        let distance = match self.form {
            POINT_AND_NORMAL => normal.dot(self.point.as_dvec3()),
            _ => f64::from(self.distance) * sign * normal.length(),
        };
        let placed = distance * placement.size + normal.dot(placement.moved);
        (normal != DVec3::ZERO).then_some((normal, placed))
    }

    // ANCHOR: prepare
    /// The plane for shaders whose camera is at `eye`.
    pub fn record((normal, distance): (DVec3, f64), eye: Vec3) -> PlaneRecord {
        let foot = foot(normal, distance, eye.as_dvec3());
        let anchor = foot.as_vec3();
        let high = distance as f32;
        PlaneRecord {
            normal: normal.as_vec3(),
            distance: Vec2::new(high, (distance - f64::from(high)) as f32),
            anchor,
            rest: (distance - normal.dot(anchor.as_dvec3())) as f32,
        }
    }
    // ANCHOR_END: prepare
}

/// The point of the plane that is nearest to `eye`.
fn foot(normal: DVec3, distance: f64, eye: DVec3) -> DVec3 {
    eye + normal * ((distance - normal.dot(eye)) / normal.length_squared())
}

// ANCHOR: phase
/// On which square of the checker board the anchor lies. The pattern repeats every two squares, so the
/// even number that is dropped here is missed by nobody, and the shader gets a small number.
pub fn anchor_square(record: &PlaneRecord, placement: &Placement, side: f32) -> Vec2 {
    let normal = record.normal.as_dvec3().normalize();
    let aside = if normal.z.abs() < 0.9 { DVec3::Z } else { DVec3::Y };
    let u = normal.cross(aside).normalize();
    let v = u.cross(normal);
    let from_origin =
        (record.anchor.as_dvec3() - placement.moved) / (placement.size * f64::from(side));
    let square = DVec2::new(u.dot(from_origin), v.dot(from_origin));
    (square - 2.0 * (square / 2.0).floor()).as_vec2()
}
// ANCHOR_END: phase
