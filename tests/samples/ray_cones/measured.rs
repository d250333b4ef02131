//! The difference of each footprint from the mean of 1,024 rays per pixel, its flicker, and its cost.

use common::app::Picture;
use serde_json::{Map, Value};

use super::{FOOTPRINTS, chapter, seen, view};
use run::expected;

const DISTANCES: [f64; 4] = [5.0, 20.0, 80.0, 320.0];
const ANGLES: [f64; 3] = [90.0, 30.0, 10.0];
/// The camera's motion in pixels from frame to frame.
const STEP: f64 = 0.3;
const FRAMES: usize = 4;
/// 32 by 32 rays per pixel, each in its own part of it, without a footprint: a box filter over the pixel.
const TRUTH: [&str; 2] = ["footprint=point", "rays=32"];

/// The root of the mean squared difference of two lists, over all pixels and colours.
fn error(a: &[f64], b: &[f64]) -> f64 {
    let squares = a.iter().zip(b).map(|(a, b)| (a - b).powi(2));
    (squares.sum::<f64>() / a.len() as f64).sqrt()
}

fn colors(picture: &Picture) -> Vec<f64> {
    picture.pixels.iter().flat_map(|p| [p[0], p[1], p[2]].map(f64::from)).collect()
}

/// Changes from frame to frame.
fn changes(frames: &[Vec<f64>]) -> Vec<f64> {
    let pairs = frames.windows(2);
    pairs.flat_map(|pair| pair[0].iter().zip(&pair[1]).map(|(a, b)| b - a)).collect()
}

/// The first frames of a move.
fn frames(count: usize, distance: f64, angle: f64, sets: &[&str]) -> Vec<Vec<f64>> {
    let at = |frame| colors(&seen(&view(distance, angle, STEP * frame as f64), sets));
    (0..count).map(at).collect()
}

/// The error and the flicker of a footprint.
fn judged(distance: f64, angle: f64, footprint: &str, truth: &[Vec<f64>]) -> [f64; 2] {
    let found = frames(truth.len(), distance, angle, &[&format!("footprint={footprint}")]);
    [error(&found.concat(), &truth.concat()), error(&changes(&found), &changes(truth))]
}

fn place(distance: f64, angle: f64) -> String {
    format!("{distance},-{angle}°")
}

#[test]
fn an_ellipse_is_nearest_and_a_point_flickers() {
    let truth = frames(2, 80.0, 10.0, &["footprint=point", "rays=16"]);
    let found = FOOTPRINTS.map(|footprint| judged(80.0, 10.0, footprint, &truth));
    println!("{found:.4?}");
    let [point, cone, ellipse, differentials] = found;
    assert!(ellipse[0] < cone[0] && cone[0] < point[0], "{found:?}");
    assert!(ellipse[1] < 0.3 * point[1] && differentials[1] < 0.3 * point[1], "{found:?}");
}

#[test]
#[ignore = "nightly: hundreds of pictures; quick: ray_cones::measured::an_ellipse_is_nearest_and_a_point_flickers"]
fn error_and_flicker_by_distance_and_angle() {
    let (mut errors, mut flicker) = (Map::new(), Map::new());
    let mut truth_is_off: f64 = 0.0;
    for distance in DISTANCES {
        for angle in ANGLES {
            let place = place(distance, angle);
            let truth = frames(FRAMES, distance, angle, &TRUTH);
            let again = seen(&view(distance, angle, 0.0), &["footprint=point", "rays=31"]);
            truth_is_off = truth_is_off.max(error(&truth[0], &colors(&again)));
            let found = FOOTPRINTS.map(|footprint| judged(distance, angle, footprint, &truth));
            println!("{place}: {found:.4?}");
            for (footprint, [error, change]) in FOOTPRINTS.iter().zip(found) {
                errors.insert(format!("{place}.{footprint}"), error.into());
                flicker.insert(format!("{place}.{footprint}"), change.into());
            }
        }
    }
    println!("truth: {truth_is_off:.4}");
    errors.insert("truth".into(), truth_is_off.into());
    expected::hold("19_ray_cones/errors", Value::Object(errors));
    expected::hold("19_ray_cones/flicker", Value::Object(flicker));
}

/// The time of a frame relative to that with a point.
#[test]
#[ignore = "by hand: takes times"]
fn time_by_distance_and_angle() {
    let mut table = Map::new();
    let mut sums = [0.0; 4];
    for distance in DISTANCES {
        for angle in ANGLES {
            let from = view(distance, angle, 0.0);
            let compare = format!("footprint={}", FOOTPRINTS.join("|"));
            let compared = chapter("480x300").frames(15).with(&["--compare", &compare]);
            let report = compared.sets(&from).run().report;
            for (i, footprint) in FOOTPRINTS.iter().enumerate() {
                let ratio =
                    report["comparison"]["values"][i]["ratio"]["median"].as_f64().expect("a ratio");
                sums[i] += ratio / (DISTANCES.len() * ANGLES.len()) as f64;
                table.insert(format!("{}.{footprint}", place(distance, angle)), ratio.into());
            }
        }
    }
    for (footprint, mean) in FOOTPRINTS.iter().zip(sums) {
        table.insert(format!("mean.{footprint}"), mean.into());
    }
    expected::give_timed("19_ray_cones/times", Value::Object(table));
}
