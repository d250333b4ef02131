//! Ray against a cone between two discs, and so against a cylinder: exactly.

use std::cmp::Ordering;

use dashu::rational::RBig;
use glam::DVec3;

use super::rational::{rational, sign};
use super::ray::Ray;
use super::sphere::roots;
use super::surd::Surd;
use super::surface::Surface;
use super::vector::Vector;

/// The side of a cone between two discs, and the discs themselves if it is closed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// The middle of the first disc.
    pub a: DVec3,
    /// The middle of the second, which is another point.
    pub b: DVec3,
    /// The radii of the two discs, at least 0.
    pub radii: [f64; 2],
    /// True if the discs are part of the surface.
    pub is_closed: bool,
}

/// A part of the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Part {
    Side,
    Disc(usize),
}

impl Cone {
    /// The t of all hits within the ray's interval, in order, correctly rounded. A tangent counts once, and so does a rim,
    /// where side and disc meet. A ray that lies within a disc's plane or in the side has no hit with that part.
    ///
    /// # Panics
    /// If a number is not finite.
    pub fn hits(&self, ray: &Ray) -> Vec<f64> {
        self.parts(ray).into_iter().map(|(t, _)| t).collect()
    }

    /// The first hit: t exactly and then rounded, the outward normal in f64.
    ///
    /// # Panics
    /// If a number is not finite.
    pub fn intersect(&self, ray: &Ray) -> Option<Surface> {
        let (t, part) = *self.parts(ray).first()?;
        let axis = self.b - self.a;
        let normal = match part {
            Part::Disc(0) => -axis,
            Part::Disc(_) => axis,
            Part::Side => {
                let from = ray.at(t) - self.a;
                let height = from.dot(axis) / axis.length_squared();
                let slope = (self.radii[1] - self.radii[0]) / axis.length();
                let across = (from - height * axis).normalize_or_zero();
                across - slope * axis.normalize()
            }
        };
        Some(Surface { t, normal: normal.normalize() })
    }

    fn parts(&self, ray: &Ray) -> Vec<(f64, Part)> {
        let (d, axis) =
            (Vector::from(ray.direction), &Vector::from(self.b) - &Vector::from(self.a));
        let from = &Vector::from(ray.origin) - &Vector::from(self.a);
        let [ra, rb] = self.radii.map(rational);
        let widening = &rb - &ra;
        let square = axis.length_squared();
        let (along, rate) = (from.dot(&axis), d.dot(&axis));
        // In units of the axis' squared length: the radius at a height h is ra·square + widening·h.
        let (radius, growth) = (&ra * &square + &widening * &along, &widening * &rate);
        let a = &square * (&square * d.length_squared() - &rate * &rate) - &growth * &growth;
        let b = &square * (&square * from.dot(&d) - &along * &rate) - &radius * &growth;
        let c = &square * (&square * from.length_squared() - &along * &along) - &radius * &radius;

        let mut side: Vec<Surd> = Vec::new();
        if a.is_zero() {
            if !b.is_zero() {
                side.push(Surd::from(-c / (RBig::from(2) * b)));
            }
        } else if let Some([low, high]) = roots(&a, &b, &c) {
            let is_double = &b * &b == &a * &c;
            side.push(low);
            if !is_double {
                side.push(high);
            }
        }
        side.retain(|t| {
            let height = t.affine(&rate, &along);
            height.sign().is_ge() && height.compare(&square).is_le() && t.within(ray)
        });
        let mut found: Vec<(f64, Part)> = Vec::new();
        if self.is_closed && !rate.is_zero() {
            for (end, (r, height)) in [(ra, RBig::ZERO), (rb, square.clone())].iter().enumerate() {
                let t = (height - &along) / &rate;
                let across = &(&from + &(&d * &t)) - &(&axis * &(height / &square));
                let is_within = sign(&(across.length_squared() - r * r)) != Ordering::Greater;
                let is_known = side.iter().any(|other| other.compare(&t).is_eq());
                let t = Surd::from(t);
                if is_within && !is_known && t.within(ray) {
                    found.push((t.to_f64(), Part::Disc(end)));
                }
            }
        }
        found.extend(side.iter().map(|t| (t.to_f64(), Part::Side)));
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        found
    }
}

#[cfg(test)]
mod tests {
    use super::super::random::{Random, f32s, towards};
    use super::*;

    fn hits(cone: &Cone, origin: [f64; 3], direction: [f64; 3]) -> Vec<f64> {
        let [origin, direction] = [origin, direction].map(DVec3::from);
        cone.hits(&Ray { origin, direction, tmin: 0.0, tmax: 1e30 })
    }

    fn upright(radii: [f64; 2], is_closed: bool) -> Cone {
        Cone { a: DVec3::ZERO, b: DVec3::Y * 4.0, radii, is_closed }
    }

    #[test]
    fn known_rays_have_their_known_hits() {
        let (can, pipe) = (upright([1.0, 1.0], true), upright([1.0, 1.0], false));
        assert_eq!(hits(&can, [-4.0, 2.0, 0.0], [1.0, 0.0, 0.0]), [3.0, 5.0]);
        // Along the axis: through both discs, and through the pipe.
        assert_eq!(hits(&can, [0.5, 8.0, 0.0], [0.0, -1.0, 0.0]), [4.0, 8.0]);
        assert!(hits(&pipe, [0.5, 8.0, 0.0], [0.0, -1.0, 0.0]).is_empty());
        // Along the wall, and in the plane of a disc.
        assert_eq!(hits(&can, [1.0, 8.0, 0.0], [0.0, -1.0, 0.0]), [4.0, 8.0]);
        assert!(hits(&pipe, [1.0, 8.0, 0.0], [0.0, -1.0, 0.0]).is_empty());
        assert_eq!(hits(&can, [-4.0, 4.0, 0.0], [1.0, 0.0, 0.0]), [3.0, 5.0]);
        // A tangent, and a ray across a rim, which are met once.
        assert_eq!(hits(&can, [1.0, 2.0, -4.0], [0.0, 0.0, 1.0]), [4.0]);
        assert_eq!(hits(&can, [-2.0, 3.0, 0.0], [1.0, 1.0, 0.0]), [1.0]);
        assert_eq!(hits(&can, [0.0, 5.0, 0.0], [1.0, -1.0, 0.0]), [1.0]);
        assert_eq!(hits(&can, [-1.0, 5.0, 0.0], [0.5, -1.0, 0.0]), [1.0, 4.0]);
    }

    #[test]
    fn a_cone_has_an_apex_and_lines_along_which_one_root_is_left() {
        let cone = upright([0.0, 3.0], false);
        // Along the side at x = 3y/4: the line itself, and a parallel one inside.
        assert!(hits(&cone, [-3.0, -4.0, 0.0], [3.0, 4.0, 0.0]).is_empty());
        assert_eq!(hits(&cone, [-3.75, -4.0, 0.0], [0.75, 1.0, 0.0]), [4.5]);
        // Through the apex.
        assert_eq!(hits(&cone, [-4.0, 0.0, 0.0], [1.0, 0.0, 0.0]), [4.0]);
        assert_eq!(hits(&cone, [0.0, -4.0, 0.0], [0.0, 1.0, 0.0]), [4.0]);
        let closed = upright([0.0, 3.0], true);
        assert_eq!(hits(&closed, [0.0, -4.0, 0.0], [0.0, 1.0, 0.0]), [4.0, 8.0]);
        assert_eq!(hits(&closed, [-3.0, -4.0, 0.0], [3.0, 4.0, 0.0]), [1.0, 2.0]);
    }

    #[test]
    fn hits_are_on_the_surface_and_a_closed_one_is_entered_and_left() {
        let mut random = Random(62);
        let mut met = 0;
        for round in 0..400 {
            let (a, b) = (f32s(random.in_cube()), f32s(random.in_cube()));
            let radii = [0.25, [0.25, 0.5, 0.0][round % 3]];
            let closed = Cone { a, b, radii, is_closed: true };
            let ray = towards(random.unit() * 9.0, random.in_cube());
            let all = closed.parts(&ray);
            assert!(all.len() == 2 || all.is_empty(), "{closed:?} {ray:?}: {all:?}");
            let open = Cone { is_closed: false, ..closed }.hits(&ray);
            let side: Vec<f64> =
                all.iter().filter(|(_, part)| *part == Part::Side).map(|(t, _)| *t).collect();
            assert_eq!(open, side);
            let axis = b - a;
            for (t, part) in all {
                met += 1;
                let from = ray.at(t) - a;
                let height = from.dot(axis) / axis.length_squared();
                let across = (from - height * axis).length();
                let radius = radii[0] + (radii[1] - radii[0]) * height;
                match part {
                    Part::Side => assert!((across - radius).abs() < 1e-13),
                    Part::Disc(end) => {
                        assert!((height - end as f64).abs() < 1e-13 && across <= radii[end]);
                    }
                }
            }
            if let Some(hit) = closed.intersect(&ray) {
                assert!(hit.normal.dot(ray.direction) < 0.0);
            }
        }
        assert!(met > 100, "{met}");
    }
}
