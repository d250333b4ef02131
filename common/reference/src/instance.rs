//! The unit sphere under an instance's matrix: an ellipsoid anywhere, found in the sphere's space.

use dashu::rational::RBig;
use glam::{DMat3, DVec3};

use super::rational::rational;
use super::ray::Ray;
use super::sphere::first_root;
use super::surface::Surface;
use super::vector::Vector;

/// The unit sphere under `point ↦ linear·point + translation`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipsoid {
    /// Any matrix that can be inverted: turned, scaled, sheared, mirrored.
    pub linear: DMat3,
    /// Position of the centre.
    pub translation: DVec3,
}

impl Ellipsoid {
    /// The first hit: t exactly and then rounded, the outward normal in f64.
    ///
    /// t is the same in both spaces. The normal is that of the sphere under the inverse transpose, and
    /// is off by a few 2^-53·|o - T|/|p - T|, o the ray's origin, p the hit.
    ///
    /// # Panics
    /// If a number is not finite.
    pub fn intersect(&self, ray: &Ray) -> Option<Surface> {
        let rows = [0, 1, 2].map(|i| Vector::from(self.linear.row(i)));
        // The rows of adjugate and inverse: the columns are cross products of the matrix's rows.
        let columns = [rows[1].cross(&rows[2]), rows[2].cross(&rows[0]), rows[0].cross(&rows[1])];
        let determinant = rows[0].dot(&columns[0]);
        if determinant.is_zero() {
            return None;
        }
        let inverse = |v: &Vector| {
            let row = |i: usize| -> RBig {
                Vector(columns.each_ref().map(|column| column.0[i].clone())).dot(v) / &determinant
            };
            Vector([row(0), row(1), row(2)])
        };
        let origin = inverse(&(&Vector::from(ray.origin) - &Vector::from(self.translation)));
        let direction = inverse(&Vector::from(ray.direction));
        let t = first_root(&origin, &direction, &RBig::ONE, ray)?.to_f64();
        let point = &origin + &(&direction * &rational(t));
        let normal = self.linear.inverse().transpose() * point.to_f64();
        Some(Surface { t, normal: normal.normalize() })
    }
}

#[cfg(test)]
mod tests {
    use super::super::random::{Random, instance, towards};
    use super::super::sphere::Sphere;
    use super::*;

    #[test]
    fn hits_lie_on_the_ellipsoid() {
        let mut random = Random(5);
        let mut hits = 0;
        for _ in 0..300 {
            let rows = instance(&mut random, true).map(|row| row.map(f64::from));
            let column = |k: usize| DVec3::new(rows[0][k], rows[1][k], rows[2][k]);
            let linear = DMat3::from_cols(column(0), column(1), column(2));
            let ellipsoid = Ellipsoid { linear, translation: column(3) };
            let origin = column(3) + random.unit() * linear.determinant().abs().cbrt() * 30.0;
            let target = column(3) + linear * random.in_cube() * 0.8;
            let ray = towards(origin, target);
            let Some(hit) = ellipsoid.intersect(&ray) else { continue };
            hits += 1;
            let on_sphere = linear.inverse() * (ray.at(hit.t) - ellipsoid.translation);
            assert!((on_sphere.length() - 1.0).abs() < 1e-9, "{ellipsoid:?} {ray:?} {hit:?}");
            assert!(hit.normal.dot(ray.direction) < 0.0, "{ellipsoid:?} {ray:?} {hit:?}");
        }
        assert!(hits > 200, "{hits}");
    }

    #[test]
    fn without_shear_it_is_a_sphere() {
        let ball =
            Ellipsoid { linear: DMat3::from_diagonal(DVec3::splat(-3.0)), translation: DVec3::X };
        let ray = towards(DVec3::new(7.0, 2.0, 5.0), DVec3::X);
        let sphere = Sphere { center: DVec3::X, radius: 3.0 };
        let (a, b) =
            (ball.intersect(&ray).unwrap(), sphere.intersect_exact(&ray).unwrap().to_f64());
        assert_eq!(a.t, b.t);
        assert!((a.normal - b.normal).length() < 1e-15);
    }
}
