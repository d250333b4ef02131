//! The reason why an exercise is not solved: a line of text, the run that showed it, and the compared
//! pictures.

use std::fmt;

use anyhow::{Context, Result, anyhow, ensure};
use common::app::Picture;
use flip::near::Near;
use serde_json::Value;

use super::expectation::Expectation;
use super::interval::Interval;
use crate::patches::edition::Tested;
use crate::pictures::difference::{darker_and_brighter, mean_difference, pixels_apart, same_bits};
use crate::programs::command_line::quoted;
use crate::programs::run_result::RunResult;

/// A result other than the expected one.
#[derive(Default)]
pub struct Mismatch {
    /// The description, in one line.
    pub what: String,
    /// The arguments of the run that showed it; `None` if it was not a run of a program.
    pub arguments: Option<Vec<String>>,
    /// A picture to look at beside it, and its description.
    pub beside: Option<(String, Picture)>,
}

impl fmt::Display for Mismatch {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(&self.what)?;
        match &self.arguments {
            Some(arguments) => write!(f, " with {}", quoted(arguments)),
            None => Ok(()),
        }
    }
}

impl From<String> for Mismatch {
    fn from(what: String) -> Self {
        Self { what, ..Self::default() }
    }
}

impl Mismatch {
    /// The line for a reader, including the paths of the two pictures.
    pub fn told(&self, own: &str, other: &str) -> String {
        match &self.beside {
            Some((with, _)) => format!("{self}: yours {own}, {with} {other}"),
            None if self.arguments.is_some() => format!("{self}: {own}"),
            None => self.to_string(),
        }
    }
}

impl Expectation {
    /// Checks a run against the expectation, and describes the mismatch if there is one. `other` is the
    /// picture to compare with; `near`, called only when needed, returns the tolerance for equal pictures, or
    /// `None` for bitwise equality.
    ///
    /// # Errors
    /// If a picture is missing, or the sizes differ.
    pub fn missed(
        &self,
        seen: &RunResult,
        other: Option<&Picture>,
        near: &dyn Fn() -> Result<Option<Near>>,
    ) -> Result<Option<String>> {
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
            Self::AsSolution(but_for) => {
                let (own, other) = pictures()?;
                let (darker, brighter) = darker_and_brighter(own, other);
                let (apart, all) = (darker + brighter, own.pixels.len());
                let how = match (darker, brighter) {
                    (0, _) => format!("brighter than the target in {brighter} of {all} pixels"),
                    (_, 0) => format!("darker than the target in {darker} of {all} pixels"),
                    _ => format!(
                        "darker than the target in {darker} of {all} pixels and brighter in {brighter}"
                    ),
                };
                let what = format!("yours is {how}");
                held(apart <= but_for.unwrap_or(all / ROUNDED), what)
            }
            Self::DiffersBy(amount, _) => {
                let (own, other) = pictures()?;
                let by = mean_difference(own, other);
                let much = much(amount.below(by));
                let what = format!("{much}: by {by:.4} in the mean, where it should be {amount}");
                held(amount.holds(by), differing(own, other, &what))
            }
            Self::DiffersIn(amount, _) => {
                let (own, other) = pictures()?;
                let pixels = pixels_apart(own, other) as f64;
                let what = format!("{}: {amount} should", many(amount.below(pixels)));
                held(amount.holds(pixels), differing(own, other, &what))
            }
            Self::Same(_) => {
                let (own, other) = pictures()?;
                let same =
                    same_bits(own, other) || near()?.is_some_and(|near| near.holds(own, other));
                held(
                    same,
                    match pixels_apart(own, other) {
                        0 => "not the same to the bit".to_owned(),
                        pixels => format!("not the same: {pixels} pixels differ"),
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
                let wanted: Vec<String> = amounts.iter().map(Interval::to_string).collect();
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
                let what = if refused {
                    format!("refused, but not by '{text}': {}", seen.said)
                } else {
                    format!("not refused by '{text}'")
                };
                held(refused && seen.said.contains(text), what)
            }
            Self::Validation(text) => {
                let heard = seen.messages().iter().any(|message| message.contains(text));
                held(heard, format!("validation does not say '{text}'"))
            }
            Self::Gone(_) => Err(anyhow!("a run of a program shows no code")),
            Self::Passes | Self::Fails(_) => Err(anyhow!("a run of a program is no test")),
        }
    }

    /// Checks the result of tests, and describes the mismatch if there is one.
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

/// One pixel in this many may differ from the solution's: computing a colour in another order changes it by
/// about 1e-6, which crosses a step of 1/255 in fewer pixels.
const ROUNDED: usize = 1000;

/// The number of pixels that differ, in words.
fn differing(own: &Picture, other: &Picture, what: &str) -> String {
    match (pixels_apart(own, other), own.pixels.len()) {
        (0, _) => format!("no pixel differs from the other picture, {what}"),
        (apart, all) => format!("{apart} of {all} pixels differ from the other picture, {what}"),
    }
}

fn much(below: bool) -> &'static str {
    if below { "too little" } else { "too much" }
}

fn many(below: bool) -> &'static str {
    if below { "too few" } else { "too many" }
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
    use super::super::expectation::Other;
    use super::*;

    /// Two pixels: mid grey and red.
    fn picture() -> Picture {
        Picture { width: 2, height: 1, pixels: vec![[0.5, 0.5, 0.5, 3.0], [1.0, 0.0, 0.0, -1.0]] }
    }

    fn seen(code: i32) -> RunResult {
        #[cfg(unix)]
        let status = std::os::unix::process::ExitStatusExt::from_raw(code << 8);
        #[cfg(windows)]
        let status = std::os::windows::process::ExitStatusExt::from_raw(code as u32);
        let report = serde_json::json!({
            "groups": 3, "chapter": { "rows": [{ "name": "a b" }] }, "validation_messages": ["VUID-x: y"],
        });
        let (said, told) = ("no such control".to_owned(), "2 rays\n".to_owned());
        RunResult { picture: Some(picture()), status: Some(status), said, told, report }
    }

    /// Tests it against a picture with one black pixel.
    fn holds(text: &str) -> bool {
        let expectation = Expectation::parse(text).unwrap_or_else(|| panic!("{text}"));
        let as_solution = matches!(expectation, Expectation::AsSolution(_));
        let other = expectation.other().cloned().or(as_solution.then(Other::default));
        let other = other.map(|other| {
            let mut picture = picture();
            // With arguments, the pictures are the same.
            if other.arguments.is_none() {
                picture.pixels[1] = [0.0; 4];
            }
            picture
        });
        let seen = seen(if text.starts_with("refused") { 2 } else { 0 });
        expectation.missed(&seen, other.as_ref(), &|| Ok(None)).unwrap().is_none()
    }

    #[test]
    fn each_holds_or_not() {
        for (true_one, false_one) in [
            ("as the solution but for 1 pixels", "as the solution"),
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

    /// Another device's arithmetic may change a few pixels beside an edge, but no more.
    #[test]
    fn what_is_the_same_may_be_off_by_arithmetic_where_that_is_allowed() {
        let same = Expectation::parse("same").unwrap();
        let plain = Picture { width: 96, height: 60, pixels: vec![[0.5; 4]; 96 * 60] };
        let is_met = |flipped: usize, near: Option<Near>| {
            let mut own = plain.clone();
            own.pixels.iter_mut().step_by(101).take(flipped).for_each(|pixel| *pixel = [1.0; 4]);
            let seen = RunResult { picture: Some(own), ..seen(0) };
            same.missed(&seen, Some(&plain), &|| Ok(near)).unwrap().is_none()
        };
        let near = Some(Near::of("16_ray_query").both());
        assert_eq!([0, 1, 40].map(|flipped| is_met(flipped, None)), [true, false, false]);
        assert_eq!([0, 1, 40].map(|flipped| is_met(flipped, near)), [true, true, false]);
    }

    #[test]
    fn a_refusal_is_an_exit_code() {
        let refused = Expectation::parse("refused: no such control").unwrap();
        assert!(refused.missed(&seen(0), None, &|| Ok(None)).unwrap().is_some());
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
            let wrong = expectation.missed(&seen(0), Some(&wide), &|| Ok(None)).unwrap_err();
            format!("{wrong:#}")
        };
        assert_eq!(missed("same"), "pictures of 2x1 and 1x2 cannot be compared");
        assert_eq!(missed("pixel 2 0 is 0 0 0"), "2 0 is no pixel of 2x1");
        assert_eq!(missed("report chapter.gone 1"), "the report has no 'chapter.gone'");
    }
}
