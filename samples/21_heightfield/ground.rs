//! The ground on the host: what it is, in f64, and prepared for the shaders.

use glam::{DVec3, Vec3};

use super::shape::HeightfieldShape;

/// Width of a hill, and of the pond beside it.
pub const CELL: f32 = 16.0;
/// Position of the middle hill, on whose top the world began.
pub const MIDDLE: Vec3 = Vec3::new(8.0, 0.0, 0.0);

/// A landscape by what can be set of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Landscape {
    /// Scales all heights; 0 is flat ground.
    pub k: f32,
    /// Rings of hills and ponds around the middle hill.
    pub rings: u32,
}

common::shader_struct! {
    /// The ground as shaders get it.
    pub struct Ground {
        /// Its height.
        pub shape: HeightfieldShape,
        /// Corners of its bounding box.
        pub low: Vec3,
        /// The other corner.
        pub high: Vec3,
        /// The error bound of a height above the ground that is computed inside the box.
        pub error: f32,
        /// Its material, in the scene's list.
        pub material: u32,
    }
}

impl Landscape {
    /// Hills 16 wide, with ridges across.
    pub fn shape(&self) -> HeightfieldShape {
        let hill = 0.5 / CELL;
        HeightfieldShape::new(self.k, [2.2, hill, hill], [0.12, 0.125, 0.1875])
    }

    /// The height of the ground, in f64, for placing pieces on it.
    pub fn height(&self, x: f32, z: f32) -> f64 {
        let HeightfieldShape { k, a, fx, fz, b, gx, gz, .. } = self.shape();
        let [x, z, k, a, fx, fz, b, gx, gz] = [x, z, k, a, fx, fz, b, gx, gz].map(f64::from);
        let wave = |u: f64| {
            let v = u - u.round_ties_even();
            8.0 * v * (1.0 - 2.0 * v.abs())
        };
        k * (a * wave(fx * x) * wave(fz * z + 0.25) + b * wave(gx * x + gz * z))
    }

    /// Corners of the box around it, with a margin below and above.
    ///
    /// The box ends where the hills do. There is room of 1 above them: a march that ends 0.0015·t above
    /// the ground must not be there when it enters the box. (In a box of no height every rung is right.)
    pub fn bounds(&self, margin: f32) -> (Vec3, Vec3) {
        let HeightfieldShape { k, a, b, .. } = self.shape();
        let height = k * (a + b) + 1.0 + margin;
        let across = CELL * (0.5 + self.rings as f32);
        let half = Vec3::new(across, height, across);
        (MIDDLE - half, MIDDLE + half)
    }

    /// By how much the height of a ray above the ground may be wrong that is computed in f32, for rays
    /// from `origin` (its absolute coordinates), wherever they are in the box.
    pub fn error(&self, origin: DVec3) -> f64 {
        let (low, high) = self.bounds(0.0);
        self.shape().error(origin, low.abs().max(high.abs()).as_dvec3())
    }
}
