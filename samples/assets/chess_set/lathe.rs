//! Solids of revolution: a profile of lines, arcs and curves is turned around the y axis.
//!
//! A profile runs from the axis at the bottom outwards, up, and back to the axis at the top, in
//! coordinates (radius, height); outside is then on its right. Normals come from the tangents of
//! the curves, not from the facets, so that few facets look round.

use std::f64::consts::{FRAC_PI_4, TAU};
use std::ops::Range;

use glam::{DVec2, DVec3, dvec2};

use crate::mesh::{Mesh, Vertex};

/// Greatest distance of a facet from its curve, in squares.
const TOLERANCE: f64 = 0.0025;
/// The most that the profile may turn from one facet to the next on a curve.
const MAX_TURN: f64 = FRAC_PI_4;
/// Cosine of 35 degrees: where the profile turns by more at once, it has a crease.
const CREASE: f64 = 0.819;

/// One point of a profile.
#[derive(Clone, Copy)]
struct Knot {
    point: DVec2,
    /// Unit tangents just before and just after the point.
    before: DVec2,
    after: DVec2,
    /// The part of the rim's ripple that the point follows.
    ripple: f64,
}

/// The outline of a turned piece.
#[derive(Clone)]
pub struct Profile {
    knots: Vec<Knot>,
    /// The ripple weight of the knots to come.
    ripple: f64,
}

impl Profile {
    /// A profile that starts at the given radius and height.
    pub fn new(radius: f64, height: f64) -> Self {
        let mut profile = Self { knots: Vec::new(), ripple: 0.0 };
        profile.push(dvec2(radius, height), DVec2::X, DVec2::X);
        profile
    }

    /// Goes straight to a point.
    pub fn line(mut self, radius: f64, height: f64) -> Self {
        let end = dvec2(radius, height);
        let tangent = (end - self.end()).normalize();
        self.leave(tangent);
        self.push(end, tangent, tangent);
        self
    }

    /// Goes to a point along a circular arc, given by its bulge: the tangent of a quarter of its
    /// angle. 1 is a half circle; positive is convex (a bead), negative is concave (a cove).
    pub fn arc(mut self, radius: f64, height: f64, bulge: f64) -> Self {
        let (start, end) = (self.end(), dvec2(radius, height));
        let chord = end - start;
        let outward = dvec2(chord.y, -chord.x) / chord.length();
        let signed_radius = chord.length() * (1.0 + bulge * bulge) / (4.0 * bulge);
        let sagitta = bulge * chord.length() / 2.0;
        let centre = start.midpoint(end) + outward * (sagitta - signed_radius);
        let angle = 4.0 * bulge.atan();
        let tangent = |p: DVec2| (p - centre).perp() / signed_radius;
        let steps = steps(angle.abs(), (angle * signed_radius).abs());
        self.leave(tangent(start));
        for i in 1..=steps {
            let turn = DVec2::from_angle(angle * i as f64 / steps as f64);
            let point = centre + turn.rotate(start - centre);
            // The last point is the end itself, not an approximation of it.
            let point = if i == steps { end } else { point };
            self.push(point, tangent(point), tangent(point));
        }
        self
    }

    /// Goes to `end` along a cubic Bézier curve.
    pub fn curve(mut self, control_1: [f64; 2], control_2: [f64; 2], end: [f64; 2]) -> Self {
        let [a, b, c, d] = [self.end(), control_1.into(), control_2.into(), end.into()];
        let point = |t: f64| {
            let s = 1.0 - t;
            a * (s * s * s) + b * (3.0 * s * s * t) + c * (3.0 * s * t * t) + d * (t * t * t)
        };
        let tangent = |t: f64| {
            let s = 1.0 - t;
            ((b - a) * (s * s) + (c - b) * (2.0 * s * t) + (d - c) * (t * t)).normalize()
        };
        let samples = (0..16).map(|i| (f64::from(i) / 16.0, f64::from(i + 1) / 16.0));
        let (turn, length) = samples.fold((0.0, 0.0), |(turn, length), (t, u)| {
            (turn + tangent(t).angle_to(tangent(u)).abs(), length + point(t).distance(point(u)))
        });
        let steps = steps(turn, length);
        self.leave(tangent(0.0));
        for i in 1..=steps {
            let t = i as f64 / steps as f64;
            self.push(point(t), tangent(t), tangent(t));
        }
        self
    }

    /// Goes straight to a ball around a point of the axis, where the ball has the radius `from`,
    /// and around it to where it has the radius `to` above its centre.
    pub fn ball(self, from: f64, height: f64, radius: f64, to: f64) -> Self {
        let [below, above] = [from, to].map(|r| (radius * radius - r * r).sqrt());
        let angle = dvec2(from, -below).angle_to(dvec2(to, above));
        self.line(from, height - below).arc(to, height + above, (angle / 4.0).tan())
    }

    /// Sets how much the points to come follow the ripple that [`Profile::turn_rippled`] gets.
    pub fn ripple(mut self, weight: f64) -> Self {
        self.ripple = weight;
        self
    }

    /// The last point.
    pub fn end(&self) -> DVec2 {
        self.knots[self.knots.len() - 1].point
    }

    /// All points.
    pub fn points(&self) -> impl DoubleEndedIterator<Item = DVec2> {
        self.knots.iter().map(|knot| knot.point)
    }

    /// Turns the profile all the way round in `segments` facets.
    pub fn turn(&self, segments: u32) -> Mesh {
        self.turn_rippled(segments, 0..segments, |_| dvec2(0.0, 0.0))
    }

    /// Turns the profile through some of the `segments` facets of a full turn.
    pub fn turn_part(&self, segments: u32, part: Range<u32>) -> Mesh {
        self.turn_rippled(segments, part, |_| dvec2(0.0, 0.0))
    }

    /// Turns the profile and lifts it by `rise(angle)`, which answers with the height and its
    /// derivative, times the weights set by [`Profile::ripple`].
    pub fn turn_rippled(
        &self,
        segments: u32,
        part: Range<u32>,
        rise: impl Fn(f64) -> DVec2,
    ) -> Mesh {
        let mut mesh = Mesh::default();
        let mut length = 0.0;
        for pair in self.knots.windows(2) {
            let (low, high) = (pair[0], pair[1]);
            let step = low.point.distance(high.point);
            let slope = (high.ripple - low.ripple) / step;
            let vertex = |knot: Knot, tangent: DVec2, v: f64, column: f64| {
                let angle = TAU * column / f64::from(segments);
                let (sin, cos) = angle.sin_cos();
                let [lift, lift_slope] = rise(angle).to_array();
                let along_y = tangent.y + slope * lift;
                let along = DVec3::new(tangent.x * sin, along_y, tangent.x * cos);
                let around = DVec3::new(cos, 0.0, -sin) * knot.point.x.max(1e-9)
                    + DVec3::Y * knot.ripple * lift_slope;
                Vertex {
                    position: on_circle(knot.point, angle) + DVec3::Y * knot.ripple * lift,
                    normal: around.cross(along).normalize(),
                    uv: dvec2(column / f64::from(segments), v),
                }
            };
            let (low_tangent, high_tangent) = (smooth(low).1, smooth(high).0);
            for column in part.clone() {
                let [left, right] = [f64::from(column), f64::from(column + 1)];
                // Towards the axis a facet is a triangle, whose tip takes the middle column.
                if low.point.x > 0.0 {
                    let tip = if high.point.x > 0.0 { right } else { (left + right) / 2.0 };
                    mesh.triangle(
                        vertex(low, low_tangent, length, left),
                        vertex(low, low_tangent, length, right),
                        vertex(high, high_tangent, length + step, tip),
                    );
                }
                if high.point.x > 0.0 {
                    let tip = if low.point.x > 0.0 { left } else { (left + right) / 2.0 };
                    mesh.triangle(
                        vertex(low, low_tangent, length, tip),
                        vertex(high, high_tangent, length + step, right),
                        vertex(high, high_tangent, length + step, left),
                    );
                }
            }
            length += step;
        }
        mesh
    }

    fn push(&mut self, point: DVec2, before: DVec2, after: DVec2) {
        self.knots.push(Knot { point, before, after, ripple: self.ripple });
    }

    /// Sets the direction in which the profile leaves its last point.
    fn leave(&mut self, tangent: DVec2) {
        let last = self.knots.len() - 1;
        self.knots[last].after = tangent;
    }
}

/// The point of the profile turned by `angle`; counter-clockwise as seen from above, from +z.
pub fn on_circle(point: DVec2, angle: f64) -> DVec3 {
    DVec3::new(point.x * angle.sin(), point.y, point.x * angle.cos())
}

/// The tangents before and after a knot, made equal unless the knot is a crease.
fn smooth(knot: Knot) -> (DVec2, DVec2) {
    if knot.before.dot(knot.after) < CREASE {
        return (knot.before, knot.after);
    }
    let mean = (knot.before + knot.after).normalize();
    (mean, mean)
}

/// The number of facets for a curve that turns by `turn` over `length`. A facet of length l on a
/// circle of radius R stays l²/8R away from it.
fn steps(turn: f64, length: f64) -> u32 {
    let by_distance = (turn * length / (8.0 * TOLERANCE)).sqrt();
    by_distance.max(turn / MAX_TURN).ceil().max(1.0) as u32
}
