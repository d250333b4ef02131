//! Intersections in f64 and exact arithmetic on the CPU, with which the GPU is compared.
//!
//! | file | what it holds |
//! |---|---|
//! | [`Ray`], [`Surface`] | the query, and its answer |
//! | [`rational`], [`vector`] | rational numbers and vectors, exactly those that the f32 or f64 bits denote |
//! | [`surd`] | `p + q·√r`: the root of a quadratic, a unit normal, compared and rounded exactly |
//! | [`sphere`], [`aabb`], [`plane`], [`triangle`] | the intersections, each in f64 and exactly |
//! | [`capsule`], [`swept`], [`instance`] | the same for a capsule, a swept sphere, and a sphere under any matrix |
//! | [`cone`], [`quadric`], [`patch`] | a cone between two discs, which may be a cylinder, a surface of degree two, and a bilinear patch, exactly |
//! | [`torus`], [`polynomial`] | the same for a torus, by Sturm's theorem for polynomials with whole coefficients |
//! | [`voxel`] | the same for the trilinear surface in a voxel |
//! | [`algebraic`] | the same for an algebraic surface of degree four in a box |
//! | [`heightfield`] | a surface of heights, bisected in f64 |
//! | [`occlusion`] | how much of the sky a polygon hides from a point, in closed form |
//! | [`random`] | seeded rays: the same on every machine |
//! | [`solid`] | half-spaces and balls combined: union, intersection, difference, inverse |
//! | [`crossing`] | where a ray's line crosses a triangle's plane, and how near to the border |
//! | [`transform`] | an instance's 3×4 matrix, and how far an f32 ray strays on its way through it |
//! | [`bound`] | how far a triangle test in f32 may be off: the derivation and the numbers |
//! | [`bvh`], [`scene`], [`hit`] | many triangles: closest hit, all hits, near misses |
//! | [`verdict`] | the GPU's answer is right, excused by a bound, or wrong |
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
pub mod algebraic;
pub mod bound;
pub mod bvh;
pub mod capsule;
mod clipped;
pub mod cone;
pub mod crossing;
mod dot2;
pub mod heightfield;
pub mod hit;
pub mod instance;
pub mod occlusion;
pub mod patch;
pub mod plane;
pub mod polynomial;
pub mod quadric;
pub mod random;
pub mod rational;
mod ray;
pub mod scene;
pub mod solid;
pub mod sphere;
pub mod surd;
mod surface;
pub mod swept;
pub mod torus;
pub mod transform;
pub mod triangle;
pub mod ulp;
pub mod vector;
pub mod verdict;
pub mod voxel;

#[cfg(test)]
mod hard_cases;
#[cfg(test)]
mod simulated;

pub use ray::Ray;
pub use surface::{ExactSurface, Surface};
