//! Judges an answer: the device's f32 compared with the exact result.

use glam::{DVec3, Vec3};
use reference::ulp::ulp_error;
use serde::{Deserialize, Serialize};

use crate::probe::Way;
use crate::query::{Answer, Ray};
use crate::shape::{Leaving, Shape};

/// The verdict of hit or miss.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ExpectedHit {
    Yes,
    No,
    /// Denormal numbers decide, which a device may flush.
    Either,
}

/// The exact result, here rounded to f64.
#[derive(Clone, Debug)]
pub struct Expected {
    pub hit: ExpectedHit,
    /// The t of the hit; the mean of a sum.
    pub t: Option<f64>,
    pub normal: Option<DVec3>,
    /// Any of these normals will do: at edges and corners of a box.
    pub faces: Vec<DVec3>,
    /// The t of the point that a ray leaves, for a ray that leaves a sphere.
    pub surface: Option<f64>,
    /// The number of times the ray meets the surface.
    pub count: Option<u32>,
}

/// Error limits of a top rung; a missing one is not checked.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tolerance {
    pub t_ulp: Option<f64>,
    pub t_abs: Option<f64>,
    pub normal_abs: Option<f64>,
    pub offset_max: Option<f64>,
    pub secondary_t_abs: Option<f64>,
    pub mean_rel: Option<f64>,
}

impl Tolerance {
    pub fn all(&self) -> [Option<f64>; 6] {
        let Self { t_ulp, t_abs, normal_abs, offset_max, secondary_t_abs, mean_rel } = *self;
        [t_ulp, t_abs, normal_abs, offset_max, secondary_t_abs, mean_rel]
    }
}

/// The outcome of a query.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    Right,
    /// Hit or miss is right, a number is farther off than the tolerance.
    Inexact,
    FalseHit,
    FalseMiss,
    /// The device's box test kept the ray from the shape.
    NeverOffered,
    /// Something is infinite or not a number.
    NotFinite,
}

/// A verdict and the numbers behind it.
#[derive(Clone, Debug, Serialize)]
pub struct Judgement {
    pub verdict: Verdict,
    pub hit: bool,
    pub t: Option<f32>,
    /// Error of t in units in the last place.
    pub ulp: Option<f64>,
    /// Quantities beyond their limits.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub why: String,
}

/// Judges an answer to a ray.
pub fn judge(
    shape: &Shape,
    ray: &Ray,
    expected: &Expected,
    tolerance: &Tolerance,
    way: Way,
    answer: &Answer,
) -> Judgement {
    let is_sum = matches!(shape, Shape::Sum(_));
    let hit = answer.hit != 0 || is_sum;
    let t = hit.then_some(answer.t);
    let ulp = t.zip(expected.t).map(|(t, exact)| ulp_error(t, exact));
    let judged = |verdict, why: String| Judgement { verdict, hit, t, ulp, why };
    if hit && !(answer.t.is_finite() && answer.normal.is_finite() && answer.point.is_finite()) {
        return judged(Verdict::NotFinite, format!("t {}, normal {}", answer.t, answer.normal));
    }
    match (expected.hit, hit) {
        (ExpectedHit::Either, _) => return judged(Verdict::Right, String::new()),
        (ExpectedHit::Yes, false) if way == Way::Traced && answer.offered == 0 => {
            return judged(Verdict::NeverOffered, String::new());
        }
        (ExpectedHit::Yes, false) => return judged(Verdict::FalseMiss, String::new()),
        (ExpectedHit::No, true) => return judged(Verdict::FalseHit, String::new()),
        _ => {}
    }
    let mut why = Vec::new();
    let mut check = |what: &str, error: Option<f64>, bar: Option<f64>| {
        if let Some((error, bar)) =
            error.zip(bar).filter(|(error, bar)| error > bar || error.is_nan())
        {
            why.push(format!("{what} is off by {error:.3e}, allowed {bar:.3e}"));
        }
    };
    if hit {
        let off = t.zip(expected.t).map(|(t, exact)| (f64::from(t) - exact).abs());
        check("t in ULP", ulp, tolerance.t_ulp);
        check("t", off, tolerance.t_abs);
        check("t of the second ray", off, tolerance.secondary_t_abs);
        let relative = off.zip(expected.t).map(|(off, exact)| match exact {
            0.0 => off,
            exact => off / exact.abs(),
        });
        check("the mean", relative, tolerance.mean_rel);
        let normal = expected.normal.map(|normal| largest(answer.normal, normal));
        check("the normal", normal, tolerance.normal_abs);
        let faces = expected.faces.iter().map(|face| largest(answer.normal, *face));
        let face = faces.min_by(f64::total_cmp);
        check("the face", face, (face.is_some()).then_some(0.0));
    }
    if let Shape::Leaving(leaving) = shape {
        let from = departure(leaving, ray, expected);
        let offset = (answer.point.as_dvec3() - from).length();
        check("the start", Some(offset), tolerance.offset_max);
    }
    // Through an acceleration structure, only the first hit is reported.
    if let Some(count) = expected.count.filter(|&count| way == Way::Direct && count != answer.count)
    {
        why.push(format!("it is met {} times, not {count}", answer.count));
    }
    let verdict = if why.is_empty() { Verdict::Right } else { Verdict::Inexact };
    judged(verdict, why.join("; "))
}

/// The exact point that a ray leaves, rounded to f64.
fn departure(leaving: &Leaving, ray: &Ray, expected: &Expected) -> DVec3 {
    match leaving.gap {
        Some(gap) => gap.point.as_dvec3(),
        None => ray.exact().at(expected.surface.unwrap_or(f64::NAN)),
    }
}

fn largest(a: Vec3, b: DVec3) -> f64 {
    (a.as_dvec3() - b).abs().max_element()
}
