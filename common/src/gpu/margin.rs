//! Room around a shape: the box that a device is given is a little larger than the shape's own.

use glam::{DVec3, Vec3};

use super::order::Bounds;

// ANCHOR: margin
/// How much larger on each side a box has to be lest a test of it lose a ray, if rays begin at most `reach`
/// from it, along each axis.
///
/// The test's time of a wall w is `(w - o)·(1 / d)`. If the device computes it no worse than it has to
/// compute the same in a shader, it may be off by 1 ULP for the difference, 2.5 for the reciprocal and 1
/// for the product (Vulkan specification, appendix "Vulkan Environment for SPIR-V", Precision and
/// Operation of SPIR-V Instructions; 2.5 ULP hold for a divisor from 2^-126 to 2^126). One ULP is 2u at
/// most, relative, u = 2^-24: that is 9u, and a tenth for the products of errors.
pub fn margin(reach: f32) -> f32 {
    10.0 * 0.5f32.powi(24) * reach
}

/// A box with that margin, rounded outwards.
///
/// ```no_run
/// use raybook::prelude::*;
///
/// /// The box of a unit sphere for rays that begin no farther than 100 from it.
/// fn unit_sphere(gpu: &Gpu) -> Result<Buffer> {
///     boxes_on_gpu(gpu, "sphere", &[padded((Vec3::NEG_ONE, Vec3::ONE), 100.0)])
/// }
/// ```
pub fn padded((low, high): Bounds, reach: f32) -> [Vec3; 2] {
    let margin = DVec3::splat(margin(reach).into());
    [down(low.as_dvec3() - margin), -down(-(high.as_dvec3() + margin))]
}
// ANCHOR_END: margin

/// Rounded to f32, but never up.
fn down(v: DVec3) -> Vec3 {
    let down = |x: f64| if f64::from(x as f32) > x { (x as f32).next_down() } else { x as f32 };
    v.to_array().map(down).into()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers between 0 and 1, one after the other.
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

    /// From when to when a ray is in a box, as late and as early as rounding may make it: each of three
    /// operations off by its bound, `[difference, reciprocal, product]` in ULP.
    fn stay(o: Vec3, d: Vec3, [low, high]: [Vec3; 2], ulps: [f64; 3]) -> (f64, f64) {
        let off: f64 = ulps.iter().map(|ulp| 1.0 + ulp / 8_388_608.0).product();
        let (mut enter, mut leave) = (f64::MIN, f64::MAX);
        for axis in 0..3 {
            let time =
                |wall: Vec3| (f64::from(wall[axis]) - f64::from(o[axis])) / f64::from(d[axis]);
            let (a, b) = (time(low), time(high));
            let (first, last) = (a.min(b), a.max(b));
            enter = enter.max(first + first.abs() * (off - 1.0));
            leave = leave.min(last - last.abs() * (off - 1.0));
        }
        (enter, leave)
    }

    #[test]
    fn the_worst_test_that_vulkan_allows_loses_no_ray() {
        let (mut random, mut tried, mut without) = (Random(1), 0, 0);
        for _ in 0..200_000 {
            let low = 2.0 * random.vector() - 1.0;
            let size = (-20.0 * random.next()).exp2() * random.vector();
            let (low, high) = (low, low + size);
            let reach = (12.0 * random.next()).exp2();
            // Through a corner, an edge or a wall, or close by, from as far away as may be.
            let at = random.vector().map(|x| if x < 0.6 { x.round() } else { x });
            let o = low + (random.vector() * 2.0 - 1.0) * (reach - 1.0);
            let d = low + at * (high - low) - o;
            if d.abs().min_element() < 1e-30 {
                continue;
            }
            let (enter, leave) = stay(o, d, [low, high], [0.0; 3]);
            if enter > leave {
                continue;
            }
            tried += 1;
            let worst = |boxed| stay(o, d, boxed, [1.0, 2.5, 1.0]);
            let (enter, leave) = worst([low, high]);
            without += u32::from(enter > leave);
            let (enter, leave) = worst(padded((low, high), reach));
            assert!(enter <= leave, "{o} {d} {low} {high}: {enter} > {leave}");
        }
        assert!(tried > 50_000 && without > 10_000, "{without} of {tried} are lost without");
    }

    #[test]
    fn without_a_reach_a_box_stays_as_it_is() {
        let bounds = (Vec3::new(-0.1, 1e9, 1e-30), Vec3::new(0.3, 2e9, 1e30));
        assert_eq!(padded(bounds, 0.0), [bounds.0, bounds.1]);
    }
}
