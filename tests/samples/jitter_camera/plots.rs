//! What the page of 04_jitter_camera shows beside its picture. Drawn when asked for:
//! `cargo test --test samples jitter_camera::plots -- --ignored --nocapture`.

use common::app::Picture;
use serde_json::Map;

use super::converging::shrunk;
use super::points::{Scrambling, Sequence, sample_point};
use super::{NAME, error, offsets, part_below, run};
use run::plot::{Axis, Chart, Series, Shown, draw, draw_panels};
use run::{figures, render};

/// The sequences, each with the scrambling that suits it.
const SEQUENCES: [(&str, &str, Sequence, Scrambling); 4] = [
    ("random", "Owen", Sequence::Random, Scrambling::Owen),
    ("Halton", "rotation", Sequence::Halton, Scrambling::Rotation),
    ("R2", "rotation", Sequence::R2, Scrambling::Rotation),
    ("Sobol", "Owen", Sequence::Sobol, Scrambling::Owen),
];

fn settings(sequence: &str, scrambling: &str) -> [String; 2] {
    [format!("sequence={sequence}"), format!("scrambling={scrambling}")]
}

fn picture(size: &str, frames: u32, settings: &[String]) -> Picture {
    run(size, frames, &settings.iter().map(String::as_str).collect::<Vec<_>>())
}

#[test]
#[ignore = "by hand: draws docs/images/04_points.svg"]
fn points() {
    let axis = Axis { label: "", ticks: &[0.0, 0.25, 0.5, 0.75, 1.0], logarithmic: false };
    let chart = |&(title, _, sequence, scrambling): &(&'static str, _, _, _)| {
        let points =
            (0..64).map(|i| sample_point(sequence, scrambling, [480, 300], 0, i)).collect();
        let series = Series { points, dots: true, ..Default::default() };
        Chart { title, x: axis, y: axis, series: vec![series] }
    };
    draw("04_points.svg", (250, 270), &SEQUENCES.each_ref().map(chart));
}

#[test]
#[ignore = "by hand: draws docs/images/04_filters.svg"]
fn filters() {
    let x = Axis {
        label: "pixels",
        ticks: &[-1.5, -1.0, -0.5, 0.0, 0.5, 1.0, 1.5],
        logarithmic: false,
    };
    let y = Axis { label: "", ticks: &[0.0, 0.5, 1.0, 1.5, 2.0], logarithmic: false };
    let chart = |title: &'static str| {
        let offsets =
            offsets(&run("480x300", 1, &[&format!("filter={title}"), "show=ray direction"]));
        let step = 0.05;
        let middles: Vec<f64> = (-30..30).map(|i| (f64::from(i) + 0.5) * step).collect();
        let drawn = |&middle: &f64| {
            let inside = |offset: &&[f64; 2]| (offset[0] - middle).abs() < step / 2.0;
            [middle, offsets.iter().filter(inside).count() as f64 / offsets.len() as f64 / step]
        };
        let exact = |middle: &f64| {
            let part =
                part_below(title, middle + step / 2.0) - part_below(title, middle - step / 2.0);
            [*middle, part / step]
        };
        let filter = Series {
            name: "the filter",
            points: middles.iter().map(exact).collect(),
            line: true,
            ..Default::default()
        };
        let drawn = Series {
            name: "drawn",
            points: middles.iter().map(drawn).collect(),
            dots: true,
            ..Default::default()
        };
        Chart { title, x, y, series: vec![filter, drawn] }
    };
    draw("04_filters.svg", (320, 250), &["box", "tent", "Blackman-Harris"].map(chart));
}

#[test]
#[ignore = "by hand: draws docs/images/04_samples.png"]
fn samples() {
    const SIZE: &str = "960x600";
    let centre = ("through the centre".to_owned(), run(SIZE, 1, &["sequence=centre"]));
    let means = [1, 4, 16, 64].map(|frames| {
        let label =
            if frames == 1 { "1 jittered ray".to_owned() } else { format!("{frames} rays") };
        (label, run(SIZE, frames, &[]))
    });
    let rows = [[670, 223, 63, 63], [340, 108, 63, 63]].map(|area| {
        let shown = |(label, picture)| Shown { label: String::clone(label), picture, area };
        [&centre]
            .into_iter()
            .chain(&means)
            .map(|(label, picture)| shown((label, picture)))
            .collect()
    });
    draw_panels("04_samples.png", 3, &rows);
}

#[test]
#[ignore = "by hand: draws docs/images/04_scrambling.png"]
fn scrambling() {
    const SIZE: &str = "480x300";
    let pictures = ["none", "Owen"]
        .map(|scrambling| run(SIZE, 4, &["filter=box", &format!("scrambling={scrambling}")]));
    let reference = run(SIZE, 1024, &["filter=box", "seed=1"]);
    let labels = ["scrambling none, 4 points", "scrambling Owen, 4 points", "1024 points"];
    let row = labels.iter().zip(pictures.iter().chain([&reference])).map(|(label, picture)| {
        Shown { label: (*label).to_owned(), picture, area: [190, 12, 79, 50] }
    });
    draw_panels("04_scrambling.png", 4, &[row.collect()]);
    println!("| pixels averaged | none | Owen |\n|---|---|---|");
    let mut blocks = Map::new();
    for side in [1, 2, 4, 8, 16] {
        let error = |picture| error(&shrunk(picture, side), &shrunk(&reference, side));
        let [none, owen] = [&pictures[0], &pictures[1]].map(error);
        println!("| {side}×{side} | {none:.5} | {owen:.5} |");
        blocks.insert(format!("{side}.none"), none.into());
        blocks.insert(format!("{side}.Owen"), owen.into());
    }
    figures::hold("04_jitter_camera/blocks", blocks.into());
}

#[test]
#[ignore = "by hand: draws docs/images/04_error.svg; takes minutes"]
fn errors() {
    const SIZE: &str = "192x120";
    const FRAMES: [u32; 10] = [1, 2, 4, 8, 16, 32, 64, 128, 256, 512];
    let reference = run(SIZE, 4096, &["seed=1"]);
    let times = milliseconds(SIZE);
    let curves = SEQUENCES.map(|(sequence, scrambling, ..)| {
        let of =
            |frames| error(&picture(SIZE, frames, &settings(sequence, scrambling)), &reference);
        FRAMES.map(|frames| (frames, of(frames)))
    });
    println!(
        "| sequence | ms a frame | 1 | 4 | 16 | 64 | 256 | power of $N$ |\n|---|---|---|---|---|---|---|---|"
    );
    let (mut held, mut spans) = (Map::new(), Map::new());
    for (((sequence, ..), time), curve) in SEQUENCES.iter().zip(&times).zip(&curves) {
        let shown = [0, 2, 4, 6, 8].map(|i| format!("{:.4}", curve[i].1)).join(" | ");
        // From 4 samples on: the first ones are too few for a pattern.
        let slope = (curve[9].1 / curve[2].1).log2() / 7.0;
        held.extend(
            [0, 2, 4, 6, 8].map(|i| (format!("{sequence}.{}", curve[i].0), curve[i].1.into())),
        );
        held.insert(format!("{sequence}.slope"), slope.into());
        spans.insert((*sequence).to_owned(), (*time).into());
        println!("| {sequence} | {time:.2} | {shown} | {slope:.2} |");
    }
    figures::hold("04_jitter_camera/errors", held.into());
    figures::give_timed("04_jitter_camera/milliseconds", spans.into());
    let y = Axis {
        label: "root mean squared error",
        ticks: &[0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1],
        logarithmic: true,
    };
    let samples =
        Axis { label: "samples a pixel", ticks: &FRAMES.map(f64::from), logarithmic: true };
    let ends = [0, 9].map(|end| times.map(|time| time * f64::from(FRAMES[end])));
    let ticks = ticks_around(
        ends[0].into_iter().fold(f64::INFINITY, f64::min),
        ends[1].into_iter().fold(0.0, f64::max),
    );
    let spent = Axis { label: "milliseconds on the device", ticks: &ticks, logarithmic: true };
    let chart = |title, x, cost: &dyn Fn(usize, u32) -> f64| {
        let series = (0..4).map(|i| Series {
            name: SEQUENCES[i].0,
            points: curves[i].iter().map(|&(frames, error)| [cost(i, frames), error]).collect(),
            line: true,
            dots: true,
            ..Default::default()
        });
        Chart { title, x, y, series: series.collect() }
    };
    let charts = [
        chart("what a sample buys", samples, &|_, frames| f64::from(frames)),
        chart("what a millisecond buys", spent, &|i, frames| times[i] * f64::from(frames)),
    ];
    draw("04_error.svg", (520, 400), &charts);
}

/// The numbers 1, 2, 5, 10, 20, … from the last that is not above `low` to the first not below `high`.
fn ticks_around(low: f64, high: f64) -> Vec<f64> {
    let all: Vec<f64> =
        (-3..9).flat_map(|power| [1.0, 2.0, 5.0].map(|digit| digit * 10f64.powi(power))).collect();
    let first = all.iter().rposition(|&tick| tick <= low).expect("above a microsecond");
    let last = all.iter().position(|&tick| tick >= high).expect("below a month");
    all[first..=last].to_vec()
}

/// The device's median time for a frame of each sequence, measured in turns within one run.
fn milliseconds(size: &str) -> [f64; 4] {
    let compare = format!("sequence={}", SEQUENCES.map(|(name, ..)| name).join("|"));
    let report = render(NAME, size, &["--compare", &compare, "--frames", "60"]).report;
    let values = &report["comparison"]["values"];
    std::array::from_fn(|i| values[i]["milliseconds"].as_f64().expect("a time"))
}
