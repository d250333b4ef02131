//! States of micro-triangles: by a bound on the any-hit shader's result, or by samples.

use glam::{DVec2, Vec2};

use super::alpha::{Alpha, THRESHOLD};
use super::curve::{self, State};

common::shader_enum! {
    /// The way to find a state.
    pub enum Rule {
        /// Opaque or transparent only if every lookup has that result.
        Conservative,
        /// The mean of four lookups, compared with 0.05 and 0.95.
        Samples,
    }
}

/// The distance by which the barycentrics of a hit may be outside of a triangle, by the device's rounding.
/// Beyond that the shader does not trust a state. `micromap.glsl` has the same number.
pub const SLACK: f64 = 1.0 / 16384.0;

/// The rounding error of the search for a micro-triangle, as a part of the triangle: below 2^-22 in 32 bits.
pub const SEARCH: f64 = 1.0 / 1_048_576.0;

/// The shader's rounding error where it interpolates texture coordinates and multiplies them by the texture's size,
/// as a part of the largest coordinate. A dozen roundings of 2^-24 each are less.
pub const ROUNDING: f64 = 1.0 / 1_048_576.0;

/// The state of each micro-triangle of a triangle, in the order of the curve. Corners are texture coordinates.
pub fn triangle(alpha: &Alpha, corners: [Vec2; 3], level: u32, rule: Rule) -> Vec<State> {
    let corners = corners.map(Vec2::as_dvec2);
    let state = |index| {
        let small = micro_corners(corners, index, level);
        match rule {
            Rule::Conservative => by_bound(alpha, corners, small),
            Rule::Samples => by_samples(alpha, corners, index, level),
        }
    };
    (0..curve::count(level)).map(state).collect()
}

/// The corners of a micro-triangle in texture coordinates.
fn micro_corners(corners: [DVec2; 3], index: u32, level: u32) -> [DVec2; 3] {
    let part = 1.0 / f64::from(1 << level);
    let exact = |weight| f64::from(weight) * part;
    curve::corners(index, level)
        .map(|[a, b, c]| exact(a) * corners[0] + exact(b) * corners[1] + exact(c) * corners[2])
}

/// Looks at the box around a micro-triangle, made larger by all that may be rounded.
fn by_bound(alpha: &Alpha, corners: [DVec2; 3], small: [DVec2; 3]) -> State {
    let (low, high) = around(small);
    let (lowest, highest) = around(corners);
    // Two weights can be off, each by this part of the triangle's size.
    let beside = 2.0 * (SLACK + SEARCH) * (highest - lowest);
    let rounded = ROUNDING * lowest.abs().max(highest.abs());
    let margin = beside + rounded;
    match alpha.certain(low - margin, high + margin) {
        Some(true) => State::Opaque,
        Some(false) => State::Transparent,
        None => guess(alpha.lookup((small[0] + small[1] + small[2]) / 3.0)),
    }
}

/// Unknown, and what it would be by its middle.
fn guess(alpha: f64) -> State {
    if alpha >= THRESHOLD { State::UnknownOpaque } else { State::UnknownTransparent }
}

fn around(corners: [DVec2; 3]) -> (DVec2, DVec2) {
    let [a, b, c] = corners;
    (a.min(b).min(c), a.max(b).max(c))
}

/// The rule of a well-known tutorial: four lookups at the middle and beside it. How far beside does not depend on
/// the level.
fn by_samples(alpha: &Alpha, corners: [DVec2; 3], index: u32, level: u32) -> State {
    let small = curve::corners(index, level);
    let part = 1.0 / f64::from(3 << level);
    let [_, u, v] = [0, 1, 2].map(|i| f64::from(small[0][i] + small[1][i] + small[2][i]) * part);
    let lookup = |(du, dv): (f64, f64)| {
        let (u, v) = (u + du, v + dv);
        alpha.lookup((1.0 - u - v).max(0.0) * corners[0] + u * corners[1] + v * corners[2])
    };
    let places = [(0.0, 0.0), (0.04, -0.02), (-0.02, 0.04), (-0.02, -0.02)];
    let mean = places.map(lookup).iter().sum::<f64>() / 4.0;
    if mean < 0.05 {
        State::Transparent
    } else if mean >= 0.95 {
        State::Opaque
    } else {
        guess(mean)
    }
}
