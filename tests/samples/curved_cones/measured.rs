//! The difference of each way to carry a cone from the mean of 1,024 rays per pixel, in a mirror, in a
//! concave one and in glass; its flicker, and its cost.

use common::app::Picture;
use serde_json::{Map, Value};

use super::{FOOTPRINTS, NAME};
use run::{Chapter, expected, render};

/// The instances, with the floor at 0.
const SURFACES: [(&str, f32); 3] = [("mirror", 1.0), ("hollow", 2.0), ("glass", 3.0)];
const VIEW: &str = "144x90";
/// The camera's motion in pixels from frame to frame, as in 19.
const STEP: f64 = 0.3;
const FRAMES: usize = 4;
/// 32 by 32 rays per pixel, each in its own part of it.
const TRUTH: [&str; 2] = ["footprint=point", "rays=32"];

/// The chapter's own view, moved sideways by this many pixels, measured at the balls.
fn view(slid: f64) -> [String; 2] {
    let pixel = 2.0 * 18f64.to_radians().tan() / 90.0 * 8.5;
    let aside = slid * pixel;
    [format!("camera eye={},2.3,8.6", 0.3 + aside), format!("camera target={},0.45,0", aside - 0.1)]
}

fn seen(slid: f64, sets: &[&str]) -> Picture {
    let from = view(slid);
    let from = from.iter().map(String::as_str);
    Chapter::new(NAME)
        .size(VIEW)
        .sets(&from.chain(sets.iter().copied()).collect::<Vec<_>>())
        .picture()
}

/// The pixels that, with their four neighbours, show the same surface in all frames.
fn pixels(surface: f32, frames: &[Picture]) -> Vec<usize> {
    let shows = |i: usize| frames.iter().all(|frame| frame.pixels[i][0] == surface);
    let (width, height) = (144, 90);
    let all = (1..height - 1).flat_map(|y| (1..width - 1).map(move |x| y * width + x));
    all.filter(|&i| [i, i - 1, i + 1, i - width, i + width].into_iter().all(shows)).collect()
}

/// The frames of a move, showing texture colours.
fn frames(count: usize, sets: &[&str]) -> Vec<Picture> {
    let sets: Vec<&str> = sets.iter().copied().chain(["show=color"]).collect();
    (0..count).map(|i| seen(STEP * i as f64, &sets)).collect()
}

fn colors(frame: &Picture, pixels: &[usize]) -> Vec<f64> {
    pixels.iter().flat_map(|&i| frame.pixels[i][..3].iter().map(|&x| f64::from(x))).collect()
}

/// The root of the mean squared difference, over pixels and colours.
fn error(a: &[f64], b: &[f64]) -> f64 {
    let squares = a.iter().zip(b).map(|(a, b)| (a - b).powi(2));
    (squares.sum::<f64>() / a.len() as f64).sqrt()
}

/// The error, and the flicker: the change from frame to frame in excess of the truth's.
fn judged(found: &[Picture], truth: &[Picture], pixels: &[usize]) -> [f64; 2] {
    let [found, truth] = [found, truth]
        .map(|frames| frames.iter().map(|frame| colors(frame, pixels)).collect::<Vec<_>>());
    let changes = |frames: &[Vec<f64>]| -> Vec<f64> {
        let pairs = frames.windows(2);
        pairs.flat_map(|pair| pair[0].iter().zip(&pair[1]).map(|(a, b)| b - a)).collect()
    };
    [error(&found.concat(), &truth.concat()), error(&changes(&found), &changes(&truth))]
}

/// For each surface its pixels, and the error and flicker of each footprint. Curvature must reduce both.
fn tables(count: usize, truth: &[&str]) -> Vec<(&'static str, usize, [[f64; 2]; 4])> {
    let truth = frames(count, truth);
    let found = FOOTPRINTS.map(|footprint| frames(count, &[&format!("footprint={footprint}")]));
    let hits: Vec<Picture> = (0..count).map(|i| seen(STEP * i as f64, &["show=hit"])).collect();
    let table = SURFACES.map(|(name, surface)| {
        let pixels = pixels(surface, &hits);
        let judged = found.each_ref().map(|frames| judged(frames, &truth, &pixels));
        println!("{name}, {} pixels: {judged:.4?}", pixels.len());
        let [_, flat, curved, differentials] = judged;
        for i in 0..2 {
            assert!(curved[i] < flat[i] && differentials[i] < flat[i], "{name}: {judged:?}");
        }
        (name, pixels.len(), judged)
    });
    table.into()
}

#[test]
fn curvature_brings_the_picture_nearer_and_calms_it() {
    tables(2, &["footprint=point", "rays=4"]);
}

#[test]
#[ignore = "nightly: 1,024 rays per pixel; quick: curved_cones::measured::curvature_brings_the_picture_nearer_and_calms_it"]
fn error_and_flicker_in_each_of_the_three() {
    let (mut errors, mut flicker) = (Map::new(), Map::new());
    for (name, pixels, judged) in tables(FRAMES, &TRUTH) {
        errors.insert(format!("{name}.pixels"), pixels.into());
        for (footprint, [error, change]) in FOOTPRINTS.iter().zip(judged) {
            errors.insert(format!("{name}.{footprint}"), error.into());
            flicker.insert(format!("{name}.{footprint}"), change.into());
        }
    }
    expected::hold("40_curved_cones/errors", Value::Object(errors));
    expected::hold("40_curved_cones/flicker", Value::Object(flicker));
}

/// The time of a frame relative to that with a point.
#[test]
#[ignore = "by hand: takes times"]
fn time_by_footprint() {
    let compare = format!("footprint={}", FOOTPRINTS.join("|"));
    let report = render(NAME, "480x300", &["--frames", "101", "--compare", &compare]).report;
    let mut table = Map::new();
    for (i, footprint) in FOOTPRINTS.iter().enumerate() {
        let ratio = &report["comparison"]["values"][i]["ratio"]["median"];
        table.insert((*footprint).to_owned(), ratio.clone());
    }
    expected::give_timed("40_curved_cones/times", Value::Object(table));
}
