//! The mean of many pictures is that of 29, whose shadow rays do not know of each other.

use run::Chapter;
use tempfile::TempDir;

use super::{NAME, colors, mean, tiny};
use crate::emitters::closed_forms::lit_by_balls;

const SEEDS: u32 = 8;
const EMITTERS: &str = "29_emitters";

/// The mean of several means, and six of their standard errors: eight are few.
fn settled(means: &[f64]) -> (f64, f64) {
    let count = means.len() as f64;
    let middle = mean(means.iter().copied());
    let squares: f64 = means.iter().map(|mean| (mean - middle).powi(2)).sum();
    (middle, 6.0 * (squares / (count - 1.0) / count).sqrt())
}

/// The pixels without a lamp: a lamp's rim has far more noise than the light on the board.
pub fn without_lamps(size: &str, sets: &[&str]) -> Vec<bool> {
    let lamps = Chapter::new(EMITTERS).size(size).sets(&["scene=many lamps", "sky=black"]);
    let lamps = lamps.set("depth", 0).sets(sets).frames(64).picture();
    lamps.pixels.iter().map(|pixel| pixel[..3] == [0.0; 3]).collect()
}

/// The mean brightness of some pixels, of so many pictures with different seeds.
fn means(chapter: &Chapter, pixels: &[bool]) -> (f64, f64) {
    let of = |seed: u32| {
        let picture = chapter.clone().set("seed", seed).picture();
        let colors: Vec<f64> = colors(&picture).collect();
        mean(
            colors
                .chunks(3)
                .zip(pixels)
                .filter(|(_, counts)| **counts)
                .map(|(c, _)| c.iter().sum()),
        )
    };
    settled(&(0..SEEDS).map(of).collect::<Vec<_>>())
}

/// The difference of two means and its confidence interval, as parts of the second.
fn difference(name: &str, here: (f64, f64), there: (f64, f64), most: f64) -> (f64, f64) {
    let (off, bound) = (here.0 / there.0 - 1.0, here.1.hypot(there.1) / there.0);
    println!("{name}: {:.5}, 29 {:.5}: off by {off:.4} ± {bound:.4}", here.0, there.0);
    assert!(bound < most, "{name}: the test sees an error of {most}, not {bound}");
    (off, bound)
}

/// A chapter's view of the floor between shadows, from below the lamps.
fn of_floor(name: &str, folder: &TempDir) -> Chapter {
    let view = ["camera eye=0,0,0.45", "camera target=0,0,0", "field of view=100", "sky=black"];
    Chapter::new(name).size("40x40").scene(folder.path().join("tiny.obj")).sets(&view)
}

#[test]
fn a_floor_with_shadows_is_lit_as_in_29() {
    let folder = tiny::scene();
    let all = vec![true; 40 * 40];
    let there = of_floor(EMITTERS, &folder).sets(&["depth=1", "estimator=light"]).frames(16);
    let there = means(&there, &all);
    let of = |weights: &str| {
        let here = of_floor(NAME, &folder).sets(&["candidates=4", "radius=8"]).frames(5);
        difference(weights, means(&here.set("weights", weights), &all), there, 0.03)
    };
    let (off, bound) = of("balance");
    assert!(off.abs() < bound, "balance: {off}");
    // The test tells right from wrong.
    let (off, bound) = of("1/M");
    assert!(off < -bound, "1/M: {off}");
}

/// From below the strings of lamps.
const VIEW: [&str; 3] = ["camera eye=-5,1.9,3", "camera target=-1.6,0.3,0.4", "field of view=24"];

fn of_lamps(sets: &[&str]) -> Chapter {
    let here = Chapter::new(NAME).size("48x30").sets(&["scene=many lamps", "sky=black"]);
    here.sets(&VIEW).set("show", "mean").sets(sets).frames(16)
}

fn of_lamps_in_29() -> Chapter {
    let there = Chapter::new(EMITTERS).size("48x30").sets(&["scene=many lamps", "sky=black"]);
    there.sets(&VIEW).sets(&["depth=1", "estimator=MIS"]).frames(64)
}

#[test]
#[ignore = "nightly: 100 pictures; quick: reservoirs::means::a_floor_with_shadows_is_lit_as_in_29"]
fn a_thousand_lamps_light_the_set_as_in_29() {
    let pixels = without_lamps("48x30", &VIEW);
    let there = means(&of_lamps_in_29(), &pixels);
    // Both together are tested on the floor: 1/Z without visibility has single pixels here that hide all others.
    for reuse in ["reuse=none", "reuse=time", "reuse=space"] {
        for weights in ["weights=1/Z", "weights=balance"] {
            for visibility in ["visibility=on", "visibility=off"] {
                let sets = [reuse, weights, visibility];
                let here = means(&of_lamps(&sets), &pixels);
                let (off, bound) = difference(&sets.join(", "), here, there, 0.1);
                assert!(off.abs() < bound, "{sets:?}: {off}");
            }
        }
    }
}

/// The last frame saw other surfaces in its pixels.
#[test]
#[ignore = "nightly: 24 pictures; quick: reservoirs::means::a_floor_with_shadows_is_lit_as_in_29"]
fn a_turning_camera_keeps_the_light() {
    let folder = tiny::scene();
    let all = vec![true; 40 * 40];
    let (frames, turn) = (6, 2.0_f64);
    // From straight above, the camera turns around the vertical of the world, y.
    let (sine, cosine) = (turn * f64::from(frames - 1)).to_radians().sin_cos();
    let eye = format!("camera eye={},0,{}", 0.45 * sine, 0.45 * cosine);
    let there = of_floor(EMITTERS, &folder).sets(&["depth=1", "estimator=light", &eye]).frames(16);
    let there = means(&there, &all);
    for weights in ["1/Z", "balance"] {
        let here = of_floor(NAME, &folder).sets(&["candidates=4", "radius=8", "turn=2"]);
        let here = means(&here.set("weights", weights).frames(frames), &all);
        // 1/Z is noisier; with 1/M, 8 % of the light are missing.
        let (off, bound) = difference(weights, here, there, 0.06);
        assert!(off.abs() < bound, "{weights}: {off}");
    }
}

/// Nothing hides one of the balls, and each pixel sees all of them.
#[test]
fn many_balls_light_a_square_as_their_closed_form_says() {
    let expected = lit_by_balls("many balls", 32);
    let truth = mean(expected.iter().copied());
    let of = |seed: u32| {
        let sets = ["scene=many balls", "reuse=both", "candidates=4"];
        let picture =
            Chapter::new(NAME).size("32x32").sets(&sets).set("seed", seed).frames(4).picture();
        mean(colors(&picture))
    };
    let (light, bound) = settled(&(0..SEEDS).map(of).collect::<Vec<_>>());
    println!("{light:.5} ± {bound:.5}, closed form {truth:.5}");
    assert!((light - truth).abs() < bound, "{light} {truth}");
    assert!(bound < 0.03 * truth, "the test sees an error of 3 %: {bound}");
}
