//! Operations with a bounded error: operands, the exact result, and the error bound.

use std::f64::consts::LN_2;

use glam::Vec3;

/// The distance between neighbouring floats at x.
pub fn ulp(x: f64) -> f64 {
    let exponent = (x.abs().max(1e-300).to_bits() >> 52) as i32 - 1023;
    2f64.powi(exponent.max(-126) - 23)
}

/// Numbers from 0 to 1, the same in every run.
pub struct Random(pub u32);

impl Random {
    pub fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
        let word = ((self.0 >> ((self.0 >> 28) + 4)) ^ self.0).wrapping_mul(277_803_737);
        (((word >> 22) ^ word) >> 8) as f32 / 16_777_216.0
    }

    pub fn within(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.next()
    }

    /// A number within 2^±10, of either sign.
    pub fn any(&mut self) -> f32 {
        let size = self.within(-10.0, 10.0).exp2();
        if self.next() < 0.5 { size } else { -size }
    }
}

/// An operation with an error bound: its number in the shader, its operands, and a function that returns the
/// exact result and the bound.
pub struct Bounded {
    pub name: &'static str,
    pub number: u32,
    pub operands: fn(&mut Random) -> Vec3,
    pub exact: fn(f64, f64, f64) -> f64,
    pub bound: fn(f64, f64, f64) -> f64,
}

pub fn pair(random: &mut Random) -> Vec3 {
    Vec3::new(random.any(), random.any(), random.any())
}

fn positive(random: &mut Random) -> Vec3 {
    pair(random).abs()
}

fn angle(random: &mut Random) -> Vec3 {
    let most = std::f32::consts::PI.next_down();
    Vec3::splat(random.within(-most, most))
}

fn exponent(random: &mut Random) -> Vec3 {
    Vec3::splat(random.within(-20.0, 20.0))
}

/// An angle whose sine and cosine are both well above 0.
fn acute(random: &mut Random) -> Vec3 {
    Vec3::splat(random.within(0.1, 1.4))
}

fn sine(random: &mut Random) -> Vec3 {
    Vec3::splat(random.within(-0.999, 0.999))
}

/// Two numbers, and the weight of the second in a blend.
fn blend(random: &mut Random) -> Vec3 {
    Vec3::new(random.any(), random.any(), random.next())
}

/// An edge, a larger edge, and a number between them.
fn edges(random: &mut Random) -> Vec3 {
    let (low, high) = (random.within(-4.0, 0.0), random.within(1.0, 4.0));
    Vec3::new(low, high, random.within(0.1, 0.9) * (high - low) + low)
}

/// A direction, and a ratio of refractive indices without total reflection.
fn refracted(random: &mut Random) -> Vec3 {
    Vec3::new(random.within(-0.4, 0.4), random.within(-0.9, -0.5), random.within(0.5, 1.0))
}

fn near_one(random: &mut Random) -> Vec3 {
    Vec3::splat(random.within(0.5, 2.0))
}

/// The largest distance between `of` and `of(x)`, for numbers within `off` of `x`.
fn spread(of: impl Fn(f64) -> f64, x: f64, off: f64) -> f64 {
    (of(x + off) - of(x)).abs().max((of(x - off) - of(x)).abs())
}

fn logarithm_bound(x: f64, exact: f64) -> f64 {
    if (0.5..=2.0).contains(&x) { 2f64.powi(-21) } else { 3.0 * ulp(exact) }
}

fn power_bound(x: f64, y: f64) -> f64 {
    let product = y * x.log2();
    let off = logarithm_bound(x, x.log2()) * y.abs();
    let off = off + 1.01 * ulp(product.abs() + off);
    let largest = (product + off).exp2();
    spread(f64::exp2, product, off) + (3.0 + 2.0 * (product.abs() + off)) * ulp(largest)
}

/// Error bound of a quotient if `x` and `y` have these errors: 2.5 ULP for the division.
fn quotient_bound(x: f64, x_off: f64, y: f64, y_off: f64) -> f64 {
    let (exact, largest) = ((x / y).abs(), (x.abs() + x_off) / (y.abs() - y_off));
    largest - exact + 2.5 * ulp(largest)
}

/// Error bound of √(1 - x²).
fn leg_bound(x: f64) -> f64 {
    let rest = 1.0 - x * x;
    let off = ulp(x * x) + ulp(rest + ulp(x * x));
    spread(f64::sqrt, rest, off) + root_bound(rest + off)
}

fn mix_bound(x: f64, y: f64, a: f64) -> f64 {
    let rest_off = x.abs() * ulp(1.0 - a);
    let (first, second) = ((x * (1.0 - a)).abs(), (y * a).abs());
    let off = rest_off + ulp(first + rest_off) + ulp(second);
    off + ulp((x * (1.0 - a) + y * a).abs() + off)
}

fn smooth(t: f64) -> f64 {
    t * t * (3.0 - 2.0 * t)
}

fn smoothstep_bound(low: f64, high: f64, x: f64) -> f64 {
    let t = (x - low) / (high - low);
    let t_off = quotient_bound(x - low, ulp(x - low), high - low, ulp(high - low));
    let square = t * t + 2.0 * t * t_off + t_off * t_off;
    let rest = 3.0 - 2.0 * t + 2.0 * t_off;
    let off = spread(smooth, t, t_off) + ulp(square) * rest + ulp(rest) * (square + ulp(square));
    off + ulp(smooth(t) + off)
}

/// Through a plane across y: η·y - (η·y + √k), k = 1 - η²·(1 - y²).
fn refract_bound(y: f64, eta: f64) -> f64 {
    let rest = 1.0 - y * y;
    let rest_off = ulp(y * y) + ulp(rest + ulp(y * y));
    let (square, square_off) = (eta * eta, ulp(eta * eta));
    let product = (square + square_off) * (rest + rest_off);
    let product_off = product - square * rest + ulp(product);
    let k = 1.0 - square * rest;
    let k_off = product_off + ulp(k + product_off);
    let root = k.sqrt();
    let root_off = spread(f64::sqrt, k, k_off) + root_bound(k + k_off);
    let bent = (eta * y).abs();
    let sum_off = root_off + ulp(bent) + ulp((root - bent).abs() + root_off + ulp(bent));
    sum_off + ulp(bent) + ulp(root + sum_off + ulp(bent))
}

fn root_bound(x: f64) -> f64 {
    let inverse = 1.0 / x.sqrt();
    let off = spread(|inverse| 1.0 / inverse, inverse, 2.0 * ulp(inverse));
    off + 2.5 * ulp(x.sqrt() + off)
}

pub const BOUNDED: [Bounded; 20] = [
    Bounded {
        name: "division",
        number: 3,
        operands: pair,
        exact: |x, y, _| x / y,
        bound: |x, y, _| 2.5 * ulp(x / y),
    },
    Bounded {
        name: "sqrt",
        number: 4,
        operands: positive,
        exact: |x, _, _| x.sqrt(),
        bound: |x, _, _| root_bound(x),
    },
    Bounded {
        name: "inversesqrt",
        number: 5,
        operands: positive,
        exact: |x, _, _| 1.0 / x.sqrt(),
        bound: |x, _, _| 2.0 * ulp(1.0 / x.sqrt()),
    },
    Bounded {
        name: "exp2",
        number: 6,
        operands: exponent,
        exact: |x, _, _| x.exp2(),
        bound: |x, _, _| (3.0 + 2.0 * x.abs()) * ulp(x.exp2()),
    },
    Bounded {
        name: "exp",
        number: 7,
        operands: exponent,
        exact: |x, _, _| x.exp(),
        bound: |x, _, _| (3.0 + 2.0 * x.abs()) * ulp(x.exp()),
    },
    Bounded {
        name: "log2 near 1",
        number: 8,
        operands: near_one,
        exact: |x, _, _| x.log2(),
        bound: |_, _, _| 2f64.powi(-21),
    },
    Bounded {
        name: "log2",
        number: 8,
        operands: positive,
        exact: |x, _, _| x.log2(),
        bound: |x, _, _| logarithm_bound(x, x.log2()),
    },
    Bounded {
        name: "log",
        number: 9,
        operands: positive,
        exact: |x, _, _| x.log2() * LN_2,
        bound: |x, _, _| logarithm_bound(x, x.ln()),
    },
    Bounded {
        name: "sin",
        number: 10,
        operands: angle,
        exact: |x, _, _| x.sin(),
        bound: |_, _, _| 2f64.powi(-11),
    },
    Bounded {
        name: "cos",
        number: 11,
        operands: angle,
        exact: |x, _, _| x.cos(),
        bound: |_, _, _| 2f64.powi(-11),
    },
    Bounded {
        name: "tan",
        number: 20,
        operands: acute,
        exact: |x, _, _| x.tan(),
        bound: |x, _, _| quotient_bound(x.sin(), 2f64.powi(-11), x.cos(), 2f64.powi(-11)),
    },
    Bounded {
        name: "asin",
        number: 21,
        operands: sine,
        exact: |x, _, _| x.asin(),
        bound: |x, _, _| {
            let leg = (1.0 - x * x).sqrt();
            let off = spread(|leg| x.atan2(leg), leg, leg_bound(x));
            off + 4096.0 * ulp(x.asin().abs() + off)
        },
    },
    Bounded {
        name: "acos",
        number: 22,
        operands: sine,
        exact: |x, _, _| x.acos(),
        bound: |x, _, _| {
            let leg = (1.0 - x * x).sqrt();
            let off = spread(|leg| leg.atan2(x), leg, leg_bound(x));
            off + 4096.0 * ulp(x.acos() + off)
        },
    },
    Bounded {
        name: "atan",
        number: 12,
        operands: pair,
        exact: |x, _, _| x.atan(),
        bound: |x, _, _| 4096.0 * ulp(x.atan()),
    },
    Bounded {
        name: "atan2",
        number: 13,
        operands: pair,
        exact: |x, y, _| x.atan2(y),
        bound: |x, y, _| 4096.0 * ulp(x.atan2(y)),
    },
    Bounded {
        name: "pow",
        number: 14,
        operands: positive,
        exact: |x, y, _| x.powf(y.min(9.0)),
        bound: |x, y, _| power_bound(x, y.min(9.0)),
    },
    Bounded {
        name: "length",
        number: 17,
        operands: pair,
        exact: |x, y, z| (x * x + y * y + z * z).sqrt(),
        bound: |x, y, z| {
            let square = x * x + y * y + z * z;
            // Three products and two sums, each with an error of at most one ULP of the whole.
            let off = 5.0 * ulp(square);
            spread(f64::sqrt, square, off) + root_bound(square + off)
        },
    },
    Bounded {
        name: "mix",
        number: 23,
        operands: blend,
        exact: |x, y, a| x * (1.0 - a) + y * a,
        bound: mix_bound,
    },
    Bounded {
        name: "smoothstep",
        number: 24,
        operands: edges,
        exact: |low, high, x| smooth((x - low) / (high - low)),
        bound: smoothstep_bound,
    },
    Bounded {
        name: "refract",
        number: 25,
        operands: refracted,
        exact: |_, y, eta| -(1.0 - eta * eta * (1.0 - y * y)).sqrt(),
        bound: |_, y, eta| refract_bound(y, eta),
    },
];
