//! Families of rays and shapes, each hard in its own way, from fixed seeds.

use glam::DVec3;
use reference::random::{Random, f32s, towards};
use reference::swept::Swept;

use super::direct::Case;

pub const COUNT: usize = 1000;

/// The families, and the difficulty of each.
pub const FAMILIES: [&str; 11] = [
    "everyday",  // from 3 to 10 sizes away
    "far",       // from 10,000
    "tiny",      // a millionth in size, from 100
    "huge",      // a million in size, from 3 to 10
    "hair",      // a thousandth as thick as long, with a tip
    "cylinders", // radii that differ by a few units in the last place
    "swallowed", // one end just within the other, or just not
    "along",     // rays almost along the axis
    "inside",    // rays that begin inside
    "tips",      // a radius of 0, and rays past that end
    "joints",    // rays that touch where body and cap meet
];

/// A number rounded to f32.
fn rounded(x: f64) -> f64 {
    f64::from(x as f32)
}

/// A point of the surface: on an end, or on the body next to the ball at `s`, in a direction perpendicular to
/// the axis.
fn on_surface(swept: &Swept, s: f64, turn: DVec3) -> DVec3 {
    let [a, b] = swept.ends;
    let radius = swept.radii[0] + s * (swept.radii[1] - swept.radii[0]);
    let u = b - a;
    let across = turn - turn.dot(u) / u.length_squared() * u;
    let lean = (swept.radii[1] - swept.radii[0]) / u.length();
    let normal = (1.0 - lean * lean).max(0.0).sqrt() * across.normalize() - lean * u.normalize();
    a + s * u + radius * normal
}

fn case(family: &str, random: &mut Random) -> Case {
    let mut size = 1.0;
    let mut radii = [random.between(0.05, 0.6), random.between(0.05, 0.6)];
    let mut distance = random.between(3.0, 10.0);
    match family {
        "far" => distance = 1e4,
        "tiny" => (size, distance) = (1e-6, 100.0),
        "huge" => size = 1e6,
        "hair" => {
            radii = [random.between(2e-4, 1e-3), if random.below(2) == 0 { 0.0 } else { 5e-4 }]
        }
        "tips" => radii[1] = 0.0,
        _ => {}
    }
    let center = random.in_cube() * size;
    let u = random.unit() * size;
    let mut ends = [f32s(center - 0.5 * u), f32s(center + 0.5 * u)];
    let mut radii = radii.map(|radius| rounded(radius * size));
    match family {
        "cylinders" => {
            let steps = random.below(5) as i32 - 2;
            radii[1] =
                f64::from(f32::from_bits((radii[0] as f32).to_bits().wrapping_add_signed(steps)));
        }
        "swallowed" => {
            let apart = (ends[1] - ends[0]).length();
            let off = 1e-6 * random.between(-1.0, 1.0) * f64::from(random.below(2) as u32);
            radii[1] = rounded(radii[0] + apart * (1.0 + off));
        }
        _ => {}
    }
    if random.below(2) == 0 {
        ends.reverse();
        radii.reverse();
    }
    let swept = Swept { ends, radii };
    // Half aim at the shape, half at its outline, within a thousandth of the radius on either side.
    let along = ends[1] - ends[0];
    let eye = center + random.unit() * distance * size;
    let s = random.between(-0.2, 1.2);
    let axis = ends[0] + s * along;
    let radius = radii[0] + s.clamp(0.0, 1.0) * (radii[1] - radii[0]);
    let view = (axis - eye).normalize();
    let outline = view.cross(along).normalize() * radius;
    let target = match random.below(2) {
        0 => axis + 0.9 * radius * random.in_cube(),
        _ => axis + (1.0 + 1e-3 * random.between(-1.0, 1.0)) * outline,
    };
    let ray = match family {
        "along" => {
            let off = random.in_cube() * random.scale(1e-7, 1e-2);
            let from = target - distance * along;
            // Every fourth is as nearly parallel as floats allow, every eighth exactly.
            let to = if random.below(4) == 0 { target } else { target + off };
            let mut ray = towards(from, to);
            if random.below(8) == 0 {
                ray.direction = f32s(ends[1] - ends[0]);
            }
            ray
        }
        "inside" => {
            let s = random.between(0.0, 1.0);
            let radius = radii[0] + s * (radii[1] - radii[0]);
            towards(
                ends[0].lerp(ends[1], s) + 0.5 * radius * random.in_cube(),
                random.in_cube() * 2.0,
            )
        }
        "tips" => {
            let tip = ends[usize::from(radii[1] == 0.0)];
            towards(eye, tip + random.in_cube() * random.scale(1e-7, 1e-2))
        }
        "joints" => {
            // A tangent through the circle where body and cap meet, moved by about a rounding.
            let point = on_surface(&swept, random.below(2) as f64, random.unit());
            let normal = swept.normal(point);
            let tangent = normal.cross(random.unit()).normalize();
            let point = point + normal * random.between(-1.0, 1.0) * random.scale(1e-8, 1e-5);
            towards(point - tangent * distance, point)
        }
        _ => towards(eye, target),
    };
    Case { ray, swept }
}

/// Rays exactly along an axis with a tip, first or last: from the tip, from inside, and from outside at both ends.
pub fn through_tips() -> Vec<Case> {
    let mut cases = Vec::new();
    for (axis, tip_first) in
        [DVec3::X, DVec3::Y, DVec3::Z].into_iter().flat_map(|a| [(a, true), (a, false)])
    {
        let (tip, thick) = (0.75 * axis, -1.25 * axis);
        let ends = if tip_first { [tip, thick] } else { [thick, tip] };
        let radii = if tip_first { [0.0, 0.5] } else { [0.5, 0.0] };
        for (from, to) in [
            (tip, thick),
            (0.25 * axis, tip),
            (0.25 * axis, thick),
            (-1.5 * axis, thick),
            (4.0 * axis, tip),
            (-4.0 * axis, thick),
        ] {
            cases.push(Case { ray: towards(from, to), swept: Swept { ends, radii } });
        }
    }
    cases
}

/// Another seed: with `SEED=7` the tests try new cases.
pub fn seed() -> Option<u64> {
    std::env::var("SEED").ok().map(|seed| seed.parse().expect("SEED is a whole number"))
}

/// All cases of a family.
pub fn cases(family: &str) -> Vec<Case> {
    let number = FAMILIES.iter().position(|name| *name == family).expect("a family") as u64;
    let mut random = Random(seed().map_or(1800, |seed| seed << 8) + number);
    (0..COUNT).map(|_| case(family, &mut random)).collect()
}
