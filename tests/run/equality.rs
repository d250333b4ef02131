//! Bounds on the difference of two pictures computed with the same formulas.
//!
//! Vulkan promises equal results of *identical* pipelines, made of the same SPIR-V and the same state
//! (specification, appendix Invariance, rules 4 and 7). For two others, it only bounds the difference of each
//! from the exact result. On the software driver they are nevertheless compared bit for bit, which detects
//! more; on any other device, and in worst arithmetic with a seed, they are compared within bounds.

use common::app::Picture;
pub use flip::near::{Near, flipped};

use crate::{bits, device, flip};

/// The number of pixels in which two pictures of `show=hit` have another answer at the same distance, and of
/// other differences. The distance comes from either triangle's own test, which may be off by up to 16 ULP
/// (`docs/arithmetic.md`).
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

/// Checks that two pictures of `show=hit`, from builds in another order, agree: bit for bit on the software
/// driver, elsewhere except for ties and flips.
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

/// Checks that two pictures of colours, from different pipelines of the chapter, are equal: bit for bit on
/// the software driver, elsewhere within the bound for two inexact pictures.
#[track_caller]
pub fn same_colors(what: &str, chapter: &str, one: &Picture, other: &Picture) {
    if device::is_software() {
        assert!(bits(one) == bits(other), "{what}: other bits, {:?}", flip(one, other));
    } else {
        let near = Near::of(chapter).both();
        assert!(near.holds(one, other), "{what}: {:?}, {near:?}", flip(one, other));
    }
}

/// The same for pictures of data, such as those of `show=hit`.
#[track_caller]
pub fn same_answers(what: &str, chapter: &str, one: &Picture, other: &Picture) {
    if device::is_software() {
        assert!(bits(one) == bits(other), "{what}: other bits, {}", flipped(one, other));
    } else {
        let near = Near::of(chapter).both();
        assert!(near.answers(one, other), "{what}: {}, {near:?}", flipped(one, other));
    }
}

/// Bound on the mean FLIP between a chapter's picture by this device and the golden picture; `own` is the
/// bound for the software driver, which made it. `None` if a picture shows the device's own errors.
pub(crate) fn golden_tolerance(name: &str, picture: &Picture, own: f32) -> Option<f32> {
    if device::is_software() {
        return Some(own);
    }
    flip::near::golden(name, (picture.width, picture.height), own)
}
