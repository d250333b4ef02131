//! Plots for the page of 29_emitters. Drawn on request: `cargo test --test samples emitters::plots
//! -- --ignored --nocapture`.

use common::app::Picture;
use serde_json::Map;

use super::closed_forms::{lit_by_balls, mean_variances, variances_of_squares};
use super::{ESTIMATORS, Estimate, brightness, chapter, estimator};
use crate::path_tracing::closed_forms::{SQUARES, form_factors};
use run::expected;
use run::plot::{Axis, Chart, Series, Shown, draw, draw_panels};

#[test]
#[ignore = "by hand: draws docs/images/29_estimators.png"]
fn estimators() {
    let names = ["BSDF: 64 samples", "light: 64 samples", "MIS: 64 samples"];
    let show = |i: usize| {
        let sets = [
            &estimator(ESTIMATORS[i])[..],
            "depth=2",
            "camera target=-2.0,0.45,0.35",
            "field of view=19",
        ];
        (names[i].to_owned(), chapter("320x240").frames(64).sets(&sets).picture())
    };
    draw_panels("29_estimators.png", 1, &[Shown::row(&[0, 1, 2].map(show))]);
}

/// The mean number of rays of a path; each is shown as a sixteenth of white.
pub fn rays(picture: &Picture) -> f64 {
    16.0 * Estimate::of(&brightness(picture)).mean
}

/// The title and curves of a chart: each a name and its points.
type Curves = (&'static str, Vec<(&'static str, Vec<[f64; 2]>)>);

const FRAMES: [u32; 5] = [1, 4, 16, 64, 256];
const ERRORS: &[f64] = &[0.0001, 0.001, 0.01, 0.1, 1.0, 10.0, 100.0, 1000.0];

/// The root of the mean squared error relative to the expected value.
pub fn relative(shown: &[f64], expected: &[f64]) -> f64 {
    let squares: f64 = shown.iter().zip(expected).map(|(s, e)| (s - e).powi(2)).sum();
    (squares / expected.iter().map(|e| e * e).sum::<f64>()).sqrt()
}

/// The error of one sample per pixel: the root mean square over the first 64 samples, each alone. A path
/// rarely hits a small bright ball, so a single sample of 1,024 pixels says little.
fn error_alone(sets: &[&str], expected: &[f64]) -> f64 {
    let square = |k: u32| {
        let samples = format!("{k}..{}", k + 1);
        let picture = chapter("32x32").with(&["--samples", &samples]).sets(sets).picture();
        relative(&brightness(&picture), expected).powi(2)
    };
    ((0..64).map(square).sum::<f64>() / 64.0).sqrt()
}

#[test]
#[ignore = "by hand: draws docs/images/29_error.svg"]
fn errors() {
    let side = 32;
    let scenes = [
        ("ball", lit_by_balls("ball", side)),
        ("many balls", lit_by_balls("many balls", side)),
        ("perpendicular squares", form_factors(side, &SQUARES[1].1)),
    ];
    let x = Axis { label: "rays per pixel", ticks: &[1.0, 10.0, 100.0, 1000.0], logarithmic: true };
    let y = Axis { label: "error, relative", ticks: ERRORS, logarithmic: true };
    let mut held = Map::new();
    let mut charts = Vec::new();
    for (scene, expected) in &scenes {
        let (mut series, mut lines) = (Vec::new(), Vec::new());
        let scale = (expected.iter().map(|e| e * e).sum::<f64>() / expected.len() as f64).sqrt();
        let theories = match *scene {
            "perpendicular squares" => variances_of_squares(side),
            scene => mean_variances(scene, side),
        };
        let set = format!("scene={scene}");
        for (i, name) in ESTIMATORS.iter().enumerate() {
            let sets = [&set[..], &estimator(name), "depth=1"];
            let rays = rays(&chapter("32x32").frames(4).sets(&sets).sets(&["show=rays"]).picture());
            let mut points = Vec::new();
            for frames in FRAMES {
                let error = relative(
                    &brightness(&chapter("32x32").frames(frames).sets(&sets).picture()),
                    expected,
                );
                println!("{scene}, {name}, {frames} samples: {error:.5}");
                points.push([rays * f64::from(frames), error]);
                if frames == 64 {
                    held.insert(format!("{scene}.{name}"), error.into());
                }
            }
            held.insert(format!("{scene}.{name}.rays"), rays.into());
            // An estimator that weighs two ways has no such simple form.
            if let Some(variance) = theories.get(i) {
                let of = |frames: u32| {
                    [rays * f64::from(frames), (variance / f64::from(frames)).sqrt() / scale]
                };
                // The error of a single sample agrees with theory; Sobol's points are not worse.
                let (alone, theory) = (error_alone(&sets, expected), of(1)[1]);
                println!("{scene}, {name}: one sample {alone:.5}, by theory {theory:.5}");
                assert!((alone / theory - 1.0).abs() < 0.1, "{scene}, {name}: {alone} {theory}");
                // A single sample of each pixel may deviate from theory at random.
                let mut several = points.iter().zip(FRAMES).skip(1);
                assert!(
                    several.all(|(p, n)| p[1] < 1.15 * of(n)[1]),
                    "{scene}, {name}: {points:?}"
                );
                lines.push((["theory, BSDF", "theory, light"][i], FRAMES.map(of).to_vec(), false));
            }
            series.push((*name, points, true));
        }
        // Last, so that an estimator has the same colour in all charts.
        let series = series.into_iter().chain(lines).map(|(name, points, dots)| Series {
            name,
            points,
            line: true,
            dots,
            names: vec![],
        });
        charts.push(Chart { title: scene, x, y, series: series.collect() });
    }
    draw("29_error.svg", (400, 380), &charts);
    expected::hold("29_emitters/errors", held.into());
}

const SMALL: &str = "96x60";

/// The light that a depth leaves out, with the same random numbers, so that it has no noise.
#[test]
#[ignore = "nightly: paths of 256 bounces; quick: emitters::closed_forms::a_room_that_shines_is_as_bright_as_its_series"]
fn a_depth_leaves_out_what_its_paths_do_not_reach() {
    let of = |depth: u32| brightness(&chapter(SMALL).frames(16).set("depth", depth).picture());
    let all = of(256);
    let mut held = Map::new();
    let mut last = f64::INFINITY;
    for depth in [0, 1, 2, 4, 8, 16] {
        let shown = of(depth);
        assert!(shown.iter().zip(&all).all(|(some, all)| some <= all), "{depth} adds light");
        let error = relative(&shown, &all);
        println!("depth {depth}: {error:.5}");
        assert!(error < last, "depth {depth}: {error}");
        last = error;
        held.insert(depth.to_string(), error.into());
    }
    expected::hold("29_emitters/left_out", held.into());
}

/// The set by lamp light: the error against rays and against time, compared with a picture of many more
/// samples.
#[test]
#[ignore = "by hand: draws docs/images/29_price.svg; takes minutes"]
fn price() {
    let shared = ["depth=4", "clamp=0"];
    let of =
        |sets: &[&str], frames: u32| chapter(SMALL).frames(frames).sets(&shared).sets(sets).run();
    let reference = brightness(&of(&["seed=9"], 2048).picture);
    let mut held = Map::new();
    let mut charts: Vec<Curves> =
        vec![("error against rays", vec![]), ("error against time", vec![])];
    for name in ESTIMATORS {
        let set = estimator(name);
        let rays = rays(&of(&[&set, "show=rays"], 4).picture);
        let mut curves = [vec![], vec![]];
        for frames in [1, 4, 16, 64] {
            let run = of(&[&set], frames);
            let error = relative(&brightness(&run.picture), &reference);
            let milliseconds = run.report["gpu_milliseconds"]["median"].as_f64().expect("a time")
                * f64::from(frames);
            println!("{name}, {frames} samples: {error:.4}, {rays:.2} rays, {milliseconds:.0} ms");
            curves[0].push([rays * f64::from(frames), error]);
            curves[1].push([milliseconds / 1000.0, error]);
            if frames == 64 {
                held.insert(format!("{name}.error"), error.into());
                held.insert(format!("{name}.rays"), rays.into());
                held.insert(format!("{name}.milliseconds"), (milliseconds / 64.0).into());
            }
        }
        for (chart, curve) in charts.iter_mut().zip(curves) {
            chart.1.push((name, curve));
        }
    }
    let rays = Axis {
        label: "rays per pixel",
        ticks: &[1.0, 3.0, 10.0, 30.0, 100.0, 300.0],
        logarithmic: true,
    };
    let time =
        Axis { label: "seconds", ticks: &[0.01, 0.03, 0.1, 0.3, 1.0, 3.0], logarithmic: true };
    let y = Axis {
        label: "error, relative",
        ticks: &[0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0],
        logarithmic: true,
    };
    let charts: Vec<Chart> = charts
        .iter()
        .zip([rays, time])
        .map(|((title, curves), x)| {
            let series = |(name, points): &(&'static str, Vec<[f64; 2]>)| Series {
                name,
                points: points.clone(),
                line: true,
                dots: true,
                names: vec![],
            };
            Chart { title, x, y, series: curves.iter().map(series).collect() }
        })
        .collect();
    draw("29_price.svg", (400, 380), &charts);
    expected::give_timed("29_emitters/price", held.into());
}
