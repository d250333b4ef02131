//! A set of a picture's samples: numbers, as ranges.

use std::fmt;
use std::ops::Range;

use serde::{Deserialize, Serialize};

/// A set of sample numbers.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "Vec<[u32; 2]>", into = "Vec<[u32; 2]>")]
pub struct SampleSet {
    /// In order, separate from each other, none empty.
    ranges: Vec<Range<u32>>,
}

impl SampleSet {
    /// Number of samples.
    pub fn count(&self) -> u64 {
        self.ranges.iter().map(|range| u64::from(range.end - range.start)).sum()
    }

    /// The numbers, range by range.
    pub fn ranges(&self) -> &[Range<u32>] {
        &self.ranges
    }

    /// The intersection of both.
    pub fn overlap(&self, other: &Self) -> Self {
        let mut both = Self::default();
        let (mut mine, mut others) =
            (self.ranges.iter().peekable(), other.ranges.iter().peekable());
        while let (Some(a), Some(b)) = (mine.peek(), others.peek()) {
            both.push(a.start.max(b.start)..a.end.min(b.end));
            if a.end < b.end {
                mine.next()
            } else {
                others.next()
            };
        }
        both
    }

    /// The part of `whole` that is missing.
    pub fn missing(&self, whole: Range<u32>) -> Self {
        let mut missing = Self::default();
        let mut next = whole.start;
        for range in &self.ranges {
            missing.push(next..range.start.min(whole.end));
            next = next.max(range.end);
        }
        missing.push(next..whole.end);
        missing
    }

    /// The samples missing between the first and the last.
    pub fn gaps(&self) -> Self {
        match &self.ranges[..] {
            [] => Self::default(),
            [first, .., last] => self.missing(first.start..last.end),
            [_] => Self::default(),
        }
    }

    /// True if it contains all of `other`.
    pub fn contain(&self, other: &Self) -> bool {
        self.overlap(other).count() == other.count()
    }

    /// Adds `other`, none of which may be present: no sample counts twice.
    ///
    /// # Errors
    /// Names those already present; then nothing is added.
    pub fn add(&mut self, other: &Self) -> Result<(), Self> {
        let both = self.overlap(other);
        if both.count() > 0 {
            return Err(both);
        }
        let mut ranges = std::mem::take(&mut self.ranges);
        ranges.extend_from_slice(&other.ranges);
        ranges.sort_by_key(|range| range.start);
        ranges.into_iter().for_each(|range| self.push(range));
        Ok(())
    }

    /// Appends a range that begins at the end of the last, or later; an empty one is ignored.
    fn push(&mut self, range: Range<u32>) {
        match self.ranges.last_mut() {
            _ if range.is_empty() => {}
            Some(last) if last.end == range.start => last.end = range.end,
            _ => self.ranges.push(range),
        }
    }
}

impl From<Range<u32>> for SampleSet {
    fn from(range: Range<u32>) -> Self {
        let mut samples = Self::default();
        samples.push(range);
        samples
    }
}

impl From<SampleSet> for Vec<[u32; 2]> {
    fn from(samples: SampleSet) -> Self {
        samples.ranges.into_iter().map(|range| [range.start, range.end]).collect()
    }
}

impl TryFrom<Vec<[u32; 2]>> for SampleSet {
    type Error = String;

    fn try_from(pairs: Vec<[u32; 2]>) -> Result<Self, String> {
        let mut samples = Self::default();
        for [start, end] in pairs {
            let after = samples.ranges.last().map_or(0, |last| last.end);
            if start >= end || start < after {
                return Err(format!("{start}..{end} is not a range of samples after {after}"));
            }
            samples.push(start..end);
        }
        Ok(samples)
    }
}

impl fmt::Display for SampleSet {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let ranges = self.ranges.iter().map(|range| format!("{}..{}", range.start, range.end));
        let ranges: Vec<_> = ranges.collect();
        f.write_str(if ranges.is_empty() { "none" } else { "" })?;
        f.write_str(&ranges.join(", "))
    }
}

/// Reads `A..B`: from sample A to the one before B, at least one.
///
/// # Errors
/// States the correct form.
pub fn range(text: &str) -> Result<Range<u32>, String> {
    let ends = text.split_once("..").map(|(a, b)| (a.trim().parse(), b.trim().parse::<u64>()));
    let end = u64::from(u32::MAX);
    match ends {
        Some((Ok(start), Ok(b))) if b <= end && start < b as u32 => Ok(start..b as u32),
        Some((Ok(_), Ok(b))) if b > end => Err(format!("samples are A..B, and B is at most {end}")),
        Some((Ok(_), Ok(_))) => Err("samples are A..B, and A must be below B".to_owned()),
        _ => Err("samples are A..B, from A to the one before B, such as 0..64".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(ranges: &[Range<u32>]) -> SampleSet {
        let mut samples = SampleSet::default();
        ranges.iter().for_each(|range| samples.add(&range.clone().into()).unwrap());
        samples
    }

    #[test]
    fn ranges_that_meet_are_one() {
        assert_eq!(of(&[4..8, 0..4, 10..12]).to_string(), "0..8, 10..12");
        assert_eq!(of(&[4..8, 0..4, 10..12]).count(), 10);
        assert_eq!(of(&[0..1, 2..3, 1..2]), (0..3).into());
    }

    #[test]
    fn no_sample_is_added_twice() {
        let mut samples = of(&[0..4, 8..12]);
        assert_eq!(samples.add(&(3..9).into()).unwrap_err().to_string(), "3..4, 8..9");
        assert_eq!(samples, of(&[0..4, 8..12]), "a refusal changes nothing");
    }

    #[test]
    fn what_is_missing_is_named() {
        let samples = of(&[2..4, 8..12]);
        assert_eq!(samples.missing(0..20).to_string(), "0..2, 4..8, 12..20");
        assert_eq!(samples.missing(3..10).to_string(), "4..8");
        assert_eq!(samples.missing(20..22).to_string(), "20..22");
        assert_eq!(samples.missing(0..1).to_string(), "0..1");
        assert_eq!(samples.gaps().to_string(), "4..8");
        assert!(samples.contain(&of(&[2..3, 9..12])) && !samples.contain(&(3..5).into()));
    }

    #[test]
    fn as_many_ranges_as_a_header_holds_are_compared_at_once() {
        // Comparing all pairs would take ten thousand million steps.
        let every = |first: u32| -> SampleSet {
            let pairs: Vec<_> = (0..100_000).map(|i| [first + 4 * i, first + 4 * i + 1]).collect();
            pairs.try_into().unwrap()
        };
        let work = time_limit::Work::of_this_thread();
        let (start, limit) = (std::time::Instant::now(), time_limit::Limit::worked(5));
        let mut samples = every(0);
        assert!(!samples.contain(&every(2)) && samples.contain(&every(0)));
        samples.add(&every(2)).unwrap();
        assert_eq!((samples.count(), samples.overlap(&every(2)).count()), (200_000, 100_000));
        assert!(!limit.is_over(work, start), "{:?}", work.done());
    }

    #[test]
    fn text_that_is_no_range_is_refused() {
        assert_eq!(range("0..64"), Ok(0..64));
        for (wrong, what) in [
            ("", "such as 0..64"),
            ("4", "such as 0..64"),
            ("-1..4", "such as 0..64"),
            ("a..b", "such as 0..64"),
            ("0..=4", "such as 0..64"),
            ("4..4", "A must be below B"),
            ("5..4", "A must be below B"),
            ("0..4294967296", "B is at most 4294967295"),
        ] {
            assert!(range(wrong).unwrap_err().contains(what), "{wrong}");
        }
    }

    #[test]
    fn a_file_with_ranges_out_of_order_is_refused() {
        let read = |text: &str| serde_json::from_str::<SampleSet>(text);
        assert_eq!(read("[[0,4],[4,8]]").unwrap(), (0..8).into());
        for wrong in ["[[4,4]]", "[[5,4]]", "[[0,4],[3,8]]", "[[4,8],[0,2]]"] {
            assert!(read(wrong).is_err(), "{wrong}");
        }
    }
}
