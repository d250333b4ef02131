//! Rational numbers, made from floats without rounding.
//!
//! Every finite float is an integer times a power of two, so it *is* a rational, and sums, products
//! and quotients of rationals are rationals again: whatever needs no square root is decided here
//! without any error. Square roots are surds.

use std::cmp::Ordering;

use dashu::rational::RBig;

/// The rational that a float denotes, without rounding; pass an f32 through `f64::from`.
///
/// # Panics
/// If `x` is infinite or NaN.
pub fn rational(x: f64) -> RBig {
    RBig::try_from(x).unwrap_or_else(|_| panic!("{x} is not a rational number"))
}

/// The f64 nearest to a rational, ties to even.
pub fn to_f64(x: &RBig) -> f64 {
    x.to_f64().value()
}

/// The sign of a rational: its comparison with zero.
pub fn sign(x: &RBig) -> Ordering {
    x.cmp(&RBig::ZERO)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn extreme_floats_make_the_round_trip() {
        for x in [0.0, 5e-324, 1e-310, f64::MIN_POSITIVE, f64::MAX, -1.5] {
            assert_eq!(to_f64(&rational(x)), x);
        }
        assert_eq!(rational(-0.0), RBig::ZERO);
        assert_eq!(rational(f64::from(f32::from_bits(1))) * rational(2f64.powi(149)), RBig::ONE);
    }

    #[test]
    fn rounding_is_to_nearest_even() {
        let half_ulp = rational(f64::EPSILON) / RBig::from(2);
        let nudge = rational(5e-324);
        assert_eq!(to_f64(&(RBig::ONE + &half_ulp)), 1.0);
        assert_eq!(to_f64(&(RBig::ONE + &half_ulp + &nudge)), 1.0 + f64::EPSILON);
        assert_eq!(to_f64(&(RBig::ONE + half_ulp * RBig::from(3))), 1.0 + 2.0 * f64::EPSILON);
    }

    #[test]
    #[should_panic(expected = "not a rational")]
    fn nan_is_refused() {
        rational(f64::NAN);
    }

    proptest! {
        #[test]
        fn floats_make_the_round_trip(x in proptest::num::f64::NORMAL | proptest::num::f64::SUBNORMAL) {
            prop_assert_eq!(to_f64(&rational(x)), x);
        }
    }
}
