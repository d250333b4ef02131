//! The mean of many frames: the shader's recurrence, and the running sum it replaces.

use common::app::Picture;

use serde_json::Map;

use super::{SMALL, chapter};
use crate::sequences::points::hash;
use run::{bits, expected, render};

/// Frames after which the mean must still be right.
const MANY: u32 = 100_000;
/// Half the distance from 1 to the next float: the relative error of a rounded operation.
const U: f64 = 1.0 / (1u64 << 24) as f64;

/// The shader's recurrence: the mean of `count` values and one more.
fn add(mean: f32, value: f32, count: u32) -> f32 {
    mean + (value - mean) / (count + 1) as f32
}

#[test]
fn the_mean_on_the_device_is_this_recurrence() {
    let single = |frame: u32| chapter(SMALL).frames(frame + 1).sets(&["accumulate=off"]).picture();
    let singles: Vec<Picture> = (0..8).map(single).collect();
    let means = chapter(SMALL).frames(8).picture();
    let (mut equal, mut largest) = (0, 0f32);
    for (i, mean) in means.pixels.iter().enumerate() {
        for (channel, &mean) in mean.iter().enumerate() {
            let values: Vec<f32> = singles.iter().map(|single| single.pixels[i][channel]).collect();
            let most = values.iter().fold(0f32, |most, value| most.max(value.abs()));
            let mut expected = 0.0;
            for (count, value) in values.into_iter().enumerate() {
                expected = add(expected, value, count as u32);
            }
            // Vulkan allows a division an error of 2.5 ULP: 5 of U for a difference of at most `most`,
            // divided by 1 to 8; and the sum is rounded in either direction, by U of `most` per frame.
            let divisions: f64 = (1..=8).map(|count| 5.0 / f64::from(count)).sum();
            let bound = (divisions + 2.0 * 8.0) * U * f64::from(most);
            let error = f64::from((mean - expected).abs());
            assert!(error <= bound, "pixel {i}: {mean}, not {expected}");
            equal += usize::from(mean.to_bits() == expected.to_bits());
            largest = largest.max(most);
        }
    }
    println!("{equal} of {} values equal to the bit", 4 * means.pixels.len());
    assert!(largest > 0.5, "the picture is too dark to show anything");
    assert!(bits(&means) != bits(&singles[7]), "nothing was accumulated");
}

#[test]
fn on_the_device_a_hundred_equal_frames_are_one() {
    equal_frames_are_one(100);
}

#[test]
#[ignore = "nightly: ten times the frames; quick: jitter_camera::mean::on_the_device_a_hundred_equal_frames_are_one"]
fn on_the_device_a_thousand_equal_frames_are_one() {
    equal_frames_are_one(1000);
}

/// A running sum divided by its count fails here: in 32 bits, a hundred times 0.1 is 10.000002, and a
/// thousand times 0.1 is 99.99905.
fn equal_frames_are_one(frames: u32) {
    let one = render("02_basic", SMALL, &[]).picture;
    let mean = chapter(SMALL).frames(frames).sets(&["jitter=off"]).picture();
    assert_eq!(bits(&mean), bits(&one));
}

/// A mean in f32 by the recurrence; a mean in f64, to compare with; and a running sum in f32.
#[derive(Default)]
struct Means {
    count: u32,
    mean: f32,
    sum: f32,
    exact_sum: f64,
    /// Error bound of the mean, times the count.
    bound: f64,
}

impl Means {
    fn add(&mut self, value: f32) {
        let before = self.mean;
        self.mean = add(self.mean, value, self.count);
        self.count += 1;
        self.sum += value;
        self.exact_sum += f64::from(value);
        // The step's difference and quotient are rounded, then the mean; an error made at frame k has shrunk
        // to k/n of itself by frame n.
        let step = 2.0 * f64::from((value - before).abs()) * (1.0 + 2.0 * U);
        self.bound += U * (step + f64::from(self.count) * f64::from(self.mean.abs()));
    }

    fn exact(&self) -> f64 {
        self.exact_sum / f64::from(self.count)
    }

    /// The relative errors of the sum and of the mean.
    fn errors(&self) -> [f64; 2] {
        let relative = |x: f64| (x / self.exact() - 1.0).abs();
        [relative(f64::from(self.sum) / f64::from(self.count)), relative(self.mean.into())]
    }
}

/// A frame of a pixel, given its number and the mean so far.
type Input = fn(u32, f32) -> f32;

/// Inputs that are hard for a mean.
fn inputs() -> Vec<(&'static str, Input)> {
    vec![
        ("0.1, always", |_, _| 0.1),
        ("an edge: 0 or 1 at random", |i, _| (hash([i, 0, 0, 0])[0] & 1) as f32),
        (
            "0.1, and 10,000 every 10,000th frame",
            |i, _| if i % 10_000 == 9_999 { 1e4 } else { 0.1 },
        ),
        ("first 1,000,000, then 0.1", |i, _| if i == 0 { 1e6 } else { 0.1 }),
        ("chosen so that every step is rounded up", |i, mean| {
            let unit = mean.max(0.5).next_up() - mean.max(0.5);
            if i == 0 { 0.5 } else { mean + 0.51 * unit * (i + 1) as f32 }
        }),
    ]
}

#[test]
fn the_mean_is_right_after_a_hundred_thousand_frames() {
    println!(
        "| a pixel's frames | sum, divided | running mean | the mean's bound |\n|---|---|---|---|"
    );
    let mut errors = Map::new();
    for (name, value) in inputs() {
        let mut means = Means::default();
        for i in 0..MANY {
            means.add(value(i, means.mean));
        }
        let [sum, mean] = means.errors();
        let bound = means.bound / f64::from(MANY) / means.exact();
        println!("| {name} | {sum:.1e} | {mean:.1e} | {bound:.1e} |");
        for (figure, value) in [("sum", sum), ("mean", mean), ("bound", bound)] {
            errors.insert(format!("{name}: {figure}").replace(' ', "-"), value.into());
        }
        assert!(mean <= bound, "{name}: {mean} above {bound}");
        // Each frame's weight is positive, so that rounding contributes no more than n times U.
        assert!(bound <= f64::from(MANY) * U * 1.01, "{name}: the bound is {bound}");
        if name.starts_with("0.1, always") {
            assert_eq!(means.mean, 0.1, "equal frames have an exact mean");
            assert!(sum > 1e-4, "the sum is better than its reputation: {sum}");
        }
    }
    expected::hold_exact("04_jitter_camera/means", errors.into());
}

#[test]
#[ignore = "nightly: 50 million additions; quick: jitter_camera::mean::the_mean_is_right_after_a_hundred_thousand_frames"]
fn a_running_sum_stalls_and_the_mean_does_not() {
    println!("| frames of 0.1 | sum | sum, divided | running mean |\n|---|---|---|---|");
    let mut means = Means::default();
    let (mut stalled, mut sums) = (None, Map::new());
    for frame in 1..=50_000_000u32 {
        let before = means.sum;
        means.add(0.1);
        if means.sum == before && stalled.is_none() {
            stalled = Some(frame);
        }
        let shown = [1_000, 100_000, 1_000_000, 10_000_000, 50_000_000].contains(&frame);
        if shown || stalled == Some(frame) {
            let Means { count, mean, sum, .. } = means;
            let divided = f64::from(sum) / f64::from(count);
            println!("| {count} | {sum} | {divided} | {mean} |");
            sums.insert(format!("{count}.sum"), sum.into());
            sums.insert(format!("{count}.divided"), divided.into());
            sums.insert(format!("{count}.mean"), mean.into());
        }
    }
    // Above 2^21 floats are a quarter apart, and a tenth is less than half of that.
    assert_eq!(means.sum, (1u32 << 21) as f32);
    assert!(stalled.is_some());
    assert_eq!(means.mean, 0.1);
    expected::hold_exact("04_jitter_camera/sums", sums.into());
}
