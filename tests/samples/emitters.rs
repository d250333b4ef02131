//! 29_emitters: three estimators of the light from emitters agree with each other and with closed forms.

pub mod caught;
mod choosing;
pub mod closed_forms;
mod directions;
mod plots;

use common::app::Picture;
use instruments::sums::merge;
use serde_json::{Map, json};

use run::{Chapter, bits, command, compiled_for, expected, same_colors};

const NAME: &str = "29_emitters";
/// The relative error of one rounding to f32.
const U: f64 = 1.0 / 16_777_216.0;
const ESTIMATORS: [&str; 3] = ["BSDF", "light", "MIS"];

fn chapter(size: &str) -> Chapter {
    Chapter::new(NAME).size(size)
}

fn estimator(name: &str) -> String {
    format!("estimator={name}")
}

/// One number per pixel: the mean of its colours.
fn brightness(picture: &Picture) -> Vec<f64> {
    let mean = |pixel: &[f32; 4]| pixel[..3].iter().map(|&c| f64::from(c)).sum::<f64>() / 3.0;
    picture.pixels.iter().map(mean).collect()
}

/// The mean of independent values, and its confidence interval: four standard errors, which are exceeded at
/// random once in 16,000 times.
struct Estimate {
    mean: f64,
    deviation: f64,
    confidence: f64,
}

impl Estimate {
    fn of(values: &[f64]) -> Self {
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        let deviation = (squares / (count - 1.0)).sqrt();
        Self { mean, deviation, confidence: 4.0 * deviation / count.sqrt() }
    }

    #[track_caller]
    fn is(&self, expected: f64, what: &str) {
        let Self { mean, confidence, .. } = self;
        println!("{what}: {mean:.6} ± {confidence:.6}, not {expected:.6}?");
        assert!((mean - expected).abs() <= *confidence, "{what}: {mean} is not {expected}");
    }
}

#[test]
fn the_picture_repeats() {
    Chapter::new(NAME).frames(8).repeats();
}

/// Surfaces of all kinds, including mirrors, lit by spheres and by a mesh.
#[test]
#[ignore = "nightly: 256 samples per pixel, three times; quick: emitters::closed_forms::a_ball_lights_a_plane_as_its_closed_form_says"]
fn three_estimators_make_one_picture() {
    let [bsdf, light, mis] = [0, 1, 2].map(|i| {
        let sets = [&estimator(ESTIMATORS[i])[..], &format!("seed={i}"), "depth=3"];
        brightness(&chapter("64x40").frames(256).sets(&sets).picture())
    });
    let mut held = Map::new();
    let whole = Estimate::of(&mis).mean;
    for (name, other) in [("BSDF", &bsdf), ("light", &light)] {
        let differences: Vec<f64> = mis.iter().zip(other).map(|(mis, other)| mis - other).collect();
        let estimate = Estimate::of(&differences);
        estimate.is(0.0, &format!("MIS - {name}"));
        // The test would detect light that is counted twice, or a tenth of it that is missing.
        assert!(estimate.confidence < 0.1 * whole, "{name}: {} of {whole}", estimate.confidence);
        held.insert(format!("{name}.off"), json!((estimate.mean / whole).abs()));
        held.insert(format!("{name}.confidence"), json!(estimate.confidence / whole));
    }
    expected::hold("29_emitters/one_picture", held.into());
}

#[test]
#[ignore = "nightly: 64 samples per pixel, three times; quick: emitters::closed_forms::many_balls_light_it_as_all_of_them_do_whichever_are_asked"]
fn one_emitter_all_and_those_by_power_make_one_picture() {
    let choices = ["one", "all", "by power"];
    let shown = [0, 1, 2].map(|i| {
        let sets = [&format!("emitters={}", choices[i])[..], &format!("seed={i}"), "depth=2"];
        brightness(&chapter("64x40").frames(64).sets(&sets).picture())
    });
    for (name, other) in choices.iter().zip(&shown).take(2) {
        let differences: Vec<f64> = shown[2].iter().zip(other).map(|(a, b)| a - b).collect();
        let estimate = Estimate::of(&differences);
        estimate.is(0.0, &format!("by power - {name}"));
        let whole = Estimate::of(&shown[2]).mean;
        assert!(estimate.confidence < 0.1 * whole, "{name}: {} of {whole}", estimate.confidence);
    }
}

/// The eye sees the emission directly, and there is no bounce: no light is sampled, so nothing is random.
#[test]
fn what_is_seen_straight_is_the_same_by_all() {
    let of =
        |name| chapter("64x40").frames(2).sets(&[&estimator(name)]).sets(&["depth=0"]).picture();
    let [first, others @ ..] = ESTIMATORS.map(of);
    // Only the nearest hit matters, as in 02.
    others.iter().for_each(|other| same_colors("seen straight", "02", &first, other));
}

/// One sample of each estimator: the brightest pixel, and the number of pixels ten times as bright as the
/// mean.
#[test]
fn fireflies_are_those_of_chance_and_of_area() {
    let mut held = Map::new();
    let mut brightest = Vec::new();
    for (name, sets) in [
        ("BSDF", ["estimator=BSDF", "triangles=solid angle"]),
        ("area", ["estimator=light", "triangles=area"]),
        ("solid_angle", ["estimator=light", "triangles=solid angle"]),
        ("MIS", ["estimator=MIS", "triangles=solid angle"]),
    ] {
        let sets = [&sets[..], &["scene=perpendicular squares"]].concat();
        let shown = brightness(&chapter("96x96").frames(16).sets(&sets).picture());
        let Estimate { mean, deviation, .. } = Estimate::of(&shown);
        let most = shown.iter().copied().fold(0.0, f64::max);
        println!("{name}: mean {mean:.4}, deviation {deviation:.4}, brightest {most:.3}");
        held.insert(format!("{name}.brightest"), most.into());
        brightest.push(most);
    }
    // A white surface near an emitter of 1 is 1/2 at most; sampling by area, one point may have any weight.
    assert!(brightest[1] > 2.0 && brightest[2] < 1.01 && brightest[3] < 1.01, "{brightest:?}");
    expected::hold("29_emitters/fireflies", held.into());
}

#[test]
fn a_clamp_takes_light_and_adds_none() {
    let [all, clamped] =
        ["clamp=0", "clamp=0.5"].map(|clamp| chapter("64x40").frames(8).sets(&[clamp]).picture());
    let mut colors = all.pixels.iter().flatten().zip(clamped.pixels.iter().flatten());
    assert!(colors.all(|(all, clamped)| clamped <= all) && bits(&all) != bits(&clamped));
}

#[test]
fn light_that_is_cut_and_merged_is_the_light_in_one_piece() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let part = |samples: &str, file: &str| {
        let file = folder.path().join(file);
        let mut task = command(NAME);
        task.args(["--size", "24x16", "--samples", samples, "--save"]).arg(&file);
        let output = task.arg("--resume").arg(&file).output().expect("the sample starts");
        let errors = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success() && errors.is_empty(), "{samples}: {errors}");
        file
    };
    let whole = std::fs::read(part("0..12", "whole")).unwrap();
    let parts = [part("0..5", "a"), part("5..6", "b"), part("6..12", "c")];
    let merged = merge(&parts.each_ref().map(|path| path.as_path())).expect("they fit");
    assert_eq!(merged.bytes().expect("they can be written"), whole);
    // A single file that is continued, and samples out of order.
    ["7..9", "0..3", "0..12"].into_iter().for_each(|samples| drop(part(samples, "one")));
    assert_eq!(std::fs::read(folder.path().join("one")).unwrap(), whole);
}

#[test]
#[ignore = "nightly: compiles for a GPU; quick: gpus budgets::no_chapter_costs_a_gpu_more_than_is_recorded"]
fn its_programs_spill_no_register() {
    for estimator in ["estimator=MIS", "estimator=BSDF"] {
        for choice in ["emitters=by power", "emitters=all"] {
            let sets = ["--set", estimator, "--set", choice];
            let Some(programs) = compiled_for(NAME, "navi31", &sets) else { return };
            assert_eq!(programs.len(), 1, "rays do not nest: one program");
            assert_eq!(programs[0]["spilled_registers"], 0, "{}", programs[0]);
        }
    }
}
