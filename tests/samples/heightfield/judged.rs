//! The ground as the reference has it, and a verdict on where a rung says that a ray meets it.

use glam::DVec3;
use reference::heightfield::Heightfield;
use reference::{Ray, Surface};

use super::ground::Landscape;
use super::shape::HeightfieldShape;

/// The fault of an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verdict {
    /// Nothing, within the bound.
    Right,
    /// The ray grazes the ground within the bound: it may hit or miss.
    Grazes,
    /// A hit before the ground.
    TooNear,
    /// A hit behind it, in the ground.
    TooFar,
    /// A hit behind it, after the ray has come out of the ground again.
    Through,
    FalseHit,
    FalseMiss,
}

/// The ground as the reference has it, and how far rays from a place may be off.
pub struct Exact {
    pub field: Heightfield,
    low: DVec3,
    high: DVec3,
    pub error: f64,
}

/// A landscape in f64, from the very numbers that the shaders get.
pub fn exact(landscape: Landscape) -> Heightfield {
    let HeightfieldShape { k, a, fx, fz, b, gx, gz, lipschitz } = landscape.shape();
    let [k, a, fx, fz, b, gx, gz, lipschitz] = [k, a, fx, fz, b, gx, gz, lipschitz].map(f64::from);
    Heightfield { k, a, fx, fz, b, gx, gz, lipschitz }
}

impl Exact {
    /// For rays whose origins have coordinates no larger than those.
    pub fn new(landscape: Landscape, origin: DVec3) -> Self {
        // By rounding, a point of the ground may lie above the box; the box's sides count.
        let (low, high) = landscape.bounds(1e-2);
        let error = landscape.error(origin.abs());
        Self { field: exact(landscape), low: low.as_dvec3(), high: high.as_dvec3(), error }
    }

    pub fn height_above(&self, ray: &Ray, t: f64) -> f64 {
        let p = ray.at(t);
        p.y - self.field.height(p.x, p.z).0
    }

    /// The part of a ray in the box.
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

    /// Bound on the height's distance from 0 where one end of the last bracket is above and the other below.
    pub fn bound(&self, ray: &Ray, t: f64) -> f64 {
        let d = ray.direction;
        let gap = t.abs() * 2.0 * 1.2e-7;
        self.error + gap * (self.field.lipschitz * d.x.hypot(d.z) + d.y.abs())
    }

    /// Tests whether the ray is nowhere farther from the ground than the bound, between two places.
    pub fn stays_near(&self, ray: &Ray, from: f64, to: f64) -> bool {
        (0..=64).all(|i| {
            let t = from + (to - from) * f64::from(i) / 64.0;
            self.height_above(ray, t).abs() <= self.bound(ray, t)
        })
    }

    /// Tests whether a ray that meets the ground at `from` leaves it again before `to`.
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
                // How deep does it go before it comes out again, or leaves the box?
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
