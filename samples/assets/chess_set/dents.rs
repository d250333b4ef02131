//! Normal maps: metal that a hammer has dented, and board squares with bevelled edges.
//!
//! A map's red, green and blue are x, y and z of a normal, 0 to 255 for -1 to 1; x is to the right and y up.

use glam::{DVec2, DVec3, IVec2, dvec2, ivec2};
use image::{Rgba, RgbaImage};

/// A map is this many texels wide and high. It repeats in both directions.
const SIZE: u32 = 256;
/// Samples per texel in each direction.
const SAMPLES: u32 = 4;
/// Dents in each direction.
const DENTS: i32 = 12;
/// The slope of a dent at a distance of one dent from its middle.
const DEPTH: f64 = 0.5;
/// The width of a bevel; the map is 1 wide.
const BEVEL: f64 = 0.045;
/// Its slope at the edge of the square.
const STEEPNESS: f64 = 1.0;

/// Metal with dents, each part of a paraboloid.
pub fn hammered() -> RgbaImage {
    image(dented)
}

/// A square whose edges are rounded off, with shallow dents.
pub fn bevelled() -> RgbaImage {
    image(|at| {
        // Rising from the left edge, and falling to the right one.
        let bevel = |x: f64| {
            let near = |distance: f64| (1.0 - distance / BEVEL).max(0.0);
            STEEPNESS * (near(x) - near(1.0 - x))
        };
        let inside = |x: f64| (x.min(1.0 - x) / BEVEL).clamp(0.0, 1.0);
        dvec2(bevel(at.x), bevel(at.y)) + dented(at) * 0.15 * inside(at.x) * inside(at.y)
    })
}

/// The map of a height by its slopes, to the right and up.
fn image(slope: impl Fn(DVec2) -> DVec2) -> RgbaImage {
    RgbaImage::from_fn(SIZE, SIZE, |x, y| {
        let mut sum = DVec2::ZERO;
        for i in 0..SAMPLES * SAMPLES {
            let sub = dvec2(f64::from(i % SAMPLES), f64::from(i / SAMPLES)) + 0.5;
            // The rows of a picture begin at the top.
            let row = f64::from(SIZE - 1 - y);
            sum += slope((dvec2(f64::from(x), row) + sub / f64::from(SAMPLES)) / f64::from(SIZE));
        }
        let mean = sum / f64::from(SAMPLES * SAMPLES);
        let normal = DVec3::new(-mean.x, -mean.y, 1.0).normalize();
        let [r, g, b] = normal.to_array().map(|part| (127.5 + 127.5 * part).round() as u8);
        Rgba([r, g, b, 255])
    })
}

/// The slope of the dent whose middle is nearest.
fn dented(at: DVec2) -> DVec2 {
    let place = at * f64::from(DENTS);
    let cell = place.floor().as_ivec2();
    let around = (0..25).map(|i| cell + ivec2(i % 5, i / 5) - 2);
    let from_middle = around.map(|cell| place - middle(cell));
    let nearest = from_middle.min_by(|a, b| a.length_squared().total_cmp(&b.length_squared()));
    nearest.unwrap_or_default() * DEPTH
}

/// The middle of a dent, at a place of its own in its cell.
fn middle(cell: IVec2) -> DVec2 {
    let [x, y] = [cell.x, cell.y].map(|i| i.rem_euclid(DENTS) as u32);
    let key = scrambled(scrambled(x) ^ y);
    let part = |bits: u32| 0.1 + 0.8 * f64::from(bits & 0xffff) / 65536.0;
    cell.as_dvec2() + dvec2(part(key), part(key >> 16))
}

/// A permutation of the whole numbers that looks random (Wellons, "Prospecting for hash functions", 2018).
fn scrambled(value: u32) -> u32 {
    let value = (value ^ value >> 16).wrapping_add(0x9e37_79b9).wrapping_mul(0x21f0_aaad);
    let value = (value ^ value >> 15).wrapping_mul(0x735a_2d97);
    value ^ value >> 15
}
