//! Families of rays and tori, each hard in its own way, from fixed seeds.

use glam::DVec3;
use reference::Ray;
use reference::random::{Random, f32s, towards};
use reference::torus::Torus;
use serde_json::Value;

use super::direct::Case;

pub const COUNT: usize = 500;

/// The families, and the difficulty of each.
pub const FAMILIES: [&str; 10] = [
    "everyday", // from 3 to 10 radii away, at the torus
    "outline",  // past the tube by up to a thousandth of its radius
    "tangents", // past the tube by a few roundings
    "far",      // from 10,000 to a million radii
    "scaled",   // a millionth or a million in size
    "thin",     // a tube of 1e-6 to 1e-2 of the ring
    "closed",   // a tube as thick as the ring, or nearly
    "inside",   // from inside the tube
    "surface",  // from the surface, up to rounding
    "plane",    // along the axis, in the ring's plane, along its top
];

fn rounded(x: f64) -> f64 {
    f64::from(x as f32)
}

/// A point of the surface and the normal there: the ring turned by `turn`, and the tube by `roll`.
fn on_surface(torus: &Torus, turn: f64, roll: f64) -> (DVec3, DVec3) {
    let n = torus.axis.normalize();
    let side = n.any_orthonormal_vector();
    let ring = turn.cos() * side + turn.sin() * n.cross(side);
    let normal = roll.cos() * ring + roll.sin() * n;
    (torus.center + torus.major * ring + torus.minor * normal, normal)
}

fn case(family: &str, random: &mut Random) -> Case {
    let mut size = 1.0;
    let mut tube = random.between(0.05, 0.9);
    let mut distance = random.between(3.0, 10.0);
    match family {
        "far" => distance = random.scale(1e4, 1e6),
        "scaled" => size = if random.below(2) == 0 { 1e-6 } else { 1e6 },
        "thin" => tube = random.scale(1e-6, 1e-2),
        "closed" => tube = 1.0 - random.scale(1e-7, 1e-2) * random.below(2) as f64,
        _ => {}
    }
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    let axis = match family {
        "plane" => axes[random.below(3)] * if random.below(2) == 0 { 1.0 } else { 0.3 },
        _ => random.unit() * random.scale(0.1, 10.0),
    };
    let center = random.in_cube() * size * random.below(2) as f64;
    let major = rounded(size * random.between(0.5, 2.0));
    let torus = Torus {
        center: f32s(center),
        axis: f32s(axis),
        major,
        minor: rounded(major * tube).min(major),
    };
    let turn = random.between(0.0, std::f64::consts::TAU);
    let roll = match family {
        // The inner side, where the hole is closed, is the hard one.
        "closed" => std::f64::consts::PI + random.between(-1.0, 1.0) * random.scale(1e-3, 1.0),
        _ => random.between(0.0, std::f64::consts::TAU),
    };
    let (point, normal) = on_surface(&torus, turn, roll);
    let tangent = normal.cross(random.unit()).normalize();
    let off = match family {
        "tangents" => random.between(-1.0, 1.0) * random.scale(1e-8, 1e-5) * torus.major,
        _ => 1e-3 * random.between(-1.0, 1.0) * torus.minor,
    };
    let at_tangent = point + off * normal;
    let away = distance * torus.major;
    let mut ray = match family {
        "tangents" | "outline" => towards(at_tangent - tangent * away, at_tangent),
        "inside" => {
            let (wall, inward) = on_surface(&torus, random.between(0.0, 6.0), roll);
            let start = wall - inward * torus.minor * random.between(1e-6, 1.9);
            towards(start, point + random.in_cube() * torus.minor)
        }
        "surface" => {
            let leave = (normal + random.in_cube()) * if random.below(2) == 0 { 1.0 } else { -1.0 };
            towards(point, f32s(point) + leave * torus.major)
        }
        "plane" => {
            let n = torus.axis.normalize();
            let side = n.any_orthonormal_vector();
            let height = [0.0, torus.minor, -torus.minor][random.below(3)];
            let reach = random.below(5) as f64 * 0.5 * torus.minor - torus.minor + torus.major;
            let start = torus.center + height * n + reach * n.cross(side);
            match random.below(3) {
                0 => towards(start + 4.0 * size * side, start),
                1 => towards(start - 4.0 * size * n, start),
                _ => towards(torus.center - 4.0 * size * n, torus.center),
            }
        }
        // Half at the torus, half past its outline.
        _ if random.below(2) == 0 => {
            towards(torus.center + random.unit() * away, point - 0.3 * torus.minor * normal)
        }
        _ => towards(at_tangent - tangent * away, at_tangent),
    };
    // A direction need not be a unit vector: its length is between 2^-8 and 2^8 of what it was.
    ray.direction *= f64::from(random.below(17) as i32 - 8).exp2();
    Case { ray, torus }
}

/// The rays and tori of `tests/data/torus_cases.json`; the reference's own test compares its answers.
pub fn hard_cases() -> Vec<Case> {
    let path = run::root().join("tests/data/torus_cases.json");
    let text = std::fs::read_to_string(path).expect("the cases");
    let file: Value = serde_json::from_str(&text).expect("JSON");
    let number = |of: &Value| of.as_f64().expect("a number");
    let case = |case: &Value| {
        let vector = |key: &str| DVec3::from([0, 1, 2].map(|i| number(&case[key][i])));
        let [origin, direction, center, axis] =
            ["origin", "direction", "center", "axis"].map(vector);
        let [tmin, major, minor] = ["tmin", "major", "minor"].map(|key| number(&case[key]));
        let ray = Ray { origin, direction, tmin, tmax: 1e30 };
        Case { ray, torus: Torus { center, axis, major, minor } }
    };
    file["cases"].as_array().expect("a list").iter().map(case).collect()
}

/// Another seed: with `SEED=7` the tests try new cases.
pub fn seed() -> Option<u64> {
    std::env::var("SEED").ok().map(|seed| seed.parse().expect("SEED is a whole number"))
}

/// All cases of a family.
pub fn cases(family: &str) -> Vec<Case> {
    let number = FAMILIES.iter().position(|name| *name == family).expect("a family") as u64;
    let mut random = Random(seed().map_or(3300, |seed| seed << 8) + number);
    (0..COUNT).map(|_| case(family, &mut random)).collect()
}
