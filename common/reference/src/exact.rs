//! Exact numbers and vectors: rationals, made from floats without rounding.
//!
//! Every finite float is an integer times a power of two, so it *is* a rational, and sums, products
//! and quotients of rationals are rationals again: whatever needs no square root is decided here
//! without any error. Square roots are [`Surd`]s.

use std::cmp::Ordering;
use std::ops::{Add, Mul, Sub};

use dashu::rational::RBig;
use glam::DVec3;

use super::surd::Surd;

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

/// The f64 nearest to the square root of a rational, ties to even.
///
/// # Panics
/// If `x` is negative.
pub fn sqrt_to_f64(x: &RBig) -> f64 {
    Surd::new(RBig::ZERO, RBig::ONE, x.clone()).to_f64()
}

/// How a rational compares with zero: its sign.
pub fn sign(x: &RBig) -> Ordering {
    x.cmp(&RBig::ZERO)
}

/// A vector of three rationals.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Vector(pub [RBig; 3]);

impl From<DVec3> for Vector {
    /// The vector that the floats denote, without rounding.
    ///
    /// # Panics
    /// If a component is infinite or NaN.
    fn from(v: DVec3) -> Self {
        Self(v.to_array().map(rational))
    }
}

impl Vector {
    /// The scalar product.
    pub fn dot(&self, other: &Self) -> RBig {
        let ([a, b, c], [x, y, z]) = (&self.0, &other.0);
        a * x + b * y + c * z
    }

    /// The vector product.
    pub fn cross(&self, other: &Self) -> Self {
        let ([a, b, c], [x, y, z]) = (&self.0, &other.0);
        Self([b * z - c * y, c * x - a * z, a * y - b * x])
    }

    /// The scalar product with itself.
    pub fn length_squared(&self) -> RBig {
        self.dot(self)
    }

    /// The components, each rounded to the nearest f64.
    pub fn to_f64(&self) -> DVec3 {
        DVec3::from_array(self.0.each_ref().map(to_f64))
    }

    /// The vector divided by its length and multiplied by `factor`, which gives its side.
    ///
    /// # Panics
    /// If the vector is zero.
    pub fn normalized(&self, factor: &RBig) -> [Surd; 3] {
        let square = self.length_squared();
        let scale = factor / &square;
        (self.0.each_ref()).map(|x| Surd::new(RBig::ZERO, x * &scale, square.clone()))
    }

    fn zip(&self, other: &Self, f: impl Fn(&RBig, &RBig) -> RBig) -> Self {
        Self(std::array::from_fn(|i| f(&self.0[i], &other.0[i])))
    }
}

impl Add for &Vector {
    type Output = Vector;
    fn add(self, other: Self) -> Vector {
        self.zip(other, |a, b| a + b)
    }
}

impl Sub for &Vector {
    type Output = Vector;
    fn sub(self, other: Self) -> Vector {
        self.zip(other, |a, b| a - b)
    }
}

impl Mul<&RBig> for &Vector {
    type Output = Vector;
    fn mul(self, factor: &RBig) -> Vector {
        Vector(self.0.each_ref().map(|x| x * factor))
    }
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

        /// Rust's own square root is correctly rounded, so it must be found again.
        #[test]
        fn square_root_is_correctly_rounded(x in proptest::num::f64::POSITIVE | proptest::num::f64::SUBNORMAL) {
            let x = x.abs();
            prop_assert_eq!(sqrt_to_f64(&rational(x)), x.sqrt());
        }

        #[test]
        fn cross_is_perpendicular(a: [f32; 3], b: [f32; 3]) {
            prop_assume!(a.iter().chain(&b).all(|x| x.is_finite()));
            let [a, b] = [a, b].map(|v| Vector::from(glam::Vec3::from(v).as_dvec3()));
            let cross = a.cross(&b);
            prop_assert_eq!(cross.dot(&a), RBig::ZERO);
            prop_assert_eq!(cross.dot(&b), RBig::ZERO);
            // Lagrange's identity ties its length to the scalar product.
            let lengths = a.length_squared() * b.length_squared();
            prop_assert_eq!(cross.length_squared() + a.dot(&b) * a.dot(&b), lengths);
        }
    }
}
