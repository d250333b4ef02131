//! Variants of a solution, each with one wrong number. The check must reject them.

use std::fmt;

use anyhow::{Result, ensure};
use manuscript::fault::Fault;

use super::attempt::{Attempt, Originals};
use super::exercise::{Exercise, FORM};
use super::solution::Solution;
use crate::patches::edition::Patched;
use crate::patches::patch::{Field, Patch};
use crate::programs::interrupt;
use crate::programs::program::Programs;

/// A change of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Change {
    /// It is halved.
    Halved,
    /// It is doubled.
    Doubled,
    /// It has the other sign.
    Negated,
    /// It is a tenth larger.
    More,
}

impl Change {
    const WORDS: [(Self, &str); 4] = [
        (Self::Halved, "halved"),
        (Self::Doubled, "doubled"),
        (Self::Negated, "negated"),
        (Self::More, "a tenth more"),
    ];

    fn of(self, number: f64) -> f64 {
        match self {
            Self::Halved => number / 2.0,
            Self::Doubled => number * 2.0,
            Self::Negated => -number,
            Self::More => number * 1.1,
        }
    }
}

impl fmt::Display for Change {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let found = Self::WORDS.iter().find(|(change, _)| change == self);
        f.write_str(found.map_or("", |(_, word)| word))
    }
}

/// Variants that leave the picture unchanged, as declared in the exercise's file: `Same: 2.0 halved, doubled
/// because …`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Exempt {
    number: String,
    change: Change,
}

impl Exempt {
    /// Parses them, one per change.
    ///
    /// # Errors
    /// If there is none.
    pub fn parse(file: &str, field: &Field) -> Result<Vec<Self>, Fault> {
        let claim = field.value.split_once(" because ").map(|(claim, _)| claim);
        let read = || -> Option<Vec<Self>> {
            let (number, changes) = claim?.split_once(' ')?;
            let exempt = |how: &str| {
                let (change, _) = Change::WORDS.into_iter().find(|(_, word)| *word == how)?;
                Some(Self { number: number.to_owned(), change })
            };
            changes.split(", ").map(exempt).collect()
        };
        read().ok_or_else(|| {
            let what = format!("'{}' does not say which variant is the same", field.value);
            let form = "write `Same: 2.0 doubled because WHY`; or halved, negated, a tenth more";
            Fault::new(file, field.line, what, form)
        })
    }
}

impl fmt::Display for Exempt {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{} {}", self.number, self.change)
    }
}

/// A solution with one number changed.
struct Variant {
    what: Exempt,
    line: String,
    patch: Patch,
}

/// Every variant of a solution.
fn variants(exercise: &Exercise) -> Result<Vec<Variant>, Fault> {
    let text = &exercise.patch.text;
    let diff = text.len() - exercise.patch.diff().len();
    let mut found = Vec::new();
    let mut start = diff;
    for line in text[diff..].split_inclusive('\n') {
        let at = start;
        start += line.len();
        let code = line.split("//").next().unwrap_or_default();
        if !code.starts_with('+') || code.starts_with("+++") || code.starts_with("+#") {
            continue;
        }
        for (from, number) in numbers(code) {
            let mut tried = vec![number.to_owned()];
            for (change, _) in Change::WORDS {
                let Some(other) = changed(number, change).filter(|other| !tried.contains(other))
                else {
                    continue;
                };
                let (before, after) = (&text[..at + from], &text[at + from + number.len()..]);
                let patch =
                    Patch::parse(&exercise.patch.file, &format!("{before}{other}{after}"), FORM)?;
                tried.push(other);
                let what = Exempt { number: number.to_owned(), change };
                found.push(Variant { what, line: code[1..].trim().to_owned(), patch });
            }
        }
    }
    Ok(found)
}

/// The numbers in a line of a shader, each with its position.
fn numbers(code: &str) -> Vec<(usize, &str)> {
    let bytes = code.as_bytes();
    let is_name = |byte: u8| byte.is_ascii_alphanumeric() || byte == b'_' || byte == b'.';
    let (mut found, mut at) = (Vec::new(), 0);
    while at < bytes.len() {
        if !bytes[at].is_ascii_digit() {
            at += 1;
            continue;
        }
        let from = at;
        while at < bytes.len()
            && (is_name(bytes[at]) || b"+-".contains(&bytes[at]) && b"eE".contains(&bytes[at - 1]))
        {
            at += 1;
        }
        if from == 0 || !is_name(bytes[from - 1]) {
            found.push((from, &code[from..at]));
        }
    }
    found
}

/// The number with the change applied, written in the same form; `None` if that changes nothing.
fn changed(number: &str, change: Change) -> Option<String> {
    let plain = number.trim_end_matches(['u', 'U']);
    let unsigned = &number[plain.len()..];
    let told = match plain.parse::<i64>() {
        Ok(whole) => format!("{}", change.of(whole as f64).trunc() as i64),
        Err(_) => format!("{:?}", change.of(plain.parse::<f64>().ok()?)),
    };
    let same = told == plain;
    let zero = plain.parse::<f64>() == Ok(0.0);
    let told = format!("{told}{unsigned}");
    let signed = if told.starts_with('-') { format!("({told})") } else { told };
    (!same && !zero).then_some(signed)
}

/// Runs an exercise's check on every variant; the returned line counts them.
///
/// # Errors
/// If a variant is accepted that the file does not declare as the same, or a declared one is rejected.
pub fn prove(programs: &Programs, originals: &Originals, exercise: &Exercise) -> Result<String> {
    let solution = &Solution::new(programs, exercise);
    let attempt = Attempt { programs, originals, exercise, solution };
    let (mut refused, mut same, mut accepted) = (0, Vec::new(), Vec::new());
    for variant in variants(exercise).map_err(Fault::error)? {
        interrupt::asked()?;
        let edition = Patched::of(programs, &variant.patch)?;
        if !attempt.looks_solved(&edition.edition)? {
            refused += 1;
        } else if exercise.same.contains(&variant.what) {
            same.push(variant.what);
        } else {
            accepted.push(format!("{} in `{}`", variant.what, variant.line));
        }
    }
    let file = &exercise.patch.file;
    let (wrong, exempt) = (accepted.join(", "), same.len());
    ensure!(accepted.is_empty(), "{file}: the check accepts {wrong}");
    if let Some(other) = exercise.same.iter().find(|one| !same.contains(one)) {
        anyhow::bail!("{file}: {other} is not the same");
    }
    Ok(format!("{exercise}: {} variants, {refused} refused, {exempt} the same", refused + exempt))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_found_in_code_and_no_names() {
        let found = |code| numbers(code).into_iter().map(|(_, number)| number).collect::<Vec<_>>();
        assert_eq!(found("+ vec3(1e-3, u.x, t2.y) * 2u - 10.5"), ["1e-3", "2u", "10.5"]);
        assert_eq!(found("+ a[0] = x - 1;"), ["0", "1"]);
    }

    #[test]
    fn a_number_is_changed_as_it_is_written() {
        let all = |number| Change::WORDS.map(|(change, _)| changed(number, change));
        let some = |words: [&str; 4]| words.map(|word| (!word.is_empty()).then(|| word.to_owned()));
        assert_eq!(all("2.0"), some(["1.0", "4.0", "(-2.0)", "2.2"]));
        assert_eq!(all("1"), some(["0", "2", "(-1)", ""]));
        assert_eq!(all("11u"), some(["5u", "22u", "(-11u)", "12u"]));
        assert_eq!(all("0.0"), some(["", "", "", ""]));
    }
}
