//! Plots for the page of 11_path_tracing. Drawn on request: `cargo test --test samples
//! path_tracing::plots -- --ignored --nocapture`.

use common::app::Picture;
use serde_json::Map;

use super::closed_forms::{ROOM_VARIANCE, SQUARES, form_factors};
use super::{Estimate, brightness, chapter, colors, error, picture_by_chance};
use run::expected;
use run::plot::{Axis, Chart, Series, Shown, draw, draw_panels};

#[test]
#[ignore = "by hand: draws docs/images/11_light.png"]
fn light() {
    let shows =
        [("direct", "light straight to what the eye sees"), ("bounced", "light by bounces")];
    let shows = [shows[0], shows[1], ("picture", "both")];
    let show = |(show, label): (&str, &str)| {
        (
            label.to_owned(),
            chapter("320x200").frames(64).set("show", show).sets(&["clamp=8"]).picture(),
        )
    };
    draw_panels("11_light.png", 1, &[Shown::row(&shows.map(show))]);
}

#[test]
#[ignore = "by hand: draws docs/images/11_furnace.png"]
fn furnace() {
    let show = |depth: u32| {
        let label = if depth == 1 { "1 bounce".to_owned() } else { format!("{depth} bounces") };
        let sets = ["scene=furnace", "roulette=off", &format!("depth={depth}")];
        (label, chapter("240x150").frames(16).sets(&sets).picture())
    };
    draw_panels("11_furnace.png", 1, &[Shown::row(&[1, 2, 5, 256].map(show))]);
}

/// A function that renders a picture, and the name of its random numbers.
type Numbers = (&'static str, fn(&str, u32, &[&str]) -> Picture);
const NUMBERS: [Numbers; 2] = [
    ("random", picture_by_chance),
    ("Sobol", |size, frames, sets| chapter(size).frames(frames).sets(sets).picture()),
];
const FRAMES: [u32; 6] = [1, 4, 16, 64, 256, 1024];

/// The error for a scene with known light, for each kind of random numbers and number of samples.
fn curves(scene: &str, expected: &[f64]) -> [[f64; 6]; 2] {
    NUMBERS.map(|(_, picture)| {
        FRAMES.map(|frames| {
            let sets = [&format!("scene={scene}"), "depth=256"];
            let shown = brightness(&picture("32x32", frames, &sets));
            let squares = shown.iter().zip(expected).map(|(shown, value)| (shown - value).powi(2));
            (squares.sum::<f64>() / expected.len() as f64).sqrt()
        })
    })
}

#[test]
#[ignore = "by hand: draws docs/images/11_error.svg"]
fn errors() {
    let mut scenes = vec![("closed room", vec![1.0; 32 * 32], ROOM_VARIANCE)];
    for (name, square) in &SQUARES {
        let factors = form_factors(32, square);
        let variance = factors.iter().map(|p| p * (1.0 - p)).sum::<f64>() / factors.len() as f64;
        scenes.push((name, factors, variance));
    }
    let x = Axis { label: "samples per pixel", ticks: &FRAMES.map(f64::from), logarithmic: true };
    let y = Axis {
        label: "root mean squared error",
        ticks: &[0.0005, 0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0],
        logarithmic: true,
    };
    let mut held = Map::new();
    let charts: Vec<Chart> = scenes
        .iter()
        .map(|(name, expected, variance)| {
            let theory = |frames: u32| (variance / f64::from(frames)).sqrt();
            let line = Series {
                name: "theory, for random numbers",
                points: FRAMES.map(|frames| [f64::from(frames), theory(frames)]).into(),
                line: true,
                ..Default::default()
            };
            let mut series = vec![line];
            held.insert(format!("{name}.theory"), theory(256).into());
            for ((numbers, _), curve) in NUMBERS.iter().zip(curves(name, expected)) {
                println!("{name}, {numbers}: {curve:.5?}");
                held.insert(format!("{name}.{numbers}"), curve[4].into());
                let points = FRAMES.iter().zip(curve).map(|(&n, error)| [f64::from(n), error]);
                let points = points.collect();
                series.push(Series {
                    name: numbers,
                    points,
                    line: true,
                    dots: true,
                    names: vec![],
                });
                if *numbers == "random" {
                    // 1024 pixels determine a deviation to within a twentieth, which is four of its standard
                    // errors.
                    for (frames, error) in FRAMES.iter().zip(curve).skip(1) {
                        let off = (error / theory(*frames) - 1.0).abs();
                        assert!(off < 0.15, "{name}, {frames} samples: {error} {off}");
                    }
                }
            }
            Chart { title: name, x, y, series }
        })
        .collect();
    draw("11_error.svg", (400, 380), &charts);
    expected::hold("11_path_tracing/errors", held.into());
}

/// The root mean square difference relative to the picture's own colours.
fn relative(picture: &Picture, reference: &Picture) -> f64 {
    let squares: f64 = colors(reference).map(|c| c * c).sum();
    error(picture, reference) / (squares / (3 * reference.pixels.len()) as f64).sqrt()
}

const SMALL: &str = "96x60";

#[test]
#[ignore = "by hand: prints what stopping at a depth costs in error"]
fn biases() {
    // The random numbers are the same, so pictures differ only by the omission and not at random.
    let of = |sets: &[&str]| {
        chapter(SMALL).frames(64).sets(&["roulette=off", "depth=32"]).sets(sets).picture()
    };
    let all = of(&[]);
    let mut held = Map::new();
    for depth in [0, 1, 2, 4, 8, 16] {
        let error = relative(&of(&[&format!("depth={depth}")]), &all);
        println!("| depth {depth} | {error:.5} |");
        held.insert(format!("depth.{depth}"), error.into());
    }
    expected::hold("11_path_tracing/biases", held.into());
}

#[test]
#[ignore = "by hand: prints the noise of roulette and clamps"]
fn noise() {
    let reference = chapter(SMALL).frames(512).sets(&["depth=32", "seed=1"]).picture();
    let of = |sets: &[&str]| chapter(SMALL).frames(16).sets(&["depth=32"]).sets(sets).picture();
    let mut held = Map::new();
    for roulette in ["off", "on"] {
        let error = relative(&of(&[&format!("roulette={roulette}")]), &reference);
        println!("| roulette {roulette} | {error:.4} |");
        held.insert(format!("roulette.{roulette}"), error.into());
    }
    let mean = |picture: &Picture| Estimate::of(&brightness(picture)).mean;
    let unclamped = of(&["clamp=0"]);
    for clamp in ["0", "10", "2", "0.5"] {
        let clamped = of(&[&format!("clamp={clamp}")]);
        let error = relative(&clamped, &reference);
        let lost = 1.0 - mean(&clamped) / mean(&unclamped);
        println!("| clamp {clamp} | {error:.4} | {lost:.5} |");
        held.insert(format!("clamp.{clamp}.error"), error.into());
        held.insert(format!("clamp.{clamp}.lost"), lost.into());
    }
    expected::hold("11_path_tracing/noise", held.into());
}

#[test]
#[ignore = "by hand: prints what a sum of floats loses; takes minutes"]
fn sums() {
    let mut held = Map::new();
    for frames in [100, 1000, 10_000] {
        let of = |sum: &str| chapter("8x5").frames(frames).set("sum", sum).picture();
        let [integers, floats] = ["integers", "floats"].map(of);
        let offs = colors(&floats).zip(colors(&integers)).map(|(f, i)| (f / i - 1.0).abs());
        let most = offs.fold(0.0, f64::max);
        println!("| {frames} | {most:.1e} |");
        held.insert(frames.to_string(), most.into());
    }
    expected::hold("11_path_tracing/sums", held.into());
}
