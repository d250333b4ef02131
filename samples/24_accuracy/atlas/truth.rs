//! The truth: 64-bit floats decide where their error is proved to be too small to matter, and rationals else.
//!
//! The proof is that of [`Bounds`]: it bounds a watertight triangle test by the error of one rounding, which
//! it takes to be 2^-24. The reference does the same test in 64 bits, where that error is 2^-53.

use reference::Ray;
use reference::bound::Bounds;
use reference::crossing::{Crossing, Shear};
use reference::rational::to_f64;
use reference::transform::{Transform, U};
use reference::triangle::{Triangle, intersect_exact};

/// The error of one rounding in 64 bits by that in 32.
const FINER: f64 = 1.0 / (1u64 << 29) as f64;

/// Of the unit that an error is told in, how much of it may be the truth's own.
const NEGLIGIBLE: f64 = 1.0 / 1024.0;

/// The hit of a ray with a triangle.
#[derive(Clone, Copy, Debug)]
pub struct Hit {
    /// In lengths of the ray's direction.
    pub t: f64,
    /// Of the second and the third corner.
    pub weights: [f64; 2],
}

/// Error bounds of a test in floats, if each rounding is off by `finer` times 2^-24.
pub struct Off {
    /// In lengths of the ray's direction.
    pub t: f64,
    /// Of the second and the third corner.
    pub weights: [f64; 2],
    /// Results that the test may report: a hit, a miss.
    pub may_hit: bool,
    pub may_miss: bool,
}

impl Off {
    /// By the proof of [`Bounds`].
    fn new(ray: &Ray, triangle: &Triangle, crossing: &Crossing, finer: f64) -> Self {
        let bounds = Bounds::new(ray, triangle, &Transform::identity(), crossing.t);
        let edges = bounds.edges.map(|edge| finer * edge);
        // A weight is the volume that the ray spans with an edge, by the sum of all three. A volume is a margin
        // times the length of the edge as seen along the ray.
        let [a, b, c] = *triangle;
        let slope = (b - a).cross(c - a).dot(ray.direction).abs();
        let off = [c - b, a - c, b - a].map(|edge| ray.direction.cross(edge).length() / slope);
        let off = [0, 1, 2].map(|k| off[k] * edges[k]);
        let all = off[0] + off[1] + off[2] + 8.0 * finer * U;
        let weight = |k: usize| off[k] + crossing.weights[k].abs() * all;
        let margins = crossing.margins;
        Self {
            t: finer * bounds.t,
            weights: [weight(1), weight(2)],
            may_hit: (0..3).all(|k| margins[k] >= -edges[k]),
            may_miss: !(0..3).all(|k| margins[k] > edges[k]),
        }
    }
}

/// Decides, and counts how it did.
pub struct Truth {
    /// Rays that rationals alone are still to decide, as a check of the floats.
    pub to_check: usize,
    /// Rays that floats decided, and rationals.
    pub by_floats: u64,
    pub by_rationals: u64,
    /// Rays for which both are known.
    pub checked: u64,
    /// Number of them for which the floats exceeded their bound: none, or the proof is wrong.
    pub beyond: u64,
}

impl Truth {
    /// A row's, of whose rays rationals are to decide `to_check` in any case.
    pub fn new(to_check: usize) -> Self {
        Self { to_check, by_floats: 0, by_rationals: 0, checked: 0, beyond: 0 }
    }

    /// Decides a question: by floats, if they are sure, or by rationals.
    pub fn decide(
        &mut self,
        is_sure: bool,
        floats: bool,
        rationals: impl FnOnce() -> bool,
    ) -> bool {
        if is_sure && self.to_check == 0 {
            self.by_floats += 1;
            return floats;
        }
        self.by_rationals += 1;
        let exact = rationals();
        if is_sure {
            self.check(floats == exact);
        }
        exact
    }

    fn check(&mut self, agree: bool) {
        self.to_check -= 1;
        self.checked += 1;
        self.beyond += u64::from(!agree);
    }

    /// The hit of a ray with a closed triangle, if there is one, and the error bound of a test in 32-bit floats.
    pub fn hit(&mut self, ray: &Ray, triangle: &Triangle) -> (Option<Hit>, Off) {
        let crossing = Shear::new(ray).cross(triangle);
        let off = |finer| Off::new(ray, triangle, &crossing, finer);
        let (own, coarse) = (off(FINER), off(1.0));
        let hit = Hit { t: crossing.t, weights: [crossing.weights[1], crossing.weights[2]] };
        let is_in = own.may_hit && ray.contains(hit.t);
        let is_fine = own.t <= NEGLIGIBLE * ulp(hit.t)
            && (0..2).all(|k| own.weights[k] <= NEGLIGIBLE * ulp(hit.weights[k]));
        let is_sure = own.may_hit != own.may_miss && (!own.may_hit || is_fine);
        if is_sure && self.to_check == 0 {
            self.by_floats += 1;
            return (is_in.then_some(hit), coarse);
        }
        self.by_rationals += 1;
        let exact = exactly(ray, triangle);
        if is_sure {
            self.check(match &exact {
                Some(exact) => is_in && own.covers(&hit, exact),
                None => !is_in,
            });
        }
        (exact, coarse)
    }

    /// Tests whether a ray passes between the outer edges of triangles that have a corner or an edge in common, and
    /// so hits at least one of them. `outer` names those edges of each, by the corner across.
    pub fn hits_one(&mut self, ray: &Ray, fan: &[(Triangle, &[usize])]) -> bool {
        // Seen along the ray, what lies on the inner side of all outer edges lies within the fan.
        let shear = Shear::new(ray);
        let within = |(triangle, outer): &(Triangle, &[usize])| {
            let crossing = shear.cross(triangle);
            let bounds = Bounds::new(ray, triangle, &Transform::identity(), crossing.t);
            outer.iter().all(|&k| crossing.margins[k] > FINER * bounds.edges[k])
        };
        self.decide(fan.iter().all(within), true, || {
            fan.iter().any(|(triangle, _)| exactly(ray, triangle).is_some())
        })
    }
}

impl Off {
    fn covers(&self, hit: &Hit, exact: &Hit) -> bool {
        let near = |k: usize| (hit.weights[k] - exact.weights[k]).abs() <= self.weights[k];
        (hit.t - exact.t).abs() <= self.t && near(0) && near(1)
    }
}

fn exactly(ray: &Ray, triangle: &Triangle) -> Option<Hit> {
    let hit = intersect_exact(ray, triangle)?;
    let [_, b, c] = &hit.weights;
    Some(Hit { t: hit.surface.t.to_f64(), weights: [to_f64(b), to_f64(c)] })
}

/// The distance of the 32-bit floats around `x`.
pub fn ulp(x: f64) -> f64 {
    f64::from_bits(x.to_bits() & (0x7ff << 52)) / f64::from(1 << 23)
}
