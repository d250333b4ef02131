//! 37_sequences: the points match the literature, cover a pixel evenly, and differ between pixels.

mod converging;
mod plots;
pub mod points;

use serde_json::json;

use self::points::{Scrambling, Sequence, sample_point};
use crate::jitter_camera::{error, offsets};
use run::{Chapter, expected, render, same_colors};

const NAME: &str = "37_sequences";
const SIZE: &str = "240x150";
/// Enough pixels for many points, few enough for many frames.
const SMALL: &str = "64x40";

fn chapter(size: &str) -> Chapter {
    Chapter::new(NAME).size(size)
}

#[test]
fn the_picture_repeats() {
    Chapter::new(NAME).frames(16).repeats();
}

#[test]
fn rays_through_the_centre_give_the_picture_of_04() {
    let still = render("04_jitter_camera", SIZE, &["--frames", "3", "--set", "jitter=off"]).picture;
    for sets in [&["filter=tent", "scrambling=none"][..], &["filter=Blackman-Harris", "seed=5"]] {
        let picture = chapter(SIZE).frames(3).sets(&["sequence=centre"]).sets(sets).picture();
        same_colors(&format!("37 and 04, {sets:?}"), NAME, &picture, &still);
    }
}

#[test]
fn the_points_are_those_of_the_literature() {
    let cases = [
        (Sequence::Random, "random", Scrambling::Owen, "Owen"),
        (Sequence::Halton, "Halton", Scrambling::Rotation, "rotation"),
        (Sequence::R2, "R2", Scrambling::Rotation, "rotation"),
        (Sequence::Sobol, "Sobol", Scrambling::None, "none"),
        (Sequence::Sobol, "Sobol", Scrambling::Owen, "Owen"),
    ];
    for (sequence, name, scrambling, scrambled) in cases {
        for index in [1, 98] {
            let settings = [
                &format!("sequence={name}"),
                &format!("scrambling={scrambled}"),
                "filter=box",
                "seed=7",
                "show=ray direction",
            ];
            let directions = chapter(SMALL).frames(index + 1).sets(&settings).picture();
            for (i, offset) in offsets(&directions).into_iter().enumerate() {
                let pixel = [i as u32 % directions.width, i as u32 / directions.width];
                let point = sample_point(sequence, scrambling, pixel, 7, index);
                // A direction of 24 bits determines the place in a picture of 64 columns to 2^-16 of a
                // column.
                let most = [0, 1].map(|axis| (offset[axis] + 0.5 - point[axis]).abs());
                let near = most.iter().all(|&error| error < 0.5f64.powi(16));
                assert!(near, "{name} {scrambled} {index} at {pixel:?}: {offset:?} {point:?}");
            }
        }
    }
}

#[test]
fn each_box_of_a_scrambled_net_holds_one_point() {
    for pixel in 0..8 {
        let points = |count: u32| {
            (0..count).map(move |i| {
                sample_point(Sequence::Sobol, Scrambling::Owen, [pixel, 7 * pixel], 0, i)
            })
        };
        for bits in 0..=10 {
            for columns in 0..=bits {
                let (columns, rows) = (1 << columns, 1 << (bits - columns));
                let mut seen = vec![false; 1 << bits];
                for [x, y] in points(1 << bits) {
                    let (column, row) = (x * f64::from(columns), y * f64::from(rows));
                    let cell = row as usize * columns as usize + column as usize;
                    assert!(!seen[cell], "pixel {pixel}: two points in a box of {columns}×{rows}");
                    seen[cell] = true;
                }
            }
        }
    }
}

#[test]
fn in_floats_the_multiples_of_r2_run_out_of_digits() {
    let mut places: Vec<u32> =
        (100_000..101_024).map(|i| (i as f32 * 0.754_877_7).fract().to_bits()).collect();
    places.sort_unstable();
    places.dedup();
    println!("{} places of 1024 in floats", places.len());
    assert!(places.len() <= 128);
    let whole = |i: u32| i.wrapping_mul(3_242_174_889);
    let error = |i: u32| (f64::from(whole(i)) * 0.5f64.powi(32) - points::r2(i)[0]).abs();
    // The step is rounded to 2^-33, a hundred thousand times.
    assert!((100_000..101_024).all(|i| error(i) < 101_024.0 * 0.5f64.powi(33)));
}

#[test]
fn the_first_points_are_those_in_print() {
    let first =
        |sequence| (0..8).map(move |i| sample_point(sequence, Scrambling::None, [0, 0], 0, i));
    let third = 1.0 / 3.0;
    let ninth = third * third;
    let halton = [
        [0.0, 0.0],
        [0.5, third],
        [0.25, 2.0 * third],
        [0.75, ninth],
        [0.125, 4.0 * ninth],
        [0.625, 7.0 * ninth],
        [0.375, 2.0 * ninth],
        [0.875, 5.0 * ninth],
    ];
    let sobol = [
        [0.0, 0.0],
        [0.5, 0.5],
        [0.25, 0.75],
        [0.75, 0.25],
        [0.125, 0.625],
        [0.625, 0.125],
        [0.375, 0.375],
        [0.875, 0.875],
    ];
    for (sequence, expected) in [(Sequence::Halton, halton), (Sequence::Sobol, sobol)] {
        for (point, expected) in first(sequence).zip(expected) {
            let near = [0, 1].iter().all(|&axis| (point[axis] - expected[axis]).abs() < 1e-15);
            assert!(near, "{sequence:?}: {point:?}, not {expected:?}");
        }
    }
}

#[test]
fn neighbours_have_their_points_in_common_only_without_scrambling() {
    let points = |sequence: &str, scrambling: &str| {
        let [sequence, scrambling] =
            [format!("sequence={sequence}"), format!("scrambling={scrambling}")];
        offsets(
            &chapter(SIZE)
                .frames(6)
                .sets(&[&sequence, &scrambling])
                .sets(&["filter=box", "show=ray direction"])
                .picture(),
        )
    };
    // The directions determine an offset to 2^-14 of a pixel.
    let shared = points("Sobol", "none");
    let most =
        |axis: usize| shared.iter().map(|p| (p[axis] - shared[0][axis]).abs()).fold(0.0, f64::max);
    assert!(most(0).max(most(1)) < 0.5f64.powi(13), "{} {}", most(0), most(1));

    for (sequence, scrambling) in [("random", "Owen"), ("R2", "rotation"), ("Sobol", "Owen")] {
        let points = points(sequence, scrambling);
        let correlation = |axis: usize, (column, row): (usize, usize)| {
            // The variance of a uniform number over a pixel is 1/12.
            let pairs = points.iter().zip(&points[row * 240 + column..]);
            let count = pairs.len() as f64;
            pairs.map(|(a, b)| 12.0 * a[axis] * b[axis]).sum::<f64>() / count
        };
        let near = [(1, 0), (0, 1), (1, 1), (2, 0), (0, 2)];
        let all = near.iter().flat_map(|&place| [0, 1].map(|axis| correlation(axis, place).abs()));
        let most = all.fold(0.0, f64::max);
        println!("{sequence}: neighbours correlate by {most:.3} at most");
        assert!(most < 4.0 / (points.len() as f64).sqrt(), "{sequence}: {most}");
    }
}

/// The page's statement about a key that is not reversed: its low bits, which are related, are used first.
#[test]
fn keys_that_are_not_reversed_relate_the_first_points_of_neighbours() {
    let naive = |key: u32| f64::from(points::owen(0, key.reverse_bits())) * 0.5f64.powi(32) - 0.5;
    let at = |x: u32, y: u32, axis: usize| naive(points::hash([x, y, 0, 1])[axis]);
    let correlation = |axis: usize, (dx, dy): (u32, u32)| {
        let places = (0..150).flat_map(|y| (0..240).map(move |x| (x, y)));
        let products = places.map(|(x, y)| 12.0 * at(x, y, axis) * at(x + dx, y + dy, axis));
        products.sum::<f64>() / (240.0 * 150.0)
    };
    let near = [(1, 0), (0, 1), (1, 1), (2, 0), (0, 2)];
    let all = near.iter().flat_map(|&place| [0, 1].map(|axis| correlation(axis, place).abs()));
    let most = all.fold(0.0, f64::max);
    println!("{most:.2}");
    expected::hold_exact("37_sequences/neighbours", json!({ "correlation": most }));
}
