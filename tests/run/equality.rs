//! Bounds on the difference of two pictures that come from the same formulas.
//!
//! Vulkan promises equal results of *identical* pipelines, made of the same SPIR-V and the same state
//! (specification, appendix Invariance, rules 4 and 7). Of two others it says no more than how far each may be
//! from the exact result. On the software driver they are held to the same bits all the same, which notices
//! more; on any other device, and in worst arithmetic that has a seed, to bounds.

use common::app::Picture;
pub use flip::near::{Near, flipped};

use crate::{bits, device, flip};

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
    if device::is_software() {
        assert!(bits(one) == bits(other), "{what}: {ties} ties, {others} others");
    } else {
        let flips = Near::of(chapter).both().flips(one) as usize;
        assert!(others <= flips, "{what}: {ties} ties, {others} others of {flips}");
    }
}

/// Holds two pictures of colours, by different pipelines of the chapter, to be the same: to the bit on the
/// software driver, elsewhere as near as two pictures are that are both inexact.
#[track_caller]
pub fn same_colors(what: &str, chapter: &str, one: &Picture, other: &Picture) {
    if device::is_software() {
        assert!(bits(one) == bits(other), "{what}: other bits, {:?}", flip(one, other));
    } else {
        let near = Near::of(chapter).both();
        assert!(near.holds(one, other), "{what}: {:?}, {near:?}", flip(one, other));
    }
}

/// The same of pictures of answers, such as those of `show=hit`.
#[track_caller]
pub fn same_answers(what: &str, chapter: &str, one: &Picture, other: &Picture) {
    if device::is_software() {
        assert!(bits(one) == bits(other), "{what}: other bits, {}", flipped(one, other));
    } else {
        let near = Near::of(chapter).both();
        assert!(near.answers(one, other), "{what}: {}, {near:?}", flipped(one, other));
    }
}

/// Bound on the mean FLIP between a chapter's picture by this device and the golden one: `own` is the bound for the
/// software driver, which made it. `None` if a picture shows the device's own errors.
pub(crate) fn golden_tolerance(name: &str, picture: &Picture, own: f32) -> Option<f32> {
    if device::is_software() {
        return Some(own);
    }
    flip::near::golden(name, (picture.width, picture.height), own)
}
