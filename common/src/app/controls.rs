//! One declaration, four uses: a control is a row of the panel, a `--set` of a script or test, a row of
//! the table on the chapter's page, and a line of `--list-controls`.

use std::ops::RangeInclusive;

use anyhow::Result;
use glam::{DVec3, Vec3};

use super::chart::Chart;
use crate::scene::Camera;
use crate::usage::Usage;

/// A control's value, borrowed from the sample, and what it may be.
pub enum Value<'a> {
    /// A number between two others.
    Slider(&'a mut f32, RangeInclusive<f32>),
    /// A whole number between two others.
    Integer(&'a mut u32, RangeInclusive<u32>),
    /// On or off.
    Checkbox(&'a mut bool),
    /// A linear colour, each part 0 to 1.
    Color(&'a mut Vec3),
    /// One of several words, held as its position among them.
    Choice(&'a mut u32, &'a [&'a str]),
    /// Three numbers, each between two others.
    Vector(&'a mut Vec3, RangeInclusive<f32>),
    /// A point in f64, anywhere that f32 can tell.
    Point(&'a mut DVec3),
}

/// Something that is shown every control in turn: the panel, a list, a setting.
pub trait Visit {
    /// Sees one control, may change its value, and says whether it did.
    fn visit(&mut self, name: &str, value: Value) -> bool;

    /// Sees a line that only tells something, such as what is in use; by default passed over.
    fn note(&mut self, _name: &str, _text: &str) {}

    /// Sees the camera; by default as the controls that a script can set.
    fn camera(&mut self, camera: &mut Camera) -> bool {
        let mut degrees = camera.fov_y as f32;
        let moved = self.visit("camera eye", Value::Point(&mut camera.eye))
            | self.visit("camera target", Value::Point(&mut camera.target));
        let zoomed = self.visit("field of view", Value::Slider(&mut degrees, 1.0..=150.0));
        if zoomed {
            camera.fov_y = f64::from(degrees);
        }
        moved | zoomed
    }

    /// Sees what the sample has found out; only the panel has room for it.
    fn chart(&mut self, _: &Chart) {}
}

/// What [`Sample::controls`](super::Sample::controls) declares its controls on.
///
/// Each method returns whether the value has just been changed.
pub struct Controls<'a> {
    visitor: &'a mut dyn Visit,
}

impl<'a> Controls<'a> {
    /// Controls as seen by `visitor`.
    pub fn new(visitor: &'a mut dyn Visit) -> Self {
        Self { visitor }
    }

    /// A number in a range.
    pub fn slider(&mut self, name: &str, value: &mut f32, range: RangeInclusive<f32>) -> bool {
        self.visitor.visit(name, Value::Slider(value, range))
    }

    /// A whole number in a range.
    pub fn integer(&mut self, name: &str, value: &mut u32, range: RangeInclusive<u32>) -> bool {
        self.visitor.visit(name, Value::Integer(value, range))
    }

    /// On or off.
    pub fn checkbox(&mut self, name: &str, value: &mut bool) -> bool {
        self.visitor.visit(name, Value::Checkbox(value))
    }

    /// A linear colour.
    pub fn color(&mut self, name: &str, value: &mut Vec3) -> bool {
        self.visitor.visit(name, Value::Color(value))
    }

    /// One of `options`; `value` is its position.
    pub fn choice(&mut self, name: &str, value: &mut u32, options: &[&str]) -> bool {
        self.visitor.visit(name, Value::Choice(value, options))
    }

    /// Three numbers, each in a range.
    pub fn vector(&mut self, name: &str, value: &mut Vec3, range: RangeInclusive<f32>) -> bool {
        self.visitor.visit(name, Value::Vector(value, range))
    }

    /// A line that tells something: shown in the panel, no control.
    pub fn note(&mut self, name: &str, text: &str) {
        self.visitor.note(name, text);
    }

    /// A camera: moved with the mouse in a window, by three controls elsewhere.
    pub fn camera(&mut self, camera: &mut Camera) -> bool {
        self.visitor.camera(camera)
    }

    /// A plot below the controls before it; nothing to set.
    pub fn chart(&mut self, chart: &Chart) {
        self.visitor.chart(chart);
    }
}

impl Value<'_> {
    /// The kind, in a word.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Slider(..) => "number",
            Self::Integer(..) => "whole number",
            Self::Checkbox(_) => "switch",
            Self::Color(_) => "colour",
            Self::Choice(..) => "choice",
            Self::Vector(..) => "vector",
            Self::Point(_) => "point",
        }
    }

    /// What it may be, as an error or a table says it.
    pub fn possible(&self) -> String {
        match self {
            Self::Slider(_, range) => format!("{} to {}", range.start(), range.end()),
            Self::Integer(_, range) => format!("{} to {}", range.start(), range.end()),
            Self::Checkbox(_) => "on, off".to_owned(),
            Self::Color(_) => "r,g,b, each 0 to 1".to_owned(),
            Self::Choice(_, options) => options.join(", "),
            Self::Vector(_, range) => format!("x,y,z, each {} to {}", range.start(), range.end()),
            Self::Point(_) => "x,y,z".to_owned(),
        }
    }

    /// The value, in the form that [`Value::set`] takes.
    pub fn text(&self) -> String {
        match self {
            Self::Slider(value, _) => value.to_string(),
            Self::Integer(value, _) => value.to_string(),
            Self::Checkbox(value) => if **value { "on" } else { "off" }.to_owned(),
            Self::Color(v) | Self::Vector(v, _) => format!("{},{},{}", v.x, v.y, v.z),
            Self::Choice(value, options) => {
                options.get(**value as usize).copied().unwrap_or_default().to_owned()
            }
            Self::Point(v) => format!("{},{},{}", v.x, v.y, v.z),
        }
    }

    /// Sets the value from text; `None` if the text is not one that is possible.
    pub fn set(self, text: &str) -> Option<()> {
        let within =
            |number: f32, range: &RangeInclusive<f32>| range.contains(&number).then_some(number);
        match self {
            Self::Slider(value, range) => *value = within(text.parse().ok()?, &range)?,
            Self::Integer(value, range) => {
                *value = text.parse().ok().filter(|number| range.contains(number))?;
            }
            Self::Checkbox(value) => {
                *value = match text {
                    "on" | "true" | "1" => true,
                    "off" | "false" | "0" => false,
                    _ => return None,
                }
            }
            Self::Color(value) => *value = vector(text, &(0.0..=1.0))?,
            Self::Choice(value, options) => {
                *value = options.iter().position(|option| *option == text)? as u32;
            }
            Self::Vector(value, range) => *value = vector(text, &range)?,
            // Shaders get it in 32 bits.
            Self::Point(value) => {
                let point = DVec3::from_array(three(text)?);
                *value = point.as_vec3().is_finite().then_some(point)?;
            }
        }
        Some(())
    }
}

fn three(text: &str) -> Option<[f64; 3]> {
    let parts: Option<Vec<f64>> = text.split(',').map(|part| part.trim().parse().ok()).collect();
    let point: [f64; 3] = parts?.try_into().ok()?;
    point.iter().all(|part| part.is_finite()).then_some(point)
}

fn vector(text: &str, range: &RangeInclusive<f32>) -> Option<Vec3> {
    let parts = three(text)?.map(|part| part as f32);
    parts.iter().all(|part| range.contains(part)).then_some(Vec3::from_array(parts))
}

/// A control as a list shows it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Listed {
    /// Its name.
    pub name: String,
    /// Its kind.
    pub kind: &'static str,
    /// What it may be.
    pub possible: String,
    /// What it is.
    pub value: String,
}

impl Visit for Vec<Listed> {
    fn visit(&mut self, name: &str, value: Value) -> bool {
        let (kind, possible) = (value.kind(), value.possible());
        self.push(Listed { name: name.to_owned(), kind, possible, value: value.text() });
        false
    }
}

/// Every control that `declare` declares.
pub fn list(declare: impl FnOnce(&mut Controls)) -> Vec<Listed> {
    let mut listed = Vec::new();
    declare(&mut Controls::new(&mut listed));
    listed
}

/// Controls on their way to new values, each with its name and text.
struct Settings<'a> {
    waiting: Vec<(&'a str, &'a str)>,
    seen: Vec<String>,
    refused: Option<String>,
}

impl Visit for Settings<'_> {
    fn visit(&mut self, name: &str, value: Value) -> bool {
        self.seen.push(name.to_owned());
        let wanted = self.waiting.iter().position(|&(waiting, _)| waiting == name);
        let Some(wanted) = wanted.filter(|_| self.refused.is_none()) else { return false };
        let (_, text) = self.waiting.remove(wanted);
        let possible = value.possible();
        let set = value.set(text);
        if set.is_none() {
            self.refused =
                Some(format!("control '{name}' cannot be '{text}': it takes {possible}"));
        }
        set.is_some()
    }
}

/// Sets one control of those that `declare` declares.
///
/// # Errors
/// If there is none of that name, or the value is not possible; the line lists what is.
pub fn set(name: &str, text: &str, mut declare: impl FnMut(&mut Controls)) -> Result<(), Usage> {
    round(vec![(name, text)], &mut declare)
}

/// Sets controls, each given by name and text, as they are declared and not as they are given: a preset
/// that comes last does not undo what was set beside it. A name that is given again begins another round
/// after those before it, so that one control can choose what the next ones are about.
///
/// # Errors
/// As [`set`].
pub fn set_all(
    sets: &[(String, String)],
    mut declare: impl FnMut(&mut Controls),
) -> Result<(), Usage> {
    let mut waiting: Vec<(&str, &str)> = Vec::new();
    for (name, text) in sets {
        if waiting.iter().any(|(other, _)| other == name) {
            round(std::mem::take(&mut waiting), &mut declare)?;
        }
        waiting.push((name, text));
    }
    round(waiting, &mut declare)
}

/// Sets controls of different names.
fn round(waiting: Vec<(&str, &str)>, declare: &mut impl FnMut(&mut Controls)) -> Result<(), Usage> {
    let mut settings = Settings { waiting, seen: Vec::new(), refused: None };
    while let Some(&(name, _)) = settings.waiting.first() {
        let count = settings.waiting.len();
        settings.seen.clear();
        declare(&mut Controls::new(&mut settings));
        if let Some(refused) = settings.refused {
            return Err(Usage(refused));
        }
        // A control may be declared only after a later one was set.
        if settings.waiting.len() == count {
            let there_is = settings.seen.join(", ");
            return Err(Usage(format!("no control '{name}'; there is {there_is}")));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Default)]
    struct Sample {
        height: f32,
        depth: u32,
        on: bool,
        show: u32,
        tint: Vec3,
        camera: Camera,
    }

    impl Sample {
        fn controls(&mut self, c: &mut Controls) {
            c.slider("height", &mut self.height, 0.0..=10.0);
            c.integer("depth", &mut self.depth, 0..=8);
            c.checkbox("shadows", &mut self.on);
            c.choice("show", &mut self.show, &["picture", "ray direction"]);
            c.color("tint", &mut self.tint);
            c.camera(&mut self.camera);
        }
    }

    fn set_on(sample: &mut Sample, name: &str, text: &str) -> Result<(), String> {
        set(name, text, |c| sample.controls(c)).map_err(|usage| usage.0)
    }

    #[test]
    fn every_control_can_be_set_to_what_the_list_says_it_is() {
        let mut sample = Sample::default();
        for control in list(|c| sample.controls(c)) {
            set_on(&mut sample, &control.name, &control.value).unwrap();
        }
        set_on(&mut sample, "show", "ray direction").unwrap();
        set_on(&mut sample, "tint", "0.5, 0.25,1").unwrap();
        set_on(&mut sample, "camera eye", "1e6,2,-3.5").unwrap();
        set_on(&mut sample, "field of view", "30").unwrap();
        assert_eq!((sample.show, sample.tint), (1, Vec3::new(0.5, 0.25, 1.0)));
        assert_eq!((sample.camera.eye, sample.camera.fov_y), (DVec3::new(1e6, 2.0, -3.5), 30.0));
    }

    /// A preset, what it brings, and a control that is there for one preset alone, declared before it.
    #[derive(Clone, Copy, Debug, Default, PartialEq)]
    struct Presets {
        preset: u32,
        height: f32,
        extra: f32,
    }

    impl Presets {
        fn controls(&mut self, c: &mut Controls) {
            if self.preset == 1 {
                c.slider("extra", &mut self.extra, 0.0..=10.0);
            }
            if c.choice("preset", &mut self.preset, &["low", "high"]) {
                self.height = [1.0, 9.0][self.preset as usize];
            }
            c.slider("height", &mut self.height, 0.0..=10.0);
        }

        fn with(sets: &[&str]) -> Result<Self, String> {
            let pair = |set: &&str| {
                let (name, text) = set.split_once('=').unwrap();
                (name.to_owned(), text.to_owned())
            };
            let sets: Vec<_> = sets.iter().map(pair).collect();
            let mut presets = Self::default();
            set_all(&sets, |c| presets.controls(c)).map_err(|usage| usage.0)?;
            Ok(presets)
        }
    }

    #[test]
    fn the_order_of_settings_does_not_matter() {
        let expected = Ok(Presets { preset: 1, height: 5.0, extra: 3.0 });
        let [a, b, c] = ["preset=high", "height=5", "extra=3"];
        for sets in [[a, b, c], [a, c, b], [b, a, c], [b, c, a], [c, a, b], [c, b, a]] {
            assert_eq!(Presets::with(&sets), expected, "{sets:?}");
        }
        assert_eq!(Presets::with(&["height=5", "preset=high"]).unwrap().height, 5.0);
        assert_eq!(Presets::with(&["preset=high"]).unwrap().height, 9.0);
        assert_eq!(Presets::with(&[]), Ok(Presets::default()));
    }

    #[test]
    fn a_name_given_again_begins_another_round() {
        let again = Presets::with(&["height=5", "preset=high", "preset=low"]).unwrap();
        assert_eq!((again.preset, again.height), (0, 1.0));
        let last = Presets::with(&["height=5", "height=6"]).unwrap();
        assert_eq!(last.height, 6.0);
        // Whatever stands in the way of the rest is told.
        let wrong = Presets::with(&["height=11", "height=6"]).unwrap_err();
        assert!(wrong.contains("'height' cannot be '11'"), "{wrong}");
        let absent = Presets::with(&["height=5", "extra=3"]).unwrap_err();
        assert_eq!(absent, "no control 'extra'; there is preset, height");
    }

    #[test]
    fn wrong_names_and_values_say_what_there_is() {
        let mut sample = Sample::default();
        let error = set_on(&mut sample, "bogus", "1").unwrap_err();
        assert!(error.contains("no control 'bogus'; there is height, depth, shadows"), "{error}");
        let wrong = [
            ("height", "10.5", "0 to 10"),
            ("height", "NaN", "0 to 10"),
            ("depth", "9", "0 to 8"),
            ("depth", "-1", "0 to 8"),
            ("shadows", "maybe", "on, off"),
            ("show", "pictures", "picture, ray direction"),
            ("tint", "1,1", "r,g,b"),
            ("tint", "1,1,2", "0 to 1"),
            ("camera eye", "1,2,inf", "x,y,z"),
            ("camera eye", "1,2,1e39", "x,y,z"),
        ];
        for (name, text, possible) in wrong {
            let error = set_on(&mut sample, name, text).unwrap_err();
            assert!(error.contains(&format!("'{name}'")) && error.contains(possible), "{error}");
        }
        assert_eq!(sample.height, 0.0);
    }
}
