//! Numbers of a scene file: finite, and within bounds that arithmetic in 32 bits can bear.
//!
//! Each is a function for serde's `deserialize_with`, so that the error has the number's own line.

use common::gpu::ShaderEnum;
use common::model::text::quoted;
use common::scene::LightKind;
use glam::{DVec3, Vec2, Vec3};
use serde::de::{Deserialize, Deserializer, Error};
use toml::Value;

use crate::{FOCUS, GlassKind, NORMAL_MAPS, Pattern};

/// The farthest coordinate of a scene file, and the largest strength of a light.
const FAR: f64 = 1e6;

/// A number of a TOML file, whole or not.
fn number<E: Error>(value: &Value) -> Result<f64, E> {
    match value {
        Value::Float(number) => Ok(*number),
        Value::Integer(number) => Ok(*number as f64),
        other => Err(E::custom(format!("{} is no number", shown(other)))),
    }
}

/// A value as a message shows it: on one line, and short.
fn shown(value: &Value) -> String {
    match value {
        Value::String(text) => quoted(text),
        Value::Array(_) => "a list".to_owned(),
        Value::Table(_) => "a table".to_owned(),
        other => other.to_string(),
    }
}

fn within<'de, D: Deserializer<'de>>(from: D, low: f64, high: f64) -> Result<f32, D::Error> {
    let value = Value::deserialize(from)?;
    match value {
        Value::Float(_) | Value::Integer(_) => check(number(&value)?, low, high).map(|n| n as f32),
        _ => {
            Err(D::Error::custom(format!("{} is not a number from {low} to {high}", shown(&value))))
        }
    }
}

/// A NaN is in no range.
fn check<E: Error>(number: f64, low: f64, high: f64) -> Result<f64, E> {
    if (low..=high).contains(&number) {
        Ok(number)
    } else {
        Err(E::custom(format!("{number:?} is not a number from {low} to {high}")))
    }
}

/// Parses exactly `N` numbers: the usual reader of arrays would ignore further ones.
fn numbers<const N: usize, E: Error>(value: &Value) -> Result<[f64; N], E> {
    let Value::Array(list) = value else {
        let example = vec!["1"; N].join(", ");
        let what = format!("{} is no list of {N} numbers, such as [{example}]", shown(value));
        return Err(E::custom(what));
    };
    let numbers = list.iter().map(number).collect::<Result<Vec<_>, E>>()?;
    let count = numbers.len();
    numbers.try_into().map_err(|_| E::custom(format!("{count} numbers where there are {N}")))
}

/// One of some words.
fn word<'de, D: Deserializer<'de>, T: Copy>(
    from: D,
    what: &str,
    words: &[(&str, T)],
) -> Result<T, D::Error> {
    let value = Value::deserialize(from)?;
    let known = words.iter().find(|(word, _)| value.as_str() == Some(word));
    known.map(|&(_, meaning)| meaning).ok_or_else(|| {
        let words: Vec<String> = words.iter().map(|(word, _)| format!("{word:?}")).collect();
        let words = words.join(" or ");
        D::Error::custom(format!("{} is no {what}; write {words}", shown(&value)))
    })
}

fn three<'de, D: Deserializer<'de>>(from: D, low: f64, high: f64) -> Result<DVec3, D::Error> {
    let [x, y, z] = numbers(&Value::deserialize(from)?)?;
    Ok(DVec3::new(check(x, low, high)?, check(y, low, high)?, check(z, low, high)?))
}

/// A number from 0 to 1.
pub fn part<'de, D: Deserializer<'de>>(from: D) -> Result<f32, D::Error> {
    within(from, 0.0, 1.0)
}

/// As [`part`], where nothing may be said.
pub fn maybe_part<'de, D: Deserializer<'de>>(from: D) -> Result<Option<f32>, D::Error> {
    part(from).map(Some)
}

/// A length above 0.
pub fn length<'de, D: Deserializer<'de>>(from: D) -> Result<f32, D::Error> {
    within(from, 1e-6, FAR)
}

/// As [`length`], where nothing may be said.
pub fn maybe_length<'de, D: Deserializer<'de>>(from: D) -> Result<Option<f32>, D::Error> {
    length(from).map(Some)
}

/// A line's width in pixels.
pub fn maybe_width<'de, D: Deserializer<'de>>(from: D) -> Result<Option<f32>, D::Error> {
    within(from, 0.0, 20.0).map(Some)
}

/// A factor of the slopes of a normal map.
pub fn maybe_steepness<'de, D: Deserializer<'de>>(from: D) -> Result<Option<f32>, D::Error> {
    within(from, 0.0, 20.0).map(Some)
}

/// A coordinate.
pub fn coordinate<'de, D: Deserializer<'de>>(from: D) -> Result<f32, D::Error> {
    within(from, -FAR, FAR)
}

/// The exponent of a highlight.
pub fn maybe_exponent<'de, D: Deserializer<'de>>(from: D) -> Result<Option<f32>, D::Error> {
    within(from, 0.0, 1e5).map(Some)
}

/// An angle in degrees.
pub fn degrees<'de, D: Deserializer<'de>>(from: D) -> Result<f32, D::Error> {
    within(from, -360.0, 360.0)
}

/// A field of view in degrees.
pub fn view<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    within(from, 1.0, 150.0).map(f64::from)
}

/// A point.
pub fn point<'de, D: Deserializer<'de>>(from: D) -> Result<Vec3, D::Error> {
    three(from, -FAR, FAR).map(|v| v.as_vec3())
}

/// A point in 64 bits.
pub fn far_point<'de, D: Deserializer<'de>>(from: D) -> Result<DVec3, D::Error> {
    three(from, -FAR, FAR)
}

/// A place in x and z.
pub fn place<'de, D: Deserializer<'de>>(from: D) -> Result<Vec2, D::Error> {
    two(from, -FAR)
}

/// Two lengths above 0.
pub fn lengths<'de, D: Deserializer<'de>>(from: D) -> Result<Vec2, D::Error> {
    two(from, 1e-2)
}

fn two<'de, D: Deserializer<'de>>(from: D, low: f64) -> Result<Vec2, D::Error> {
    let [x, z] = numbers(&Value::deserialize(from)?)?;
    Ok(Vec2::new(check(x, low, FAR)? as f32, check(z, low, FAR)? as f32))
}

/// A height from 0.
pub fn height<'de, D: Deserializer<'de>>(from: D) -> Result<f32, D::Error> {
    within(from, 0.0, 1e3)
}

/// Half-spaces: a normal of any length but 0, and a distance.
pub fn faces<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<[f64; 4]>, D::Error> {
    let value = Value::deserialize(from)?;
    let Value::Array(faces) = &value else {
        let what = format!("{} is no list of planes, such as [[0, 1, 0, 2], …]", shown(&value));
        return Err(D::Error::custom(what));
    };
    let faces: Vec<[f64; 4]> = faces.iter().map(numbers).collect::<Result<_, _>>()?;
    for &[x, y, z, distance] in &faces {
        for part in [x, y, z, distance] {
            check(part, -FAR, FAR)?;
        }
        if DVec3::new(x, y, z).length() <= 1e-6 {
            return Err(D::Error::custom("a normal has a length: [0, 1, 0, 2] is y <= 2"));
        }
    }
    match faces.len() {
        4..=24 => Ok(faces),
        count => Err(D::Error::custom(format!("{count} planes; a solid has 4 to 24"))),
    }
}

/// A chain's balls: a centre and a radius, each.
pub fn nodes<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<[f32; 4]>, D::Error> {
    let value = Value::deserialize(from)?;
    let Value::Array(nodes) = &value else {
        let what = format!("{} is no list of balls, such as [[0, 1, 0, 0.1], …]", shown(&value));
        return Err(D::Error::custom(what));
    };
    let nodes: Vec<[f64; 4]> = nodes.iter().map(numbers).collect::<Result<_, _>>()?;
    for &[x, y, z, radius] in &nodes {
        for part in [x, y, z] {
            check(part, -FAR, FAR)?;
        }
        check(radius, 0.0, FAR)?;
    }
    match nodes.len() {
        0 | 1 => Err(D::Error::custom(format!("{} nodes; a strand has 2 or more", nodes.len()))),
        _ if nodes.iter().all(|&[.., radius]| radius == 0.0) => {
            Err(D::Error::custom("every radius is 0, and such a strand has no surface"))
        }
        _ => Ok(nodes.into_iter().map(|node| node.map(|part| part as f32)).collect()),
    }
}

/// A direction, of any length but nearly 0.
pub fn direction<'de, D: Deserializer<'de>>(from: D) -> Result<Vec3, D::Error> {
    let direction = point(from)?;
    if direction.length() > 1e-6 {
        Ok(direction)
    } else {
        Err(D::Error::custom("a direction is longer than 0.000001: [0, 1, 0] is up"))
    }
}

/// A colour, each part from 0 to 1.
pub fn color<'de, D: Deserializer<'de>>(from: D) -> Result<Vec3, D::Error> {
    three(from, 0.0, 1.0).map(|v| v.as_vec3())
}

/// A factor from 0.
pub fn factor<'de, D: Deserializer<'de>>(from: D) -> Result<f32, D::Error> {
    within(from, 0.0, FAR)
}

/// As [`color`], where nothing may be said.
pub fn maybe_color<'de, D: Deserializer<'de>>(from: D) -> Result<Option<Vec3>, D::Error> {
    color(from).map(Some)
}

/// The strength of a light, each part from 0.
pub fn strength<'de, D: Deserializer<'de>>(from: D) -> Result<Vec3, D::Error> {
    three(from, 0.0, FAR).map(|v| v.as_vec3())
}

/// An angle in degrees, where nothing may be said.
pub fn maybe_degrees<'de, D: Deserializer<'de>>(from: D) -> Result<Option<f32>, D::Error> {
    degrees(from).map(Some)
}

/// A point, where nothing may be said.
pub fn maybe_point<'de, D: Deserializer<'de>>(from: D) -> Result<Option<Vec3>, D::Error> {
    point(from).map(Some)
}

/// As [`strength`], where nothing may be said.
pub fn maybe_strength<'de, D: Deserializer<'de>>(from: D) -> Result<Option<Vec3>, D::Error> {
    strength(from).map(Some)
}

fn whole<'de, D: Deserializer<'de>>(from: D, low: i64, high: i64) -> Result<u32, D::Error> {
    let value = Value::deserialize(from)?;
    match value.as_integer().filter(|number| (low..=high).contains(number)) {
        Some(number) => Ok(number as u32),
        None => {
            let what = format!("{} is not a whole number from {low} to {high}", shown(&value));
            Err(D::Error::custom(what))
        }
    }
}

/// Rays a pixel.
pub fn samples<'de, D: Deserializer<'de>>(from: D) -> Result<u32, D::Error> {
    whole(from, 1, 64)
}

/// Frames of an animation.
pub fn frames<'de, D: Deserializer<'de>>(from: D) -> Result<u32, D::Error> {
    whole(from, 2, 3600)
}

/// Reflections and refractions of a path.
pub fn depth<'de, D: Deserializer<'de>>(from: D) -> Result<u32, D::Error> {
    whole(from, 0, 32)
}

/// Maximum number of times a path is scattered.
pub fn bounces<'de, D: Deserializer<'de>>(from: D) -> Result<u32, D::Error> {
    whole(from, 0, 8)
}

/// Blades around a lens; fewer than three make no polygon, but leave a disk (28).
pub fn blades<'de, D: Deserializer<'de>>(from: D) -> Result<u32, D::Error> {
    whole(from, 0, 12)
}

/// The distance at which a lens is in focus.
pub fn maybe_focus<'de, D: Deserializer<'de>>(from: D) -> Result<Option<f32>, D::Error> {
    within(from, f64::from(*FOCUS.start()), f64::from(*FOCUS.end())).map(Some)
}

/// An index of refraction.
pub fn maybe_index<'de, D: Deserializer<'de>>(from: D) -> Result<Option<f32>, D::Error> {
    within(from, 0.1, 10.0).map(Some)
}

/// The normal map of a material, by position in [`NORMAL_MAPS`].
pub fn maybe_normal_map<'de, D: Deserializer<'de>>(from: D) -> Result<Option<usize>, D::Error> {
    let maps: Vec<_> = NORMAL_MAPS.iter().copied().zip(0..).collect();
    word(from, "normal map", &maps).map(Some)
}

/// The pattern of a material.
pub fn maybe_pattern<'de, D: Deserializer<'de>>(from: D) -> Result<Option<Pattern>, D::Error> {
    let patterns: Vec<_> = Pattern::ALL[1..].iter().map(|&kind| (kind.word(), kind)).collect();
    word(from, "pattern", &patterns).map(Some)
}

/// The kind of glass, thick or thin.
pub fn maybe_glass<'de, D: Deserializer<'de>>(from: D) -> Result<Option<GlassKind>, D::Error> {
    let kinds = [("thick", GlassKind::Thick), ("thin", GlassKind::Thin)];
    word(from, "kind of glass", &kinds).map(Some)
}

/// The kind of a light, directional or point.
pub fn light_kind<'de, D: Deserializer<'de>>(from: D) -> Result<LightKind, D::Error> {
    let kinds = [("directional", LightKind::Directional), ("point", LightKind::Point)];
    word(from, "kind of light", &kinds)
}
