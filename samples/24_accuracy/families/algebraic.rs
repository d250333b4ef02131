//! Algebraic surfaces: rays from everywhere, and rays that nearly touch the surface or follow it, pass a node, meet it at a
//! face, or lose a degree.

use glam::DVec3;
use reference::algebraic;
use reference::random::{Random, f32s};

use super::curved::nearly;
use super::{Draw, Family, on_disc};
use crate::shape::{Algebraic, Shape};
use crate::specimen::kummer;

/// Cayley's cubic, with four nodes.
fn cayley() -> Algebraic {
    let square = [[2, 0, 0], [0, 2, 0], [0, 0, 2]].map(|powers| (powers, 4.0));
    Algebraic::from_terms(1.0, &[&square[..], &[([1, 1, 1], 16.0), ([0, 0, 0], -1.0)]].concat())
}

/// A lemniscate turned about x, with one node.
fn lemniscate() -> Algebraic {
    let terms = [([4, 0, 0], 1.0), ([2, 0, 0], -1.0), ([0, 2, 0], 1.0), ([0, 0, 2], 1.0)];
    Algebraic::from_terms(1.125, &terms)
}

/// A quartic without any order: every coefficient has its own value.
fn disorder() -> Algebraic {
    let mut random = Random(35);
    let mut surface = Algebraic::from_terms(1.0, &[]);
    surface.coefficients.iter_mut().for_each(|c| *c = random.between(-1.0, 1.0) as f32);
    surface
}

/// Cayley's cubic, a Kummer surface, the lemniscate, and no order at all.
fn all() -> [Algebraic; 4] {
    [cayley(), kummer(), lemniscate(), disorder()]
}

/// Nodes of the first three.
const NODES: [&[[f64; 3]]; 3] = [
    &[[0.5, 0.5, -0.5], [0.5, -0.5, 0.5], [-0.5, 0.5, 0.5], [-0.5, -0.5, -0.5]],
    &[[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [0.5, 0.5, 0.25], [-0.5, 0.25, -0.5]],
    &[[0.0, 0.0, 0.0]],
];

/// The same surface for the reference.
pub fn exact(surface: &Algebraic) -> algebraic::Algebraic {
    let Algebraic { low, high, coefficients } = *surface;
    algebraic::Algebraic {
        low: low.as_dvec3(),
        high: high.as_dvec3(),
        coefficients: coefficients.map(f64::from),
    }
}

fn within(random: &mut Random, surface: &algebraic::Algebraic) -> DVec3 {
    let mut along = |k: usize| random.between(surface.low[k], surface.high[k]);
    DVec3::new(along(0), along(1), along(2))
}

/// A point of the surface on the way from one random point of the box to another; if wanted, both on the same face.
fn point(random: &mut Random, surface: &algebraic::Algebraic, is_on_face: bool) -> DVec3 {
    loop {
        let mut ends = [within(random, surface), within(random, surface)];
        if is_on_face {
            let k = random.below(3);
            let at = if random.below(2) == 0 { surface.low[k] } else { surface.high[k] };
            ends.iter_mut().for_each(|end| end[k] = at);
        }
        let [mut a, mut b] = ends;
        let is_above = surface.value(a) > 0.0;
        if is_above == (surface.value(b) > 0.0) {
            continue;
        }
        for _ in 0..60 {
            let middle = 0.5 * (a + b);
            if (surface.value(middle) > 0.0) == is_above { a = middle } else { b = middle }
        }
        return b;
    }
}

pub fn surfaces(draw: Draw) -> Vec<Family> {
    let shapes = || all().map(Shape::Algebraic).to_vec();
    let exacts = all().each_ref().map(exact);
    let count = exacts.len();
    let afar = |name, distance: f64| {
        Family::new(name, shapes(), draw, &mut move |random, number| {
            let axis = random.unit();
            let origin = f32s(axis * distance);
            (number % count, origin, (on_disc(random, DVec3::ZERO, axis, 1.2) - origin).normalize())
        })
    };
    // A face has no part of the lemniscate.
    let faces = &mut |random: &mut Random, number: usize| {
        let number = [0, 1, 3][number % 3];
        let target = point(random, &exacts[number], true) + random.unit() * nearly(random);
        let origin = f32s(random.unit() * 4.0);
        (number, origin, target - origin)
    };
    let touched = &mut |random: &mut Random, number: usize| {
        let number = number % count;
        let on = point(random, &exacts[number], false);
        let normal = exacts[number].gradient(on).normalize();
        let direction = normal.cross(random.unit()).normalize();
        let target = on + normal * nearly(random);
        let origin = f32s(target - 4.0 * direction);
        (number, origin, target - origin)
    };
    // Along a tangent that the surface bends away from on neither side: three roots meet. The other two have none.
    let threefold = &mut |random: &mut Random, number: usize| loop {
        let number = number % 2;
        let on = point(random, &exacts[number], false);
        let normal = exacts[number].gradient(on).normalize();
        let across = normal.cross(random.unit()).normalize();
        let tangents = [across, normal.cross(across)];
        let step = 1e-3;
        let bend = |along: DVec3, by: DVec3| {
            let [ahead, behind] = [step, -step].map(|h| exacts[number].gradient(on + h * along));
            (ahead - behind).dot(by) / (2.0 * step)
        };
        let [u, v] = tangents;
        let (a, b, c) = (bend(u, u), bend(u, v), bend(v, v));
        let discriminant = b * b - a * c;
        if discriminant <= 0.0 || c == 0.0 {
            continue;
        }
        let direction = (u + (discriminant.sqrt() - b) / c * v).normalize();
        let side = if random.below(2) == 0 { 1.0 } else { -1.0 };
        let target = on + normal * side * random.scale(1e-6, 1e-3);
        let origin = f32s(target - 4.0 * direction);
        return (number, origin, target - origin);
    };
    // The value near a node grows with the square of the distance.
    let nodes = &mut |random: &mut Random, number: usize| {
        let number = number % NODES.len();
        let node = DVec3::from(NODES[number][random.below(NODES[number].len())]);
        let target = node + random.unit() * random.scale(1e-4, 1e-2);
        let origin = f32s(target - 4.0 * random.unit());
        (number, origin, target - origin)
    };
    // Along an axis, or nearly: there Cayley's cubic has degree two, and across its own axis so has the lemniscate.
    let flat = &mut |random: &mut Random, number: usize| {
        let number = [0, 2][number % 2];
        let k = if number == 2 { 1 + random.below(2) } else { random.below(3) };
        let mut direction = DVec3::ZERO;
        direction[k] = if random.below(2) == 0 { 1.0 } else { -1.0 };
        for other in [(k + 1) % 3, (k + 2) % 3] {
            direction[other] = if random.below(3) == 0 { 0.0 } else { random.scale(1e-9, 1e-2) };
        }
        let target = within(random, &exacts[number]);
        (number, f32s(target - 4.0 * direction.normalize()), direction.normalize())
    };
    vec![
        afar("algebraic from 10", 10.0),
        afar("algebraic from 1e4", 1e4),
        Family::new("algebraic nearly touched", shapes(), draw, touched),
        Family::new("algebraic nearly threefold", shapes(), draw, threefold),
        Family::new("algebraic near its nodes", shapes(), draw, nodes),
        Family::new("algebraic at its faces", shapes(), draw, faces),
        Family::new("algebraic of lower degree", shapes(), draw, flat),
    ]
}
