//! Ray against plane, in the two forms that scenes use.

use std::cmp::Ordering;

use dashu::rational::RBig;
use glam::DVec3;

use super::dot2::{dot2, vector_dot2};
use super::rational::{rational, sign};
use super::ray::Ray;
use super::surd::Surd;
use super::surface::{ExactSurface, Surface};
use super::vector::Vector;

/// POV-Ray's plane `{<A,B,C>, D}`: all points p with `normal·p = distance·|normal|`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// `<A,B,C>`: any length but 0; it points to the outside.
    pub normal: DVec3,
    /// `D`: distance of the plane from the world's origin, along the normal.
    pub distance: f64,
}

/// The plane through a point: all points p with `normal·(p - point) = 0`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointPlane {
    /// Any point of the plane.
    pub point: DVec3,
    /// Any length but 0.
    pub normal: DVec3,
}

impl Plane {
    /// The hit in f64, with the normal facing the ray's origin.
    ///
    /// `t = (D·|N| - o·N) / (d·N)`, both sums in doubled precision; what remains is the rounding of
    /// |N|, so the height of the origin above the plane is off by at most 2^-52·|D|.
    pub fn intersect(&self, ray: &Ray) -> Option<Surface> {
        let (n, o) = (self.normal, ray.origin);
        let height = dot2([(self.distance, n.length()), (-o.x, n.x), (-o.y, n.y), (-o.z, n.z)]);
        meet(ray, n, height)
    }

    /// The hit, exactly: `t = (D·√(N·N) - o·N) / (d·N)`, the normal facing the ray's origin.
    ///
    /// # Panics
    /// If a number of the plane or of the ray (but `tmin`, `tmax`) is not finite.
    pub fn intersect_exact(&self, ray: &Ray) -> Option<ExactSurface> {
        let n = Vector::from(self.normal);
        let height = -Vector::from(ray.origin).dot(&n);
        let height = Surd::new(height, rational(self.distance), n.length_squared());
        meet_exact(ray, &n, &height)
    }
}

impl PointPlane {
    /// The hit in f64, with the normal facing the ray's origin: `t = (point - o)·N / (d·N)`.
    ///
    /// A `point` near the origin of the ray keeps the difference exact, and with it t.
    pub fn intersect(&self, ray: &Ray) -> Option<Surface> {
        let (n, o, p) = (self.normal, ray.origin, self.point);
        // Not (p - o)·N: that difference would round where the two are of unlike magnitude.
        let height =
            dot2([(p.x, n.x), (-o.x, n.x), (p.y, n.y), (-o.y, n.y), (p.z, n.z), (-o.z, n.z)]);
        meet(ray, n, height)
    }

    /// The hit, exactly, with the normal facing the ray's origin.
    ///
    /// # Panics
    /// If a number of the plane or of the ray (but `tmin`, `tmax`) is not finite.
    pub fn intersect_exact(&self, ray: &Ray) -> Option<ExactSurface> {
        let n = Vector::from(self.normal);
        let height = (&Vector::from(self.point) - &Vector::from(ray.origin)).dot(&n);
        meet_exact(ray, &n, &Surd::from(height))
    }
}

/// `height` is what the ray has to gain along `n`, times |n|.
fn meet(ray: &Ray, n: DVec3, height: f64) -> Option<Surface> {
    let slope = vector_dot2(ray.direction, n);
    let t = height / slope;
    (slope != 0.0 && ray.contains(t))
        .then(|| Surface { t, normal: n.normalize() * -slope.signum() })
}

fn meet_exact(ray: &Ray, n: &Vector, height: &Surd) -> Option<ExactSurface> {
    let slope = Vector::from(ray.direction).dot(n);
    let side = match sign(&slope) {
        Ordering::Equal => return None,
        Ordering::Less => RBig::ONE,
        Ordering::Greater => -RBig::ONE,
    };
    let t = height.affine(&(RBig::ONE / slope), &RBig::ZERO);
    t.within(ray).then(|| ExactSurface { t, normal: n.normalized(&side) })
}

#[cfg(test)]
mod tests {
    use super::super::random::{Random, f32s, towards};
    use super::*;
    use proptest::prelude::*;

    /// Compares f64 with exact: `height_error` is how far off the height above the plane may be.
    fn agree(exact: Option<ExactSurface>, plain: Option<Surface>, ray: &Ray, height_error: f64) {
        let exact = exact.map(|hit| hit.to_f64());
        let (Some(exact), Some(plain)) = (exact, plain) else {
            assert_eq!(exact, plain, "{ray:?}");
            return;
        };
        let slope = exact.normal.dot(ray.direction).abs();
        let bound = 4.0 * f64::EPSILON * exact.t + height_error / slope;
        assert!((plain.t - exact.t).abs() <= bound, "{ray:?}: {exact:?} {plain:?}");
        assert!((plain.normal - exact.normal).length() <= 4.0 * f64::EPSILON);
        assert!(exact.normal.dot(ray.direction) < 0.0);
    }

    #[test]
    fn f64_agrees_with_exact_down_to_grazing_rays() {
        let mut random = Random(3);
        for _ in 0..600 {
            let normal = f32s(random.in_cube() * random.scale(1e-20, 1e18));
            let distance = f64::from((random.between(-1.0, 1.0) * random.scale(1e-3, 1e7)) as f32);
            let n = normal.normalize();
            let foot = n * distance + n.any_orthonormal_vector() * random.scale(1e-2, 1e3);
            let origin = foot + n * random.scale(1e-3, 1e3);
            let along = n.any_orthogonal_vector();
            // Slopes from steep to 1e-8, upwards as well as downwards.
            let slope = random.scale(1e-8, 1.0) * if random.below(4) == 0 { 1.0 } else { -1.0 };
            let ray = towards(origin, origin + along + n * slope);
            let plane = Plane { normal, distance };
            let error = 2f64.powi(-51) * distance.abs();
            agree(plane.intersect_exact(&ray), plane.intersect(&ray), &ray, error);
            let plane = PointPlane { point: f32s(foot), normal };
            agree(plane.intersect_exact(&ray), plane.intersect(&ray), &ray, 1e-24 * foot.length());
        }
    }

    #[test]
    fn parallel_rays_and_rays_in_the_plane_miss() {
        let normal = DVec3::new(1.0, 2.0, 3.0);
        for origin in [DVec3::ZERO, DVec3::ONE] {
            let ray = Ray { direction: DVec3::new(2.0, -1.0, 0.0), ..towards(origin, origin) };
            assert!(Plane { normal, distance: 0.0 }.intersect(&ray).is_none());
            assert!(Plane { normal, distance: 0.0 }.intersect_exact(&ray).is_none());
            assert!(PointPlane { normal, point: DVec3::ZERO }.intersect(&ray).is_none());
        }
        // 0.1f32·3 - 0.3f32 is not 0, and must not be taken for it.
        let direction = f32s(DVec3::new(0.3, -0.1, 0.0));
        let ray = Ray { direction, ..towards(DVec3::Y, DVec3::ZERO) };
        let plane = Plane { normal: DVec3::new(1.0, 3.0, 0.0), distance: 0.0 };
        let (hit, exact) = (plane.intersect(&ray), plane.intersect_exact(&ray));
        assert_eq!(hit.is_some(), exact.is_some());
    }

    #[test]
    fn no_normal_no_hit() {
        let ray = towards(DVec3::Y, DVec3::ZERO);
        let plane = Plane { normal: DVec3::ZERO, distance: 0.0 };
        assert!(plane.intersect(&ray).is_none() && plane.intersect_exact(&ray).is_none());
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        /// The two forms of one plane are hit at the same t where both are exact: a normal of length 5.
        #[test]
        fn forms_agree(o in prop::array::uniform3(-9.0f32..9.0), d in prop::array::uniform3(-1.0f32..1.0), distance in -5i8..5) {
            let normal = DVec3::new(3.0, 0.0, 4.0);
            let distance = f64::from(distance) * 5.0;
            let ray = Ray::from_f32(o, d, 0.0, f32::INFINITY);
            let a = Plane { normal, distance }.intersect_exact(&ray);
            let b = PointPlane { normal, point: normal * distance / 5.0 }.intersect_exact(&ray);
            prop_assert_eq!(a.map(|hit| hit.to_f64()), b.map(|hit| hit.to_f64()));
        }
    }
}
