//! The gain and the cost of reuse: error in the same time, and how the noise of neighbours and of frames grows alike.
//! `cargo test --test samples reservoirs::plots -- --ignored --nocapture`.

use common::app::Picture;
use run::{Chapter, expected};
use serde_json::{Map, json};

use super::chapter;
use super::means::without_lamps;

const SIZE: &str = "64x40";
/// From below the strings: their lamps are smaller than a pixel, and their noise would hide all other.
const VIEW: [&str; 3] = ["camera eye=-5,1.9,3", "camera target=-1.6,0.3,0.4", "field of view=24"];

/// Brightness of the pixels without lamps, as a screen shows it: at most 1.
fn light(picture: &Picture, pixels: &[bool]) -> Vec<f64> {
    let all = picture.pixels.iter().zip(pixels).filter(|(_, dark)| **dark);
    all.map(|(pixel, _)| pixel[..3].iter().map(|&c| f64::from(c).min(1.0)).sum::<f64>() / 3.0)
        .collect()
}

/// The root of the mean squared error, relative to the mean.
fn relative(shown: &[f64], truth: &[f64]) -> f64 {
    let squares: f64 = shown.iter().zip(truth).map(|(s, t)| (s - t).powi(2)).sum();
    let whole = truth.iter().sum::<f64>() / truth.len() as f64;
    (squares / truth.len() as f64).sqrt() / whole
}

fn of_29(sets: &[&str]) -> Chapter {
    let scene = ["scene=many lamps", "sky=black", "depth=1"];
    Chapter::new("29_emitters").size(SIZE).sets(&scene).sets(&VIEW).sets(sets)
}

fn here(sets: &[&str]) -> Chapter {
    chapter().size(SIZE).set("sky", "black").sets(&VIEW).sets(sets)
}

fn truth(pixels: &[bool]) -> Vec<f64> {
    let sets = ["seed=900", "show=mean", "reuse=space", "candidates=32", "visibility=on"];
    light(&here(&sets).frames(256).picture(), pixels)
}

fn milliseconds(chapter: &Chapter) -> f64 {
    let run = chapter.clone().frames(17).run();
    run.report["gpu_milliseconds"]["median"].as_f64().expect("a time")
}

#[test]
#[ignore = "by hand: takes minutes, and depends on times"]
fn equal_time() {
    let pixels = without_lamps(SIZE, &VIEW);
    let truth = truth(&pixels);
    let methods = [
        ("29, BSDF", of_29(&["estimator=BSDF"])),
        ("29, light by power", of_29(&["estimator=light"])),
        ("29, light, each as often", of_29(&["estimator=light", "emitters=one"])),
        ("29, MIS", of_29(&["estimator=MIS"])),
        ("no reuse", here(&["show=mean", "reuse=none"])),
        ("in time", here(&["show=mean", "reuse=time"])),
        ("in space", here(&["show=mean", "reuse=space"])),
        ("both", here(&["show=mean", "reuse=both"])),
    ];
    let times = methods.each_ref().map(|(_, chapter)| milliseconds(chapter));
    let budget = 16.0 * times[7];
    let mut held = Map::new();
    for ((name, chapter), time) in methods.iter().zip(times) {
        let frames = (budget / time).round().max(1.0) as u32;
        let alone = relative(&light(&chapter.clone().frames(1).picture(), &pixels), &truth);
        let error = relative(&light(&chapter.clone().frames(frames).picture(), &pixels), &truth);
        println!("{name}: {time:.1} ms, one frame {alone:.3}; {frames} frames: {error:.4}");
        let key = name.replace([' ', ','], "-").replace("--", "-");
        held.insert(format!("{key}.time"), json!(time / times[1]));
        held.insert(format!("{key}.one"), json!(alone));
        held.insert(format!("{key}.frames"), json!(frames));
        held.insert(format!("{key}.error"), json!(error));
    }
    expected::give_timed("32_reservoirs/equal_time", held.into());
}

/// The error of one frame with a history of eight, by each kind of weights.
#[test]
#[ignore = "by hand: takes minutes"]
fn weights() {
    let pixels = without_lamps(SIZE, &VIEW);
    let truth = truth(&pixels);
    let mut held = Map::new();
    for weights in ["1/M", "1/Z", "balance"] {
        for visibility in ["on", "off"] {
            let chapter = here(&[]).set("weights", weights).set("visibility", visibility);
            let square = |seed: u32| {
                let shown = light(&chapter.clone().set("seed", seed).frames(9).picture(), &pixels);
                relative(&shown, &truth).powi(2)
            };
            let error = ((0..8).map(square).sum::<f64>() / 8.0).sqrt();
            println!("{weights}, visibility {visibility}: error {error:.3}");
            held.insert(format!("{}-{visibility}.error", weights.replace('/', "-")), json!(error));
        }
    }
    expected::hold("32_reservoirs/weights", held.into());
}

/// Pictures of a frame with different seeds: the error of one, how alike the errors of neighbours are, and the error of
/// the mean of 32 frames.
#[test]
#[ignore = "by hand: takes minutes"]
fn caps() {
    let pixels = without_lamps(SIZE, &VIEW);
    let truth = truth(&pixels);
    let (width, count) = (64, 8);
    let mut held = Map::new();
    for cap in [1, 20, 1000] {
        let chapter = here(&[]).set("cap", cap);
        let of = |seed: u32| chapter.clone().set("seed", seed).frames(32).picture();
        let shown: Vec<Vec<f64>> = (0..count)
            .map(|seed| {
                let picture = of(seed);
                picture
                    .pixels
                    .iter()
                    .map(|p| p[..3].iter().map(|&c| f64::from(c).min(1.0)).sum())
                    .collect()
            })
            .collect();
        let middle = |i: usize| shown.iter().map(|s| s[i]).sum::<f64>() / f64::from(count);
        let middles: Vec<f64> = (0..pixels.len()).map(middle).collect();
        let (mut product, mut squares) = (0.0, [0.0; 2]);
        for i in (0..pixels.len() - 1).filter(|i| i % width + 1 < width) {
            if pixels[i] && pixels[i + 1] {
                for s in &shown {
                    let [a, b] = [i, i + 1].map(|i| (s[i] - middles[i]) / middles[i].max(1e-3));
                    product += a * b;
                    squares = [squares[0] + a * a, squares[1] + b * b];
                }
            }
        }
        let alike = product / (squares[0] * squares[1]).sqrt();
        let error = relative(&light(&of(0), &pixels), &truth);
        let mean = chapter.clone().set("show", "mean").frames(32).picture();
        let of_mean = relative(&light(&mean, &pixels), &truth);
        println!("cap {cap}: error {error:.3}, neighbours {alike:.3}, mean of 32 {of_mean:.4}");
        held.insert(format!("{cap}.error"), json!(error));
        held.insert(format!("{cap}.alike"), json!(alike));
        held.insert(format!("{cap}.mean"), json!(of_mean));
    }
    expected::hold("32_reservoirs/caps", held.into());
}
