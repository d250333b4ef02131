//! The time saved by the flag of the first hit.

use run::expected;
use serde_json::{Value, json};

use super::{FIRST_HIT, NAME};
use run::{Chapter, copy_of_shaders, shaders_with};

/// The time of a frame whose shadow rays continue to the nearest hit, relative to one where they end at the
/// first.
#[test]
#[ignore = "by hand: takes times"]
fn the_first_hit_in_time() {
    let [with, without] = FIRST_HIT;
    let first = copy_of_shaders();
    let nearest = shaders_with("common/shadow.glsl", with, without);
    let time = |shaders: &tempfile::TempDir| {
        let chapter = Chapter::new(NAME).size("480x300").shaders(shaders.path());
        let run = chapter.set("sun elevation", "5").frames(5).run();
        run.report["gpu_milliseconds"]["min"].as_f64().expect("a time")
    };
    let mut ratios: Vec<f64> = (0..20).map(|_| time(&nearest) / time(&first)).collect();
    ratios.sort_by(f64::total_cmp);
    let [low, ratio, high] = [5, 10, 15].map(|at| ratios[at]);
    println!("{ratio:.2}, middle half {low:.2} to {high:.2}");
    let values: Value = json!({ "ratio": ratio, "low": low, "high": high });
    expected::give_timed("05_shadow_miss/flags", values);
}
