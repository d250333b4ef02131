//! Ray against torus: a polynomial of degree four with whole coefficients, and its roots exactly.

use dashu::rational::RBig;
use glam::DVec3;

use super::polynomial::{Dyadic, Polynomial, Sturm};
use super::rational::{rational, to_f64};
use super::ray::Ray;
use super::surface::Surface;
use super::vector::Vector;

/// All points at a distance from a circle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Torus {
    /// The circle's centre.
    pub center: DVec3,
    /// Perpendicular to the circle, of any length but 0.
    pub axis: DVec3,
    /// The circle's radius.
    pub major: f64,
    /// The distance: the radius of the tube, at most `major`.
    pub minor: f64,
}

impl Torus {
    /// The polynomial in t that is 0 where the ray meets the torus, negative in the tube, times a positive number.
    ///
    /// `lift` is added to it, in units of `4·R·r·(R + r)²`: a positive number makes the tube thinner.
    pub fn polynomial(&self, ray: &Ray, lift: f64) -> Polynomial {
        let [n, d] = [self.axis, ray.direction].map(Vector::from);
        let f = &Vector::from(ray.origin) - &Vector::from(self.center);
        let [major, minor] = [self.major, self.minor].map(rational);
        let [two, four] = [2, 4].map(RBig::from);
        let w = &four * &major * &major / n.length_squared();
        // Q = dd·t² + 2·fd·t + m and Z = h + rate·t; the torus is Q² + w·Z² = 4R²r².
        let (dd, fd) = (d.length_squared(), f.dot(&d));
        let m = f.length_squared() - &major * &major - &minor * &minor;
        let (h, rate) = (f.dot(&n), d.dot(&n));
        let size = &major + &minor;
        let level = &four * &major * &minor * (&major * &minor - rational(lift) * &size * &size);
        Polynomial::new(&[
            &m * &m + &w * &h * &h - level,
            &four * &fd * &m + &two * &w * &h * &rate,
            &four * &fd * &fd + &two * &dd * &m + &w * &rate * &rate,
            &four * &dd * &fd,
            &dd * &dd,
        ])
    }

    /// The t of all hits within the ray's interval, in order, to f64; a tangent counts once.
    ///
    /// # Panics
    /// If a number is not finite (but `tmax`).
    pub fn roots(&self, ray: &Ray, lift: f64) -> Vec<f64> {
        let roots = self.intervals(ray, lift, 64);
        roots.iter().map(|[_, high]| to_f64(&high.rational())).collect()
    }

    /// The hits within the ray's interval, in order, each enclosed within 2^-`bits` of itself.
    pub fn intervals(&self, ray: &Ray, lift: f64, bits: usize) -> Vec<[Dyadic; 2]> {
        if ray.direction == DVec3::ZERO {
            return Vec::new();
        }
        // No hit is beyond the ball around the torus.
        let f = ray.origin - self.center;
        let farthest = (f.length() + self.major + self.minor) / ray.direction.length();
        let end = ray.tmax.min((2.0 * farthest).log2().ceil().exp2());
        Sturm::new(&self.polynomial(ray, lift)).roots(ray.tmin, end, bits)
    }

    /// The first hit: t exactly and then rounded, the outward normal in f64.
    ///
    /// # Panics
    /// If a number is not finite (but `tmax`).
    pub fn intersect(&self, ray: &Ray) -> Option<Surface> {
        let t = *self.roots(ray, 0.0).first()?;
        Some(Surface { t, normal: self.normal(ray.at(t)) })
    }

    /// The outward normal at a point of the surface: away from the nearest point of the circle.
    pub fn normal(&self, point: DVec3) -> DVec3 {
        let n = self.axis.normalize();
        let p = point - self.center;
        let across = p - p.dot(n) * n;
        ((across.length() - self.major) * across.normalize_or_zero() + p.dot(n) * n).normalize()
    }

    /// The distance from a point to the surface; negative in the tube.
    pub fn distance(&self, point: DVec3) -> f64 {
        let n = self.axis.normalize();
        let p = point - self.center;
        let across = p - p.dot(n) * n;
        (across.length() - self.major).hypot(p.dot(n)) - self.minor
    }
}

#[cfg(test)]
mod tests {
    use super::super::random::{Random, f32s, towards};
    use super::*;

    fn upright(minor: f64) -> Torus {
        Torus { center: DVec3::ZERO, axis: DVec3::Y, major: 1.0, minor }
    }

    fn roots(torus: &Torus, origin: [f64; 3], direction: [f64; 3]) -> Vec<f64> {
        let [origin, direction] = [origin, direction].map(DVec3::from);
        torus.roots(&Ray { origin, direction, tmin: 0.0, tmax: 1e30 }, 0.0)
    }

    #[test]
    fn known_rays_have_their_known_hits() {
        let torus = upright(0.25);
        assert_eq!(roots(&torus, [-4.0, 0.0, 0.0], [1.0, 0.0, 0.0]), [2.75, 3.25, 4.75, 5.25]);
        assert_eq!(roots(&torus, [1.0, 4.0, 0.0], [0.0, -1.0, 0.0]), [3.75, 4.25]);
        assert!(roots(&torus, [0.0, 4.0, 0.0], [0.0, -1.0, 0.0]).is_empty(), "through the hole");
        // Tangent to the outer and to the inner equator, and along the top, where all of the circle is touched.
        assert_eq!(roots(&torus, [1.25, 0.0, -4.0], [0.0, 0.0, 1.0]), [4.0]);
        let inner = roots(&torus, [0.75, 0.0, -4.0], [0.0, 0.0, 1.0]);
        assert_eq!(inner, [3.0, 4.0, 5.0]);
        assert_eq!(roots(&torus, [1.0, 0.25, -4.0], [0.0, 0.0, 1.0]), [4.0]);
        assert_eq!(roots(&torus, [1.0, 0.0, 0.0], [1.0, 0.0, 0.0]), [0.25]);
        assert_eq!(roots(&torus, [1.25, 0.0, 0.0], [-2.0, 0.0, 0.0]), [0.25, 1.0, 1.25]);
    }

    /// The cases and answers of another program: `tests/data/torus_cases.py`.
    #[test]
    fn every_hard_case_has_its_hits() {
        const CASES: &str =
            concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/torus_cases.json");
        let text =
            std::fs::read_to_string(CASES).unwrap_or_else(|error| panic!("{CASES}: {error}"));
        let file: serde_json::Value = serde_json::from_str(&text).unwrap();
        let cases = file["cases"].as_array().unwrap();
        for case in cases {
            // Inputs are f32 numbers, written as decimals of f64.
            let number = |of: &serde_json::Value| of.as_f64().unwrap();
            let vector = |key: &str| DVec3::from([0, 1, 2].map(|i| number(&case[key][i])));
            let torus = Torus {
                center: vector("center"),
                axis: vector("axis"),
                major: number(&case["major"]),
                minor: number(&case["minor"]),
            };
            let ray = Ray {
                origin: vector("origin"),
                direction: vector("direction"),
                tmin: number(&case["tmin"]),
                tmax: 1e30,
            };
            let hits = case["hits"].as_array().unwrap().iter().map(|hit| hit.as_str().unwrap());
            let hits: Vec<f64> = hits.map(|hit| hit.parse().unwrap()).collect();
            assert_eq!(torus.roots(&ray, 0.0), hits, "{}", case["id"]);
        }
        assert!(cases.len() > 30);
    }

    #[test]
    fn without_a_hole_its_middle_is_one_point() {
        assert_eq!(roots(&upright(1.0), [0.0, 4.0, 0.0], [0.0, -1.0, 0.0]), [4.0]);
        assert_eq!(roots(&upright(1.0), [-4.0, 0.0, 0.0], [1.0, 0.0, 0.0]), [2.0, 4.0, 6.0]);
    }

    #[test]
    fn hits_are_as_far_from_the_circle_as_they_should_be() {
        let mut random = Random(33);
        let mut hits = 0;
        for _ in 0..200 {
            let (center, axis) = (f32s(random.in_cube()), f32s(random.unit() * 3.0));
            let torus = Torus { center, axis, major: 0.75, minor: 0.25 };
            let ray = towards(random.unit() * 9.0, center + random.in_cube());
            let roots = torus.roots(&ray, 0.0);
            assert!(roots.len() <= 4 && roots.is_sorted());
            for t in roots {
                hits += 1;
                assert!(torus.distance(ray.at(t)).abs() < 1e-13, "{torus:?} {ray:?} {t}");
            }
        }
        assert!(hits > 100, "{hits}");
    }

    #[test]
    fn a_lift_makes_the_tube_thinner() {
        let torus = upright(0.25);
        let ray = towards(DVec3::new(1.25, 0.0, -4.0), DVec3::new(1.25, 0.0, 4.0));
        assert!(torus.roots(&ray, 1e-12).is_empty());
        assert_eq!(torus.roots(&ray, -1e-12).len(), 2);
    }
}
