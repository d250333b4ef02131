//! Polynomials with whole coefficients, and their real roots by Sturm's theorem: exactly.

use std::cmp::Ordering;

use dashu::integer::IBig;
use dashu::rational::RBig;

/// A polynomial; `0[i]` multiplies the i-th power, and the last coefficient is not 0.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Polynomial(Vec<IBig>);

/// `numerator / 2^places`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Dyadic {
    /// The number, times 2^places.
    pub numerator: IBig,
    /// Binary places behind the point.
    pub places: usize,
}

impl Dyadic {
    /// The rational it is.
    pub fn rational(&self) -> RBig {
        RBig::from(self.numerator.clone()) / RBig::from(IBig::ONE << self.places)
    }

    fn at(&self, places: usize) -> IBig {
        &self.numerator << (places - self.places)
    }
}

impl From<f64> for Dyadic {
    /// The number that a float denotes.
    fn from(x: f64) -> Self {
        let (numerator, denominator) = super::rational::rational(x).into_parts();
        Self { numerator, places: denominator.trailing_zeros().unwrap_or(0) }
    }
}

fn sign(x: &IBig) -> Ordering {
    x.cmp(&IBig::ZERO)
}

impl Polynomial {
    /// The polynomial with these coefficients times a positive number that makes all of them whole.
    pub fn new(coefficients: &[RBig]) -> Self {
        let mut common = IBig::ONE;
        for c in coefficients {
            common *= IBig::from(c.denominator().clone());
        }
        let factor = RBig::from(common);
        let whole = coefficients.iter().map(|c| (c * &factor).into_parts().0).collect();
        Self(whole).trimmed()
    }

    fn trimmed(mut self) -> Self {
        while self.0.last().is_some_and(IBig::is_zero) {
            self.0.pop();
        }
        self
    }

    /// The highest power; `None` if the polynomial is 0.
    pub fn degree(&self) -> Option<usize> {
        self.0.len().checked_sub(1)
    }

    fn derivative(&self) -> Self {
        let scaled = self.0.iter().enumerate().skip(1).map(|(i, c)| c * IBig::from(i));
        Self(scaled.collect()).trimmed()
    }

    /// The sign of the value at `x`.
    pub fn sign_at(&self, x: &Dyadic) -> Ordering {
        let mut sum = IBig::ZERO;
        for (above, c) in self.0.iter().rev().enumerate() {
            sum = sum * &x.numerator + (c << (above * x.places));
        }
        sign(&sum)
    }

    /// A positive multiple of the remainder by `divisor`, with the opposite sign.
    fn negative_remainder(&self, divisor: &Self) -> Self {
        let mut rest = self.0.clone();
        let (lead, tail) = divisor.0.split_last().expect("the divisor is not 0");
        while rest.len() > tail.len() {
            let top = rest.pop().expect("it is longer than the tail");
            // Times |lead|, so that the sign stays.
            let top = if sign(lead).is_lt() { -top } else { top };
            let positive = if sign(lead).is_lt() { -lead } else { lead.clone() };
            for c in &mut rest {
                *c *= &positive;
            }
            let shift = rest.len() - tail.len();
            for (c, d) in rest[shift..].iter_mut().zip(tail) {
                *c -= &top * d;
            }
        }
        Self(rest.into_iter().map(|c| -c).collect()).trimmed()
    }
}

/// A polynomial's Sturm chain: it counts the different real roots between two places.
#[derive(Clone, Debug)]
pub struct Sturm(Vec<Polynomial>);

impl Sturm {
    /// # Panics
    /// If the polynomial is 0.
    pub fn new(polynomial: &Polynomial) -> Self {
        assert!(polynomial.degree().is_some(), "0 has every number for a root");
        let mut chain = vec![polynomial.clone(), polynomial.derivative()];
        while let [.., a, b] = &chain[..] {
            if b.degree().is_none() {
                chain.pop();
                break;
            }
            let next = a.negative_remainder(b);
            chain.push(next);
        }
        Self(chain)
    }

    fn changes(&self, x: &Dyadic) -> usize {
        let signs: Vec<_> =
            self.0.iter().map(|member| member.sign_at(x)).filter(|sign| sign.is_ne()).collect();
        signs.windows(2).filter(|pair| pair[0] != pair[1]).count()
    }

    /// The number of different roots x with `low < x <= high`.
    ///
    /// At a multiple root every member of the chain is 0. It is then counted right all the same if it is `high`
    /// and wrong if it is `low`; [`Sturm::roots`] divides multiple roots out first.
    fn count(&self, low: &Dyadic, high: &Dyadic) -> usize {
        self.changes(low) - self.changes(high)
    }

    /// The different roots x with `low < x <= high`, in order, each within an interval whose ends differ by less than
    /// 2^-`bits` of the root.
    pub fn roots(&self, low: f64, high: f64, bits: usize) -> Vec<[Dyadic; 2]> {
        let simple = self.square_free();
        let [low, high] = [low, high].map(Dyadic::from);
        let places = low.places.max(high.places);
        let [low, high] = [&low, &high].map(|x| Dyadic { numerator: x.at(places), places });
        let mut found = Vec::new();
        if low.numerator < high.numerator {
            simple.isolate(low, high, bits, &mut found);
        }
        found
    }

    /// The chain of the polynomial that has each root once.
    fn square_free(&self) -> Self {
        let last = self.0.last().expect("a chain has a first member");
        if last.degree() == Some(0) {
            return self.clone();
        }
        Self::new(&self.0[0].divided_by(last))
    }

    fn isolate(&self, low: Dyadic, high: Dyadic, bits: usize, found: &mut Vec<[Dyadic; 2]>) {
        let count = self.count(&low, &high);
        if count == 0 {
            return;
        }
        if count == 1 {
            found.push(self.refined(low, high, bits));
            return;
        }
        let [low, middle, high] = halved(&low, &high);
        self.isolate(low, middle.clone(), bits, found);
        self.isolate(middle, high, bits, found);
    }

    /// Halves an interval with one simple root until it is short enough.
    fn refined(&self, mut low: Dyadic, mut high: Dyadic, bits: usize) -> [Dyadic; 2] {
        let polynomial = &self.0[0];
        let at_high = polynomial.sign_at(&high);
        if at_high.is_eq() {
            return [high.clone(), high];
        }
        loop {
            let width = &high.numerator - &low.numerator;
            let is_left = sign(&low.numerator).is_ge();
            let size = if is_left { &low.numerator } else { &-&high.numerator };
            if (width << bits) <= *size {
                return [low, high];
            }
            let [start, middle, end] = halved(&low, &high);
            let there = polynomial.sign_at(&middle);
            if there.is_eq() {
                return [middle.clone(), middle];
            }
            // A root at `low` itself is not this one.
            (low, high) = if there == at_high { (start, middle) } else { (middle, end) };
        }
    }
}

fn halved(low: &Dyadic, high: &Dyadic) -> [Dyadic; 3] {
    let places = low.places + 1;
    let middle = &low.numerator + &high.numerator;
    [low.at(places), middle, high.at(places)].map(|numerator| Dyadic { numerator, places })
}

impl Polynomial {
    /// The quotient by a divisor that leaves no remainder, times a positive or negative number.
    fn divided_by(&self, divisor: &Self) -> Self {
        let rational = |p: &Self| p.0.iter().cloned().map(RBig::from).collect::<Vec<_>>();
        let (mut rest, divisor) = (rational(self), rational(divisor));
        let lead = divisor.last().expect("the divisor is not 0");
        let mut quotient = vec![RBig::ZERO; rest.len() + 1 - divisor.len()];
        for i in (0..quotient.len()).rev() {
            let factor = &rest[i + divisor.len() - 1] / lead;
            for (k, d) in divisor.iter().enumerate() {
                let product = &factor * d;
                rest[i + k] -= product;
            }
            quotient[i] = factor;
        }
        Self::new(&quotient)
    }
}

#[cfg(test)]
mod tests {
    use super::super::rational::{rational, to_f64};
    use super::*;

    /// The product of x - root over all roots, times x² + `rest` if that is not 0.
    fn with_roots(roots: &[f64], rest: f64) -> Polynomial {
        let mut c = vec![RBig::ONE];
        let mut times = |factor: &[RBig]| {
            let mut product = vec![RBig::ZERO; c.len() + factor.len() - 1];
            for (i, a) in c.iter().enumerate() {
                for (k, b) in factor.iter().enumerate() {
                    product[i + k] += a * b;
                }
            }
            c = product;
        };
        for &root in roots {
            times(&[-rational(root), RBig::ONE]);
        }
        if rest != 0.0 {
            times(&[rational(rest), RBig::ZERO, RBig::ONE]);
        }
        Polynomial::new(&c)
    }

    fn found(polynomial: &Polynomial, low: f64, high: f64) -> Vec<f64> {
        let roots = Sturm::new(polynomial).roots(low, high, 60);
        roots.iter().map(|[_, high]| to_f64(&high.rational())).collect()
    }

    #[test]
    fn simple_double_triple_and_quadruple_roots_are_found_once() {
        for (roots, different) in [
            (&[-3.0, 0.1, 0.75, 1e6][..], &[-3.0, 0.1, 0.75, 1e6][..]),
            (&[0.5, 0.5, 2.0, 7.0], &[0.5, 2.0, 7.0]),
            (&[0.3, 0.3, 0.3, 7.0], &[0.3, 7.0]),
            (&[0.3, 0.3, 0.7, 0.7], &[0.3, 0.7]),
            (&[0.3, 0.3, 0.3, 0.3], &[0.3]),
            (&[0.0, 0.0, 1.0], &[0.0, 1.0]),
        ] {
            assert_eq!(found(&with_roots(roots, 0.0), -1e9, 1e9), different, "{roots:?}");
        }
    }

    #[test]
    fn complex_roots_do_not_count_and_roots_apart_by_a_rounding_do() {
        assert_eq!(found(&with_roots(&[2.0, 5.0], 1.0), 0.0, 10.0), [2.0, 5.0]);
        assert!(found(&with_roots(&[], 1e-300), -1.0, 1.0).is_empty());
        let next = 2f64.next_up();
        assert_eq!(found(&with_roots(&[2.0, next], 1.0), 0.0, 10.0), [2.0, next]);
    }

    #[test]
    fn the_lower_end_is_outside_and_the_upper_inside() {
        let polynomial = with_roots(&[0.0, 0.0, 1.0, 2.0], 0.0);
        assert_eq!(found(&polynomial, 0.0, 2.0), [1.0, 2.0]);
        assert_eq!(found(&polynomial, -1.0, 1.0), [0.0, 1.0]);
        assert_eq!(found(&polynomial, 1.0, 1.0), [0.0; 0]);
    }

    #[test]
    fn an_irrational_root_is_enclosed() {
        let polynomial = Polynomial::new(&[rational(-2.0), RBig::ZERO, RBig::ONE]);
        let [[low, high]] = Sturm::new(&polynomial).roots(0.0, 4.0, 80).try_into().unwrap();
        let square = |x: &Dyadic| x.rational() * x.rational();
        assert!(square(&low) < rational(2.0) && square(&high) > rational(2.0));
        assert_eq!(to_f64(&high.rational()), 2f64.sqrt());
    }
}
