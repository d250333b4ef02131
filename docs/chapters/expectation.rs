//! What must hold of a run once an exercise is solved.

use std::fmt;

use anyhow::{Context, Result, anyhow, ensure};
use common::app::Picture;
use serde_json::Value;

use crate::amount::Amount;
use crate::command::quoted;
use crate::edition::Tested;
use crate::seen::{Seen, mean_difference, pixels_apart, same_bits};

/// What an expectation may look like, for whoever writes one.
pub const FORMS: &str = "write differs by 0.01 [to 0.03], differs in 9 [to 12] pixels, same [as ARGUMENTS], \
    pixel X Y is R G B, pixels R G B: N [to M], largest a is N [to M], report KEY N [to M], says TEXT, \
    refused: TEXT, validation: TEXT, passes, fails [with TEXT]";

/// The book's picture, or the reader's own, with which a run's picture is compared.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Other {
    /// Whether the reader's code makes it.
    pub own: bool,
    /// The first word of `arguments` may name a chapter; `None`: the run's own arguments.
    pub arguments: Option<Vec<String>>,
}

impl fmt::Display for Other {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let whose = if self.own { "and yours" } else { "the book's" };
        match &self.arguments {
            Some(arguments) if !arguments.is_empty() => write!(f, "{whose} with {}", quoted(arguments)),
            _ => f.write_str(whose),
        }
    }
}

/// What must hold.
#[derive(Clone, Debug, PartialEq)]
pub enum Expectation {
    /// The mean difference of the pictures over all channels in sRGB, of 1.
    DiffersBy(Amount, Other),
    /// The number of pixels that differ in 8 bits.
    DiffersIn(Amount, Other),
    /// The pictures are the same to the bit.
    Same(Other),
    /// The 8-bit colour of a pixel, from the upper left.
    Pixel([u32; 2], [Amount; 3]),
    /// How many pixels have an 8-bit colour.
    Pixels([u8; 3], Amount),
    /// The largest float in a channel.
    Largest(usize, Amount),
    /// The number at a dotted key of the report.
    Number(String, Amount),
    /// The text at a dotted key of the report.
    Text(String, String),
    /// A line that is printed holds this.
    Says(String),
    /// The program refuses by exit code 1 or 2, and a line holds this.
    Refused(String),
    /// A validation message holds this.
    Validation(String),
    /// The tests pass.
    Passes,
    /// A test fails, and what it says holds this.
    Fails(String),
}

/// Three values, each a number or `A to B`.
fn channels(words: &[&str]) -> Option<[Amount; 3]> {
    let (mut rest, mut found) = (words, Vec::new());
    while !rest.is_empty() {
        let count = if rest.get(1) == Some(&"to") { 3 } else { 1 };
        found.push(Amount::exactly(rest.get(..count)?)?);
        rest = &rest[count..];
    }
    found.try_into().ok()
}

/// What follows `from` or `as`: arguments as in a shell.
fn other(text: &str) -> Option<Other> {
    let mut arguments = shlex::split(text)?;
    let own = arguments.first().is_some_and(|word| word == "own");
    if own {
        arguments.remove(0);
    }
    Some(Other { own, arguments: Some(arguments) })
}

impl Expectation {
    /// Reads one; `None` if it is none.
    pub fn parse(text: &str) -> Option<Self> {
        let after =
            |start: &str| text.strip_prefix(start).map(str::trim).filter(|rest| !rest.is_empty());
        if let Some(text) = after("says ") {
            return Some(Self::Says(text.to_owned()));
        }
        if let Some(text) = after("refused:") {
            return Some(Self::Refused(text.to_owned()));
        }
        if let Some(text) = after("validation:") {
            return Some(Self::Validation(text.to_owned()));
        }
        if let Some(text) = after("fails with ") {
            return Some(Self::Fails(text.to_owned()));
        }
        if let Some(rest) = after("report ") {
            let (key, value) = rest.split_once(' ')?;
            let words: Vec<&str> = value.split_whitespace().collect();
            return Some(match Amount::exactly(&words) {
                Some(amount) => Self::Number(key.to_owned(), amount),
                None => Self::Text(key.to_owned(), value.trim().to_owned()),
            });
        }
        if let Some(arguments) = text.strip_prefix("same as ") {
            return other(arguments).map(Self::Same);
        }
        if let Some(rest) = after("differs ") {
            let (amount, from) = match rest.split_once(" from ") {
                Some((amount, from)) => (amount, other(from)?),
                None => (rest, Other::default()),
            };
            let words: Vec<&str> = amount.split_whitespace().collect();
            return match &words[..] {
                ["by", amount @ ..] => Some(Self::DiffersBy(Amount::at_least(amount)?, from)),
                ["in", amount @ .., "pixels" | "pixel"] => {
                    Some(Self::DiffersIn(Amount::exactly(amount)?, from))
                }
                _ => None,
            };
        }
        let words: Vec<&str> = text.split_whitespace().collect();
        match &words[..] {
            ["same"] => Some(Self::Same(Other::default())),
            ["passes"] => Some(Self::Passes),
            ["fails"] => Some(Self::Fails(String::new())),
            ["pixel", x, y, "is", rest @ ..] => {
                Some(Self::Pixel([x.parse().ok()?, y.parse().ok()?], channels(rest)?))
            }
            ["pixels", r, g, b, count @ ..] => {
                let blue = b.strip_suffix(':')?;
                let color = [r.parse().ok()?, g.parse().ok()?, blue.parse().ok()?];
                Some(Self::Pixels(color, Amount::exactly(count)?))
            }
            ["largest", channel, "is", amount @ ..] => {
                let channel = ["r", "g", "b", "a"].iter().position(|name| name == channel)?;
                Some(Self::Largest(channel, Amount::exactly(amount)?))
            }
            _ => None,
        }
    }

    /// Whether it is one of tests, not of a program's run.
    pub fn is_of_tests(&self) -> bool {
        matches!(self, Self::Passes | Self::Fails(_))
    }

    /// The picture that it compares with.
    pub fn other(&self) -> Option<&Other> {
        match self {
            Self::DiffersBy(_, other) | Self::DiffersIn(_, other) | Self::Same(other) => {
                Some(other)
            }
            _ => None,
        }
    }

    /// What was seen instead, if a run does not meet it; `other` is the picture to compare with.
    ///
    /// # Errors
    /// If there is no picture, or the other is of another size.
    pub fn missed(&self, seen: &Seen, other: Option<&Picture>) -> Result<Option<String>> {
        let picture =
            || seen.picture.as_ref().with_context(|| format!("no picture: {}", seen.said));
        let pictures = || -> Result<(&Picture, &Picture)> {
            let (own, other) = (picture()?, other.context("there is nothing to compare with")?);
            let [a, b] = [own, other].map(|picture| (picture.width, picture.height));
            ensure!(a == b, "pictures of {}x{} and {}x{} cannot be compared", a.0, a.1, b.0, b.1);
            Ok((own, other))
        };
        let held = |holds: bool, what: String| Ok((!holds).then_some(what));
        match self {
            Self::DiffersBy(amount, _) => {
                let (own, other) = pictures()?;
                let by = mean_difference(own, other);
                held(amount.holds(by), format!("differs by {by:.4}, not {}", amount))
            }
            Self::DiffersIn(amount, _) => {
                let (own, other) = pictures()?;
                let pixels = pixels_apart(own, other);
                let what = format!("differs in {pixels} pixels, not in {}", amount);
                held(amount.holds(pixels as f64), what)
            }
            Self::Same(_) => {
                let (own, other) = pictures()?;
                let pixels = pixels_apart(own, other);
                held(
                    same_bits(own, other),
                    match pixels {
                        0 => "not the same to the bit".to_owned(),
                        _ => format!("not the same: {pixels} pixels differ"),
                    },
                )
            }
            Self::Pixel([x, y], amounts) => {
                let picture = picture()?;
                let inside = *x < picture.width && *y < picture.height;
                ensure!(inside, "{x} {y} is no pixel of {}x{}", picture.width, picture.height);
                let at = 3 * (y * picture.width + x) as usize;
                let color = &picture.srgb()[at..at + 3];
                let holds =
                    amounts.iter().zip(color).all(|(amount, c)| amount.holds(f64::from(*c)));
                let wanted: Vec<String> = amounts.iter().map(Amount::to_string).collect();
                held(holds, format!("pixel {x} {y} is {color:?}, not [{}]", wanted.join(", ")))
            }
            Self::Pixels(color, amount) => {
                let pixels = picture()?.srgb();
                let count = pixels.chunks(3).filter(|pixel| pixel == color).count();
                let what = format!("{count} pixels are {color:?}, not {}", amount);
                held(amount.holds(count as f64), what)
            }
            Self::Largest(channel, amount) => {
                let values = picture()?.pixels.iter().map(|pixel| pixel[*channel]);
                let largest = values.fold(f32::NEG_INFINITY, f32::max);
                let what = format!("the largest value is {largest}, not {}", amount);
                held(amount.holds(f64::from(largest)), what)
            }
            Self::Number(key, amount) => {
                let value = at_key(&seen.report, key)?;
                let number =
                    value.as_f64().or_else(|| value.as_array().map(|list| list.len() as f64));
                let number =
                    number.with_context(|| format!("'{key}' of the report is no number"))?;
                held(amount.holds(number), format!("{key} is {number}, not {}", amount))
            }
            Self::Text(key, text) => {
                let value = at_key(&seen.report, key)?;
                let found = value.as_str().map_or_else(|| value.to_string(), str::to_owned);
                held(found == *text, format!("{key} is '{found}', not '{text}'"))
            }
            Self::Says(text) => held(
                seen.said.contains(text) || seen.told.contains(text),
                format!("does not say '{text}'"),
            ),
            Self::Refused(text) => {
                let refused = seen.status.and_then(|status| status.code());
                let refused = refused.is_some_and(|code| code == 1 || code == 2);
                let what = match refused {
                    true => format!("refused, but not by '{text}': {}", seen.said),
                    false => format!("not refused by '{text}'"),
                };
                held(refused && seen.said.contains(text), what)
            }
            Self::Validation(text) => {
                let heard = seen.messages().iter().any(|message| message.contains(text));
                held(heard, format!("validation does not say '{text}'"))
            }
            Self::Passes | Self::Fails(_) => Err(anyhow!("a run of a program is no test")),
        }
    }

    /// What was seen instead, if tests do not meet it.
    pub fn missed_by_tests(&self, tested: &Tested) -> Option<String> {
        match self {
            Self::Passes => (tested.failed > 0).then(|| format!("{} tests fail", tested.failed)),
            Self::Fails(_) if tested.failed == 0 => Some("all tests pass".to_owned()),
            Self::Fails(text) if !tested.said.contains(text) => {
                Some(format!("a test fails, but does not say '{text}'"))
            }
            _ => None,
        }
    }
}

fn at_key<'a>(report: &'a Value, key: &str) -> Result<&'a Value> {
    let step = |value: &'a Value, part: &str| match part.parse::<usize>() {
        Ok(index) if value.is_array() => value.get(index),
        _ => value.get(part),
    };
    let found = key.split('.').try_fold(report, step);
    found.with_context(|| format!("the report has no '{key}'"))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two pixels: mid grey and red.
    fn picture() -> Picture {
        Picture { width: 2, height: 1, pixels: vec![[0.5, 0.5, 0.5, 3.0], [1.0, 0.0, 0.0, -1.0]] }
    }

    fn seen(code: i32) -> Seen {
        #[cfg(unix)]
        let status = std::os::unix::process::ExitStatusExt::from_raw(code << 8);
        #[cfg(windows)]
        let status = std::os::windows::process::ExitStatusExt::from_raw(code as u32);
        let report = serde_json::json!({
            "groups": 3, "chapter": { "rows": [{ "name": "a b" }] }, "validation_messages": ["VUID-x: y"],
        });
        let (said, told) = ("no such control".to_owned(), "2 rays\n".to_owned());
        Seen { picture: Some(picture()), status: Some(status), said, told, report }
    }

    /// Whether it holds against a picture of which one pixel is black.
    fn holds(text: &str) -> bool {
        let expectation = Expectation::parse(text).unwrap_or_else(|| panic!("{text}"));
        let other = expectation.other().map(|other| {
            let mut picture = picture();
            // Called by arguments, the pictures are the same.
            if other.arguments.is_none() {
                picture.pixels[1] = [0.0; 4];
            }
            picture
        });
        let seen = seen(if text.starts_with("refused") { 2 } else { 0 });
        expectation.missed(&seen, other.as_ref()).unwrap().is_none()
    }

    #[test]
    fn each_holds_or_not() {
        for (true_one, false_one) in [
            ("differs by 0.16", "differs by 0.17"),
            ("differs by 0.1 to 0.2", "differs by 0.1 to 0.16"),
            ("differs in 1 pixels", "differs in 2 pixels"),
            ("differs in 1 to 4 pixels", "differs in 2 to 4 pixels"),
            ("differs in 0 pixels from --set a=b", "differs in 1 pixels from own --set a=b"),
            ("same as --set a=b", "same"),
            ("same as own", "same"),
            ("pixel 0 0 is 188 188 188", "pixel 0 0 is 188 188 187"),
            ("pixel 1 0 is 250 to 255 0 0", "pixel 1 0 is 250 to 254 0 0"),
            ("pixels 255 0 0: 1", "pixels 255 0 0: 2"),
            ("pixels 255 0 0: 0 to 1", "pixels 255 0 1: 1,000"),
            ("largest a is 3", "largest r is 3"),
            ("report groups 3", "report groups 4"),
            ("report validation_messages 1", "report validation_messages 0"),
            ("report groups 2 to 3", "report groups 4 to 5"),
            ("report chapter.rows.0.name a b", "report chapter.rows.0.name a"),
            ("says 2 rays", "says 3 rays"),
            ("says no such", "says any such"),
            ("refused: no such control", "refused: no such window"),
            ("validation: VUID-x", "validation: VUID-y"),
        ] {
            assert!(holds(true_one), "{true_one} should hold");
            assert!(!holds(false_one), "{false_one} should not hold");
        }
    }

    #[test]
    fn a_refusal_is_an_exit_code() {
        let refused = Expectation::parse("refused: no such control").unwrap();
        assert!(refused.missed(&seen(0), None).unwrap().is_some());
    }

    #[test]
    fn tests_pass_or_fail() {
        let tested = |failed| Tested { passed: 1, failed, said: "9 pixels differ".to_owned() };
        let missed = |text, failed| {
            Expectation::parse(text).unwrap().missed_by_tests(&tested(failed)).is_some()
        };
        assert_eq!([missed("passes", 0), missed("passes", 1)], [false, true]);
        assert_eq!([missed("fails", 1), missed("fails", 0)], [false, true]);
        assert_eq!(
            [missed("fails with 9 pixels", 1), missed("fails with 8 pixels", 1)],
            [false, true]
        );
    }

    #[test]
    fn what_cannot_be_compared_is_told() {
        let wide = Picture { width: 1, height: 2, ..picture() };
        let missed = |text: &str| {
            let expectation = Expectation::parse(text).unwrap();
            let wrong = expectation.missed(&seen(0), Some(&wide)).unwrap_err();
            format!("{wrong:#}")
        };
        assert_eq!(missed("same"), "pictures of 2x1 and 1x2 cannot be compared");
        assert_eq!(missed("pixel 2 0 is 0 0 0"), "2 0 is no pixel of 2x1");
        assert_eq!(missed("report chapter.gone 1"), "the report has no 'chapter.gone'");
    }

    #[test]
    fn what_is_none_is_refused() {
        for text in [
            "",
            "equal",
            "differs",
            "differs by",
            "differs by x",
            "differs in 3",
            "same as \"",
            "pixel 1 is 0 0 0",
            "pixel 0 0 is 1 2",
            "pixel 0 0 is 1 to 2",
            "pixels 1 2 3 4",
            "pixels 1 2 300: 4",
            "largest x is 1",
            "says",
            "refused:",
            "report",
            "report groups",
            "fails by",
            "passes well",
            "differs by NaN",
        ] {
            assert_eq!(Expectation::parse(text), None, "{text}");
        }
    }
}
