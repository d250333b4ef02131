//! Vectors of three rationals.

use std::ops::{Add, Mul, Sub};

use dashu::rational::RBig;
use glam::DVec3;

use super::rational::{rational, to_f64};
use super::surd::Surd;

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

    proptest! {
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
