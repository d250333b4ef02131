//! The error of a picture in motion when one part is left out, and the bias of the filter.

use common::app::Picture;
use run::{Chapter, expected};
use serde_json::{Map, json};

use super::{NAME, PLAIN, colors, error, mean, reference};

const SIZE: &str = "96x64";
const FRAME: u32 = 39;
const SAMPLES: u32 = 1024;

/// A part, and the settings without it.
const PARTS: [(&str, &[&str]); 9] = [
    ("nothing", &[]),
    ("the-plane-test", &["plane test=off"]),
    ("the-normal-test", &["normal test=off"]),
    ("the-instance-test", &["instance test=off"]),
    ("all-three-tests", &["plane test=off", "normal test=off", "instance test=off"]),
    ("the-division", &["divide colour=off"]),
    ("the-filter", &["filter passes=0"]),
    ("the-history", &["history=off"]),
    ("both", &PLAIN),
];

fn chapter() -> Chapter {
    Chapter::new(NAME).size(SIZE)
}

fn flip(a: &Picture, b: &Picture) -> f64 {
    run::flip(b, a).0.into()
}

#[test]
#[ignore = "by hand: its reference has 1,024 samples per pixel"]
fn errors_without_each_part() {
    let truth = reference(chapter(), FRAME, SAMPLES);
    let mut held = Map::new();
    for (name, sets) in PARTS {
        let picture = chapter().sets(sets).frames(FRAME + 1).picture();
        let (error, flip) = (error(&picture, &truth), flip(&picture, &truth));
        println!("without {name}: RMSE {error:.4}, FLIP {flip:.4}");
        held.insert(format!("{name}.error"), json!(error));
        held.insert(format!("{name}.flip"), json!(flip));
    }
    expected::hold("31_history_and_filter/parts", held.into());
}

/// The bias of the filter is what the mean of many filtered pictures is off by.
#[test]
#[ignore = "by hand: 32 pictures, and a reference of 1,024 samples per pixel"]
fn the_bias_of_the_filter() {
    let still = || chapter().set("motion", "still");
    let truth: Vec<f64> = colors(&reference(still(), 0, SAMPLES)).collect();
    let mut held = Map::new();
    for (name, sets, frames) in [("one", "history=off", 1), ("sixteen", "memory=255", 16)] {
        let count = 32;
        let mut sums = vec![[0.0; 2]; truth.len()];
        for seed in 0..count {
            // With seeds other than the reference's.
            let picture = still().set("seed", 1 + seed).sets(&[sets]).frames(frames).picture();
            for (sum, color) in sums.iter_mut().zip(colors(&picture)) {
                *sum = [sum[0] + color, sum[1] + color * color];
            }
        }
        let count = f64::from(count);
        let square = mean(sums.iter().zip(&truth).map(|([sum, squares], truth)| {
            let middle = sum / count;
            let variance = (squares / count - middle * middle) / (count - 1.0);
            (middle - truth).powi(2) - variance
        }));
        let (bias, whole) = (square.max(0.0).sqrt(), mean(truth.iter().copied()));
        let shift = mean(sums.iter().map(|[sum, _]| sum / count)) - whole;
        println!("{name}: bias {bias:.4} of {whole:.4}; the mean is off by {shift:.5}");
        held.insert(format!("{name}.bias"), json!(bias / whole));
        held.insert(format!("{name}.shift"), json!((shift / whole).abs()));
    }
    expected::hold("31_history_and_filter/bias", held.into());
}
