//! Ray against capsule: a cylinder between two half spheres, exactly.

use glam::DVec3;

use super::rational::rational;
use super::ray::Ray;
use super::sphere::roots;
use super::surd::Surd;
use super::surface::Surface;
use super::vector::Vector;

/// All points at a distance from a segment; with `a = b` a sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capsule {
    /// One end of the segment.
    pub a: DVec3,
    /// The other end.
    pub b: DVec3,
    /// The distance, above 0.
    pub radius: f64,
}

impl Capsule {
    /// The first hit: t exactly and then rounded, the outward normal in f64.
    ///
    /// Each part gives two roots. Those of the cylinder count between the ends, those of a sphere
    /// beyond its end; a joint belongs to both.
    ///
    /// # Panics
    /// If a number is not finite.
    pub fn intersect(&self, ray: &Ray) -> Option<Surface> {
        let (d, r) = (Vector::from(ray.direction), rational(self.radius));
        let axis = &Vector::from(self.b) - &Vector::from(self.a);
        let from_a = &Vector::from(ray.origin) - &Vector::from(self.a);
        let from_b = &Vector::from(ray.origin) - &Vector::from(self.b);
        let square = axis.length_squared();
        let (along, rate) = (from_a.dot(&axis), d.dot(&axis));
        // The position along the axis, times its length: 0 at a, `square` at b.
        let height = |t: &Surd| t.affine(&rate, &along);

        let mut found: Vec<Surd> = Vec::new();
        let mut keep = |t: Surd, counts: bool| {
            if counts && t.within(ray) {
                found.push(t);
            }
        };
        for (end, is_b) in [(&from_a, false), (&from_b, true)] {
            let c = end.length_squared() - &r * &r;
            for t in roots(&d.length_squared(), &end.dot(&d), &c).into_iter().flatten() {
                let beyond = if is_b {
                    height(&t).compare(&square).is_ge()
                } else {
                    height(&t).sign().is_le()
                };
                keep(t, beyond);
            }
        }
        let a = d.length_squared() * &square - &rate * &rate;
        let b = from_a.dot(&d) * &square - &along * &rate;
        let c = from_a.length_squared() * &square - &along * &along - &r * &r * &square;
        for t in roots(&a, &b, &c).into_iter().flatten() {
            let between = height(&t).sign().is_ge() && height(&t).compare(&square).is_le();
            keep(t, between);
        }
        let t = found.iter().map(Surd::to_f64).min_by(f64::total_cmp)?;
        let point = ray.at(t);
        let part = if square.is_zero() {
            0.0
        } else {
            ((point - self.a).dot(self.b - self.a) / (self.b - self.a).length_squared())
                .clamp(0.0, 1.0)
        };
        let normal = (point - self.a - part * (self.b - self.a)).normalize();
        Some(Surface { t, normal })
    }
}

#[cfg(test)]
mod tests {
    use super::super::random::{Random, f32s, towards};
    use super::super::sphere::Sphere;
    use super::*;

    #[test]
    fn hits_are_as_far_from_the_segment_as_they_should_be() {
        let mut random = Random(6);
        let mut hits = 0;
        for _ in 0..300 {
            let (a, b) = (f32s(random.in_cube()), f32s(random.in_cube()));
            let capsule = Capsule { a, b, radius: 0.25 };
            let ray = towards(random.unit() * 9.0, random.in_cube());
            let Some(hit) = capsule.intersect(&ray) else { continue };
            hits += 1;
            let point = ray.at(hit.t);
            let part = ((point - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
            let distance = (point - a - part * (b - a)).length();
            assert!((distance - 0.25).abs() < 1e-13, "{capsule:?} {ray:?} {hit:?}");
            assert!(hit.normal.dot(ray.direction) <= 0.0);
        }
        assert!((50..250).contains(&hits), "{hits}");
    }

    #[test]
    fn without_length_it_is_a_sphere() {
        let ray = towards(DVec3::new(2.0, 3.0, 9.0), DVec3::new(0.1, 0.2, 0.0));
        let capsule = Capsule { a: DVec3::ZERO, b: DVec3::ZERO, radius: 0.5 };
        let sphere = Sphere { center: DVec3::ZERO, radius: 0.5 };
        let (a, b) =
            (capsule.intersect(&ray).unwrap(), sphere.intersect_exact(&ray).unwrap().to_f64());
        assert_eq!(a.t, b.t);
    }
}
