//! How far two pictures may be apart that come from the same formulas.
//!
//! Vulkan promises equal results of *identical* pipelines, made of the same SPIR-V and the same state
//! (specification, appendix Invariance, rules 4 and 7). Of two others it says no more than how far each may be
//! from the exact result. On the software driver they are held to the same bits all the same, which notices
//! more; on any other device, and in worst arithmetic that has a seed, to bounds.

use common::app::Picture;

use crate::{bits, device, flip};

/// How far a picture may be from that of exact arithmetic: how many decisions lie behind a pixel, each of which
/// may *flip*, and the mean FLIP.
///
/// A ray's direction is off by some 4 ULP of 1, which is 7e-5 of a pixel of a picture that is 96 wide. An edge
/// that passes as near by a pixel's centre, on either side, flips it: of 5,760 pixels less than one does, if all
/// of them have an edge, and so does a second decision, if its point is off by as little. In larger pictures
/// there are more pixels, and each is smaller.
///
/// A colour is off where a texture is read elsewhere: weights off by 16 ULP of 1 are a thousandth of a texel
/// of 512, and a quarter of a step of 255 where black lies beside white. So at most a quarter of the pixels
/// change by a step, which has a FLIP of 0.005.
#[derive(Clone, Copy, Debug)]
pub struct Near {
    decisions: u32,
    mean: f32,
    /// How many of the two pictures are not exact.
    off: u32,
}

impl Near {
    /// The bounds of a chapter's pictures, against one that is all but exact.
    ///
    /// # Panics
    /// If nothing is said of the chapter, as of those whose paths are random.
    pub fn of(chapter: &str) -> Self {
        Self::if_any(chapter).unwrap_or_else(|| panic!("how near is a picture of {chapter}?"))
    }

    fn if_any(chapter: &str) -> Option<Self> {
        let (decisions, mean) =
            match chapter[..2].parse().expect("a chapter begins with its number") {
                // The nearest hit decides, and nothing else; lines fade out within a pixel (20).
                1 | 2 | 7 | 9 | 10 | 20 | 24 => (1, 0.00125),
                // A second decision: a hole or a random number (03), what a shadow ray meets (04 and later),
                // which of two faces of a solid is first (22), which cell of a lattice a point is in (13). Those
                // of rays to the sky move a colour by a sixteenth of the ambient light, a few steps of 255 (17).
                3 | 4 | 5 | 8 | 13 | 14 | 16 | 17 | 21 | 22 => (2, 0.00125),
                // Rays that round mirrors send on: an error grows by the way over the radius each time, and two
                // surfaces and more make a colour. Most of what they decide is dimmed by the mirrors' Fresnel
                // factor.
                6 | 12 | 26 => (2, 0.0025),
                // As before, and one decision more: Vulkan lets a sine be off by 2^-11, and so the direction of
                // a bounce in 25, and the place on the lens in 28. What such a ray meets moves a colour as much
                // as a shadow ray does.
                25 => (2, 0.0025 + 0.00125),
                28 => (2, 0.00125 + 0.00125),
                _ => return None,
            };
        Some(Self { decisions, mean, off: 1 })
    }

    /// The bounds of two pictures of which neither is exact: each may be on the other side.
    pub fn both(self) -> Self {
        Self { off: 2, ..self }
    }

    /// How many pixels of such a picture may flip.
    pub fn flips(&self, picture: &Picture) -> u32 {
        let beside = 2.0 * f64::from(self.off) * 7.3e-7 * f64::from(picture.width);
        self.decisions * (beside * picture.pixels.len() as f64).ceil() as u32
    }

    /// Whether two pictures of colours are as near as that. FLIP sees a picture as an eye does, blurred: one
    /// pixel that is another makes up to five that seem so.
    pub fn holds(&self, one: &Picture, other: &Picture) -> bool {
        let (mean, outliers) = flip(one, other);
        let flipped = outliers * one.pixels.len() as f32 / 5.0;
        mean <= self.off as f32 * self.mean && flipped <= self.flips(one) as f32
    }

    /// Whether two pictures of answers are: instances, triangles, distances, directions.
    ///
    /// A distance changes with the direction by the tangent of the angle between ray and normal. Beyond a
    /// thousandth it does so only under a grazing angle of a thousandth, which counts as flipped.
    pub fn answers(&self, one: &Picture, other: &Picture) -> bool {
        flipped(one, other) <= self.flips(one) as usize
    }
}

/// In how many pixels two pictures of answers are apart by more than arithmetic.
pub fn flipped(one: &Picture, other: &Picture) -> usize {
    assert_eq!((one.width, one.height), (other.width, other.height));
    let near = |(a, b): (&f32, &f32)| a == b || (a - b).abs() <= 1e-3 * a.abs().max(1.0);
    let pairs = one.pixels.iter().zip(&other.pixels);
    pairs.filter(|(one, other)| !one.iter().zip(other.iter()).all(near)).count()
}

/// In how many pixels two pictures of `show=hit` have another answer at the same distance, and in how many
/// others. The distance is that of either triangle's own test, off by up to 16 ULP (`docs/arithmetic.md`).
pub fn ties(one: &Picture, other: &Picture) -> (usize, usize) {
    let pairs = one.pixels.iter().zip(&other.pixels).filter(|(one, other)| one != other);
    let (mut ties, mut others) = (0, 0);
    for ([first, _, near, _], [second, _, far, _]) in pairs {
        let is_tie =
            *first >= 0.0 && *second >= 0.0 && (near - far).abs() <= 32.0 * f32::EPSILON * near;
        if is_tie { ties += 1 } else { others += 1 }
    }
    (ties, others)
}

/// Holds two pictures of `show=hit`, of builds in another order, to the same answers: to the bit on the software
/// driver, elsewhere but for ties and what flips.
#[track_caller]
pub fn same_hits(what: &str, chapter: &str, one: &Picture, other: &Picture) {
    let (ties, others) = ties(one, other);
    match device::is_software() {
        true => assert!(bits(one) == bits(other), "{what}: {ties} ties, {others} others"),
        false => {
            let flips = Near::of(chapter).both().flips(one) as usize;
            assert!(others <= flips, "{what}: {ties} ties, {others} others of {flips}");
        }
    }
}

/// Holds two pictures of colours, by different pipelines of the chapter, to be the same: to the bit on the
/// software driver, elsewhere as near as two pictures are that are both inexact.
#[track_caller]
pub fn same_colors(what: &str, chapter: &str, one: &Picture, other: &Picture) {
    match device::is_software() {
        true => assert!(bits(one) == bits(other), "{what}: other bits, {:?}", flip(one, other)),
        false => {
            let near = Near::of(chapter).both();
            assert!(near.holds(one, other), "{what}: {:?}, {near:?}", flip(one, other));
        }
    }
}

/// The same of pictures of answers, such as those of `show=hit`.
#[track_caller]
pub fn same_answers(what: &str, chapter: &str, one: &Picture, other: &Picture) {
    match device::is_software() {
        true => assert!(bits(one) == bits(other), "{what}: other bits, {}", flipped(one, other)),
        false => {
            let near = Near::of(chapter).both();
            assert!(near.answers(one, other), "{what}: {}, {near:?}", flipped(one, other));
        }
    }
}

/// The same of two pictures of random paths that meet `surfaces` each. A path that meets an edge goes elsewhere
/// from there on, as with other random numbers, which `drawn_anew` shows: one of a hundred may at each surface,
/// in either picture.
#[track_caller]
pub fn same_paths(what: &str, surfaces: f32, one: &Picture, other: &Picture, drawn_anew: &Picture) {
    let (mean, anew) = (flip(one, other).0, flip(one, drawn_anew).0);
    match device::is_software() {
        true => assert!(bits(one) == bits(other), "{what}: other bits, {mean}"),
        false => assert!(mean <= 2.0 * 0.01 * surfaces * anew, "{what}: {mean}, {anew}"),
    }
}

/// How far a chapter's picture by this device may be from the golden one, by the mean FLIP: `own` is what
/// the software driver, which made it, keeps. `None` if a picture shows the device's own errors.
pub(crate) fn golden_tolerance(name: &str, picture: &Picture, own: f32) -> Option<f32> {
    if device::is_software() {
        return Some(own);
    }
    let chapter = &name[..2];
    // What a picture of another seed has, and a hundredth of it for each surface that a path meets: see
    // `tests/samples/worst.rs`.
    let of_paths = |anew: f32, surfaces: f32| Some(own + 0.01 * surfaces * anew);
    match chapter {
        "24" => None,
        // Of 160x100 pixels and the golden's samples, by llvmpipe (Mesa 25.0.7).
        "11" => of_paths(0.074, 5.0),
        "29" => of_paths(0.134, 5.0),
        "27" => of_paths(0.140, 20.0),
        _ => {
            let near = Near::of(chapter);
            let flips = 5.0 * near.flips(picture) as f32 / picture.pixels.len() as f32;
            Some(own + near.mean + flips)
        }
    }
}
