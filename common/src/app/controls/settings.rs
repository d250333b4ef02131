//! Settings: controls that are set by name and text.

use super::{Controls, Value, Visit, elsewhere, visit_camera};
use crate::UsageError;
use crate::scene::Camera;

/// Controls to be set, each by name and text.
struct Settings<'a> {
    waiting: Vec<(&'a str, &'a str)>,
    seen: Vec<String>,
    refused: Option<String>,
    /// True if setting a control to the value it already has still triggers its side effects.
    repeats: bool,
}

impl Visit for Settings<'_> {
    fn visit(&mut self, name: &str, mut value: Value) -> bool {
        self.seen.push(name.to_owned());
        let wanted = self.waiting.iter().position(|&(waiting, _)| waiting == name);
        let Some(wanted) = wanted.filter(|_| self.refused.is_none()) else { return false };
        let (_, text) = self.waiting.remove(wanted);
        let before = value.text();
        if value.set(text).is_none() {
            self.refused = Some(impossible(name, text, &value));
        }
        self.repeats || value.text() != before
    }

    /// Either point alone could be set, but an eye that equals its target has no viewing direction.
    fn camera(&mut self, camera: &mut Camera) -> bool {
        let moved = visit_camera(self, camera);
        if moved && !camera.looks_somewhere() {
            let eye = Value::Point(&mut camera.eye).text();
            let line = format!(
                "control 'camera eye' cannot be where 'camera target' is, at '{eye}': they take two \
                 different points"
            );
            self.refused.get_or_insert(line);
        }
        moved
    }
}

fn impossible(name: &str, text: &str, value: &Value) -> String {
    let kind = if let Value::Integer(..) = value { "a whole number from " } else { "" };
    format!("control '{name}' cannot be '{text}': it takes {kind}{}", value.possible())
}

fn unknown(name: &str, seen: &[String]) -> UsageError {
    let elsewhere = elsewhere::chapters_with(name);
    UsageError(format!("no control '{name}'{elsewhere}; there is {}", seen.join(", ")))
}

/// A setting that is tried, and taken back.
struct Tried<'a> {
    name: &'a str,
    text: &'a str,
    seen: Vec<String>,
    refused: Option<String>,
}

impl Visit for Tried<'_> {
    fn visit(&mut self, name: &str, mut value: Value) -> bool {
        self.seen.push(name.to_owned());
        if name == self.name {
            let before = value.text();
            match value.set(self.text) {
                Some(_) => _ = value.set(&before),
                None => self.refused = Some(impossible(name, self.text, &value)),
            }
        }
        false
    }
}

/// Tests whether a control of those that `declare` declares can have a value, and sets nothing.
///
/// # Errors
/// As [`set`]; a control that is not declared is an error only if `all_are_declared`.
pub fn try_to_set(
    name: &str,
    text: &str,
    all_are_declared: bool,
    declare: impl FnOnce(&mut Controls),
) -> Result<(), UsageError> {
    let mut tried = Tried { name, text, seen: Vec::new(), refused: None };
    declare(&mut Controls::new(&mut tried));
    match tried.refused {
        Some(refused) => Err(UsageError(refused)),
        None if all_are_declared && !tried.seen.iter().any(|seen| seen == name) => {
            Err(unknown(name, &tried.seen))
        }
        None => Ok(()),
    }
}

/// Sets one control of those that `declare` declares.
///
/// # Errors
/// If no control has that name, or the value is not possible; the message lists what is.
pub fn set(
    name: &str,
    text: &str,
    mut declare: impl FnMut(&mut Controls),
) -> Result<(), UsageError> {
    round(vec![(name, text)], true, &mut declare)
}

/// Sets controls, each given by name and text, in the order of declaration rather than the order given: a preset
/// that comes last does not undo the controls set beside it. A repeated name starts another round after the
/// controls before it, so that one control can decide what the next ones apply to.
///
/// # Errors
/// As [`set`].
pub fn set_all(
    sets: &[(String, String)],
    declare: impl FnMut(&mut Controls),
) -> Result<(), UsageError> {
    rounds(sets, true, declare)
}

fn rounds(
    sets: &[(String, String)],
    repeats: bool,
    mut declare: impl FnMut(&mut Controls),
) -> Result<(), UsageError> {
    let mut waiting: Vec<(&str, &str)> = Vec::new();
    for (name, text) in sets {
        if waiting.iter().any(|(other, _)| other == name) {
            round(std::mem::take(&mut waiting), repeats, &mut declare)?;
        }
        waiting.push((name, text));
    }
    round(waiting, repeats, &mut declare)
}

/// As [`set_all`], but with one control at a value of its own: its side effects, such as those of a preset, undo
/// none of the others. Cheap to call once per frame: a control that already has its value does nothing.
///
/// # Errors
/// As [`set`].
pub fn set_beside(
    sets: &[(String, String)],
    name: &str,
    text: &str,
    declare: impl FnMut(&mut Controls),
) -> Result<(), UsageError> {
    let others = sets.iter().filter(|(other, _)| other != name).cloned();
    let all: Vec<_> = others.chain([(name.to_owned(), text.to_owned())]).collect();
    rounds(&all, false, declare)
}

/// Sets controls of different names.
fn round(
    waiting: Vec<(&str, &str)>,
    repeats: bool,
    declare: &mut impl FnMut(&mut Controls),
) -> Result<(), UsageError> {
    let mut settings = Settings { waiting, seen: Vec::new(), refused: None, repeats };
    while let Some(&(name, _)) = settings.waiting.first() {
        let count = settings.waiting.len();
        settings.seen.clear();
        declare(&mut Controls::new(&mut settings));
        if let Some(refused) = settings.refused {
            return Err(UsageError(refused));
        }
        // A control may be declared only after a later one has been set.
        if settings.waiting.len() == count {
            return Err(unknown(name, &settings.seen));
        }
    }
    Ok(())
}
