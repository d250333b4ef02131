//! The error of the mean of many frames, and the benefit of further frames with a lens and without.

use common::app::Picture;
use serde_json::Map;

use super::{NAME, chapter};
use run::{expected, render, shaders_with};

/// Small, because there are many frames.
const SIZE: &str = "40x25";

/// The root of the mean squared difference, over all pixels and colours.
fn error(a: &Picture, b: &Picture) -> f64 {
    let pairs = || a.pixels.iter().zip(&b.pixels);
    let squares = pairs().flat_map(|(a, b)| [0, 1, 2].map(|i| f64::from(a[i] - b[i]).powi(2)));
    (squares.sum::<f64>() / (3 * a.pixels.len()) as f64).sqrt()
}

/// The relative errors of a mean compared with the exact one: their mean, which is the bias, and the largest.
fn off(mean: &Picture, exact: &Picture) -> [f64; 2] {
    let pairs = mean.pixels.iter().zip(&exact.pixels);
    let errors = pairs.flat_map(|(mean, exact)| {
        [0, 1, 2].map(|i| f64::from(mean[i]) / f64::from(exact[i]) - 1.0)
    });
    let errors: Vec<f64> = errors.collect();
    let most = errors.iter().fold(0.0, |most, error| f64::max(most, error.abs()));
    [errors.iter().sum::<f64>() / errors.len() as f64, most]
}

#[test]
#[ignore = "nightly: thousands of frames; quick: jitter_camera::mean::the_mean_on_the_device_is_this_recurrence"]
fn the_running_mean_keeps_what_a_sum_of_floats_loses() {
    const FRAMES: u32 = 4096;
    let size = "24x15";
    // Each sample is added as an integer, and the mean is rounded once.
    let exact = render(NAME, size, &["--samples", &format!("0..{FRAMES}")]).picture;
    let mean = chapter(size).frames(FRAMES).picture();
    let sums = shaders_with(
        "28_depth_of_field/camera.rgen",
        "mean += (payload - mean) / float(push.accumulated + 1);\n    imageStore(means, pixel, mean);",
        "mean += payload;\n    imageStore(means, pixel, mean);\n    mean /= float(push.accumulated + 1);",
    );
    let sum = chapter(size).shaders(sums.path()).frames(FRAMES).picture();
    let mut table = Map::new();
    for (name, picture) in [("sum", &sum), ("mean", &mean)] {
        let [bias, most] = off(picture, &exact);
        println!("{name}: bias {bias:.2e}, at most {most:.2e}");
        table.insert(format!("{name}.bias"), bias.into());
        table.insert(format!("{name}.most"), most.into());
    }
    let [sum, mean] = [&sum, &mean].map(|picture| off(picture, &exact)[1]);
    // Chapter 04: the mean of n frames is off by at most n roundings.
    assert!(mean < f64::from(FRAMES) * 0.5f64.powi(24), "{mean}");
    assert!(mean < sum, "a sum of floats has {sum}, the mean {mean}");
    expected::hold("28_depth_of_field/sums", table.into());
}

#[test]
#[ignore = "nightly: thousands of frames; quick: depth_of_field::circle::a_light_is_spread_over_the_circle_of_confusion"]
fn samples_buy_less_where_the_lens_blurs() {
    const COUNTS: [u32; 5] = [1, 4, 16, 64, 256];
    let mut table = Map::new();
    let mut slopes = Vec::new();
    for (name, lens) in [("pinhole", "lens diameter=0"), ("lens", "lens diameter=0.6")] {
        let reference = chapter(SIZE).frames(2048).sets(&[lens, "seed=1"]).picture();
        // The mean over four seeds: in a picture this small, the error of one sample depends on a few lamps.
        let errors = COUNTS.map(|frames| {
            let square = |seed: &str| {
                error(&chapter(SIZE).frames(frames).sets(&[lens, seed]).picture(), &reference)
                    .powi(2)
            };
            (["seed=0", "seed=2", "seed=3", "seed=4"].map(square).iter().sum::<f64>() / 4.0).sqrt()
        });
        let slope = (errors[4] / errors[1]).log2() / 6.0;
        println!("{name}: {errors:.4?}, power {slope:.2}");
        assert!(errors.windows(2).all(|pair| pair[1] < pair[0]), "{name}: {errors:?}");
        for (frames, error) in COUNTS.iter().zip(errors) {
            table.insert(format!("{name}.{frames}"), error.into());
        }
        table.insert(format!("{name}.slope"), slope.into());
        slopes.push(slope);
    }
    // At an edge, the error falls with an exponent of -3/4 for evenly placed points (04). Small lamps far out
    // of focus are hit at random.
    assert!(slopes[0] < -0.65, "a pinhole: {}", slopes[0]);
    assert!((-0.65..-0.45).contains(&slopes[1]), "a lens: {}", slopes[1]);
    expected::hold("28_depth_of_field/errors", table.into());
}

/// The time of a picture with a lens, in milliseconds.
#[test]
#[ignore = "by hand: takes seconds, and gives times"]
fn price() {
    let mut table = Map::new();
    for frames in [1, 4, 16, 64, 256u32] {
        let report = chapter("240x150").frames(frames).run().report;
        let median = report["gpu_milliseconds"]["median"].as_f64().expect("a time");
        table.insert(frames.to_string(), (median * f64::from(frames)).into());
    }
    expected::give_timed("28_depth_of_field/price", table.into());
}
