//! Plots for the page of 37_sequences. Drawn on request: `cargo test --test samples
//! sequences::plots -- --ignored --nocapture`.

use serde_json::Map;

use super::converging::shrunk;
use super::points::{Scrambling, Sequence, sample_point};
use super::{chapter, error};
use run::expected;
use run::plot::{Axis, Chart, Series, Shown, draw, draw_panels};

/// The sequences, each with the scrambling that suits it.
const SEQUENCES: [(&str, &str, Sequence, Scrambling); 4] = [
    ("random", "Owen", Sequence::Random, Scrambling::Owen),
    ("Halton", "rotation", Sequence::Halton, Scrambling::Rotation),
    ("R2", "rotation", Sequence::R2, Scrambling::Rotation),
    ("Sobol", "Owen", Sequence::Sobol, Scrambling::Owen),
];

#[test]
#[ignore = "by hand: draws docs/images/37_points.svg"]
fn points() {
    let axis = Axis { label: "", ticks: &[0.0, 0.25, 0.5, 0.75, 1.0], logarithmic: false };
    let chart = |&(title, _, sequence, scrambling): &(&'static str, _, _, _)| {
        let points =
            (0..64).map(|i| sample_point(sequence, scrambling, [480, 300], 0, i)).collect();
        let series = Series { points, dots: true, ..Default::default() };
        Chart { title, x: axis, y: axis, series: vec![series] }
    };
    draw("37_points.svg", (250, 270), &SEQUENCES.each_ref().map(chart));
}

#[test]
#[ignore = "by hand: draws docs/images/37_samples.png"]
fn samples() {
    let pictures =
        [(4, "random"), (4, "Sobol"), (16, "random"), (16, "Sobol")].map(|(frames, sequence)| {
            let picture = chapter("960x600")
                .frames(frames)
                .set("sequence", sequence)
                .sets(&["filter=box"])
                .picture();
            (format!("{frames} points: {sequence}"), picture)
        });
    let rows = [[671, 223, 60, 60], [341, 108, 60, 60]].map(|area| {
        let shown = |(label, picture)| Shown { label: String::clone(label), picture, area };
        pictures.iter().map(|(label, picture)| shown((label, picture))).collect()
    });
    draw_panels("37_samples.png", 4, &rows);
}

#[test]
#[ignore = "by hand: draws docs/images/37_scrambling.png"]
fn scrambling() {
    const SIZE: &str = "480x300";
    let pictures = ["none", "Owen"].map(|scrambling| {
        chapter(SIZE).frames(4).sets(&["filter=box"]).set("scrambling", scrambling).picture()
    });
    let reference = chapter(SIZE).frames(1024).sets(&["filter=box", "seed=1"]).picture();
    let labels = ["scrambling none, 4 points", "scrambling Owen, 4 points", "1024 points"];
    let row = labels.iter().zip(pictures.iter().chain([&reference])).map(|(label, picture)| {
        Shown { label: (*label).to_owned(), picture, area: [190, 12, 79, 50] }
    });
    draw_panels("37_scrambling.png", 4, &[row.collect()]);
    println!("| pixels averaged | none | Owen |\n|---|---|---|");
    let mut blocks = Map::new();
    for side in [1, 2, 4, 8, 16] {
        let error = |picture| error(&shrunk(picture, side), &shrunk(&reference, side));
        let [none, owen] = [&pictures[0], &pictures[1]].map(error);
        println!("| {side}×{side} | {none:.5} | {owen:.5} |");
        blocks.insert(format!("{side}.none"), none.into());
        blocks.insert(format!("{side}.Owen"), owen.into());
    }
    expected::hold("37_sequences/blocks", blocks.into());
}

#[test]
#[ignore = "by hand: draws docs/images/37_error.svg; takes minutes"]
fn errors() {
    const SIZE: &str = "192x120";
    const FRAMES: [u32; 10] = [1, 2, 4, 8, 16, 32, 64, 128, 256, 512];
    let reference = chapter(SIZE).frames(4096).sets(&["seed=1"]).picture();
    let curves = SEQUENCES.map(|(sequence, scrambling, ..)| {
        let sets = [format!("sequence={sequence}"), format!("scrambling={scrambling}")];
        let sets = sets.each_ref().map(String::as_str);
        FRAMES.map(|frames| error(&chapter(SIZE).frames(frames).sets(&sets).picture(), &reference))
    });
    println!("| sequence | 1 | 4 | 16 | 64 | 256 | power of $N$ |\n|---|---|---|---|---|---|---|");
    let mut held = Map::new();
    for ((sequence, ..), curve) in SEQUENCES.iter().zip(&curves) {
        let shown = [0, 2, 4, 6, 8];
        // From 4 samples on: fewer are not yet a pattern.
        let slope = (curve[9] / curve[2]).log2() / 7.0;
        held.extend(shown.map(|i| (format!("{sequence}.{}", FRAMES[i]), curve[i].into())));
        held.insert(format!("{sequence}.slope"), slope.into());
        println!(
            "| {sequence} | {} | {slope:.2} |",
            shown.map(|i| format!("{:.4}", curve[i])).join(" | ")
        );
    }
    expected::hold("37_sequences/errors", held.into());
    let x = Axis { label: "samples per pixel", ticks: &FRAMES.map(f64::from), logarithmic: true };
    let y = Axis {
        label: "root mean squared error",
        ticks: &[0.0005, 0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1],
        logarithmic: true,
    };
    let series = SEQUENCES.iter().zip(&curves).map(|((name, ..), curve)| Series {
        name,
        points: FRAMES.iter().zip(curve).map(|(&frames, &error)| [frames.into(), error]).collect(),
        line: true,
        dots: true,
        ..Default::default()
    });
    draw("37_error.svg", (640, 420), &[Chart { title: "", x, y, series: series.collect() }]);
}
