//! A file of hard cases: rays and shapes with answers known to 50 digits.
//!
//! The schema is `rt-hard-cases/2`; the file's `conventions` say how to read it. Whatever is not in
//! the schema is refused: a case that is misread, or left out, would count as passed.

mod fields;

use std::path::Path;

use anyhow::{Context, Result, bail, ensure};
use glam::{DVec3, Vec3};
use serde::Deserialize;
use serde::de::IgnoredAny;
use serde_json::Value;

use crate::judge::{Expected, ExpectedHit, Tolerance};
use crate::ladder::Primitive;
use crate::query::Ray;
use crate::shape::{Leaving, Shape};

/// Every shape is in one top level: where many overlap, each ray is tested against all of them.
const MOST_CASES: usize = 2048;

const SCHEMA: &str = "rt-hard-cases/2";
/// Of all sums of a file. Without a bound, a small file could keep a device busy for hours.
const MOST_SAMPLES: u64 = 1 << 33;
/// Reading takes up to 64 times as much memory: `{"a":0},` becomes a table of its own.
const LARGEST_FILE: u64 = 8 << 20;

/// One case, ready to be run.
#[derive(Clone, Debug)]
pub struct Case {
    pub id: String,
    /// As the file names it.
    pub primitive: String,
    pub family: String,
    pub shape: Shape,
    pub ray: Ray,
    pub expected: Expected,
    pub tolerance: Tolerance,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    schema: String,
    #[serde(default, rename = "conventions")]
    _conventions: IgnoredAny,
    cases: Vec<Value>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawCase {
    id: String,
    primitive: String,
    family: String,
    ray: Option<RawRay>,
    shape: Value,
    expect: RawExpect,
    tol: Tolerance,
    #[serde(default, rename = "note")]
    _note: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawRay {
    origin: [f64; 3],
    dir: [f64; 3],
    tmin: f64,
    tmax: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawExpect {
    hit: Option<ExpectedHit>,
    t: Option<String>,
    normal: Option<[String; 3]>,
    faces: Option<Vec<String>>,
    secondary_hit: Option<ExpectedHit>,
    secondary_t: Option<String>,
    mean: Option<String>,
    count: Option<u32>,
}

/// Reads a file of cases.
///
/// # Errors
/// One line with file, line and what is wrong.
pub fn read(path: &Path) -> Result<Vec<Case>> {
    let shown = path.display();
    let metadata = std::fs::metadata(path).with_context(|| format!("cannot read '{shown}'"))?;
    // A pipe might never end.
    ensure!(metadata.is_file(), "cannot read '{shown}': it is no file");
    let size = metadata.len();
    ensure!(size <= LARGEST_FILE, "'{shown}' has {size} bytes; at most {LARGEST_FILE} are read");
    let text = std::fs::read_to_string(path).with_context(|| format!("cannot read '{shown}'"))?;
    parse(&text, &shown.to_string())
}

fn parse(text: &str, path: &str) -> Result<Vec<Case>> {
    let file: File = serde_json::from_str(text)
        .map_err(|error| anyhow::anyhow!("{path}:{}: {error}", error.line()))?;
    ensure!(file.schema == SCHEMA, "{path}: the schema is '{}', not '{SCHEMA}'", file.schema);
    ensure!(!file.cases.is_empty(), "{path}: there are no cases");
    let count = file.cases.len();
    ensure!(count <= MOST_CASES, "{path}: {count} cases are too many; {MOST_CASES} are the limit");
    let mut cases: Vec<Case> = Vec::new();
    for (number, value) in file.cases.into_iter().enumerate() {
        let id = value["id"].as_str().map_or_else(|| format!("number {number}"), str::to_owned);
        let place = || match line_of(text, &id) {
            Some(line) => format!("{path}:{line}: case '{id}'"),
            None => format!("{path}: case '{id}'"),
        };
        let case = case(value).with_context(place)?;
        ensure!(cases.iter().all(|other| other.id != case.id), "{}: the id is taken", place());
        cases.push(case);
    }
    let samples = |case: &Case| if let Shape::Sum(sum) = case.shape { sum.n.into() } else { 0 };
    let samples: u64 = cases.iter().map(samples).sum();
    ensure!(
        samples <= MOST_SAMPLES,
        "{path}: the sums have {samples} samples together; {MOST_SAMPLES} are the limit"
    );
    Ok(cases)
}

/// The line with the id, counted from 1.
fn line_of(text: &str, id: &str) -> Option<usize> {
    let quoted = format!("\"{id}\"");
    text.lines().position(|line| line.contains(&quoted)).map(|index| index + 1)
}

fn case(value: Value) -> Result<Case> {
    let raw: RawCase = serde_json::from_value(value)?;
    let shape = fields::shape(&raw.primitive, raw.shape)?;
    let needs_ray = !matches!(shape, Shape::Sum(_) | Shape::Leaving(Leaving { gap: Some(_), .. }));
    let ray = match raw.ray {
        Some(ray) => self::ray(&ray)?,
        None if needs_ray => bail!("it has no ray"),
        // No test reads this ray: any will do.
        None => Ray { origin: Vec3::ZERO, direction: Vec3::Y, tmin: 0.0, tmax: 1e30 },
    };
    let expected = expected(shape.primitive(), &raw.expect)?;
    let is_self = matches!(shape, Shape::Leaving(Leaving { gap: None, .. }));
    ensure!(!is_self || expected.surface.is_some(), "no t is expected of the point that it leaves");
    for x in raw.tol.all().into_iter().flatten() {
        ensure!(x >= 0.0 && x.is_finite(), "a tolerance is {x}");
    }
    Ok(Case {
        id: raw.id,
        primitive: raw.primitive,
        family: raw.family,
        shape,
        ray,
        expected,
        tolerance: raw.tol,
    })
}

fn ray(raw: &RawRay) -> Result<Ray> {
    let ray = Ray {
        origin: vector(raw.origin)?,
        direction: vector(raw.dir)?,
        tmin: number(raw.tmin)?,
        tmax: number(raw.tmax)?,
    };
    ensure!(ray.direction != Vec3::ZERO, "the ray's direction is zero");
    ensure!(
        0.0 <= ray.tmin && ray.tmin <= ray.tmax,
        "the ray's interval must be 0 <= tmin <= tmax"
    );
    Ok(ray)
}

/// An f32 written as a decimal of f64.
fn number(value: f64) -> Result<f32> {
    let single = value as f32;
    ensure!(single.is_finite(), "{value:e} is no finite f32");
    Ok(single)
}

fn vector(value: [f64; 3]) -> Result<Vec3> {
    let [x, y, z] = value;
    Ok(Vec3::new(number(x)?, number(y)?, number(z)?))
}

fn decimal(text: &str) -> Result<f64> {
    let value: f64 = text.parse().with_context(|| format!("'{text}' is no decimal"))?;
    ensure!(value.is_finite(), "'{text}' is not finite");
    Ok(value)
}

fn expected(primitive: Primitive, raw: &RawExpect) -> Result<Expected> {
    let t = raw.t.as_deref().map(decimal).transpose()?;
    let secondary_t = raw.secondary_t.as_deref().map(decimal).transpose()?;
    let mean = raw.mean.as_deref().map(decimal).transpose()?;
    let normal = raw
        .normal
        .as_ref()
        .map(|[x, y, z]| -> Result<_> { Ok(DVec3::new(decimal(x)?, decimal(y)?, decimal(z)?)) });
    let normal = normal.transpose()?;
    let faces = raw.faces.as_ref().map(|faces| faces.iter().map(|f| face(f)).collect());
    let faces: Vec<DVec3> = faces.transpose()?.unwrap_or_default();
    let foreign = match primitive {
        Primitive::Accumulation => {
            raw.hit.is_some() || t.is_some() || raw.secondary_hit.is_some() || secondary_t.is_some()
        }
        Primitive::SecondaryOrigin => mean.is_some(),
        _ => mean.is_some() || raw.secondary_hit.is_some() || secondary_t.is_some(),
    };
    let counts = matches!(
        primitive,
        Primitive::Cone
            | Primitive::Quadric
            | Primitive::Patch
            | Primitive::Voxel
            | Primitive::Algebraic
    );
    ensure!(
        !foreign && (counts || raw.count.is_none()),
        "a {} expects none of these",
        primitive.name()
    );
    Ok(match primitive {
        Primitive::Accumulation => Expected {
            hit: ExpectedHit::Yes,
            t: Some(mean.context("no mean is expected")?),
            normal: None,
            faces,
            surface: None,
            count: None,
        },
        Primitive::SecondaryOrigin => Expected {
            hit: raw.secondary_hit.context("no secondary_hit is expected")?,
            t: secondary_t,
            normal: None,
            faces,
            surface: t,
            count: None,
        },
        _ => {
            let hit = raw.hit.context("neither hit nor miss is expected")?;
            ensure!(
                (hit == ExpectedHit::Yes) == t.is_some(),
                "a t is expected where there is a hit"
            );
            Expected { hit, t, normal, faces, surface: None, count: raw.count }
        }
    })
}

fn face(name: &str) -> Result<DVec3> {
    let axis = |axis: &str| Some(DVec3::AXES[["x", "y", "z"].iter().position(|a| *a == axis)?]);
    let found = match name.split_at_checked(1) {
        Some(("+", rest)) => axis(rest),
        Some(("-", rest)) => axis(rest).map(|axis| -axis),
        _ => None,
    };
    found.with_context(|| format!("unknown face '{name}'"))
}
