//! Equal time: history and filter against plain samples that take as long.
//! `cargo test --test samples history_and_filter::plots -- --ignored --nocapture`.

use run::expected;
use run::plot::{Axis, Chart, Series, draw};
use serde_json::{Map, json};

use super::{PLAIN, chapter, error, reference};

const FRAMES: [u32; 5] = [1, 2, 4, 8, 16];
const SAMPLES: u32 = 256;

/// The time of a frame with history and filter, relative to a plain one.
fn price() -> f64 {
    let time = |sets: &[&str]| {
        let run = chapter().sets(sets).frames(25).run();
        run.report["gpu_milliseconds"]["median"].as_f64().expect("a time")
    };
    time(&[]) / time(&PLAIN)
}

#[test]
#[ignore = "by hand: draws docs/images/31_equal_time.svg, from times"]
fn equal_time() {
    let price = price();
    println!("a frame with history and filter takes {price:.2} times as long as a plain one");
    let mut held = Map::from_iter([("price".to_owned(), json!(price))]);
    let ticks: Vec<f64> = FRAMES.into_iter().map(f64::from).collect();
    let charts = ["still", "all"].map(|motion| {
        let moving = || chapter().set("motion", motion);
        let mut both = Vec::new();
        let mut plain = Vec::new();
        for frames in FRAMES {
            // With another seed, so that the errors are independent.
            let truth = reference(moving().set("seed", 1), frames - 1, SAMPLES);
            // A moving picture has the time of a frame, a still one that of all frames.
            let passed = if motion == "still" { f64::from(frames) } else { 1.0 };
            let samples = (price * passed).round() as u32;
            let settled = moving().set("memory", 255).frames(frames).picture();
            let sampled = reference(moving(), frames - 1, samples);
            let errors = [&settled, &sampled].map(|picture| error(picture, &truth));
            println!(
                "{motion}, {frames} frames: {:.4}, {samples} samples: {:.4}",
                errors[0], errors[1]
            );
            both.push([f64::from(frames), errors[0]]);
            plain.push([f64::from(frames), errors[1]]);
            held.insert(format!("{motion}.{frames}.both"), json!(errors[0]));
            held.insert(format!("{motion}.{frames}.plain"), json!(errors[1]));
        }
        (motion, both, plain)
    });
    expected::give_timed("31_history_and_filter/equal_time", held.into());
    let errors = [0.02, 0.05, 0.1, 0.2, 0.5];
    let charts = charts.map(|(motion, both, plain)| {
        let series =
            |name, points| Series { name, points, line: true, dots: true, ..Series::default() };
        Chart {
            title: if motion == "still" { "nothing moves" } else { "everything moves" },
            x: Axis { label: "frames", ticks: &ticks, logarithmic: true },
            y: Axis { label: "RMSE", ticks: &errors, logarithmic: true },
            series: vec![
                series("plain samples in the same time", plain),
                series("history and filter", both),
            ],
        }
    });
    draw("31_equal_time.svg", (840, 360), &charts);
}
