//! The ground on the host: what it is, in f64, and prepared for the shaders.

use glam::{DVec3, Vec3};

/// How wide a hill is, and the pond beside it.
pub const CELL: f32 = 16.0;
/// Where the hill stands on whose top the world began.
pub const MIDDLE: Vec3 = Vec3::new(8.0, 0.0, 0.0);
/// What one rounding costs at most, relative.
const U: f64 = 1.0 / (1 << 24) as f64;

/// A landscape by what can be set of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Landscape {
    /// Scales all heights; 0 is flat ground.
    pub k: f32,
    /// How many rings of hills and ponds lie around the middle hill.
    pub rings: u32,
}

common::shader_struct! {
    /// The height of the ground (`heightfield.glsl`).
    pub struct HeightfieldShape {
        /// Scales everything.
        pub k: f32,
        /// Height of the hills.
        pub a: f32,
        /// How many hills a unit of x.
        pub fx: f32,
        /// How many hills a unit of z.
        pub fz: f32,
        /// Height of the ridges.
        pub b: f32,
        /// How many ridges a unit of x.
        pub gx: f32,
        /// How many ridges a unit of z.
        pub gz: f32,
        /// No slope is steeper.
        pub lipschitz: f32,
    }
}

common::shader_struct! {
    /// The ground as shaders get it.
    pub struct Ground {
        /// Its height.
        pub shape: HeightfieldShape,
        /// Corners of the box that it lies in.
        pub low: Vec3,
        /// The other corner.
        pub high: Vec3,
        /// By how much a height above the ground may be wrong that is computed in the box.
        pub error: f32,
        /// Its material, in the scene's list.
        pub material: u32,
    }
}

impl Landscape {
    // ANCHOR: shape
    /// Hills 16 wide, with ridges across. No slope is steeper than the hills' and the ridges' together.
    ///
    /// |∇(S(u)·S(v))| is 8 at most, as the page shows, and the slope of S is.
    pub fn shape(&self) -> HeightfieldShape {
        let (a, fx, fz) = (2.2, 0.5 / CELL, 0.5 / CELL);
        let (b, gx, gz) = (0.12, 0.125, 0.1875);
        let hills = f64::from(a) * f64::from(fx).max(f64::from(fz));
        let ridges = f64::from(b) * f64::from(gx).hypot(f64::from(gz));
        let steepest = 8.0 * f64::from(self.k) * (hills + ridges);
        let lipschitz = (steepest as f32).next_up();
        HeightfieldShape { k: self.k, a, fx, fz, b, gx, gz, lipschitz }
    }
    // ANCHOR_END: shape

    /// The height of the ground, in f64: where pieces stand on it.
    pub fn height(&self, x: f32, z: f32) -> f64 {
        let HeightfieldShape { k, a, fx, fz, b, gx, gz, .. } = self.shape();
        let [x, z, k, a, fx, fz, b, gx, gz] = [x, z, k, a, fx, fz, b, gx, gz].map(f64::from);
        let wave = |u: f64| {
            let v = u - u.round_ties_even();
            8.0 * v * (1.0 - 2.0 * v.abs())
        };
        k * (a * wave(fx * x) * wave(fz * z + 0.25) + b * wave(gx * x + gz * z))
    }

    // ANCHOR: bounds
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
    // ANCHOR_END: bounds

    // ANCHOR: error
    /// By how much the height of a ray above the ground may be wrong that is computed in f32, for rays
    /// from `origin` (its absolute coordinates), wherever they are in the box.
    pub fn error(&self, origin: DVec3) -> f64 {
        let HeightfieldShape { k, a, fx, fz, b, gx, gz, lipschitz } = self.shape();
        let [k, a, fx, fz, b, gx, gz, lipschitz] =
            [k, a, fx, fz, b, gx, gz, lipschitz].map(f64::from);
        let (low, high) = self.bounds(0.0);
        let reach = low.abs().max(high.abs()).as_dvec3();
        // o + t·d: the product is no longer than origin and point together, and both round.
        let place = origin + 2.0 * reach;
        let place = U * (place.y + lipschitz * place.x.hypot(place.z));
        // Where on the wave, times its slope; then three roundings of the wave itself.
        let along_x = 8.0 * U * fx * reach.x + 3.0 * U;
        let along_z = 8.0 * U * (2.0 * fz * reach.z + 0.25) + 3.0 * U;
        let across = 8.0 * U * 2.0 * (gx * reach.x + gz * reach.z) + 3.0 * U;
        // The products with each other and with a, b and k, and the sum.
        let height = a * (along_x + along_z + 2.0 * U) + b * (across + U) + 2.0 * U * (a + b);
        // What is rounded twice is of the order of U².
        (place + k * height) * (1.0 + 1e-6)
    }
    // ANCHOR_END: error
}
