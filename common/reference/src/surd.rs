//! `p + q·√r` with rational p, q, r: all that spheres, planes and unit normals need of square roots.

use std::cmp::Ordering;

use dashu::base::{BitTest, SquareRoot};
use dashu::integer::{IBig, UBig};
use dashu::rational::RBig;

use super::rational::{rational, sign, to_f64};
use super::ray::Ray;

/// The real number `rational + factor·√radicand`, exactly.
///
/// Roots of a quadratic have this form with one radicand (the discriminant), and so has anything
/// linear in them, such as the point hit. Comparison with a rational is exact and conversion to f64
/// is correctly rounded; neither ever approximates the square root without knowing by how much.
#[derive(Clone, Debug)]
pub struct Surd {
    rational: RBig,
    factor: RBig,
    radicand: RBig,
}

impl From<RBig> for Surd {
    fn from(rational: RBig) -> Self {
        Self { rational, factor: RBig::ZERO, radicand: RBig::ZERO }
    }
}

impl Surd {
    /// The number `rational + factor·√radicand`.
    ///
    /// # Panics
    /// If `radicand` is negative.
    pub fn new(rational: RBig, factor: RBig, radicand: RBig) -> Self {
        assert!(radicand >= RBig::ZERO, "the square root of {radicand} is not real");
        Self { rational, factor, radicand }
    }

    /// The number `offset + scale·self`.
    pub fn affine(&self, scale: &RBig, offset: &RBig) -> Self {
        Self {
            rational: &self.rational * scale + offset,
            factor: &self.factor * scale,
            radicand: self.radicand.clone(),
        }
    }

    /// The sign of the number: its comparison with zero.
    pub fn sign(&self) -> Ordering {
        let left = sign(&self.rational);
        let right = if self.radicand.is_zero() { Ordering::Equal } else { sign(&self.factor) };
        if left == right || right == Ordering::Equal {
            return left;
        }
        // The two terms pull apart (or the first is zero): the larger square wins.
        let square = &self.factor * &self.factor * &self.radicand;
        match (&self.rational * &self.rational).cmp(&square) {
            Ordering::Greater => left,
            Ordering::Equal => Ordering::Equal,
            Ordering::Less => right,
        }
    }

    /// Compares the number with a rational.
    pub fn compare(&self, other: &RBig) -> Ordering {
        self.affine(&RBig::ONE, &-other).sign()
    }

    /// Compares the number with a float, which may be infinite.
    ///
    /// # Panics
    /// If `other` is NaN.
    pub fn compare_f64(&self, other: f64) -> Ordering {
        match other {
            f64::INFINITY => Ordering::Less,
            f64::NEG_INFINITY => Ordering::Greater,
            finite => self.compare(&rational(finite)),
        }
    }

    /// True if `tmin < self <= tmax` for this ray.
    pub fn within(&self, ray: &Ray) -> bool {
        self.compare_f64(ray.tmin).is_gt() && self.compare_f64(ray.tmax).is_le()
    }

    /// The nearest f64, ties to even.
    ///
    /// Ziv's strategy: enclose the square root between two rationals and round both ends. If they
    /// agree, that is the answer; if not, enclose more tightly. It ends because an irrational number
    /// is never halfway between two floats, and a rational one is recognised as a perfect square.
    pub fn to_f64(&self) -> f64 {
        if self.sign().is_eq() {
            return 0.0;
        }
        if self.factor.is_zero() || self.radicand.is_zero() {
            return to_f64(&self.rational);
        }
        // √(n/m) = √(n·m)/m, so that only an integer's root has to be enclosed.
        let (numerator, denominator) = self.radicand.clone().into_parts();
        let product = UBig::try_from(numerator).expect("not negative") * &denominator;
        let mut shift = 128usize.saturating_sub(product.bit_len() / 2);
        loop {
            let scaled = &product << (2 * shift);
            let root = scaled.sqrt();
            let denominator = &denominator << shift;
            let at = |root: UBig| {
                let root = RBig::from_parts(IBig::from(root), denominator.clone());
                to_f64(&(&self.rational + &self.factor * root))
            };
            let below = at(root.clone());
            if &root * &root == scaled || below == at(root + UBig::ONE) {
                return below;
            }
            shift = 2 * shift + 64;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn surd(p: f64, q: f64, r: f64) -> Surd {
        Surd::new(rational(p), rational(q), rational(r))
    }

    #[test]
    fn signs_where_the_terms_nearly_cancel() {
        // 665857/470832 exceeds √2 by 1.6e-12, 1607521/1136689 falls short of it by 2.7e-13.
        let above = RBig::from_parts(665_857.into(), 470_832u32.into());
        let below = RBig::from_parts(1_607_521.into(), 1_136_689u32.into());
        let root = surd(0.0, 1.0, 2.0);
        assert_eq!(root.compare(&above), Ordering::Less);
        assert_eq!(root.compare(&below), Ordering::Greater);
        assert_eq!(surd(-3.0, 1.0, 9.0).sign(), Ordering::Equal);
        assert_eq!(surd(-3.0, 1.0, 9.0).to_f64(), 0.0);
        assert_eq!(surd(5.0, 0.0, 9.0).sign(), Ordering::Greater);
        assert_eq!(surd(0.0, -1.0, 9.0).sign(), Ordering::Less);
    }

    #[test]
    fn cancellation_costs_no_digit() {
        // √(x² + 1) - x = 1/(√(x² + 1) + x): the left side cancels 60 digits for x = 1e30.
        let x = 1e30;
        let square = rational(x) * rational(x) + RBig::ONE;
        let difference = Surd::new(-rational(x), RBig::ONE, square).to_f64();
        assert_eq!(difference, 0.5 / x);
    }

    #[test]
    fn intervals_are_open_below_and_closed_above() {
        let ray =
            |tmin, tmax| Ray { origin: glam::DVec3::ZERO, direction: glam::DVec3::X, tmin, tmax };
        let two = surd(0.0, 1.0, 4.0);
        assert!(two.within(&ray(0.0, 2.0)) && two.within(&ray(f64::NEG_INFINITY, f64::INFINITY)));
        assert!(!two.within(&ray(2.0, 3.0)) && !two.within(&ray(0.0, 2f64.next_down())));
    }

    proptest! {
        /// Against f64 where f64 is good: no cancellation.
        #[test]
        fn agrees_with_f64(p in 0.1..10.0f64, q in 0.1..10.0f64, r in 1e-20..1e20f64) {
            let plain = p + q * r.sqrt();
            let exact = surd(p, q, r).to_f64();
            prop_assert!((exact - plain).abs() <= 3.0 * f64::EPSILON * plain);
        }

        /// Rust's own square root is correctly rounded, so it must be found again.
        #[test]
        fn square_root_is_correctly_rounded(x in proptest::num::f64::POSITIVE | proptest::num::f64::SUBNORMAL) {
            let x = x.abs();
            prop_assert_eq!(surd(0.0, 1.0, x).to_f64(), x.sqrt());
        }

        /// p - √(p²) is zero, and one unit in the last place more or less gives it a sign.
        #[test]
        fn perfect_squares_are_recognised(p in 1e-300..1e300f64) {
            let square = rational(p) * rational(p);
            let at = |p: f64| Surd::new(rational(p), -RBig::ONE, square.clone());
            prop_assert_eq!(at(p).to_f64(), 0.0);
            prop_assert_eq!(at(p.next_up()).sign(), Ordering::Greater);
            prop_assert_eq!(at(p.next_up()).to_f64(), p.next_up() - p);
            prop_assert_eq!(at(p.next_down()).to_f64(), p.next_down() - p);
        }
    }
}
