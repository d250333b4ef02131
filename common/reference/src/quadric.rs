//! Ray against quadric, a surface of degree two: exactly.

use dashu::rational::RBig;
use glam::DVec3;

use super::rational::rational;
use super::ray::Ray;
use super::sphere::roots;
use super::surd::Surd;
use super::surface::Surface;
use super::vector::Vector;

/// The points where a polynomial is 0, by its coefficients of x², y², z², yz, xz, xy, x, y, z and 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quadric(pub [f64; 10]);

impl Quadric {
    /// The t of all hits within the ray's interval, in order, correctly rounded. A tangent counts once; a ray that lies in
    /// the surface has none.
    ///
    /// # Panics
    /// If a number is not finite.
    pub fn hits(&self, ray: &Ray) -> Vec<f64> {
        let [squares, mixed, linear] =
            [0, 3, 6].map(|i| [0, 1, 2].map(|k| rational(self.0[i + k])));
        let rest = rational(self.0[9]);
        let (o, d) = (Vector::from(ray.origin).0, Vector::from(ray.direction).0);
        // The three coefficients term by term, as products of o + t·d.
        let [mut a, mut b, mut c] = [RBig::ZERO, RBig::ZERO, rest];
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            a += &squares[i] * &d[i] * &d[i] + &mixed[i] * &d[j] * &d[k];
            b += RBig::from(2) * &squares[i] * &o[i] * &d[i]
                + &mixed[i] * (&o[j] * &d[k] + &d[j] * &o[k])
                + &linear[i] * &d[i];
            c += &squares[i] * &o[i] * &o[i] + &mixed[i] * &o[j] * &o[k] + &linear[i] * &o[i];
        }
        let half = b / RBig::from(2);
        let mut found = Vec::new();
        if a.is_zero() {
            if !half.is_zero() {
                found.push(Surd::from(-c / (RBig::from(2) * half)));
            }
        } else if let Some([s, t]) = roots(&a, &half, &c) {
            let is_double = &half * &half == &a * &c;
            // Dividing by a negative number swaps them.
            let ordered = if a > RBig::ZERO { [s, t] } else { [t, s] };
            found.extend(ordered.into_iter().take(if is_double { 1 } else { 2 }));
        }
        found.iter().filter(|t| t.within(ray)).map(Surd::to_f64).collect()
    }

    /// The first hit: t exactly and then rounded, the normal in f64, to where the polynomial grows.
    ///
    /// # Panics
    /// If a number is not finite.
    pub fn intersect(&self, ray: &Ray) -> Option<Surface> {
        let t = *self.hits(ray).first()?;
        Some(Surface { t, normal: self.gradient(ray.at(t)).normalize_or_zero() })
    }

    fn gradient(&self, p: DVec3) -> DVec3 {
        let [squares, mixed, linear] =
            [0, 3, 6].map(|i| DVec3::new(self.0[i], self.0[i + 1], self.0[i + 2]));
        let swapped = DVec3::new(
            mixed.z * p.y + mixed.y * p.z,
            mixed.x * p.z + mixed.z * p.x,
            mixed.y * p.x + mixed.x * p.y,
        );
        2.0 * squares * p + swapped + linear
    }
}

#[cfg(test)]
mod tests {
    use super::super::random::{Random, f32s, towards};
    use super::super::sphere::Sphere;
    use super::*;

    fn hits(quadric: [f64; 10], origin: [f64; 3], direction: [f64; 3]) -> Vec<f64> {
        let [origin, direction] = [origin, direction].map(DVec3::from);
        Quadric(quadric).hits(&Ray { origin, direction, tmin: 0.0, tmax: 1e30 })
    }

    #[test]
    fn a_ray_along_an_asymptote_has_one_root_or_none() {
        let cone = [1.0, 1.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        assert_eq!(hits(cone, [3.0, 0.0, -5.0], [0.0, 0.0, 1.0]), [2.0, 8.0]);
        assert_eq!(hits(cone, [3.0, 0.0, -5.0], [1.0, 0.0, 1.0]), [1.0]);
        assert!(hits(cone, [3.0, 0.0, 3.0], [1.0, 0.0, 1.0]).is_empty());
        assert_eq!(hits(cone, [0.0, 0.0, -5.0], [0.0, 0.0, 1.0]), [5.0]);
        let bowl = [1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0];
        assert_eq!(hits(bowl, [2.0, 9.0, 0.0], [0.0, -1.0, 0.0]), [5.0]);
        let saddle = [0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, -1.0, 0.0];
        assert_eq!(hits(saddle, [2.0, 3.0, 9.0], [0.0, 0.0, -1.0]), [3.0]);
        assert!(hits(saddle, [2.0, -3.0, -6.0], [0.0, 1.0, 2.0]).is_empty());
    }

    #[test]
    fn a_sphere_by_its_coefficients_is_the_sphere() {
        let mut random = Random(24);
        let mut met = 0;
        for _ in 0..100 {
            let ray = towards(f32s(random.unit() * 4.0), random.in_cube() * 1.4);
            let found =
                Quadric([1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0]).intersect(&ray);
            let sphere = Sphere { center: DVec3::ZERO, radius: 1.0 }.intersect_exact(&ray);
            let sphere = sphere.map(|hit| hit.to_f64());
            assert_eq!(found.map(|hit| hit.t), sphere.map(|hit| hit.t));
            if let (Some(found), Some(sphere)) = (found, sphere) {
                assert!((found.normal - sphere.normal).length() < 1e-15);
                met += 1;
            }
        }
        assert!(met > 20, "{met}");
    }

    #[test]
    fn hits_are_on_the_surface_in_order() {
        let mut random = Random(63);
        let mut met = 0;
        for _ in 0..200 {
            let numbers = std::array::from_fn(|_| f64::from(random.between(-1.0, 1.0) as f32));
            let quadric = Quadric(numbers);
            let ray = towards(random.unit() * 4.0, random.in_cube());
            let found = quadric.hits(&ray);
            assert!(found.is_sorted() && found.len() <= 2);
            for t in found.into_iter().filter(|t| *t < 4.0) {
                let p = ray.at(t);
                let value = (quadric.gradient(p) + DVec3::from_slice(&numbers[6..9])).dot(p) / 2.0;
                assert!((value + numbers[9]).abs() < 1e-12 * (1.0 + p.length_squared()));
                met += 1;
            }
        }
        assert!(met > 50, "{met}");
    }
}
