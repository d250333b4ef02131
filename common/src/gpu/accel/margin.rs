//! Padding: a device needs a box a little larger than the shape's own.

use glam::{DVec3, Vec3};

use crate::gpu::accel::order::Bounds;

/// The padding on each side that keeps a box test from losing a ray, for rays that begin at most `reach` from the
/// box along each axis.
///
/// The test computes the distance to a wall w as `(w - o)·(1 / d)`. If the device is no less precise than a shader
/// has to be, the error is at most 1 ULP for the difference, 2.5 for the reciprocal and 1 for the product (Vulkan
/// specification, appendix "Vulkan Environment for SPIR-V", Precision and Operation of SPIR-V Instructions; the
/// 2.5 ULP apply to a divisor from 2^-126 to 2^126). One ULP is at most 2u, relative, u = 2^-24: that is 9u, and a
/// tenth for the products of errors.
pub fn margin(reach: f32) -> f32 {
    10.0 * 0.5f32.powi(24) * reach
}

/// A box with that margin, rounded outwards.
///
/// A device may compute `w·(1 / d) - o·(1 / d)` instead, and round the second product separately. That product is
/// off by at most 2u of a coordinate o, which is at most |w| + `reach`. The part of `reach` replaces the
/// difference above, so the margin needs 2u·|w| more. Vulkan does not specify how boxes are tested; an NVIDIA H200
/// loses rays in a way that fits this formula.
///
/// A reach of 0 means no padding.
///
/// ```no_run
/// use raybook::prelude::*;
///
/// /// The box of a unit sphere for rays that begin no farther than 100 from it.
/// fn unit_sphere(gpu: &Gpu) -> Result<Buffer> {
///     boxes_on_gpu(gpu, "sphere", &[padded((Vec3::NEG_ONE, Vec3::ONE), 100.0)])
/// }
/// ```
// ANCHOR: padded_box
pub fn padded((low, high): Bounds, reach: f32) -> [Vec3; 2] {
    if reach == 0.0 {
        return [low, high];
    }
    let coordinate = low.abs().max(high.abs()).as_dvec3();
    let margin = DVec3::splat(margin(reach).into()) + 0.5f64.powi(23) * coordinate;
    [down(low.as_dvec3() - margin), -down(-(high.as_dvec3() + margin))]
}
// ANCHOR_END: padded_box

/// An upper bound of the distance from a ray's origin to a shape: rays start at the eye or, as shadow rays do,
/// anywhere on the scene. Rounded up to a power of two, so that few steps of a camera change it.
pub fn reach((low, high): Bounds, eye: Vec3) -> f32 {
    let farthest = (eye - low).abs().max((eye - high).abs()).max(high - low);
    farthest.length().log2().ceil().exp2()
}

/// The box around a sphere, rounded outwards.
pub fn sphere_bounds(center: Vec3, radius: f32) -> Bounds {
    let (center, radius) = (center.as_dvec3(), f64::from(radius));
    (down(center - radius), -down(-(center + radius)))
}

/// Rounded to f32, but never up.
fn down(v: DVec3) -> Vec3 {
    let down = |x: f64| if f64::from(x as f32) > x { (x as f32).next_down() } else { x as f32 };
    v.to_array().map(down).into()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A sequence of numbers between 0 and 1.
    struct Random(u32);

    impl Random {
        fn next(&mut self) -> f32 {
            self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (self.0 >> 8) as f32 / 16_777_216.0
        }

        fn vector(&mut self) -> Vec3 {
            Vec3::new(self.next(), self.next(), self.next())
        }
    }

    /// The formula a device uses for the distance to a wall w.
    #[derive(Clone, Copy, Debug)]
    enum Way {
        /// `(w - o)·(1 / d)`
        Difference,
        /// `w·(1 / d) - o·(1 / d)`, all but the second product and the reciprocal rounded once.
        Products,
    }

    /// Bound on the error of the distance to a wall, with 1 ULP per operation and 2.5 for the reciprocal.
    fn off(way: Way, w: f64, o: f64, d: f64) -> f64 {
        let ulps = |ulps: &[f64]| ulps.iter().map(|ulp| 1.0 + ulp / 8_388_608.0).product::<f64>();
        let time = ((w - o) / d).abs();
        match way {
            Way::Difference => time * (ulps(&[1.0, 2.5, 1.0]) - 1.0),
            Way::Products => {
                let product = (o / d).abs() * (ulps(&[2.5, 1.0]) - ulps(&[2.5])) * ulps(&[1.0]);
                time * (ulps(&[2.5, 1.0]) - 1.0) + product
            }
        }
    }

    /// The interval a ray spends in a box: exact, or with the latest entry and earliest exit that rounding allows.
    fn stay(o: Vec3, d: Vec3, [low, high]: [Vec3; 2], way: Option<Way>) -> (f64, f64) {
        let (mut enter, mut leave) = (f64::MIN, f64::MAX);
        for axis in 0..3 {
            let [o, d, low, high] = [o, d, low, high].map(|v| f64::from(v[axis]));
            let [a, b] =
                [low, high].map(|w| ((w - o) / d, way.map_or(0.0, |way| off(way, w, o, d))));
            let (first, last) = if a.0 < b.0 { (a, b) } else { (b, a) };
            enter = enter.max(first.0 + first.1);
            leave = leave.min(last.0 - last.1);
        }
        (enter, leave)
    }

    /// Sends rays to boxes as far from the origin as given. Returns how many hit their box, and how many of these
    /// the worst test loses without padding.
    fn hunt(way: Way, far: f32) -> (u32, u32) {
        let (mut random, mut tried, mut without) = (Random(1), 0, 0);
        for _ in 0..200_000 {
            let low = far * (2.0 * random.vector() - 1.0);
            let size = (-20.0 * random.next()).exp2() * random.vector();
            let (low, high) = (low, low + size);
            let reach = (12.0 * random.next()).exp2();
            // Through a corner, an edge or a wall, or close by, from as far away as allowed.
            let at = random.vector().map(|x| if x < 0.6 { x.round() } else { x });
            let o = low + (random.vector() * 2.0 - 1.0) * (reach - 1.0);
            let d = low + at * (high - low) - o;
            if d.abs().min_element() < 1e-30 {
                continue;
            }
            let (enter, leave) = stay(o, d, [low, high], None);
            if enter > leave {
                continue;
            }
            tried += 1;
            let (enter, leave) = stay(o, d, [low, high], Some(way));
            without += u32::from(enter > leave);
            let (enter, leave) = stay(o, d, padded((low, high), reach), Some(way));
            assert!(enter <= leave, "{o} {d} {low} {high}: {enter} > {leave}");
        }
        (tried, without)
    }

    #[test]
    fn the_worst_test_that_vulkan_allows_loses_no_ray() {
        for (way, far) in [(Way::Difference, 1.0), (Way::Products, 1.0), (Way::Products, 1000.0)] {
            let (tried, without) = hunt(way, far);
            println!("{way:?}, {far}: {without} of {tried}");
            assert!(
                tried > 50_000 && without > 10_000,
                "{way:?}, {far}: {without} of {tried} are lost without"
            );
        }
    }

    #[test]
    fn without_a_reach_a_box_stays_as_it_is() {
        let bounds = (Vec3::new(-0.1, 1e9, 1e-30), Vec3::new(0.3, 2e9, 1e30));
        assert_eq!(padded(bounds, 0.0), [bounds.0, bounds.1]);
    }
}
