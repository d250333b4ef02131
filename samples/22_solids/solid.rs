//! A solid on the host: half-spaces and balls, combined.

use glam::{DVec3, Vec3};

/// A solid: a convex part, or what becomes of others.
#[derive(Clone, Debug, PartialEq)]
pub enum Solid {
    /// The points inside all of these, of one material.
    Convex(Vec<Bound>, &'static str),
    /// The points in either.
    Union(Box<[Solid; 2]>),
    /// The points in both.
    Intersection(Box<[Solid; 2]>),
    /// The points in the first and not in the second.
    Difference(Box<[Solid; 2]>),
    /// The points outside.
    Inverse(Box<Solid>),
}

/// A surface that bounds a convex part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bound {
    /// The part lies on the inner side of POV-Ray's `plane { <A,B,C>, D }`: `N·p <= D·|N|`, where the
    /// normal N has any length but 0.
    Plane(Vec3, f32),
    /// The part is inside a ball.
    Ball(Ball),
}

common::shader_struct! {
    /// A ball.
    #[derive(PartialEq)]
    pub struct Ball {
        pub center: Vec3,
        pub radius: f32,
    }
}

/// Half the side of the box that ends what has no end, in the solid's own units.
pub const REACH: f32 = 6.0;

/// The inner side of the plane `{normal, distance}`.
pub fn plane(normal: Vec3, distance: f32) -> Bound {
    Bound::Plane(normal, distance)
}

/// The ball around a point.
pub fn ball(center: Vec3, radius: f32) -> Bound {
    Bound::Ball(Ball { center, radius })
}

/// The six planes of a box.
pub fn block(low: Vec3, high: Vec3) -> Vec<Bound> {
    let axes = [Vec3::X, Vec3::Y, Vec3::Z];
    axes.into_iter().flat_map(|n| [plane(n, high.dot(n)), plane(-n, -low.dot(n))]).collect()
}

impl Solid {
    /// The points in this or in that.
    pub fn union(self, other: Self) -> Self {
        Self::Union(Box::new([self, other]))
    }

    /// The points in this and in that.
    pub fn intersection(self, other: Self) -> Self {
        Self::Intersection(Box::new([self, other]))
    }

    /// The points in this and not in that.
    pub fn difference(self, other: Self) -> Self {
        Self::Difference(Box::new([self, other]))
    }

    /// Inside and outside exchanged.
    pub fn inverse(self) -> Self {
        Self::Inverse(Box::new(self))
    }

    /// Returns whether a point is inside, in f64.
    pub fn contains(&self, point: DVec3) -> bool {
        match self {
            Self::Convex(bounds, _) => bounds.iter().all(|bound| bound.contains(point)),
            Self::Union(both) => both.iter().any(|solid| solid.contains(point)),
            Self::Intersection(both) => both.iter().all(|solid| solid.contains(point)),
            Self::Difference(both) => both[0].contains(point) && !both[1].contains(point),
            Self::Inverse(solid) => !solid.contains(point),
        }
    }

    /// Corners of boxes around its inside and around its surface, within ±[`REACH`].
    pub fn bounds(&self) -> [(DVec3, DVec3); 2] {
        let all = (DVec3::splat(-f64::from(REACH)), DVec3::splat(REACH.into()));
        let both = |a: (DVec3, DVec3), b: (DVec3, DVec3)| (a.0.min(b.0), a.1.max(b.1));
        let common = |a: (DVec3, DVec3), b: (DVec3, DVec3)| (a.0.max(b.0), a.1.min(b.1));
        match self {
            Self::Convex(bounds, _) => [convex_bounds(bounds); 2],
            Self::Union(solids) => {
                let [a, b] = solids.each_ref().map(Self::bounds);
                [both(a[0], b[0]), both(a[1], b[1])]
            }
            Self::Intersection(solids) => {
                let [a, b] = solids.each_ref().map(Self::bounds);
                let inside = common(a[0], b[0]);
                [inside, common(inside, both(a[1], b[1]))]
            }
            Self::Difference(solids) => {
                let [a, b] = solids.each_ref().map(Self::bounds);
                [a[0], common(a[0], both(a[1], b[1]))]
            }
            Self::Inverse(solid) => [all, solid.bounds()[1]],
        }
    }
}

impl Bound {
    /// Returns whether a point is on the inner side.
    pub fn contains(&self, point: DVec3) -> bool {
        match self {
            Self::Plane(normal, distance) => {
                let (normal, distance) = half_space(*normal, *distance);
                normal.dot(point) <= distance
            }
            Self::Ball(Ball { center, radius }) => {
                point.distance(center.as_dvec3()) <= f64::from(*radius)
            }
        }
    }
}

/// N and D·|N| of a plane.
pub fn half_space(normal: Vec3, distance: f32) -> (DVec3, f64) {
    let normal = normal.as_dvec3();
    (normal, f64::from(distance) * normal.length())
}

/// Corners of the box around a convex part: around all corners in which three of its planes meet and
/// that the others leave in, the walls of the largest box among the planes.
fn convex_bounds(bounds: &[Bound]) -> (DVec3, DVec3) {
    let limit = block(Vec3::splat(-REACH), Vec3::splat(REACH));
    let half_spaces = bounds.iter().chain(&limit).filter_map(|bound| match bound {
        Bound::Plane(normal, distance) => Some(half_space(*normal, *distance)),
        Bound::Ball(_) => None,
    });
    let planes: Vec<(DVec3, f64)> =
        half_spaces.map(|(n, d)| (n / n.length(), d / n.length())).collect();
    let mut around = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for (i, (a, at_a)) in planes.iter().enumerate() {
        for (j, (b, at_b)) in planes[..i].iter().enumerate() {
            for (c, at_c) in &planes[..j] {
                let volume = a.dot(b.cross(*c));
                let corner =
                    (b.cross(*c) * *at_a + c.cross(*a) * *at_b + a.cross(*b) * *at_c) / volume;
                if volume.abs() > 1e-9 && planes.iter().all(|(n, d)| n.dot(corner) <= d + 1e-9) {
                    around = (around.0.min(corner), around.1.max(corner));
                }
            }
        }
    }
    for bound in bounds {
        if let Bound::Ball(Ball { center, radius }) = bound {
            let (center, radius) = (center.as_dvec3(), f64::from(*radius));
            around = (around.0.max(center - radius), around.1.min(center + radius));
        }
    }
    around
}
