//! The heightfield, prepared for the shaders; chapter 21 derives it.

use common::gpu::order::Bounds;
use effects::Heightfield;
use glam::{DVec3, Vec3, Vec3Swizzles};

/// What one rounding costs at most, relative.
const U: f64 = 1.0 / (1 << 24) as f64;

common::shader_struct! {
    /// The height of the ground (`shaders/common/heightfield.glsl`).
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
        /// Colour of the light fields, linear RGB.
        pub light: Vec3,
        /// Colour of the dark ones.
        pub dark: Vec3,
        /// Colour where it is steep.
        pub rock: Vec3,
        /// Length of a field's side.
        pub square: f32,
    }
}

impl Ground {
    /// No ground: nothing has its number of instances.
    pub fn none() -> Self {
        bytemuck::Zeroable::zeroed()
    }

    /// The ground of a scene.
    pub fn new(field: &Heightfield) -> Self {
        let (low, high) = bounds(field);
        let shape = shape(field);
        let error = (error(&shape, low.abs().max(high.abs()).as_dvec3()) as f32).next_up();
        let &Heightfield { light, dark, rock, square, .. } = field;
        Self { shape, low, high, error, light, dark, rock, square }
    }
}

/// Corners of the box around it: a little higher than the hills, so that none touches it.
pub fn bounds(field: &Heightfield) -> Bounds {
    let height = 1.01 * (field.hills + field.ridges);
    (field.low.extend(-height).xzy(), field.high.extend(height).xzy())
}

fn shape(field: &Heightfield) -> HeightfieldShape {
    let (f, g) = (field.hill.recip(), field.ridge.recip());
    // |∇(S(u)·S(v))| is 8 at most, and the slope of S is.
    let hills = f64::from(field.hills) * f64::from(f.max_element());
    let ridges = f64::from(field.ridges) * f64::from(g.x).hypot(f64::from(g.y));
    HeightfieldShape {
        k: 1.0,
        a: field.hills,
        fx: f.x,
        fz: f.y,
        b: field.ridges,
        gx: g.x,
        gz: g.y,
        lipschitz: ((8.0 * (hills + ridges)) as f32).next_up(),
    }
}

/// By how much the height of a ray above the ground may be wrong, for rays from within `reach`.
fn error(shape: &HeightfieldShape, reach: DVec3) -> f64 {
    let &HeightfieldShape { a, fx, fz, b, gx, gz, lipschitz, .. } = shape;
    let [a, fx, fz, b, gx, gz, lipschitz] = [a, fx, fz, b, gx, gz, lipschitz].map(f64::from);
    // o + t·d: the product is no longer than origin and point together, and both round.
    let place = 3.0 * reach;
    let place = U * (place.y + lipschitz * place.x.hypot(place.z));
    // Where on the wave, times its slope; then three roundings of the wave itself.
    let along_x = 8.0 * U * fx * reach.x + 3.0 * U;
    let along_z = 8.0 * U * (2.0 * fz * reach.z + 0.25) + 3.0 * U;
    let across = 8.0 * U * 2.0 * (gx * reach.x + gz * reach.z) + 3.0 * U;
    let height = a * (along_x + along_z + 2.0 * U) + b * (across + U) + 2.0 * U * (a + b);
    (place + height) * (1.0 + 1e-6)
}
