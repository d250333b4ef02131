//! Ray against solids: half-spaces and balls, combined by union, intersection, difference and inverse.
//!
//! A ray goes in and out of each half-space and ball at known t. Between two such t nothing changes, so
//! the solid's surface is where its rule says something else just before and just after one of them
//! (Roth, *Ray Casting for Modeling Solids*, 1982). All that happens at one t happens at once, so what
//! has no thickness along the ray is not there: the regularised operations of Requicha and Tilove.

pub mod bound;

use std::cmp::Ordering;

use dashu::rational::RBig;
use glam::DVec3;

use super::dot2::{dot2, vector_dot2};
use super::rational::{rational, sign, to_f64};
use super::ray::Ray;
use super::sphere::Sphere;
use super::vector::Vector;

/// The construction of a solid.
#[derive(Clone, Debug, PartialEq)]
pub enum Solid {
    /// All points p with `normal·p <= offset`; the normal has any length but 0.
    HalfSpace {
        /// Points out of it.
        normal: DVec3,
        /// `D·|N|` of POV-Ray's `plane {<A,B,C>, D}`.
        offset: f64,
    },
    /// A ball.
    Ball(Sphere),
    /// The union of these; empty if there are none.
    Union(Vec<Solid>),
    /// The intersection of these; all of space if there are none.
    Intersection(Vec<Solid>),
    /// The complement.
    Inverse(Box<Solid>),
}

/// A crossing of a ray and a solid's surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Boundary<T> {
    /// Ray parameter, in lengths of the ray's direction.
    pub t: T,
    /// The half-spaces and balls whose surfaces the ray goes through there, numbered in the order in
    /// which the solid names them.
    pub through: Vec<usize>,
    /// True if the ray enters the solid there; otherwise it leaves.
    pub enters: bool,
}

/// Along a ray: whether it begins in a half-space or ball, infinitely far back, and where that changes.
struct Line<T> {
    begins_in: bool,
    changes: Vec<T>,
}

impl Solid {
    /// The first without the second.
    pub fn difference(from: Self, what: Self) -> Self {
        Self::Intersection(vec![from, Self::Inverse(Box::new(what))])
    }

    /// True if a point is in it, in f64; on a surface it counts as inside, before any inverse.
    pub fn contains(&self, point: DVec3) -> bool {
        match self {
            Self::HalfSpace { normal: n, offset } => {
                dot2([(point.x, n.x), (point.y, n.y), (point.z, n.z), (-offset, 1.0)]) <= 0.0
            }
            Self::Ball(ball) => point.distance_squared(ball.center) <= ball.radius * ball.radius,
            Self::Union(solids) => solids.iter().any(|solid| solid.contains(point)),
            Self::Intersection(solids) => solids.iter().all(|solid| solid.contains(point)),
            Self::Inverse(solid) => !solid.contains(point),
        }
    }

    /// All places where the line of the ray goes through the surface, in order, in f64; tmin and tmax
    /// are left aside.
    pub fn boundaries(&self, ray: &Ray) -> Vec<Boundary<f64>> {
        let line = |solid: &Solid| match solid {
            Self::HalfSpace { normal: n, offset } => {
                let o = ray.origin;
                let height = dot2([(*offset, 1.0), (-o.x, n.x), (-o.y, n.y), (-o.z, n.z)]);
                let slope = vector_dot2(ray.direction, *n);
                let slope_sign = slope.partial_cmp(&0.0).unwrap_or(Ordering::Equal);
                half_space(slope_sign, height.partial_cmp(&0.0), *n, || height / slope)
            }
            Self::Ball(ball) => Line { begins_in: false, changes: ball_changes(ball, ray) },
            _ => unreachable!("only what is simple has a line"),
        };
        self.walk(line, f64::total_cmp)
    }

    /// The same, exactly, for solids of half-spaces; `None` if there is a ball in it.
    ///
    /// # Panics
    /// If a number of the solid or of the ray (but `tmin`, `tmax`) is not finite.
    pub fn boundaries_exact(&self, ray: &Ray) -> Option<Vec<Boundary<RBig>>> {
        let (o, d) = (Vector::from(ray.origin), Vector::from(ray.direction));
        let mut has_ball = false;
        self.each(&mut |solid| has_ball |= matches!(solid, Self::Ball(_)));
        let line = |solid: &Solid| {
            let Self::HalfSpace { normal, offset } = solid else {
                unreachable!("there is no ball, and only what is simple has a line")
            };
            let n = Vector::from(*normal);
            let (height, slope) = (rational(*offset) - o.dot(&n), d.dot(&n));
            half_space(sign(&slope), Some(sign(&height)), *normal, || height / slope)
        };
        (!has_ball).then(|| self.walk(line, RBig::cmp))
    }

    /// The first crossing of the ray and the surface within its interval, exactly rounded if possible.
    pub fn intersect(&self, ray: &Ray) -> Option<Boundary<f64>> {
        self.intersect_within(&Self::Intersection(vec![]), ray)
    }

    /// The same, of that part of the surface that lies in `clip`, or on its surface.
    pub fn intersect_within(&self, clip: &Self, ray: &Ray) -> Option<Boundary<f64>> {
        let clip = clip.intervals(ray);
        self.rounded(ray).into_iter().find(|Boundary { t, .. }| {
            ray.contains(*t) && clip.iter().any(|[enter, leave]| enter <= t && t <= leave)
        })
    }

    /// Between which t the line of the ray is in the solid.
    pub fn intervals(&self, ray: &Ray) -> Vec<[f64; 2]> {
        let mut intervals = Vec::new();
        let boundaries = self.rounded(ray);
        let mut enter = match boundaries.first() {
            Some(first) => !first.enters,
            None => self.contains(ray.origin),
        }
        .then_some(f64::NEG_INFINITY);
        for Boundary { t, enters, .. } in boundaries {
            if enters {
                enter = Some(t);
            } else {
                intervals.extend(enter.take().map(|enter| [enter, t]));
            }
        }
        intervals.extend(enter.map(|enter| [enter, f64::INFINITY]));
        intervals
    }

    /// All places where the line of the ray goes through the surface, exactly rounded if they can be.
    fn rounded(&self, ray: &Ray) -> Vec<Boundary<f64>> {
        let Some(exact) = self.boundaries_exact(ray) else { return self.boundaries(ray) };
        let rounded = exact.into_iter().map(|Boundary { t, through, enters }| Boundary {
            t: to_f64(&t),
            through,
            enters,
        });
        rounded.collect()
    }

    /// Sees every half-space and ball, in the order of their numbers.
    pub fn each<'a>(&'a self, see: &mut impl FnMut(&'a Self)) {
        match self {
            Self::HalfSpace { .. } | Self::Ball(_) => see(self),
            Self::Union(solids) | Self::Intersection(solids) => {
                solids.iter().for_each(|solid| solid.each(see));
            }
            Self::Inverse(solid) => solid.each(see),
        }
    }

    /// The rule applied to the members' states, in the order of [`Solid::each`].
    fn holds(&self, members: &mut impl Iterator<Item = bool>) -> bool {
        // No shortcut: every operand takes its members off the list.
        match self {
            Self::HalfSpace { .. } | Self::Ball(_) => members.next().expect("one for each"),
            Self::Union(solids) => {
                solids.iter().fold(false, |any, solid| solid.holds(members) | any)
            }
            Self::Intersection(solids) => {
                solids.iter().fold(true, |all, solid| solid.holds(members) & all)
            }
            Self::Inverse(solid) => !solid.holds(members),
        }
    }

    fn walk<T: Clone + PartialEq>(
        &self,
        line: impl Fn(&Self) -> Line<T>,
        order: impl Fn(&T, &T) -> Ordering,
    ) -> Vec<Boundary<T>> {
        let mut lines = Vec::new();
        self.each(&mut |solid| lines.push(line(solid)));
        let mut at: Vec<T> = lines.iter().flat_map(|line| line.changes.iter().cloned()).collect();
        at.sort_by(&order);
        at.dedup();
        let mut members: Vec<bool> = lines.iter().map(|line| line.begins_in).collect();
        let mut within = self.holds(&mut members.iter().copied());
        let mut boundaries = Vec::new();
        for t in at {
            let mut through = Vec::new();
            for (index, line) in lines.iter().enumerate() {
                // Twice at once, as where a ball is only touched, is not at all.
                if line.changes.iter().filter(|change| **change == t).count() % 2 == 1 {
                    members[index] ^= true;
                    through.push(index);
                }
            }
            let enters = self.holds(&mut members.iter().copied());
            if enters != within {
                boundaries.push(Boundary { t, through, enters });
                within = enters;
            }
        }
        boundaries
    }
}

/// The line of a half-space: `slope` and `height` say whether the ray goes out, and whether its origin
/// is inside.
///
/// A parallel ray within the plane is taken for one that is moved a hair along the plane's normal, of
/// the two the one whose first part that is not 0 is positive: so two solids that touch in a plane have
/// no gap between them, and nothing in common (Edelsbrunner and Mücke, *Simulation of Simplicity*, 1990).
fn half_space<T>(
    slope: Ordering,
    height: Option<Ordering>,
    normal: DVec3,
    t: impl FnOnce() -> T,
) -> Line<T> {
    let first = normal.to_array().into_iter().find(|part| *part != 0.0);
    let begins_in = match (slope, height) {
        (Ordering::Greater, _) => true,
        (Ordering::Less, _) => false,
        (_, Some(Ordering::Equal)) => first.is_some_and(|part| part < 0.0),
        (_, height) => height == Some(Ordering::Greater),
    };
    Line { begins_in, changes: if slope.is_eq() { vec![] } else { vec![t()] } }
}

/// The values of t at which a ray's line enters and leaves a ball; none if it only touches.
fn ball_changes(ball: &Sphere, ray: &Ray) -> Vec<f64> {
    let (f, d, r) = (ray.origin - ball.center, ray.direction, ball.radius);
    let (a, b) = (d.length_squared(), vector_dot2(f, d));
    let foot = f - b / a * d;
    let discriminant = a * (r - foot.length()) * (r + foot.length());
    if discriminant <= 0.0 {
        return vec![];
    }
    let c = (f.length() - r) * (f.length() + r);
    let q = if b > 0.0 { -b - discriminant.sqrt() } else { -b + discriminant.sqrt() };
    let mut both = vec![c / q, q / a];
    both.sort_by(f64::total_cmp);
    both
}

#[cfg(test)]
mod tests;
