//! A control's value, and the text that sets it.

use std::ops::RangeInclusive;

use glam::{DVec3, Vec3};

/// Limit for a point's coordinates: shaders square distances in 32 bits.
const FAR: f64 = 1e18;

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
    /// Three numbers, each between two others, not all 0.
    Direction(&'a mut Vec3, RangeInclusive<f32>),
    /// A point in f64, each coordinate within ±1e18.
    Point(&'a mut DVec3),
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
            Self::Direction(..) => "direction",
            Self::Point(_) => "point",
        }
    }

    /// The possible values, in the words of an error or a table.
    pub fn possible(&self) -> String {
        match self {
            Self::Slider(_, range) => format!("{} to {}", range.start(), range.end()),
            Self::Integer(_, range) => format!("{} to {}", range.start(), range.end()),
            Self::Checkbox(_) => "on, off".to_owned(),
            Self::Color(_) => "r,g,b, each 0 to 1".to_owned(),
            Self::Choice(_, options) => options.join(", "),
            Self::Vector(_, range) => format!("x,y,z, each {} to {}", range.start(), range.end()),
            Self::Direction(_, range) => {
                let (low, high) = (range.start(), range.end());
                format!("x,y,z, each {low} to {high}, not all 0 in 32 bits")
            }
            Self::Point(_) => format!("x,y,z, each -{FAR:e} to {FAR:e}"),
        }
    }

    /// True if the value is a possible one.
    pub fn is_possible(&self) -> bool {
        let each = |v: &Vec3, range: &RangeInclusive<f32>| {
            v.to_array().iter().all(|part| range.contains(part))
        };
        match self {
            Self::Slider(value, range) => range.contains(*value),
            Self::Integer(value, range) => range.contains(*value),
            Self::Checkbox(_) => true,
            Self::Color(value) => each(value, &(0.0..=1.0)),
            Self::Choice(value, options) => (**value as usize) < options.len(),
            Self::Vector(value, range) => each(value, range),
            Self::Direction(value, range) => each(value, range) && **value != Vec3::ZERO,
            Self::Point(value) => value.abs().max_element() <= FAR && value.is_finite(),
        }
    }

    /// The value, in the form that [`Value::set`] takes.
    pub fn text(&self) -> String {
        match self {
            Self::Slider(value, _) => value.to_string(),
            Self::Integer(value, _) => value.to_string(),
            Self::Checkbox(value) => if **value { "on" } else { "off" }.to_owned(),
            Self::Color(v) | Self::Vector(v, _) | Self::Direction(v, _) => {
                format!("{},{},{}", v.x, v.y, v.z)
            }
            Self::Choice(value, options) => {
                options.get(**value as usize).copied().unwrap_or_default().to_owned()
            }
            Self::Point(v) => format!("{},{},{}", v.x, v.y, v.z),
        }
    }

    /// Sets the value from text; `None` if the text is not one that is possible.
    pub fn set(&mut self, text: &str) -> Option<()> {
        let within =
            |number: f32, range: &RangeInclusive<f32>| range.contains(&number).then_some(number);
        match self {
            Self::Slider(value, range) => **value = within(text.parse().ok()?, range)?,
            Self::Integer(value, range) => {
                **value = text.parse().ok().filter(|number| range.contains(number))?;
            }
            Self::Checkbox(value) => {
                **value = match text {
                    "on" | "true" | "1" => true,
                    "off" | "false" | "0" => false,
                    _ => return None,
                }
            }
            Self::Color(value) => **value = vector(text, &(0.0..=1.0))?,
            Self::Choice(value, options) => {
                **value = options.iter().position(|option| *option == text)? as u32;
            }
            Self::Vector(value, range) => **value = vector(text, range)?,
            Self::Direction(value, range) => {
                **value = vector(text, range).filter(|vector| *vector != Vec3::ZERO)?;
            }
            Self::Point(value) => {
                let point = DVec3::from_array(three(text)?);
                **value = (point.abs().max_element() <= FAR).then_some(point)?;
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
