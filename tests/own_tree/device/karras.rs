//! A plain way to build the same hierarchy: keys sorted on the host, and ranges split from the top.

use glam::Vec3;

use super::box_of;
use super::shapes::Shape;

/// The key of a triangle that is not finite.
pub const NOT_FINITE: u32 = 0x3fff_ffff;

/// The Morton code of each triangle, with the same arithmetic as a device that rounds every operation to
/// nearest, including division.
pub fn codes(shape: &Shape) -> Vec<u32> {
    let centres = shape
        .triangles
        .iter()
        .map(|triangle| box_of(shape.corners(*triangle)).map(|(low, high)| 0.5 * low + 0.5 * high));
    let centres: Vec<Option<Vec3>> = centres.collect();
    let known = || centres.iter().flatten().copied();
    let low = known().fold(Vec3::INFINITY, Vec3::min);
    let high = known().fold(Vec3::NEG_INFINITY, Vec3::max);
    let side = (0.5 * high - 0.5 * low).max_element();
    let side = if side > 0.0 { side } else { 1.0 };
    let code = |centre: Vec3| {
        let cell = [0, 1, 2].map(|axis| {
            let part = 0.5 * centre[axis] - 0.5 * low[axis];
            ((1024.0 * (part / side)) as u32).min(1023)
        });
        // One bit each of x, y and z, from the highest to the lowest.
        let bits = (0..10).rev().flat_map(|bit| cell.map(|number| number >> bit & 1));
        bits.fold(0, |code, bit| code << 1 | bit).min(NOT_FINITE - 1)
    };
    centres.iter().map(|centre| centre.map_or(NOT_FINITE, code)).collect()
}

/// The children of each node: a node or, with `true`, a position.
pub fn hierarchy(keys: &[u32]) -> Vec<[(u32, bool); 2]> {
    let mut nodes = vec![[(0, false); 2]; keys.len().saturating_sub(1)];
    // The bits that distinguish positions: first their keys', then their own.
    let long = |position: usize| u64::from(keys[position]) << 32 | position as u64;
    let mut open = Vec::new();
    if keys.len() > 1 {
        open.push((0, 0, keys.len() - 1));
    }
    while let Some((node, first, last)) = open.pop() {
        let highest = 63 - (long(first) ^ long(last)).leading_zeros();
        let right = (first..=last).find(|&at| long(at) >> highest & 1 == 1).unwrap();
        let mut child = |from: usize, to: usize, index: usize| {
            if from < to {
                open.push((index, from, to));
            }
            (index as u32, from == to)
        };
        nodes[node] = [child(first, right - 1, right - 1), child(right, last, right)];
    }
    nodes
}
