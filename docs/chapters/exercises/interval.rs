//! An expected number or range of numbers.

use std::fmt;

/// Numbers from `low` to `high`, both included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    low: f64,
    high: f64,
}

impl Interval {
    /// Parses `A`, exactly that number, or `A to B`; `None` if the words are neither.
    pub fn exactly(words: &[&str]) -> Option<Self> {
        let (low, high) = match words {
            [only] => (number(only)?, number(only)?),
            [low, "to", high] => (number(low)?, number(high)?),
            _ => return None,
        };
        (low <= high).then_some(Self { low, high })
    }

    /// Parses `A`, that number or more, or `A to B`; `None` if the words are neither.
    pub fn at_least(words: &[&str]) -> Option<Self> {
        let amount = Self::exactly(words)?;
        Some(if words.len() == 1 { Self { high: f64::INFINITY, ..amount } } else { amount })
    }

    /// Returns whether a number is below the interval.
    pub fn below(self, number: f64) -> bool {
        number < self.low
    }

    /// Returns whether a number is in the interval.
    pub fn holds(self, number: f64) -> bool {
        (self.low..=self.high).contains(&number)
    }
}

impl fmt::Display for Interval {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match *self {
            Self { low, high } if low == high => write!(f, "{low}"),
            Self { low, high: f64::INFINITY } => write!(f, "at least {low}"),
            Self { low, high } => write!(f, "{low} to {high}"),
        }
    }
}

/// Parses a number, with or without commas between thousands.
pub fn number(word: &str) -> Option<f64> {
    let is_thousands =
        |group: &str| group.split('.').next().is_some_and(|digits| digits.len() == 3);
    if !word.split(',').skip(1).all(is_thousands) {
        return None;
    }
    let plain = word.replace(',', "").replace('−', "-");
    plain.parse::<f64>().ok().filter(|number| number.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(text: &str) -> Vec<&str> {
        text.split_whitespace().collect()
    }

    #[test]
    fn one_number_or_two_ends() {
        let [one, range] =
            ["1,582", "-1 to 2.5"].map(|text| Interval::exactly(&words(text)).unwrap());
        assert_eq!([1582.0, 1583.0].map(|number| one.holds(number)), [true, false]);
        assert_eq!([-1.0, 2.5, 2.6].map(|number| range.holds(number)), [true, true, false]);
        let least = Interval::at_least(&["3"]).unwrap();
        assert_eq!([2.0, 3.0, 9.0].map(|number| least.holds(number)), [false, true, true]);
        let shown = [one, range, least].map(|amount| amount.to_string());
        assert_eq!(shown, ["1582", "-1 to 2.5", "at least 3"]);
        for text in ["", "x", "NaN", "1 or 2", "1 to", "2 to 1", "0,1,0"] {
            assert_eq!(Interval::exactly(&words(text)), None, "{text}");
        }
    }
}
