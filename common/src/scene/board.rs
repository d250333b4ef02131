//! The surface of the plane: a board of squares, or one colour.

use glam::{DVec2, DVec3, Vec2, Vec3};

use super::Placement;
use super::plane::{HalfSpace, Plane};

crate::shader_struct! {
    /// The board in its form for shaders.
    pub struct Board {
        /// Colour of the light squares, linear RGB.
        pub light: Vec3,
        /// Colour of the dark ones.
        pub dark: Vec3,
        /// Colour of the plane seen from inside, where that is shown.
        pub inner: Vec3,
        /// Strength of the highlight.
        pub specular: f32,
        /// Width of the highlight: 0 is a point, 1 is none.
        pub roughness: f32,
        /// The part of the light mirrored at normal incidence.
        pub reflection: f32,
        /// 1 for squares, 0 for one colour.
        pub checker: u32,
        /// Length of a square's side.
        pub square: f32,
        /// Unit vector along one side.
        pub u: Vec3,
        /// Along the other.
        pub v: Vec3,
        /// The square that contains the plane's anchor.
        pub anchor: Vec2,
    }
}

impl Default for Board {
    /// Black squares a unit long.
    fn default() -> Self {
        Self {
            light: Vec3::ZERO,
            dark: Vec3::ZERO,
            inner: Vec3::new(0.5, 0.08, 0.05),
            specular: 0.0,
            roughness: 1.0,
            reflection: 0.0,
            checker: 1,
            square: 1.0,
            u: Vec3::X,
            v: Vec3::Z,
            anchor: Vec2::ZERO,
        }
    }
}

impl Board {
    /// The board after a scene's placement, on this plane. The choice of the inside changes no square.
    ///
    /// The pattern repeats every two squares, so an even number of squares is subtracted here: the pattern stays
    /// the same, and the shader gets a small number.
    pub fn placed(&self, placement: &Placement, side: &HalfSpace, plane: &Plane) -> Self {
        let square = f64::from(self.square) * placement.size;
        let normal = side.normal.as_dvec3().normalize_or(DVec3::Y);
        let aside = if normal.z.abs() < 0.9 { DVec3::Z } else { DVec3::Y };
        let u = normal.cross(aside).normalize();
        let v = u.cross(normal);
        let from_origin = (plane.anchor.as_dvec3() - placement.moved) / square;
        let anchor = DVec2::new(u.dot(from_origin), v.dot(from_origin));
        let anchor = (anchor - 2.0 * (anchor / 2.0).floor()).as_vec2();
        Self { square: square as f32, u: u.as_vec3(), v: v.as_vec3(), anchor, ..*self }
    }
}
