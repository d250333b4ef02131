//! `--compare` with `--against`, and the plots of error against time that the pages of 11, 27 and 28 show.
//! Drawn on request: `cargo test --test samples error_against_time::draw -- --ignored --nocapture`.

use std::path::PathBuf;

use run::Chapter;
use run::plot::{self, Axis, Chart, Series};
use serde_json::Value;
use tempfile::TempDir;

/// A reference of this many frames, with random numbers of its own.
fn reference(chapter: Chapter, frames: u32) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("reference.exr");
    chapter.set("seed", 1).frames(frames).picture().save(&file).expect("the reference is written");
    (folder, file)
}

/// Compares values of a control, and returns them as the report has them.
fn compared(
    chapter: Chapter,
    control: &str,
    values: &[&str],
    frames: u32,
    file: &str,
) -> Vec<Value> {
    let list = format!("{control}={}", values.join("|"));
    let arguments = ["--compare", &list, "--against", file];
    let report = chapter.with(&arguments).frames(frames).run().report;
    let values = report["comparison"]["values"].as_array().expect("values");
    values.clone()
}

#[test]
fn errors_are_those_of_the_same_frames_alone() {
    let chapter = || Chapter::new("11_path_tracing").size("24x15").set("depth", 2);
    let (_folder, file) = reference(chapter(), 32);
    let path = file.to_str().expect("a path of plain letters");
    // A value that was rendered before starts from nothing again.
    let values = compared(chapter(), "clamp", &["0", "0.2", "0"], 5, path);
    let truth = common::app::Picture::open_exr(&file).expect("the reference");
    for (value, clamp) in values.iter().zip(["0", "0.2", "0"]) {
        let errors = value["errors"].as_array().expect("errors");
        let counts: Vec<_> = errors.iter().filter_map(|error| error["frames"].as_u64()).collect();
        assert!([1, 2, 4, 5].iter().all(|count| counts.contains(count)), "{counts:?}");
        for error in errors {
            let frames = error["frames"].as_u64().expect("a number") as u32;
            let picture = chapter().set("clamp", clamp).frames(frames).picture();
            let channels =
                picture.pixels.iter().zip(&truth.pixels).flat_map(|(shown, expected)| {
                    [0, 1, 2].map(|i| (f64::from(shown[i]) - f64::from(expected[i])).powi(2))
                });
            let squares: Vec<f64> = channels.collect();
            let rmse = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
            let told = error["rmse"].as_f64().expect("a number");
            assert!((told - rmse).abs() < 1e-12 * rmse, "clamp={clamp}, {frames}: {told}, {rmse}");
        }
    }
    let last = |value: &Value| value["errors"].as_array().and_then(|all| all.last().cloned());
    assert_eq!(last(&values[0]), last(&values[2]));
    assert_ne!(last(&values[0]), last(&values[1]), "the clamp changes nothing");
}

/// A plot of one page.
struct Plot {
    chapter: &'static str,
    size: &'static str,
    sets: &'static [&'static str],
    control: &'static str,
    values: &'static [&'static str],
    frames: u32,
    /// Frames of the reference, which has the chapter's own settings.
    reference: u32,
    errors: &'static [f64],
}

const PLOTS: [Plot; 3] = [
    Plot {
        chapter: "11_path_tracing",
        size: "96x60",
        sets: &[],
        control: "roulette",
        values: &["off", "on"],
        frames: 256,
        reference: 2048,
        errors: &[0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5],
    },
    Plot {
        chapter: "27_glass",
        size: "96x60",
        sets: &[],
        control: "clamp",
        values: &["0", "10", "2"],
        frames: 256,
        reference: 4096,
        errors: &[0.05, 0.1, 0.2, 0.5, 1.0, 2.0],
    },
    Plot {
        chapter: "28_depth_of_field",
        size: "96x60",
        sets: &[],
        control: "sequence",
        values: &["random", "Sobol"],
        frames: 256,
        reference: 4096,
        errors: &[0.02, 0.05, 0.1, 0.2, 0.5, 1.0],
    },
];

#[test]
#[ignore = "by hand: draws docs/images/NN_time.svg of three chapters, from times"]
fn draw() {
    for plot in &PLOTS {
        let Plot { chapter, control, values, frames, .. } = *plot;
        let plain = || Chapter::new(chapter).size(plot.size).sets(plot.sets);
        let (_folder, file) = reference(plain(), plot.reference);
        let path = file.to_str().expect("a path of plain letters");
        let measured = compared(plain(), control, values, frames, path);
        let names: Vec<_> = values.iter().map(|value| format!("{control}={value}")).collect();
        let series = measured.iter().zip(&names).map(|(value, name)| {
            let ratio = value["ratio"]["median"].as_f64().expect("a ratio");
            let errors = value["errors"].as_array().expect("errors");
            let point = |error: &Value| {
                let [frames, rmse] = ["frames", "rmse"].map(|it| error[it].as_f64());
                [ratio * frames.expect("a number"), rmse.expect("a number")]
            };
            let points: Vec<_> = errors.iter().map(point).collect();
            println!("{chapter} {name}: {ratio:.2}, {points:.4?}");
            Series { name, points, line: true, dots: true, ..Series::default() }
        });
        let label = format!("time, in frames with {}", names[0]);
        let ticks = [0.5, 1.0, 4.0, 16.0, 64.0, 256.0, 512.0];
        let chart = Chart {
            title: "",
            x: Axis { label: &label, ticks: &ticks, logarithmic: true },
            y: Axis { label: "RMSE", ticks: plot.errors, logarithmic: true },
            series: series.collect(),
        };
        let number = &chapter[..2];
        plot::draw(&format!("{number}_time.svg"), (560, 360), &[chart]);
    }
}
