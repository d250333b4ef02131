//! The starts of rays on the lens: they match the definitions, are evenly spread, and independent of the
//! pixel's points.

use std::f64::consts::{PI, TAU};

use glam::DVec2;
use serde_json::json;

use super::points::{hash, mirrored, owen, sobol_second};
use super::{AT_ORIGIN, SIZE, SMALL, chapter};
use run::expected;

/// The purpose of a random number, as in `shaders/common/random.glsl` and `sample_point.glsl`.
const DIMENSION_PIXEL: u32 = 1;
pub const DIMENSION_LENS: u32 = 5;

/// The numbers of a sample, of 24 bits each; `ordered` uses the points in the sequence's own order.
pub fn numbers(pixel: [u32; 2], seed: u32, i: u32, dimension: u32, ordered: bool) -> [f64; 2] {
    let key = hash([pixel[0], pixel[1], seed, dimension]);
    let i = if ordered { i } else { owen(i, key[2]) };
    let point = [mirrored(i, 2), sobol_second(i)];
    [0, 1].map(|axis| {
        let bits = owen((point[axis] * 2f64.powi(32)) as u32, key[axis]);
        f64::from(bits >> 8) * 0.5f64.powi(24)
    })
}

/// The concentric map, in polar coordinates (Shirley and Chiu 1997).
pub fn on_disk([u, v]: [f64; 2]) -> DVec2 {
    let (x, y) = (2.0 * u - 1.0, 2.0 * v - 1.0);
    let (radius, angle) = if x * x > y * y {
        (x, PI / 4.0 * (y / x))
    } else if y == 0.0 {
        (0.0, 0.0)
    } else {
        (y, PI / 2.0 - PI / 4.0 * (x / y))
    };
    radius * DVec2::from_angle(angle)
}

/// A point of a regular polygon with corners on the unit circle, the first of them on the right.
pub fn in_polygon(corners: u32, [u, v]: [f64; 2]) -> DVec2 {
    let place = u * f64::from(corners);
    let corner = |k: f64| DVec2::from_angle(TAU * k / f64::from(corners));
    let [from, to] = [place.floor(), place.floor() + 1.0].map(corner);
    v.sqrt() * from.lerp(to, place.fract())
}

/// The point on a lens of radius 1 at which each pixel's ray of a frame starts.
fn places(size: &str, frame: u32, blades: u32, more: &[&str]) -> Vec<DVec2> {
    let blades = format!("blades={blades}");
    let sets = [&AT_ORIGIN[..], &["show=ray origin", "lens diameter=2", &blades], more].concat();
    let origins = chapter(size).frames(frame + 1).sets(&sets).picture();
    assert!(origins.pixels.iter().all(|pixel| pixel[2] == 0.0), "the lens is no plane");
    origins.pixels.iter().map(|pixel| DVec2::new(pixel[0].into(), pixel[1].into())).collect()
}

#[test]
fn rays_start_where_the_definitions_say() {
    for (blades, frame) in [(0, 0), (0, 97), (3, 1), (6, 98)] {
        for (i, found) in places(SMALL, frame, blades, &["seed=7"]).into_iter().enumerate() {
            let pixel = [i as u32 % 64, i as u32 / 64];
            let u = numbers(pixel, 7, frame, DIMENSION_LENS, false);
            let place = if blades < 3 { on_disk(u) } else { in_polygon(blades, u) };
            // llvmpipe's sines and cosines are off by a ULP; that amounts to a handful of roundings.
            let off = (found - place).length();
            assert!(off < 0.5f64.powi(20), "{blades} blades, {pixel:?}: {found} and {place}");
        }
    }
}

/// The largest deviation of numbers from a uniform distribution on 0 to 1.
fn unevenness(numbers: impl Iterator<Item = f64>) -> f64 {
    let mut numbers: Vec<f64> = numbers.collect();
    numbers.sort_by(f64::total_cmp);
    let count = numbers.len() as f64;
    let off = |(i, &x): (usize, &f64)| (x - (i as f64 + 0.5) / count).abs();
    numbers.iter().enumerate().map(off).fold(0.0, f64::max)
}

#[test]
fn places_are_uniform_over_the_aperture_and_fill_it() {
    for blades in [0, 2, 3, 5, 6, 12] {
        let places = places(SIZE, 0, blades, &[]);
        let count = places.len() as f64;
        // Kolmogorov and Smirnov: one uniform set in a thousand deviates more.
        let bound = 1.95 / count.sqrt();
        let tau = |place: &DVec2| place.to_angle().rem_euclid(TAU) / TAU;
        // The distance from the middle, as the fraction of the area further in, and the fraction of the way
        // around.
        let (out, around, moment): (Vec<f64>, Vec<f64>, f64) = if blades < 3 {
            (
                places.iter().map(|p| p.length_squared()).collect(),
                places.iter().map(tau).collect(),
                0.5,
            )
        } else {
            let n = f64::from(blades);
            let half = PI / n;
            let side = |place: &DVec2| {
                let k = (tau(place) * n).floor();
                let middle = DVec2::from_angle(TAU * (k + 0.5) / n);
                let along = place.dot(middle.perp()) / (place.dot(middle) * half.tan());
                ((place.dot(middle) / half.cos()).powi(2), (k + 0.5 + 0.5 * along) / n)
            };
            // For a triangle of 0, a and b, the mean of p² is (a² + b² + a·b) / 6.
            let moment = (2.0 + (TAU / n).cos()) / 6.0;
            let (out, around) = places.iter().map(side).unzip();
            (out, around, moment)
        };
        let slack = 0.5f64.powi(20);
        let most = out.iter().copied().fold(0.0, f64::max);
        assert!((0.999..=1.0 + slack).contains(&most), "{blades} blades: out to {most}");
        let uneven = [unevenness(out.into_iter()), unevenness(around.into_iter())];
        assert!(
            uneven.iter().all(|most| *most < bound),
            "{blades} blades: {uneven:?}, not {bound}"
        );
        let found = places.iter().map(|p| p.length_squared()).sum::<f64>() / count;
        // The variance of p² is below 1/12 of the disk's radius to the fourth.
        let off = (found - moment).abs();
        assert!(off < 4.0 * (1.0 / 12.0 / count).sqrt(), "{blades} blades: {found}, not {moment}");
    }
}

#[test]
fn blades_turn() {
    let [still, turned] =
        ["blade rotation=0", "blade rotation=40"].map(|turn| places(SMALL, 3, 5, &[turn]));
    let turn = DVec2::from_angle(40f64.to_radians());
    let off = |(still, turned): (&DVec2, &DVec2)| (turn.rotate(*still) - *turned).length();
    let most = still.iter().zip(&turned).map(off).fold(0.0, f64::max);
    assert!(most < 0.5f64.powi(20), "{most}");
}

/// The number of the 16 pairs, of a quarter of the pixel and a quarter of the lens, that occur in 64 samples
/// of a pixel.
fn pairs(pixel: [u32; 2], ordered: bool) -> u32 {
    let quarter = |[u, v]: [f64; 2]| 2 * u32::from(u >= 0.5) + u32::from(v >= 0.5);
    let mut seen = 0u32;
    for i in 0..64 {
        let in_pixel = quarter(numbers(pixel, 0, i, DIMENSION_PIXEL, true));
        let on_lens = quarter(numbers(pixel, 0, i, DIMENSION_LENS, ordered));
        seen |= 1 << (4 * in_pixel + on_lens);
    }
    seen.count_ones()
}

#[test]
fn every_part_of_a_pixel_sees_through_every_part_of_the_lens() {
    let mean = |ordered| {
        let counts = (0..400).map(|i| pairs([i % 20, i / 20], ordered));
        f64::from(counts.sum::<u32>()) / 400.0
    };
    let (shared, own) = (mean(true), mean(false));
    println!("of 16 pairs, {shared} with one order for both, {own} with one each");
    // 64 random pairs miss a given one of 16 with a probability of 1.6 %.
    assert_eq!(shared, 4.0);
    assert!(own > 15.0, "{own}");
    expected::hold_exact("28_depth_of_field/pairs", json!({ "shared": shared, "own": own }));
}
