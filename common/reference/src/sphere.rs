//! Ray against sphere: a quadratic, solved where it is well conditioned, and exactly.

use dashu::rational::RBig;
use glam::DVec3;

use super::dot2::{dot2, vector_dot2};
use super::rational::rational;
use super::ray::Ray;
use super::surd::Surd;
use super::surface::{ExactSurface, Surface};
use super::vector::Vector;

/// A sphere; its surface, not its interior, is what a ray hits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// The centre.
    pub center: DVec3,
    /// The radius; a sphere whose radius is not positive is never hit.
    pub radius: f64,
}

impl Sphere {
    /// The first hit, with the outward normal, in f64.
    ///
    /// Haines, Günther and Akenine-Möller, *Precision Improvements for Ray/Sphere Intersection*
    /// (Ray Tracing Gems, chapter 7): the discriminant comes from the distance between the centre
    /// and the ray, so that a far sphere does not drown in the square of its distance; the root that
    /// would cancel comes from the product of the roots. `c = |o - C|² - r²`, which decides t for an
    /// origin close to the surface, is a doubled-precision sum.
    pub fn intersect(&self, ray: &Ray) -> Option<Surface> {
        let (d, r) = (ray.direction, self.radius);
        let f = ray.origin - self.center;
        let a = d.length_squared();
        let b = -vector_dot2(f, d);
        let foot = f + d * (b / a);
        // (r - l)(r + l) and not r² - l²: the difference of the squares would cancel near a tangent.
        let l = foot.length();
        let discriminant = a * (r - l) * (r + l);
        // Written so that NaN, which a zero direction makes, is a miss.
        if !(discriminant >= 0.0 && r > 0.0) {
            return None;
        }
        let c = dot2([(f.x, f.x), (f.y, f.y), (f.z, f.z), (-r, r)]);
        let q = b + discriminant.sqrt().copysign(b);
        let roots = if q == 0.0 { [0.0, 0.0] } else { [c / q, q / a] };
        let [near, far] = [roots[0].min(roots[1]), roots[0].max(roots[1])];
        let t = [near, far].into_iter().find(|&t| ray.contains(t))?;
        Some(Surface { t, normal: (foot + d * (t - b / a)).normalize() })
    }

    /// The first hit, with the outward normal, exactly: `t = (-b ∓ √(b² - a·c)) / a`.
    ///
    /// # Panics
    /// If a number of the sphere or of the ray (but `tmin`, `tmax`) is not finite.
    pub fn intersect_exact(&self, ray: &Ray) -> Option<ExactSurface> {
        let d = Vector::from(ray.direction);
        let f = &Vector::from(ray.origin) - &Vector::from(self.center);
        let r = rational(self.radius);
        let t = first_root(&f, &d, &r, ray)?;
        let normal = std::array::from_fn(|i| t.affine(&(&d.0[i] / &r), &(&f.0[i] / &r)));
        Some(ExactSurface { t, normal })
    }
}

/// The first t within the ray's interval with `|f + t·d| = r`, exactly.
pub(super) fn first_root(f: &Vector, d: &Vector, r: &RBig, ray: &Ray) -> Option<Surd> {
    roots(&d.length_squared(), &f.dot(d), &(f.length_squared() - r * r))
        .filter(|_| *r > RBig::ZERO)?
        .into_iter()
        .find(|t| t.within(ray))
}

/// The roots of `a·t² + 2b·t + c`, the smaller first, exactly; `None` if there are none or too many.
pub(super) fn roots(a: &RBig, b: &RBig, c: &RBig) -> Option<[Surd; 2]> {
    let discriminant = b * b - a * c;
    if a.is_zero() || discriminant < RBig::ZERO {
        return None;
    }
    let root = |side: RBig| Surd::new(-b / a, side / a, discriminant.clone());
    Some([root(-RBig::ONE), root(RBig::ONE)])
}

#[cfg(test)]
mod tests {
    use super::super::random::{Random, f32s, towards};
    use super::*;
    use proptest::prelude::*;

    fn unit(center: DVec3) -> Sphere {
        Sphere { center, radius: 1.0 }
    }

    /// Compares both and returns whether they hit.
    ///
    /// The bound: with eps = 2^-53, `foot` is off by a few eps·|f|, which moves the half chord h by
    /// eps·|f|·l/h; c and q are good to a few eps.
    fn agree(sphere: &Sphere, ray: &Ray) -> bool {
        let exact = sphere.intersect_exact(ray).map(|hit| hit.to_f64());
        let plain = sphere.intersect(ray);
        let f = (ray.origin - sphere.center).length();
        let speed = ray.direction.length();
        match (exact, plain) {
            (Some(exact), Some(plain)) => {
                let cosine = exact.normal.dot(ray.direction).abs() / speed;
                let bound = 8.0 * f64::EPSILON * (f / speed / cosine + exact.t);
                assert!(
                    (plain.t - exact.t).abs() <= bound,
                    "{sphere:?} {ray:?} {exact:?} {plain:?}"
                );
                let bound = 16.0 * f64::EPSILON * (1.0 + f / sphere.radius) / cosine;
                assert!((plain.normal - exact.normal).length() <= bound, "{exact:?} {plain:?}");
                true
            }
            (None, None) => false,
            _ => panic!("{sphere:?} {ray:?}: exact {exact:?}, f64 {plain:?}"),
        }
    }

    #[test]
    fn f64_agrees_with_exact_at_every_scale() {
        let mut random = Random(1);
        let mut hits = 0;
        for _ in 0..600 {
            let radius = f64::from(random.scale(1e-4, 1e6) as f32);
            let center = f32s(random.in_cube() * random.scale(1e-3, 1e4));
            let distance = radius * random.scale(1e-3, 1e4);
            let origin = center + random.unit() * distance;
            // Half from afar at the sphere, half from anywhere in any direction.
            let target = center + random.in_cube() * radius * 1.2;
            hits += usize::from(agree(&Sphere { center, radius }, &towards(origin, target)));
        }
        assert!((300..600).contains(&hits), "{hits}");
    }

    #[test]
    fn f64_decides_near_tangents() {
        // Impact parameters 1 ± k·1e-7 seen from 10 away: k = 0 is no f32 tangent, but decided too.
        let (mut hits, mut misses) = (0, 0);
        let mut random = Random(2);
        for step in -40..=40 {
            let axis = random.unit();
            let side = axis.any_orthonormal_vector();
            let impact = 1.0 + f64::from(step) * 1e-7;
            let origin = side * impact - axis * 10.0;
            if agree(&unit(DVec3::ZERO), &towards(origin, side * impact)) {
                hits += 1;
            } else {
                misses += 1;
            }
        }
        assert!(hits > 20 && misses > 20, "{hits} {misses}");
    }

    #[test]
    fn tangents_are_hits() {
        for z in [10.0, 1e6, 1e29] {
            let ray = Ray { direction: DVec3::NEG_Z, ..towards(DVec3::new(1.0, 0.0, z), DVec3::X) };
            assert!(agree(&unit(DVec3::ZERO), &ray));
        }
    }

    #[test]
    fn from_the_surface_only_the_other_side_is_hit() {
        let sphere = unit(DVec3::ZERO);
        let inward = towards(DVec3::Z, DVec3::ZERO);
        assert_eq!(sphere.intersect_exact(&inward).unwrap().to_f64().t, 2.0);
        assert_eq!(sphere.intersect(&inward).unwrap().t, 2.0);
        let outward = towards(DVec3::Z, DVec3::Z * 2.0);
        let tangent = towards(DVec3::Z, DVec3::new(1.0, 0.0, 1.0));
        assert!(!agree(&sphere, &outward) && !agree(&sphere, &tangent));
    }

    #[test]
    fn no_direction_no_radius_no_hit() {
        let still = Ray { direction: DVec3::ZERO, ..towards(DVec3::ZERO, DVec3::X) };
        assert!(!agree(&unit(DVec3::ZERO), &still));
        let ray = towards(DVec3::ZERO, DVec3::X);
        let astray = Ray { origin: DVec3::new(0.0, f64::NAN, 0.0), ..ray };
        assert!(unit(DVec3::ZERO).intersect(&astray).is_none());
        for radius in [0.0, -1.0] {
            assert!(!agree(&Sphere { center: DVec3::X, radius }, &ray));
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        /// The exact root satisfies the sphere's equation, whatever found it.
        #[test]
        fn exact_hits_lie_on_the_sphere(
            o in prop::array::uniform3(-8.0f32..8.0), d in prop::array::uniform3(-1.0f32..1.0),
            radius in 0.5f64..9.0,
        ) {
            let ray = Ray::from_f32(o, d, 0.0, f32::INFINITY);
            let sphere = Sphere { center: DVec3::ZERO, radius };
            if let Some(hit) = sphere.intersect_exact(&ray) {
                let hit = hit.to_f64();
                prop_assert!((hit.normal.length() - 1.0).abs() < 1e-15);
                let error = (ray.at(hit.t) - hit.normal * radius).length();
                prop_assert!(error <= 1e-14 * (1.0 + hit.t * ray.direction.length()));
            }
        }
    }
}
