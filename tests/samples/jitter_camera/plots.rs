//! Plots for the page of 04_jitter_camera. Drawn on request: `cargo test --test samples
//! jitter_camera::plots -- --ignored --nocapture`.

use serde_json::Map;

use super::{chapter, error, offsets, part_below};
use run::plot::{Axis, Chart, Series, Shown, draw, draw_panels};
use run::{expected, render};

const FILTERS: [&str; 3] = ["box", "tent", "Blackman-Harris"];

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
        let offsets = offsets(
            &chapter("480x300")
                .frames(1)
                .set("filter", title)
                .sets(&["show=ray direction"])
                .picture(),
        );
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
    draw("04_filters.svg", (320, 250), &FILTERS.map(chart));
}

#[test]
#[ignore = "by hand: draws docs/images/04_samples.png"]
fn samples() {
    const SIZE: &str = "960x600";
    let centre =
        ("through the centre".to_owned(), chapter(SIZE).frames(1).sets(&["jitter=off"]).picture());
    let means = [1, 4, 16, 64].map(|frames| {
        let label =
            if frames == 1 { "1 jittered ray".to_owned() } else { format!("{frames} rays") };
        (label, chapter(SIZE).frames(frames).picture())
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
#[ignore = "by hand: measures what a sample buys; takes minutes"]
fn errors() {
    const SIZE: &str = "192x120";
    const FRAMES: [u32; 5] = [1, 4, 16, 64, 256];
    println!("| filter | 1 | 4 | 16 | 64 | 256 | power of $N$ |\n|---|---|---|---|---|---|---|");
    let mut held = Map::new();
    for filter in FILTERS {
        let set = format!("filter={filter}");
        // The same mean, from points that converge faster.
        let reference = ["--frames", "2048", "--set", &set];
        let reference = render("37_sequences", SIZE, &reference).picture;
        let errors = FRAMES
            .map(|frames| error(&chapter(SIZE).frames(frames).sets(&[&set]).picture(), &reference));
        let slope = (errors[4] / errors[1]).log2() / 6.0;
        held.extend(
            FRAMES.iter().zip(errors).map(|(n, error)| (format!("{filter}.{n}"), error.into())),
        );
        held.insert(format!("{filter}.slope"), slope.into());
        println!("| {filter} | {} | {slope:.2} |", errors.map(|e| format!("{e:.4}")).join(" | "));
    }
    expected::hold("04_jitter_camera/errors", held.into());
}
