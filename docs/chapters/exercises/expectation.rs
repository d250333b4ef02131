//! The conditions on a run once an exercise is solved.

use std::fmt;

use super::interval::Interval;
use crate::programs::command_line::quoted;

/// The forms of an expectation, for error messages.
pub const FORMS: &str = "write as the solution [but for 9 pixels], differs by 0.01 [to 0.03], differs in 9 [to 12] pixels, same [as ARGUMENTS], \
    pixel X Y is R G B, pixels R G B: N [to M], largest a is N [to M], report KEY N [to M], says TEXT, \
    refused: TEXT, validation: TEXT, gone: CODE, passes, fails [with TEXT]";

/// The picture to compare with: the book's, or another one of the reader's.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Other {
    /// True if the reader's code makes it.
    pub own: bool,
    /// The first word of `arguments` may name a chapter; `None`: the run's own arguments.
    pub arguments: Option<Vec<String>>,
}

impl fmt::Display for Other {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let whose = if self.own { "and yours" } else { "the book's" };
        match &self.arguments {
            Some(arguments) if !arguments.is_empty() => {
                write!(f, "{whose} with {}", quoted(arguments))
            }
            _ => f.write_str(whose),
        }
    }
}

/// A condition on a run.
#[derive(Clone, Debug, PartialEq)]
pub enum Expectation {
    /// The picture is the solution's, except for this many pixels; `None` for one in a thousand.
    AsSolution(Option<usize>),
    /// The mean difference of the pictures over all channels in sRGB, of 1.
    DiffersBy(Interval, Other),
    /// The number of pixels that differ in 8 bits.
    DiffersIn(Interval, Other),
    /// The pictures are the same: bit for bit on a software driver, within its arithmetic on other devices.
    Same(Other),
    /// The 8-bit colour of a pixel, from the upper left.
    Pixel([u32; 2], [Interval; 3]),
    /// The number of pixels of an 8-bit colour.
    Pixels([u8; 3], Interval),
    /// The largest float in a channel.
    Largest(usize, Interval),
    /// The number at a dotted key of the report.
    Number(String, Interval),
    /// The text at a dotted key of the report.
    Text(String, String),
    /// A printed line contains this.
    Says(String),
    /// The program exits with code 1 or 2, and a line contains this.
    Refused(String),
    /// A validation message contains this.
    Validation(String),
    /// This code no longer occurs in the files the solution changes. Another way to the same picture would
    /// leave it there.
    Gone(String),
    /// The tests pass.
    Passes,
    /// A test fails, and its output contains this.
    Fails(String),
}

/// Three values, each a number or `A to B`.
fn channels(words: &[&str]) -> Option<[Interval; 3]> {
    let (mut rest, mut found) = (words, Vec::new());
    while !rest.is_empty() {
        let count = if rest.get(1) == Some(&"to") { 3 } else { 1 };
        found.push(Interval::exactly(rest.get(..count)?)?);
        rest = &rest[count..];
    }
    found.try_into().ok()
}

/// The words after `from` or `as`: arguments as in a shell.
fn other(text: &str) -> Option<Other> {
    let mut arguments = shlex::split(text)?;
    let own = arguments.first().is_some_and(|word| word == "own");
    if own {
        arguments.remove(0);
    }
    Some(Other { own, arguments: Some(arguments) })
}

impl Expectation {
    /// Parses an expectation; `None` if it has none of the forms.
    pub fn parse(text: &str) -> Option<Self> {
        type Of = fn(String) -> Expectation;
        let after =
            |start: &str| text.strip_prefix(start).map(str::trim).filter(|rest| !rest.is_empty());
        let texts: [(&str, Of); 5] = [
            ("says ", Self::Says),
            ("refused:", Self::Refused),
            ("validation:", Self::Validation),
            ("gone:", Self::Gone),
            ("fails with ", Self::Fails),
        ];
        let found = texts.into_iter().find_map(|(start, of)| Some(of(after(start)?.to_owned())));
        if found.is_some() {
            return found;
        }
        if let Some(rest) = after("report ") {
            let (key, value) = rest.split_once(' ')?;
            let words: Vec<&str> = value.split_whitespace().collect();
            return Some(match Interval::exactly(&words) {
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
                ["by", amount @ ..] => Some(Self::DiffersBy(Interval::at_least(amount)?, from)),
                ["in", amount @ .., "pixels" | "pixel"] => {
                    Some(Self::DiffersIn(Interval::exactly(amount)?, from))
                }
                _ => None,
            };
        }
        let words: Vec<&str> = text.split_whitespace().collect();
        match &words[..] {
            ["as", "the", "solution"] => Some(Self::AsSolution(None)),
            ["as", "the", "solution", "but", "for", pixels, "pixels"] => {
                Some(Self::AsSolution(Some(pixels.parse().ok()?)))
            }
            ["same"] => Some(Self::Same(Other::default())),
            ["passes"] => Some(Self::Passes),
            ["fails"] => Some(Self::Fails(String::new())),
            ["pixel", x, y, "is", rest @ ..] => {
                Some(Self::Pixel([x.parse().ok()?, y.parse().ok()?], channels(rest)?))
            }
            ["pixels", r, g, b, count @ ..] => {
                let blue = b.strip_suffix(':')?;
                let color = [r.parse().ok()?, g.parse().ok()?, blue.parse().ok()?];
                Some(Self::Pixels(color, Interval::exactly(count)?))
            }
            ["largest", channel, "is", amount @ ..] => {
                let channel = ["r", "g", "b", "a"].iter().position(|name| name == channel)?;
                Some(Self::Largest(channel, Interval::exactly(amount)?))
            }
            _ => None,
        }
    }

    /// Returns whether it is a condition on tests rather than on a run of the program.
    pub fn is_of_tests(&self) -> bool {
        matches!(self, Self::Passes | Self::Fails(_))
    }

    /// Returns whether it repeats the page's description of the picture. The solution must meet it; a
    /// reader's picture need not if it is compared with the solution's.
    pub fn describes(&self) -> bool {
        matches!(
            self,
            Self::DiffersBy(..)
                | Self::DiffersIn(..)
                | Self::Pixel(..)
                | Self::Pixels(..)
                | Self::Largest(..)
        )
    }

    /// The picture to compare with.
    pub fn other(&self) -> Option<&Other> {
        match self {
            Self::DiffersBy(_, other) | Self::DiffersIn(_, other) | Self::Same(other) => {
                Some(other)
            }
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_none_is_refused() {
        for text in [
            "",
            "equal",
            "as",
            "as the solution but",
            "as the solution but for x pixels",
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
            "gone:",
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
