//! The shape of a hard case, read from the fields of its primitive.

use anyhow::{Context, Result, bail, ensure};
use glam::Vec3;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::Value;

use super::{number, vector};
use crate::shape::{Algebraic, Cone, Gap, Heightfield, Leaving, Pattern, Shape, Sum, Voxel};

/// Beyond the 2^24 at which a sum of floats stops growing; ten seconds on the software driver.
const LONGEST_SUM: u32 = 1 << 26;

/// The shape of this primitive with these fields.
pub fn shape(primitive: &str, value: Value) -> Result<Shape> {
    fn typed<T: DeserializeOwned>(value: Value) -> Result<T> {
        Ok(serde_json::from_value(value)?)
    }
    Ok(match primitive {
        "sphere" => {
            #[derive(Deserialize)]
            #[serde(deny_unknown_fields)]
            struct Raw {
                center: [f64; 3],
                radius: f64,
            }
            let raw: Raw = typed(value)?;
            Shape::Sphere { center: vector(raw.center)?, radius: radius(raw.radius)? }
        }
        "box" => {
            #[derive(Deserialize)]
            #[serde(deny_unknown_fields)]
            struct Raw {
                lo: [f64; 3],
                hi: [f64; 3],
            }
            let raw: Raw = typed(value)?;
            let (low, high) = (vector(raw.lo)?, vector(raw.hi)?);
            ensure!(low.cmple(high).all(), "lo {low} is above hi {high}");
            Shape::Box { low, high }
        }
        "plane" => {
            #[derive(Deserialize)]
            #[serde(deny_unknown_fields)]
            struct Raw {
                normal: [f64; 3],
                d: f64,
            }
            let raw: Raw = typed(value)?;
            Shape::Plane { normal: direction(raw.normal)?, distance: number(raw.d)? }
        }
        "plane_point" => {
            #[derive(Deserialize)]
            #[serde(deny_unknown_fields)]
            struct Raw {
                point: [f64; 3],
                normal: [f64; 3],
            }
            let raw: Raw = typed(value)?;
            Shape::PointPlane { point: vector(raw.point)?, normal: direction(raw.normal)? }
        }
        "triangle" => {
            #[derive(Deserialize)]
            #[serde(deny_unknown_fields)]
            struct Raw {
                triangles: Vec<[[f64; 3]; 3]>,
            }
            let raw: Raw = typed(value)?;
            ensure!(!raw.triangles.is_empty(), "there are no triangles");
            let corners = |[a, b, c]: [[f64; 3]; 3]| Ok([vector(a)?, vector(b)?, vector(c)?]);
            Shape::Triangles(raw.triangles.into_iter().map(corners).collect::<Result<_>>()?)
        }
        "capsule" => {
            #[derive(Deserialize)]
            #[serde(deny_unknown_fields)]
            struct Raw {
                a: [f64; 3],
                b: [f64; 3],
                radius: f64,
            }
            let raw: Raw = typed(value)?;
            Shape::Capsule { a: vector(raw.a)?, b: vector(raw.b)?, radius: radius(raw.radius)? }
        }
        "instance" => {
            #[derive(Deserialize)]
            #[serde(deny_unknown_fields)]
            struct Raw {
                object: String,
                object_to_world: [[f64; 4]; 3],
            }
            let raw: Raw = typed(value)?;
            ensure!(raw.object == "unit_sphere", "unknown object '{}'", raw.object);
            let mut rows = [[0.0; 4]; 3];
            for (to, from) in
                rows.as_flattened_mut().iter_mut().zip(raw.object_to_world.as_flattened())
            {
                *to = number(*from)?;
            }
            let determinant = crate::shape::parts(&rows).0.determinant();
            ensure!(determinant != 0.0, "the matrix cannot be inverted");
            Shape::Instance(rows)
        }
        "heightfield" => heightfield(value)?,
        "secondary_origin" => leaving(value)?,
        "accumulation" => sum(value)?,
        "cone" => {
            #[derive(Deserialize)]
            #[serde(deny_unknown_fields)]
            struct Raw {
                a: [f64; 3],
                b: [f64; 3],
                radii: [f64; 2],
                closed: bool,
            }
            let raw: Raw = typed(value)?;
            let (a, b) = (vector(raw.a)?, vector(raw.b)?);
            let radii = [number(raw.radii[0])?, number(raw.radii[1])?];
            ensure!(a != b, "a and b are the same point");
            ensure!(radii.iter().all(|&r| r >= 0.0), "a radius is below 0");
            ensure!(radii != [0.0; 2], "both radii are 0");
            Shape::Cone(Cone { a, b, radii, is_closed: raw.closed })
        }
        "quadric" => {
            #[derive(Deserialize)]
            #[serde(deny_unknown_fields)]
            struct Raw {
                square: [f64; 3],
                mixed: [f64; 3],
                linear: [f64; 3],
                rest: f64,
            }
            let raw: Raw = typed(value)?;
            let mut coefficients = [0.0; 10];
            let given = [raw.square, raw.mixed, raw.linear];
            let given = given.as_flattened().iter().chain([&raw.rest]);
            for (to, from) in coefficients.iter_mut().zip(given) {
                *to = number(*from)?;
            }
            ensure!(coefficients[..9] != [0.0; 9], "x, y and z have no coefficient but 0");
            Shape::Quadric(coefficients)
        }
        "patch" => {
            #[derive(Deserialize)]
            #[serde(deny_unknown_fields)]
            struct Raw {
                corners: [[f64; 3]; 4],
            }
            let [a, b, c, d] = typed::<Raw>(value)?.corners;
            let corners = [vector(a)?, vector(b)?, vector(c)?, vector(d)?];
            ensure!(corners.iter().any(|c| *c != corners[0]), "all corners are the same point");
            Shape::Patch(corners)
        }
        "voxel" => {
            #[derive(Deserialize)]
            #[serde(deny_unknown_fields)]
            struct Raw {
                lo: [f64; 3],
                hi: [f64; 3],
                corners: [f64; 8],
            }
            let raw: Raw = typed(value)?;
            let (low, high) = (vector(raw.lo)?, vector(raw.hi)?);
            ensure!(low.cmplt(high).all(), "lo {low} is not below hi {high}");
            let mut corners = [0.0; 8];
            for (to, from) in corners.iter_mut().zip(raw.corners) {
                *to = number(from)?;
            }
            ensure!(corners != [0.0; 8], "all corners are 0");
            Shape::Voxel(Voxel { low, high, corners })
        }
        "algebraic" => {
            #[derive(Deserialize)]
            #[serde(deny_unknown_fields)]
            struct Raw {
                lo: [f64; 3],
                hi: [f64; 3],
                coefficients: Vec<f64>,
            }
            let raw: Raw = typed(value)?;
            let (low, high) = (vector(raw.lo)?, vector(raw.hi)?);
            ensure!(low.cmplt(high).all(), "lo {low} is not below hi {high}");
            let given: Vec<f32> =
                raw.coefficients.into_iter().map(number).collect::<Result<_>>()?;
            let surface = Algebraic::from_list(low, high, &given)
                .with_context(|| format!("{} coefficients, not 20 or 35", given.len()))?;
            let [of_x_to_z @ .., _] = surface.coefficients;
            ensure!(of_x_to_z != [0.0; 34], "x, y and z have no coefficient but 0");
            Shape::Algebraic(surface)
        }
        other => bail!("unknown primitive '{other}'"),
    })
}

fn radius(value: f64) -> Result<f32> {
    let single = number(value)?;
    ensure!(single > 0.0, "the radius {value} is not above 0");
    Ok(single)
}

fn direction(value: [f64; 3]) -> Result<Vec3> {
    let vector = vector(value)?;
    ensure!(vector != Vec3::ZERO, "a normal or direction is zero");
    Ok(vector)
}

fn heightfield(value: Value) -> Result<Shape> {
    #[derive(Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Raw {
        k: f64,
        a: f64,
        fx: f64,
        fz: f64,
        b: f64,
        gx: f64,
        gz: f64,
        lipschitz: f64,
    }
    let raw: Raw = serde_json::from_value(value)?;
    ensure!(raw.lipschitz >= 0.0, "the Lipschitz constant {} is below 0", raw.lipschitz);
    Ok(Shape::Heightfield(Heightfield {
        k: number(raw.k)?,
        a: number(raw.a)?,
        f: [number(raw.fx)?, number(raw.fz)?],
        b: number(raw.b)?,
        g: [number(raw.gx)?, number(raw.gz)?],
        lipschitz: number(raw.lipschitz)?,
    }))
}

fn leaving(value: Value) -> Result<Shape> {
    #[derive(Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Raw {
        kind: String,
        center: [f64; 3],
        radius: f64,
        secondary_dir: [f64; 3],
        point: Option<[f64; 3]>,
        normal: Option<[f64; 3]>,
        occluder_y: Option<f64>,
    }
    let raw: Raw = serde_json::from_value(value)?;
    let gap = match (raw.kind.as_str(), raw.point, raw.normal, raw.occluder_y) {
        ("self", None, None, None) => None,
        ("gap", Some(point), Some(normal), Some(y)) => Some(Gap {
            point: vector(point)?,
            normal: self::direction(normal)?,
            occluder_y: number(y)?,
        }),
        ("gap", ..) => bail!("a gap has point, normal and occluder_y"),
        ("self", ..) => bail!("only a gap has point, normal or occluder_y"),
        (other, ..) => bail!("unknown kind '{other}'"),
    };
    Ok(Shape::Leaving(Leaving {
        center: vector(raw.center)?,
        radius: radius(raw.radius)?,
        direction: self::direction(raw.secondary_dir)?,
        gap,
    }))
}

fn sum(value: Value) -> Result<Shape> {
    #[derive(Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Raw {
        pattern: String,
        value: f64,
        n: u32,
        spike: Option<f64>,
        every: Option<u32>,
        head: Option<f64>,
    }
    let raw: Raw = serde_json::from_value(value)?;
    ensure!((1..=LONGEST_SUM).contains(&raw.n), "n is {}, not 1 to {LONGEST_SUM}", raw.n);
    let pattern = match (raw.pattern.as_str(), raw.spike, raw.every, raw.head) {
        ("constant", None, None, None) => Pattern::Constant,
        ("firefly", Some(spike), Some(every @ 1..=LONGEST_SUM), None) => {
            Pattern::Firefly { spike: sample(spike)?, every }
        }
        ("firefly", Some(_), Some(every), None) => {
            bail!("every is {every}, not 1 to {LONGEST_SUM}")
        }
        ("head", None, None, Some(head)) => Pattern::Head(sample(head)?),
        ("constant" | "firefly" | "head", ..) => {
            bail!("the pattern '{}' takes other fields", raw.pattern)
        }
        (other, ..) => bail!("unknown pattern '{other}'"),
    };
    Ok(Shape::Sum(Sum { value: sample(raw.value)?, n: raw.n, pattern }))
}

/// Light: never below 0, which is what a sum in fixed point counts on.
fn sample(value: f64) -> Result<f32> {
    ensure!(value >= 0.0, "the sample {value} is below 0");
    number(value)
}
