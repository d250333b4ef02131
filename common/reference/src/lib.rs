//! f64 and exact intersections on the CPU: what the GPU is held to.
//!
//! | file | what it holds |
//! |---|---|
//! | [`exact`] | rational numbers and vectors, exactly those that the f32 or f64 bits denote |
//! | [`surd`] | `p + q·√r`: the root of a quadratic, a unit normal, compared and rounded exactly |
//! | [`sphere`], [`aabb`], [`plane`], [`triangle`] | the intersections, each in f64 and exactly |
//! | [`capsule`], [`instance`] | the same for a capsule, and for a sphere under any matrix |
//! | [`heightfield`] | a surface of heights, bisected in f64 |
//! | [`random`] | seeded rays: the same on every machine |
//! | [`solid`] | half-spaces and balls combined: union, intersection, difference, inverse |
//! | [`crossing`] | where a ray's line meets a triangle's plane, and how near to the border |
//! | [`transform`] | an instance's 3×4 matrix, and how far an f32 ray strays on its way through it |
//! | [`bound`] | how far a triangle test in f32 may be off: the derivation and the numbers |
//! | [`bvh`], [`scene`], [`hit`] | many triangles: closest hit, all hits, near misses |
//! | [`verdict`] | is the GPU's answer right, excused by a bound, or wrong |
//! | [`ulp`] | error in units in the last place of an f32 |
//!
//! # Conventions
//! - A hit is the smallest real root t with `tmin < t <= tmax`; the far root counts where the near
//!   one lies before tmin. t is for the direction as given, which need not be a unit vector.
//! - Surfaces are closed: tangency, the border of a box and the edge of a triangle are hits.
//! - Rays parallel to a plane, rays within it, and rays without a direction miss.
//! - Normals are unit vectors: outward for spheres and boxes, towards the side that the ray comes
//!   from for planes and triangles.
//! - Numbers are finite, except that `tmax` may be infinite. The f64 functions take NaN for a miss;
//!   the exact ones panic on it, since a rational number cannot say NaN.

pub mod aabb;
pub mod bound;
pub mod bvh;
pub mod capsule;
pub mod crossing;
pub mod exact;
pub mod heightfield;
pub mod hit;
pub mod instance;
pub mod plane;
pub mod random;
pub mod scene;
pub mod solid;
pub mod sphere;
pub mod surd;
pub mod transform;
pub mod triangle;
pub mod ulp;
pub mod verdict;

#[cfg(test)]
mod hard_cases;
#[cfg(test)]
mod simulated;

use glam::{DVec3, Vec3};
use surd::Surd;

/// A ray `origin + t·direction` with `tmin < t <= tmax`, in world space.
///
/// Every f32 is an f64, so a ray made from the bits that the GPU wrote is the very ray it traced.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where t is 0.
    pub origin: DVec3,
    /// What t multiplies; any length but 0.
    pub direction: DVec3,
    /// Lower end of the interval, itself excluded.
    pub tmin: f64,
    /// Upper end of the interval, itself included; may be infinite.
    pub tmax: f64,
}

impl Ray {
    /// The ray that these f32 bits denote, without rounding.
    pub fn from_f32(origin: [f32; 3], direction: [f32; 3], tmin: f32, tmax: f32) -> Self {
        Self {
            origin: Vec3::from(origin).as_dvec3(),
            direction: Vec3::from(direction).as_dvec3(),
            tmin: tmin.into(),
            tmax: tmax.into(),
        }
    }

    /// The point at parameter `t`, rounded to f64.
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + t * self.direction
    }

    /// Whether `tmin < t <= tmax`; false for NaN.
    pub fn contains(&self, t: f64) -> bool {
        self.tmin < t && t <= self.tmax
    }
}

/// Where a ray meets a surface, in f64.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// Ray parameter of the hit, in lengths of the ray's direction.
    pub t: f64,
    /// Unit normal at the hit; the module's conventions say which of the two.
    pub normal: DVec3,
}

/// Where a ray meets a surface, exactly.
#[derive(Clone, Debug)]
pub struct ExactSurface {
    /// Ray parameter of the hit, in lengths of the ray's direction.
    pub t: Surd,
    /// Unit normal at the hit; the module's conventions say which of the two.
    pub normal: [Surd; 3],
}

impl ExactSurface {
    /// The same, each number correctly rounded to the nearest f64.
    pub fn to_f64(&self) -> Surface {
        Surface {
            t: self.t.to_f64(),
            normal: DVec3::from_array(self.normal.each_ref().map(Surd::to_f64)),
        }
    }
}

/// The sum of products `Σ a·b`, as good as if computed with twice f64's precision and rounded once.
///
/// Algorithm Dot2 of Ogita, Rump and Oishi, *Accurate Sum and Dot Product* (SIAM J. Sci. Comput. 26,
/// 2005, algorithm 5.3): the rounding error of every product and of every sum is itself an f64,
/// which is added at the end. Where the products are exact (factors that came from f32) and the sum
/// is zero, the result is zero, so rays parallel to a plane are recognised.
pub(crate) fn dot2<const N: usize>(terms: [(f64, f64); N]) -> f64 {
    let (mut sum, mut error) = (0.0, 0.0);
    for (a, b) in terms {
        let product = a * b;
        let product_error = a.mul_add(b, -product);
        let next = sum + product;
        let back = next - sum;
        error += ((sum - (next - back)) + (product - back)) + product_error;
        sum = next;
    }
    sum + error
}

/// [`dot2`] of two vectors.
pub(crate) fn vector_dot2(a: DVec3, b: DVec3) -> f64 {
    dot2([(a.x, b.x), (a.y, b.y), (a.z, b.z)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ray_keeps_the_bits_and_its_open_and_closed_ends() {
        let ray = Ray::from_f32([0.1, -0.0, 3e-45], [1e38, 0.3, -7.0], 0.5, 2.0);
        assert_eq!(ray.origin.x as f32, 0.1);
        assert_eq!(ray.origin.z as f32, 3e-45);
        assert_eq!(ray.direction.y, f64::from(0.3f32));
        assert!(!ray.contains(0.5) && ray.contains(0.5 + 1e-16 * 4.0));
        assert!(ray.contains(2.0) && !ray.contains(2.0 + 1e-15) && !ray.contains(f64::NAN));
    }

    #[test]
    fn dot2_keeps_what_a_plain_sum_loses() {
        // 1 vanishes beside 1e32 in f64; the plain sum gives 0.
        assert_eq!(dot2([(1e16, 1e16), (1.0, 1.0), (-1e16, 1e16)]), 1.0);
        let x = f64::from(0.1f32);
        assert_eq!(dot2([(x, x), (x, x), (-2.0 * x, x)]), 0.0);
    }
}
