//! Error bounds of an f32 test of a ray with a solid: the cases in which a renderer is free, and by how much.
//!
//! # The question
//! Along a ray, an answer in f32 and the exact one can part only where two changes are so close that
//! rounding may exchange them, or where a ball is so nearly touched that it may be hit or not. So each
//! change gets an interval that holds whatever f32 makes of its t. To first order in u = 2^-24; a hundredth
//! is added for the rest. Assumed is Vulkan's precision: sums and products rounded correctly, divisions
//! within 2.5 ULP <= 5u, square roots within 9u.
//!
//! # Half-spaces
//! The test is `t = h / s` with the height `h = D·|N| - o·N` and the slope `s = d·N`, both sums as by
//! *Dot2* (Ogita, Rump and Oishi 2005): off by `u·|sum| + 16u²·S`, where S is the sum with every sign
//! positive. With the division, t is off by **7u·|t| + 16u²·(S_h + |t|·S_s) / |s|**. Where s is no larger
//! than its error, nothing is known.
//!
//! # Balls
//! The test is that of Haines, Günther and Akenine-Möller: f = o - C, its foot across the ray, a
//! discriminant, and the roots q/a and c/q.
//!
//! *Across.* f is off by u·|f|, the product in the foot by u·|f|, its sum by u·r. Squares, difference
//! and product with a round the discriminant as if r were off by 4u·r. What is wrong along the ray,
//! 11u·|f| at most, lengthens the foot in the second order. So it is as if the radius were off by
//! **e = u·(2|f| + 5r) + (11u·|f|)² / 2r**: the true root lies between those of the balls of r - e and
//! r + e, and if only the larger is met, the ball may be hit or not.
//!
//! *Along.* b is off by 3u·|f||d|; a, root, sum and division cost 18u of t; and c is off by
//! u·(5|f|² + 2r²), which the division by q passes on. In lengths of d:
//! **18u·|t| + (3u·|f| + u·(5|f|² + 2r²) / (|b|/|d| + h)) / |d|**, h being half the chord.
//!
//! # Instances
//! A ray that comes to the solid's space by an inverse in f32 has strayed
//! ([`Transform::stray`](super::super::transform::Transform::stray)), as if plane and ball had moved.

use glam::DVec3;

use super::super::dot2::vector_dot2;
use super::super::ray::Ray;
use super::super::sphere::Sphere;
use super::super::transform::U;
use super::Solid;

/// Allowance for higher orders in u and the f64 of this computation.
const HIGHER_ORDERS: f64 = 1.01;

/// A place where a ray's line goes through a half-space's or a ball's own surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Change {
    /// Whose, numbered in the order in which the solid names them.
    pub member: usize,
    /// The least t that f32 may make of it.
    pub low: f64,
    /// The greatest.
    pub high: f64,
    /// True if f32 is certain to find it.
    pub sure: bool,
}

/// The deviation of a ray on its way to the solid's space: none by default.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stray {
    /// Its origin, in the solid's units.
    pub origin: f64,
    /// Its direction, for each unit of t.
    pub direction: f64,
}

/// A renderer's answer for the first crossing of a ray and a solid's surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolidAnswer {
    /// Ray parameter.
    pub t: f64,
    /// The half-space or ball whose surface it is.
    pub member: usize,
    /// True if the ray enters the solid.
    pub enters: bool,
}

/// The judgement on such an answer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SolidVerdict {
    /// The exact answer, within the bound of t; with the exact t, if there is a hit.
    Agrees(Option<f64>),
    /// Another, which rounding explains: where they part, two changes are closer than their bounds.
    Near,
    /// Explained by nothing.
    Wrong,
}

impl Change {
    fn meets(&self, other: &Self) -> bool {
        self.member != other.member && self.low <= other.high && other.low <= self.high
    }

    fn holds(&self, t: f64) -> bool {
        self.low <= t && t <= self.high
    }
}

impl Solid {
    /// All places where a ray's line goes through a half-space's or a ball's own surface, with what f32
    /// may make of them if the ray has strayed so far.
    pub fn changes(&self, ray: &Ray, stray: Stray) -> Vec<Change> {
        let mut changes = Vec::new();
        let mut member = 0;
        self.each(&mut |solid| {
            match solid {
                Self::HalfSpace { normal, offset } => {
                    changes.extend(of_half_space(ray, *normal, *offset, member, stray));
                }
                Self::Ball(ball) => changes.extend(of_ball(ray, ball, member, stray)),
                _ => unreachable!("only what is simple is seen"),
            }
            member += 1;
        });
        changes
    }

    /// Judges a renderer's answer about this solid, of whose surface only what lies in `clip` is there.
    pub fn judge(
        &self,
        clip: &Self,
        ray: &Ray,
        stray: Stray,
        found: Option<SolidAnswer>,
    ) -> SolidVerdict {
        let both = Self::Intersection(vec![self.clone(), clip.clone()]);
        let changes = both.changes(ray, stray);
        // Whatever it says, the surface that it names must be there.
        let is_there = |found: SolidAnswer| {
            changes.iter().any(|change| change.member == found.member && change.holds(found.t))
        };
        if !found.is_none_or(is_there) {
            return SolidVerdict::Wrong;
        }
        let exact = self.intersect_within(clip, ray);
        let agree = match (&exact, found) {
            (None, None) => true,
            (Some(exact), Some(found)) => {
                let one = |change: &&Change| {
                    change.member == found.member && change.holds(exact.t) && change.holds(found.t)
                };
                exact.enters == found.enters
                    && exact.through.contains(&found.member)
                    && changes.iter().any(|change| one(&change))
            }
            _ => false,
        };
        if agree {
            return SolidVerdict::Agrees(exact.map(|exact| exact.t));
        }
        // They part at the nearer of the two.
        let ends = found.map(|found| found.t).into_iter().chain(exact.map(|exact| exact.t));
        let at = ends.fold(f64::INFINITY, f64::min);
        let there = || changes.iter().filter(|change| change.holds(at));
        let free = |change: &Change| {
            !change.sure
                || change.holds(ray.tmin)
                || change.holds(ray.tmax)
                || changes.iter().any(|other| change.meets(other))
        };
        if there().any(free) { SolidVerdict::Near } else { SolidVerdict::Wrong }
    }
}

fn of_half_space(ray: &Ray, n: DVec3, offset: f64, member: usize, stray: Stray) -> Option<Change> {
    let (o, d) = (ray.origin, ray.direction);
    let slope = vector_dot2(d, n);
    let height = offset - vector_dot2(o, n);
    let sizes = [offset.abs() + o.abs().dot(n.abs()), d.abs().dot(n.abs())];
    let unknown = 16.0 * U * U * sizes[1] + stray.direction * n.length();
    if slope == 0.0 && d.abs().dot(n.abs()) == 0.0 {
        // Every product is 0: so is the slope, in f32 too.
        return None;
    }
    let anywhere = [f64::NEG_INFINITY, f64::INFINITY];
    let [low, high] = if slope.abs() <= 2.0 * unknown {
        anywhere
    } else {
        let t = height / slope;
        let strayed = (stray.origin + t.abs() * stray.direction) * n.length();
        let far = 16.0 * U * U * (sizes[0] + t.abs() * sizes[1]) + strayed;
        let off = HIGHER_ORDERS * (7.0 * U * t.abs() + far / slope.abs());
        [t - off, t + off]
    };
    Some(Change { member, low, high, sure: low.is_finite() })
}

fn of_ball(ray: &Ray, ball: &Sphere, member: usize, stray: Stray) -> Vec<Change> {
    let (f, d, r) = (ray.origin - ball.center, ray.direction, ball.radius);
    let (away, speed) = (f.length(), d.length());
    let middle = -vector_dot2(f, d) / (speed * speed);
    let across = (f + d * middle).length();
    let strayed = stray.origin + (middle.abs() + r / speed) * stray.direction;
    let error = U * (2.0 * away + 5.0 * r) + (11.0 * U * away).powi(2) / (2.0 * r) + strayed;
    let half_chord = |radius: f64| {
        let square = (radius - across) * (radius + across);
        (square > 0.0).then(|| square.sqrt() / speed)
    };
    let Some(most) = half_chord(r + error) else { return vec![] };
    let least = half_chord((r - error).max(0.0));
    let half = least.unwrap_or(0.0);
    let change = |side: f64| {
        let [near, far] = [middle + side * half, middle + side * most];
        let t = near.abs().max(far.abs());
        let divided = U * (5.0 * away * away + 2.0 * r * r)
            / ((middle.abs() + half) * speed).max(f64::MIN_POSITIVE);
        let along = 18.0 * U * t + (3.0 * U * away + divided + strayed) / speed;
        let along = HIGHER_ORDERS * along;
        Change {
            member,
            low: near.min(far) - along,
            high: near.max(far) + along,
            sure: least.is_some(),
        }
    };
    vec![change(-1.0), change(1.0)]
}

#[cfg(test)]
mod tests;
