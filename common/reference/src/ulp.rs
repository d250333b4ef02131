//! Error in units in the last place (ULP) of an f32.

/// `|t - exact| / 2^(floor(log2 |exact|) - 23)`: the error in gaps between f32 numbers around `exact`.
///
/// `exact` is the true value rounded to f64, whose own error is at most 2^-30 ULP of f32. A correctly
/// rounded `t` has at most 0.5. The unit goes on shrinking below f32's smallest normal number, 2^-126,
/// where the gaps of f32 do not. For `exact` = 0 the result is 0 or infinite; NaN gives NaN.
pub fn ulp_error(t: f32, exact: f64) -> f64 {
    let error = (f64::from(t) - exact).abs();
    if error == 0.0 {
        return 0.0;
    }
    // Division by a power of two is exact, and a power of two is what the sign and fraction hide.
    let power = f64::from_bits(exact.to_bits() & (0x7ff << 52));
    error / power * f64::from(1 << 23)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn counts_gaps() {
        assert_eq!(ulp_error(1.0, 1.0), 0.0);
        assert_eq!(ulp_error(1.0f32.next_up(), 1.0), 1.0);
        // Below a power of two the gaps are half as wide, and the unit is that of the exact value.
        assert_eq!(ulp_error(1.0f32.next_down(), 1.0), 0.5);
        assert_eq!(ulp_error(1.0, f64::from(1.0f32.next_down())), 1.0);
        assert_eq!(ulp_error(-4.0, -4.0 + 2f64.powi(-22)), 1.0);
        assert_eq!(ulp_error(0.0, 0.0), 0.0);
        assert_eq!(ulp_error(1.0, 0.0), f64::INFINITY);
        assert!(ulp_error(f32::NAN, 1.0).is_nan());
    }

    proptest! {
        #[test]
        fn rounding_costs_half_a_unit(exact in 1e-37..1e37f64) {
            prop_assert!(ulp_error(exact as f32, exact) <= 0.5);
            prop_assert!(ulp_error((exact as f32).next_up(), exact) >= 0.5);
        }
    }
}
