//! Error bounds of a triangle test in f32: the cases in which a renderer is free, and by how much.
//!
//! # The question
//! The reference knows the margins of a ray: its distances, seen along the ray, to the three edges of
//! a triangle ([`Crossing::margins`]). A GPU computes in f32, so near an edge it may decide either way.
//! Below is a bound on how near, for each edge: if the margin is larger, only one answer is right. The same is done
//! for t. Everything is to first order in u = 2^-24, the relative error of one rounding; a hundredth is added for the
//! higher orders and for the reference's own f64. Overflow, underflow and flushed denormals are left out.
//!
//! # What is assumed
//! The ray goes to object space by an f32 inverse as in [`Transform`]; there the triangle's f32
//! vertices are tested by *Woop's* watertight algorithm (Woop, Benthin and Wald, JCGT 2:1, 2013: what
//! Mesa's lavapipe runs; hardware does not say what it does) or by *Möller and Trumbore's* (Journal of Graphics Tools 2:1,
//! 1997), in f32 with Vulkan's precision: sums and products rounded correctly, divisions within 2.5
//! ULP ≤ 5u. Better arithmetic and `fma` stay within the bound. Names: o, d the ray; A = a - o and so
//! on the vertices relative to it, R the distance of the farthest; e an edge; a prime where a vector
//! is meant in object space; L, T, H of the instance.
//!
//! # 1. The ray strays: both algorithms
//! To the triangle it is as if the ray moved by the vector `s = u·H·(|o| + |T| + R|d|/‖d‖)` at most.
//! A margin is measured along m = d × e / ‖d × e‖, t along the normal n; so this costs `|m|·s` of the
//! margin and `|n|·s / |n·d|` of t.
//!
//! # 2. Woop
//! Coordinates are permuted so that |d_z| is largest, and vertex A becomes the plane point
//! `(A_x - S_x·A_z, A_y - S_y·A_z)` with S_x = d_x/d_z, |S_x| <= 1. Roundings: A itself u; S_x 5u or,
//! by a reciprocal, 6u; product and difference u each. So A_x passes on 2u|A_x|, and A_z up to
//! (6+1+1+1)u|A_z| = 9u|A_z|; both axes together `u·(2‖A_xy‖ + 9√2|A_z|) <= 13u·‖A'‖`: the vertices
//! move by at most **13u·R'**, in the world by `13u·R'·stretch`.
//!
//! *From vertices to the edge.* If both ends of an edge move by δ, its line moves by δ between them,
//! and beyond them by the leverage `|f| + |1 - f|`, where f is the place on the edge line, 0 at one
//! end and 1 at the other, that the ray passes.
//!
//! *The edge function* `C_x·B_y - C_y·B_x` of the moved points is off by `u·‖B‖‖C‖` at most from
//! the two products; the difference keeps its sign. In the plane of the shear lengths exceed those
//! seen along the ray by √3 at most, so as a margin this is `3u·‖d'×B'‖‖d'×C'‖·|det L| / (‖d'‖‖d×e‖)`.
//!
//! # 3. Möller and Trumbore
//! `U = (o - a)·(d × e2)`: o - a and e2 are off by u, a cross product costs 2u more, a scalar
//! product 3u: at most 7u times the sum with every sign positive, which is at most √2 times the
//! product of the three lengths. So **10u·‖A'‖‖d'‖‖e'‖**, as a margin times `|det L| / ‖d×e‖`: it grows
//! where an edge is nearly parallel to the ray. V likewise with e1. The third edge is decided by
//! `U/det + V/det <= 1`, which suffers from U, V, det (10u·‖e1'‖‖d'‖‖e2'‖) and 8u of quotient and sum.
//!
//! # 4. t
//! Woop: a move of the vertices by δ moves the plane by δ and t by `δ‖n‖/|n·d|`; lengthwise a vertex
//! moves 8u·‖A'‖, so δ is 16u·R'. The products' errors weigh the differences of the vertices' depths,
//! at most √3 times the longest edge over ‖d'‖. Möller and Trumbore: `t = e2·q / det`, so
//! `10u·‖e1'‖‖e2'‖(‖A'‖ + t‖d'‖) / |det'|`. Both: sums, quotient and
//! result 12u of t and of those differences.
//!
//! Roundings seldom all add up: in the tests below, errors reach a seventh of the bounds where an
//! instance is only shifted and a twentieth where it is turned and sheared.
//!
//! # 5. The boxes on the way
//! A hierarchy offers the triangle only if the ray meets its boxes. Unpadded slabs `(lo - o)·(1/d)`
//! are off by 7u of themselves, as if the faces moved by 7u·R; a box of an instance in the world is
//! off by 3 roundings of `|L||v| + |T|`. Both are less than what 1 and 2 allow, and a triangle lies
//! within its box: a ray that passes deeper inside the triangle meets the box too.

use glam::DVec3;

use super::crossing::Crossing;
use super::ray::Ray;
use super::transform::{Transform, U};
use super::triangle::Triangle;

/// Allowance for higher orders in u and the f64 of this computation.
const HIGHER_ORDERS: f64 = 1.01;

/// Error bounds of an f32 test of one ray with one triangle; derived in the module's comment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// For each edge, in the units of [`Crossing::margins`]; infinite where an edge is seen end-on.
    pub edges: [f64; 3],
    /// For t, in lengths of the ray's direction; infinite where the triangle is seen edge-on.
    pub t: f64,
}

/// The edge that decides: how near the ray passes to it, and how near is too near to tell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Graze {
    /// Distance to the edge, seen along the ray, in world units; negative outside.
    pub margin: f64,
    /// Below this distance an f32 test may decide either way.
    pub bound: f64,
}

impl Graze {
    /// True if an f32 test may find a hit.
    pub fn may_hit(&self) -> bool {
        self.margin >= -self.bound
    }

    /// True if an f32 test may find a miss.
    pub fn may_miss(&self) -> bool {
        self.margin <= self.bound
    }
}

impl Bounds {
    /// Derives the bounds for a ray and a triangle in world space; `t` is where they meet.
    ///
    /// `transform` is that of the instance; the triangle's vertices in object space were f32.
    pub fn new(ray: &Ray, triangle: &Triangle, transform: &Transform, t: f64) -> Self {
        let d = ray.direction;
        let relative = triangle.map(|v| v - ray.origin);
        let [a1, b1, c1] = relative.map(|v| transform.inverse * v);
        let object = [a1, b1, c1];
        let d1 = transform.inverse * d;
        let reach = relative.map(DVec3::length).into_iter().fold(0.0, f64::max);
        let reach1 = object.map(DVec3::length).into_iter().fold(0.0, f64::max);
        let stray = transform.stray(ray.origin, d.abs() * (reach / d.length()));
        let (e1, e2) = ((b1 - a1).length(), (c1 - a1).length());
        let volume = transform.determinant.abs();

        // Möller and Trumbore number their edges from vertex a: U belongs to ca, V to ab.
        let pair = 10.0 * U * a1.length() * d1.length();
        let (error_u, error_v) = (pair * e2, pair * e1);
        let error_det = 10.0 * U * e1 * d1.length() * e2;
        let moller = [error_u + error_v + 1.8 * error_det, error_u, error_v];

        let mut products = 0.0;
        let edges = std::array::from_fn(|k| {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            let (b, edge) = (relative[i], relative[j] - relative[i]);
            let product =
                3.0 * U * d1.cross(object[i]).length() * d1.cross(object[j]).length() / d1.length();
            products += product;
            let across = d.cross(edge);
            let seen = across.length();
            if seen == 0.0 {
                return f64::INFINITY;
            }
            let foot = -d.cross(b).dot(across) / (seen * seen);
            let leverage = foot.abs() + (1.0 - foot).abs();
            let woop = leverage * 13.0 * U * reach1 * transform.stretch + product * volume / seen;
            let strayed = leverage * across.abs().dot(stray) / seen;
            HIGHER_ORDERS * (strayed + woop.max(moller[k] * volume / seen))
        });

        let n = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
        let slope = n.dot(d).abs();
        let longest = e1.max(e2).max((c1 - b1).length());
        let depths = 3f64.sqrt() * longest / d1.length();
        let woop = (16.0 * U * reach1 * transform.stretch * n.length()
            + products * volume * depths)
            / slope;
        let moller = 10.0 * U * e1 * e2 * (a1.length() + t.abs() * d1.length()) * volume / slope;
        let t = HIGHER_ORDERS
            * (n.abs().dot(stray) / slope + woop.max(moller) + 12.0 * U * (t.abs() + depths));
        // Edge-on, 0/0 and NaN say the same as infinity: nothing is known of t.
        Self { edges, t: if slope > 0.0 { t } else { f64::INFINITY } }
    }

    /// The edge that decides over hit and miss: the least margin, measured by its bound.
    pub fn graze(&self, crossing: &Crossing) -> Graze {
        let edges = std::array::from_fn::<_, 3, _>(|k| Graze {
            margin: crossing.margins[k],
            bound: self.edges[k],
        });
        let measure = |edge: &Graze| edge.margin / edge.bound;
        (edges.into_iter())
            .min_by(|p, q| measure(p).total_cmp(&measure(q)))
            .expect("a triangle has three edges")
    }
}

#[cfg(test)]
mod tests {
    use super::super::crossing::Shear;
    use super::super::random::{Random, f32s, instance, towards};
    use super::super::simulated::{Test, apply, invert, moller_trumbore, woop};
    use super::*;

    /// The result of a sweep of rays close to edges.
    #[derive(Debug, Default)]
    struct Sweep {
        /// Number of cases in which f32 decides differently from f64, and the largest margin among them in units
        /// of the bound.
        flips: usize,
        worst_flip: f64,
        /// The largest error of t in units of its bound.
        worst_t: f64,
        /// Hits that are sure, so that the sweep is known to have tested t.
        sure: usize,
    }

    fn sweep(test: Test, turned: bool) -> Sweep {
        let mut random = Random(11);
        let mut found = Sweep::default();
        for round in 0..100_000 {
            let rows = instance(&mut random, turned);
            let transform = Transform::from_rows(rows).unwrap();
            let size = random.scale(1e-2, 10.0);
            let thin = if round % 3 == 0 { random.scale(1e-3, 1.0) } else { 1.0 };
            let local = {
                let [a, b] = [0, 0].map(|_| random.in_cube() * size);
                [a, b, a.lerp(b, random.between(-0.5, 1.5)) + random.in_cube() * size * thin]
                    .map(f32s)
            };
            let triangle = local.map(|v| transform.point(v));
            // Off a point of an edge by up to twice the bound, most often by far less: errors seldom add up.
            let k = random.below(3);
            let (b, c) = (triangle[(k + 1) % 3], triangle[(k + 2) % 3]);
            let target = b.lerp(c, random.between(0.0, 1.0));
            // Along a diagonal of the axes, where a shear errs the most, and anywhere.
            let diagonal = random.in_cube().signum() + random.in_cube() * 1e-3;
            let away = [random.unit(), diagonal][round % 2];
            let origin = target + away * random.scale(0.1, 300.0);
            let aim = towards(origin, target);
            let near = Bounds::new(&aim, &triangle, &transform, 1.0).edges[k];
            let across = (target - origin).cross(c - b).normalize_or_zero();
            let ray =
                towards(origin, target + across * near * 2.0 * random.between(-1.0, 1.0).powi(5));

            let crossing = Shear::new(&ray).cross(&triangle);
            let bounds = Bounds::new(&ray, &triangle, &transform, crossing.t);
            let graze = bounds.graze(&crossing);
            let inverse = invert(rows);
            let o = apply(inverse, ray.origin.as_vec3(), 1.0);
            let d = apply(inverse, ray.direction.as_vec3(), 0.0);
            let answer = test(o, d, local.map(|v| v.as_vec3()));
            if answer.is_some() != crossing.inside {
                found.flips += 1;
                found.worst_flip = found.worst_flip.max(graze.margin.abs() / graze.bound);
            } else if let Some(t) = answer.filter(|_| !graze.may_miss()) {
                found.sure += 1;
                found.worst_t = found.worst_t.max((f64::from(t) - crossing.t).abs() / bounds.t);
            }
        }
        found
    }

    #[test]
    fn tests_in_f32_stay_within_the_bounds_and_make_use_of_them() {
        for (test, name) in [(woop as Test, "Woop"), (moller_trumbore, "Möller-Trumbore")] {
            for turned in [false, true] {
                let found = sweep(test, turned);
                println!("{name}, turned {turned}: {found:?}");
                assert!(found.worst_flip <= 1.0 && found.worst_t <= 1.0, "{found:?}");
                // A bound that is never approached would be no bound but a licence.
                let used = if turned { 0.03 } else { 0.08 };
                assert!(found.worst_flip > used && found.worst_t > used, "{found:?}");
                assert!(found.flips > 1000 && found.sure > 1000, "{found:?}");
            }
        }
    }

    #[test]
    fn a_triangle_before_the_camera_is_free_by_less_than_a_thousandth_of_a_pixel() {
        // Five units away, 500 pixels across five units: a pixel is 0.01 wide.
        let triangle = [DVec3::ZERO, DVec3::X, DVec3::Y];
        let ray = towards(DVec3::new(0.3, 0.3, 5.0), DVec3::new(0.3, 0.1, 0.0));
        let bounds = Bounds::new(&ray, &triangle, &Transform::identity(), 1.0);
        assert!(bounds.edges.iter().all(|&edge| edge < 1e-5), "{bounds:?}");
        assert!(bounds.t < 3e-6, "{bounds:?}");
    }

    #[test]
    fn bounds_scale_with_the_world() {
        let triangle = [DVec3::ZERO, DVec3::X, DVec3::Y];
        let ray = towards(DVec3::new(0.3, 0.2, 5.0), DVec3::new(0.3, 0.1, 0.0));
        let bounds = Bounds::new(&ray, &triangle, &Transform::identity(), 1.0);
        let s = 1024.0;
        let large = Ray { origin: ray.origin * s, direction: ray.direction * s, ..ray };
        let large = Bounds::new(&large, &triangle.map(|v| v * s), &Transform::identity(), 1.0);
        assert_eq!(large.edges, bounds.edges.map(|edge| edge * s));
        assert_eq!(large.t, bounds.t);
    }

    #[test]
    fn edge_on_nothing_is_known_of_t_and_little_of_the_edges() {
        let triangle = [DVec3::ZERO, DVec3::X, DVec3::Y];
        let ray = Ray { direction: DVec3::X, ..towards(DVec3::new(-1.0, 0.25, 0.0), DVec3::ZERO) };
        let crossing = Shear::new(&ray).cross(&triangle);
        let bounds = Bounds::new(&ray, &triangle, &Transform::identity(), crossing.t);
        assert_eq!((bounds.t, bounds.edges[2]), (f64::INFINITY, f64::INFINITY));
        let graze = bounds.graze(&crossing);
        assert!(graze.may_hit() && graze.may_miss());
        // A tenth of a unit away from the plane, it cannot be hit.
        let away = Ray { origin: DVec3::new(-1.0, 0.25, 0.1), ..ray };
        let crossing = Shear::new(&away).cross(&triangle);
        let graze =
            Bounds::new(&away, &triangle, &Transform::identity(), crossing.t).graze(&crossing);
        assert!(!graze.may_hit(), "{graze:?}");
    }
}
