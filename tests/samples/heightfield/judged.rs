//! The reference's ground, and a verdict on a rung's hit with it.

use glam::DVec3;
use reference::heightfield::Heightfield;
use reference::{Ray, Surface};

use super::ground::Landscape;
use super::shape::HeightfieldShape;

/// The verdict on an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verdict {
    /// Right, within the bound.
    Right,
    /// The ray grazes the ground within the bound, so it may hit or miss.
    Grazes,
    /// A hit before the ground.
    TooNear,
    /// A hit behind it, inside the ground.
    TooFar,
    /// A hit behind it, after the ray has left the ground again.
    Through,
    FalseHit,
    FalseMiss,
}

/// The reference's ground, and the error bound of rays from a place.
pub struct Exact {
    pub field: Heightfield,
    low: DVec3,
    high: DVec3,
    pub error: f64,
}

/// A landscape in f64, from the same numbers as the shaders.
pub fn exact(landscape: Landscape) -> Heightfield {
    let HeightfieldShape { k, a, fx, fz, b, gx, gz, lipschitz } = landscape.shape();
    let [k, a, fx, fz, b, gx, gz, lipschitz] = [k, a, fx, fz, b, gx, gz, lipschitz].map(f64::from);
    Heightfield { k, a, fx, fz, b, gx, gz, lipschitz }
}

impl Exact {
    /// The ground for rays whose origins have no larger coordinates than these.
    pub fn new(landscape: Landscape, origin: DVec3) -> Self {
        // Rounding may move a point of the ground above the box, so the box's sides count.
        let (low, high) = landscape.bounds(1e-2);
        let error = landscape.error(origin.abs());
        Self { field: exact(landscape), low: low.as_dvec3(), high: high.as_dvec3(), error }
    }

    pub fn height_above(&self, ray: &Ray, t: f64) -> f64 {
        let p = ray.at(t);
        p.y - self.field.height(p.x, p.z).0
    }

    /// The part of a ray inside the box.
    fn within(&self, ray: &Ray) -> Option<Ray> {
        let (a, b) =
            ((self.low - ray.origin) / ray.direction, (self.high - ray.origin) / ray.direction);
        let tmin = a.min(b).max_element().max(ray.tmin);
        let tmax = a.max(b).min_element().min(ray.tmax);
        (tmin < tmax).then_some(Ray { tmin, tmax, ..*ray })
    }

    pub fn hit(&self, ray: &Ray) -> Option<Surface> {
        self.field.intersect(&self.within(ray)?)
    }

    /// Bound on the height at the hit, if the last bracket's ends are above and below the ground.
    pub fn bound(&self, ray: &Ray, t: f64) -> f64 {
        let d = ray.direction;
        let gap = t.abs() * 2.0 * 1.2e-7;
        self.error + gap * (self.field.lipschitz * d.x.hypot(d.z) + d.y.abs())
    }

    /// Returns whether the ray stays within the bound of the ground between two distances.
    pub fn stays_near(&self, ray: &Ray, from: f64, to: f64) -> bool {
        (0..=64).all(|i| {
            let t = from + (to - from) * f64::from(i) / 64.0;
            self.height_above(ray, t).abs() <= self.bound(ray, t)
        })
    }

    /// Returns whether a ray that hits the ground at `from` leaves it again before `to`.
    fn comes_out(&self, ray: &Ray, from: f64, to: f64) -> bool {
        let side = self.height_above(ray, from - 1e-6).signum();
        let between = (1..1000).map(|i| from + (to - from) * f64::from(i) / 1000.0);
        { between }.any(|t| side * self.height_above(ray, t) > self.bound(ray, t))
    }

    pub fn judge(&self, ray: &Ray, found: Option<f64>, exact: Option<&Surface>) -> Verdict {
        match (found, exact) {
            (None, None) => Verdict::Right,
            (Some(found), Some(&Surface { t, .. })) => {
                if self.stays_near(ray, found, t) {
                    Verdict::Right
                } else if found < t && self.height_above(ray, found).abs() <= self.bound(ray, found)
                {
                    Verdict::Grazes
                } else if found < t {
                    Verdict::TooNear
                } else if self.comes_out(ray, t, found) {
                    Verdict::Through
                } else {
                    Verdict::TooFar
                }
            }
            (Some(found), None) => {
                let near = self.height_above(ray, found).abs() <= self.bound(ray, found);
                if near { Verdict::Grazes } else { Verdict::FalseHit }
            }
            (None, Some(&Surface { t, .. })) => {
                // The depth it reaches before it leaves the ground or the box.
                let end = self.within(ray).map_or(t, |ray| ray.tmax);
                let side = self.height_above(ray, t - 1e-9 * t.max(1.0)).signum();
                let steps = (0..).map(|i| t + 1e-7 * 1.1f64.powi(i)).take_while(|t| *t < end);
                let depths = steps.map(|t| -side * self.height_above(ray, t));
                let deepest = depths.take_while(|depth| *depth >= 0.0).fold(0.0, f64::max);
                if deepest <= self.bound(ray, t) { Verdict::Grazes } else { Verdict::FalseMiss }
            }
        }
    }
}
