//! Voxels of a distance grid: rays from everywhere, and rays that nearly touch the surface, meet it at a face, or lose a degree.

use glam::{DVec3, Vec3};
use reference::random::{Random, f32s};
use reference::voxel;

use super::curved::nearly;
use super::{Draw, Family, on_disc};
use crate::shape::{Shape, Voxel};

const LOW: Vec3 = Vec3::new(-0.45, -0.5, -0.4);
const HIGH: Vec3 = Vec3::new(0.5, 0.4, 0.55);

/// A ball's distances, a saddle, two sheets and a tunnel between them, and no order at all.
const CORNERS: [[f32; 8]; 4] = [
    [-0.31, 0.12, 0.08, 0.45, 0.15, 0.47, 0.41, 0.72],
    [0.3, -0.25, -0.35, 0.28, 0.21, -0.3, -0.22, 0.4],
    [0.6, -0.1, -0.2, 0.05, 0.1, -0.15, -0.3, 0.7],
    [0.31, -0.17, -0.42, 0.23, -0.29, 0.55, 0.38, -0.61],
];

fn shape(corners: [f32; 8]) -> Voxel {
    Voxel { low: LOW, high: HIGH, corners }
}

/// The same voxel for the reference.
pub fn exact(voxel: &Voxel) -> voxel::Voxel {
    let Voxel { low, high, corners } = *voxel;
    voxel::Voxel { low: low.as_dvec3(), high: high.as_dvec3(), corners: corners.map(f64::from) }
}

fn mean(number: usize, point: DVec3) -> f64 {
    let at = (point - LOW.as_dvec3()) / (HIGH - LOW).as_dvec3();
    let weight = |n: usize, k: usize| if n >> k & 1 != 0 { at[k] } else { 1.0 - at[k] };
    let corners = CORNERS[number].iter().enumerate();
    corners.map(|(n, c)| f64::from(*c) * weight(n, 0) * weight(n, 1) * weight(n, 2)).sum()
}

fn within(random: &mut Random) -> DVec3 {
    let mut along = |k: usize| random.between(LOW[k].into(), HIGH[k].into());
    DVec3::new(along(0), along(1), along(2))
}

/// A point of the surface on the way from one random point of the box to another; if wanted, both on the same face.
fn point(random: &mut Random, number: usize, is_on_face: bool) -> DVec3 {
    loop {
        let mut ends = [within(random), within(random)];
        if is_on_face {
            // Not every face has a part of the surface: each try has its own.
            let k = random.below(3);
            let at = if random.below(2) == 0 { LOW[k] } else { HIGH[k] };
            ends.iter_mut().for_each(|end| end[k] = at.into());
        }
        let [mut a, mut b] = ends;
        let is_above = mean(number, a) > 0.0;
        if is_above == (mean(number, b) > 0.0) {
            continue;
        }
        for _ in 0..60 {
            let middle = 0.5 * (a + b);
            if (mean(number, middle) > 0.0) == is_above { a = middle } else { b = middle }
        }
        return b;
    }
}

pub fn voxels(draw: Draw) -> Vec<Family> {
    let shapes = || CORNERS.map(|corners| Shape::Voxel(shape(corners))).to_vec();
    let count = CORNERS.len();
    let afar = |name, distance: f64| {
        Family::new(name, shapes(), draw, &mut move |random, number| {
            let axis = random.unit();
            let origin = f32s(axis * distance);
            (number % count, origin, (on_disc(random, DVec3::ZERO, axis, 0.6) - origin).normalize())
        })
    };
    let touched = &mut |random: &mut Random, number: usize| {
        let number = number % count;
        let on = point(random, number, false);
        let normal = exact(&shape(CORNERS[number])).gradient(on).normalize();
        let direction = normal.cross(random.unit()).normalize();
        let target = on + normal * nearly(random);
        let origin = f32s(target - 4.0 * direction);
        (number, origin, target - origin)
    };
    let faces = &mut |random: &mut Random, number: usize| {
        let number = number % count;
        let target = point(random, number, true) + random.unit() * nearly(random);
        let origin = f32s(random.unit() * 4.0);
        (number, origin, target - origin)
    };
    // Parallel to a plane of two axes, or nearly: the polynomial has degree two, or nearly.
    let flat = &mut |random: &mut Random, number: usize| {
        let k = random.below(3);
        let mut direction = random.unit();
        direction[k] = if random.below(2) == 0 { 0.0 } else { random.scale(1e-9, 1e-4) };
        let target = within(random);
        (number % count, f32s(target - 4.0 * direction.normalize()), direction.normalize())
    };
    vec![
        afar("voxel from 10", 10.0),
        afar("voxel from 1e4", 1e4),
        Family::new("voxel nearly touched", shapes(), draw, touched),
        Family::new("voxel at its faces", shapes(), draw, faces),
        Family::new("voxel of degree two", shapes(), draw, flat),
    ]
}
