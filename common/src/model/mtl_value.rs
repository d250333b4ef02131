//! The value of an MTL statement, made fit to be shown.

use glam::Vec3;

use super::number::{numbers, words};
use super::text::{Statement, quoted};
use super::warnings::{Kind, Warnings};

/// The largest emission of a material, equal to the largest strength of a light in a scene file: sums of many
/// samples must not overflow.
pub(crate) const BRIGHTEST: f32 = 1e6;

/// The largest size of bumps: the steepest slope of an image is finite after that.
pub(crate) const BUMPIEST: f32 = 1e6;

/// The words after a keyword. A wrong number gets a warning, and the nearest that can be shown takes its place.
pub(crate) struct Value<'a> {
    pub keyword: &'static str,
    pub rest: &'a str,
    pub statement: &'a Statement<'a>,
    pub warnings: &'a mut Warnings,
}

impl Value<'_> {
    /// Warns of a form that is not supported.
    pub fn pass_over(&mut self, what: &str) {
        let what = || format!("{} has {what}, which is not supported", self.keyword);
        self.warnings.add(Kind::Option, self.statement, what);
    }

    /// Warns of a line that is left out.
    pub fn leave_out(&mut self, what: &str) {
        self.warnings.add_word(Kind::Line, self.keyword, self.statement, || what);
    }

    /// Warns of a number in whose place another is taken.
    fn correct(&mut self, kind: Kind, what: &str) {
        self.warnings.add_word(kind, self.keyword, self.statement, || what);
    }

    /// Three numbers from 0 to `most`, or one for all three.
    pub fn color(&mut self, most: f32) -> Option<Vec3> {
        let keyword = self.keyword;
        let first = self.rest.split_whitespace().next().unwrap_or_default();
        if matches!(first, "spectral" | "xyz") {
            self.pass_over(&format!("the form {first}"));
            return None;
        }
        let mut values = [0.0; 3];
        let color = match numbers(keyword, self.rest, &mut values) {
            Err(what) => {
                self.leave_out(&what);
                return None;
            }
            Ok(1) => Vec3::splat(values[0]),
            Ok(3) => Vec3::from(values),
            Ok(count @ (0 | 2)) => {
                let what =
                    format!("{keyword} has {count} numbers; a colour has 3, or 1 for a grey");
                self.leave_out(&what);
                return None;
            }
            Ok(count) => {
                let what =
                    format!("{keyword} has {count} numbers; a colour has 3, which are taken");
                self.correct(Kind::Count, &what);
                Vec3::from(values)
            }
        };
        // 2 2 2 is perhaps a bright white, 200 100 50 is not.
        let are_bytes = most == 1.0 && color.max_element() >= 16.0 && {
            let is_byte = |part: f32| part.fract() == 0.0 && (0.0..=255.0).contains(&part);
            color.to_array().into_iter().all(is_byte)
        };
        let taken =
            if are_bytes { color / 255.0 } else { color.clamp(Vec3::ZERO, Vec3::splat(most)) };
        if taken != color {
            let [was, is] = [color, taken].map(shown);
            let why = if are_bytes {
                format!("{was}, perhaps from 0 to 255; a colour is from 0 to 1: {is}")
            } else {
                format!("{was}; a colour is from 0 to {most}: {is}")
            };
            self.correct(Kind::Number, &format!("{keyword} is {why} is taken"));
        }
        Some(taken)
    }

    /// The size of bumps after the option `-bm`; negative ones make dents of them.
    pub fn bumps(&mut self, argument: &str) -> f32 {
        let number = argument.parse::<f32>();
        let what = match number {
            Ok(number) if number.abs() <= BUMPIEST => return number,
            Ok(number) if !number.is_nan() => format!("is too large, at most {BUMPIEST}"),
            _ => "is no number".to_owned(),
        };
        let what = format!("-bm {} of {} {what}; 1 is taken", quoted(argument), self.keyword);
        self.correct(Kind::Number, &what);
        1.0
    }

    /// A single number from 0 to `most`; `below` is taken for a negative one.
    pub fn number(&mut self, below: f32, most: f32) -> Option<f32> {
        let keyword = self.keyword;
        let mut values = [0.0; 1];
        match numbers(keyword, self.rest, &mut values) {
            Err(what) => {
                self.leave_out(&what);
                return None;
            }
            Ok(0) => {
                self.leave_out(&format!("{keyword} is not followed by a number"));
                return None;
            }
            Ok(1) => {}
            Ok(count) => {
                self.correct(
                    Kind::Count,
                    &format!("{keyword} has {count} numbers; the first is taken"),
                );
            }
        }
        let [value] = values;
        if value < 0.0 {
            self.correct(
                Kind::Number,
                &format!("{keyword} is {value}, and cannot be negative; {below} is taken"),
            );
            Some(below)
        } else if value > most {
            self.correct(
                Kind::Number,
                &format!("{keyword} is {value}, and cannot be more than {most}; {most} is taken"),
            );
            Some(most)
        } else {
            Some(value)
        }
    }

    /// The number of an illumination model.
    pub fn illumination(&mut self) -> Option<u32> {
        let word = words(self.rest).next().unwrap_or_default();
        let number = word.parse::<f32>().ok();
        if number == Some(10.0) {
            self.leave_out("illum 10 is a surface of which only the shadows on it are seen");
            return None;
        }
        let number = number.filter(|number| number.fract() == 0.0 && (0.0..=9.0).contains(number));
        if number.is_none() {
            self.leave_out(&format!("illum {} is not a whole number from 0 to 9", quoted(word)));
        }
        number.map(|number| number as u32)
    }
}

/// A colour as written in a file, rounded.
fn shown(color: Vec3) -> String {
    let shown = |part: f32| match part.abs() {
        0.0..=1e6 => ((part * 1e3).round() / 1e3).to_string(),
        _ => format!("{part:e}"),
    };
    color.to_array().map(shown).join(" ")
}

/// True if a name has an option of a texture behind it, as in `a.png -bm 2`.
pub(crate) fn has_late_option(named: &str) -> bool {
    named.split_whitespace().skip(1).any(|word| arguments(word).is_some())
}

/// The least and the largest number of arguments of an option; of offset, scale and turbulence, only the first is
/// required. None for other words, such as a name that begins like an option.
fn arguments(option: &str) -> Option<(usize, usize)> {
    Some(match option {
        "-blendu" | "-blendv" | "-bm" | "-boost" | "-cc" | "-clamp" | "-colorspace"
        | "-imfchan" | "-texres" | "-type" => (1, 1),
        "-mm" => (2, 2),
        "-o" | "-s" | "-t" => (1, 3),
        _ => return None,
    })
}

/// The name of a texture, after the options. `found` receives each option and its first argument.
pub(crate) fn after_options<'a>(rest: &'a str, found: &mut impl FnMut(&str, &str)) -> &'a str {
    let mut rest = rest;
    while let Some(option) = rest.split_whitespace().next()
        && let Some((least, most)) = arguments(option)
    {
        rest = rest[option.len()..].trim_start();
        found(option, rest.split_whitespace().next().unwrap_or_default());
        for taken in 0..most {
            let word = rest.split_whitespace().next().unwrap_or_default();
            if taken >= least && word.parse::<f32>().is_err() {
                break;
            }
            rest = rest[word.len()..].trim_start();
        }
    }
    rest
}
