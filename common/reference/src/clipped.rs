//! Roots of a polynomial along a ray within a box, exactly.

use std::cmp::Ordering;

use dashu::rational::RBig;
use glam::DVec3;

use super::polynomial::{Dyadic, Polynomial, Sturm};
use super::rational::{rational, to_f64};
use super::ray::Ray;

/// An end of a ray's way through a box.
pub(crate) struct End {
    /// Ray parameter of the end.
    pub t: RBig,
    /// True if every face that the ray crosses there is a low one.
    pub are_low: bool,
    /// True if the end belongs to the box.
    pub is_inside: bool,
}

/// The ray's way through the closed box.
pub(crate) fn span(low: DVec3, high: DVec3, ray: &Ray) -> Option<[End; 2]> {
    let mut span: [Option<End>; 2] = [None, None];
    for k in 0..3 {
        let (o, d) = (rational(ray.origin[k]), rational(ray.direction[k]));
        let (low, high) = (rational(low[k]), rational(high[k]));
        if d.is_zero() {
            if o < low || o > high {
                return None;
            }
            continue;
        }
        let rises = d > RBig::ZERO;
        let [at_low, at_high] = [low, high].map(|face| (face - &o) / &d);
        let [first, last] = if rises { [at_low, at_high] } else { [at_high, at_low] };
        narrow(&mut span[0], End { t: first, are_low: rises, is_inside: true }, Ordering::Greater);
        narrow(&mut span[1], End { t: last, are_low: !rises, is_inside: true }, Ordering::Less);
    }
    let [Some(enter), Some(leave)] = span else { return None };
    (enter.t <= leave.t).then_some([enter, leave])
}

/// Takes the later (or earlier) of two ends, or both if they are at one place.
fn narrow(known: &mut Option<End>, new: End, wins: Ordering) {
    match known {
        Some(end) if new.t == end.t => end.are_low &= new.are_low,
        Some(end) if new.t.cmp(&end.t) != wins => {}
        _ => *known = Some(new),
    }
}

/// The roots within the span and the ray's interval, in order, to f64. The coefficients go with the powers of t. A multiple
/// root counts once; a polynomial that is 0 everywhere has none.
pub(crate) fn roots_within(coefficients: &[RBig], span: &[End; 2], ray: &Ray) -> Vec<f64> {
    let [enter, leave] = span;
    let polynomial = Polynomial::new(coefficients);
    if polynomial.degree().is_none() {
        return Vec::new();
    }
    let end = ray.tmax.min(to_f64(&leave.t).next_up());
    let start = ray.tmin.max(to_f64(&enter.t).next_down());
    if start >= end {
        return Vec::new();
    }
    let is_root = |t: &RBig| {
        let value = coefficients.iter().rev().fold(RBig::ZERO, |sum, c| sum * t + c);
        value.is_zero()
    };
    let sturm = Sturm::new(&polynomial);
    let mut bits = 96;
    let roots = loop {
        let roots = sturm.roots(start, end, bits);
        // Too near an end to tell the side, unless the end is a root.
        let is_open = |end: &End| {
            let is_near = |root: &[Dyadic; 2]| within(root, &end.t).is_eq();
            !is_root(&end.t) && roots.iter().any(is_near)
        };
        if !is_open(enter) && !is_open(leave) {
            break roots;
        }
        bits *= 2;
    };
    let is_inside = |root: &[Dyadic; 2]| {
        let from_enter = within(root, &enter.t);
        let from_leave = within(root, &leave.t);
        (from_enter.is_gt() || from_enter.is_eq() && enter.is_inside)
            && (from_leave.is_lt() || from_leave.is_eq() && leave.is_inside)
    };
    let inside = roots.into_iter().filter(is_inside);
    inside.map(|[_, high]| to_f64(&high.rational())).collect()
}

/// The comparison of a root with a number; equal if that is in the root's interval.
fn within([low, high]: &[Dyadic; 2], t: &RBig) -> Ordering {
    if low.rational() > *t {
        Ordering::Greater
    } else if high.rational() < *t {
        Ordering::Less
    } else {
        Ordering::Equal
    }
}
