//! The height function: its numbers, and what is known of them. 25 has it, too.

use glam::DVec3;

/// Bound of one rounding error, relative.
const U: f64 = 1.0 / (1 << 24) as f64;

common::shader_struct! {
    /// The height of the ground (`shaders/common/heightfield.glsl`).
    pub struct HeightfieldShape {
        /// Scales everything.
        pub k: f32,
        /// Height of the hills.
        pub a: f32,
        /// Hills per unit of x.
        pub fx: f32,
        /// Hills per unit of z.
        pub fz: f32,
        /// Height of the ridges.
        pub b: f32,
        /// Ridges per unit of x.
        pub gx: f32,
        /// Ridges per unit of z.
        pub gz: f32,
        /// No slope is steeper.
        pub lipschitz: f32,
    }
}

impl HeightfieldShape {
    /// From `k`, and for the hills and the ridges: their height, and how many a unit of x and of z.
    ///
    /// No slope is steeper than the hills' and the ridges' together. |∇(S(u)·S(v))| is 8 at most, as the page of
    /// chapter 21 shows, and so is the slope of S.
    pub fn new(k: f32, [a, fx, fz]: [f32; 3], [b, gx, gz]: [f32; 3]) -> Self {
        let hills = f64::from(a) * f64::from(fx).max(f64::from(fz));
        let ridges = f64::from(b) * f64::from(gx).hypot(f64::from(gz));
        let steepest = 8.0 * f64::from(k) * (hills + ridges);
        let lipschitz = (steepest as f32).next_up();
        Self { k, a, fx, fz, b, gx, gz, lipschitz }
    }

    /// By how much the height of a ray above the ground may be wrong that is computed in f32, for rays
    /// from `origin` (its absolute coordinates), wherever they are within `reach`.
    pub fn error(&self, origin: DVec3, reach: DVec3) -> f64 {
        let &Self { k, a, fx, fz, b, gx, gz, lipschitz } = self;
        let [k, a, fx, fz, b, gx, gz, lipschitz] =
            [k, a, fx, fz, b, gx, gz, lipschitz].map(f64::from);
        // o + t·d: the product is no longer than origin and point together, and both round.
        let place = origin + 2.0 * reach;
        let place = U * (place.y + lipschitz * place.x.hypot(place.z));
        // The error of the position on the wave, times its slope; then three roundings of the wave itself.
        let along_x = 8.0 * U * fx * reach.x + 3.0 * U;
        let along_z = 8.0 * U * (2.0 * fz * reach.z + 0.25) + 3.0 * U;
        let across = 8.0 * U * 2.0 * (gx * reach.x + gz * reach.z) + 3.0 * U;
        // The products with each other and with a, b and k, and the sum.
        let height = a * (along_x + along_z + 2.0 * U) + b * (across + U) + 2.0 * U * (a + b);
        // Errors of two roundings are of the order of U².
        (place + k * height) * (1.0 + 1e-6)
    }
}
