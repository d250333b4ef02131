//! Values for the page, on request: `cargo test --test samples environment::plots -- --ignored --nocapture`.

use common::app::Picture;
use serde_json::Map;

use super::table;
use super::{SAMPLERS, brightness, chapter};
use run::expected;

/// The root of the mean squared error relative to the mean square of the expected value.
fn relative(shown: &Picture, expected: &Picture) -> f64 {
    let (shown, expected) = (brightness(shown), brightness(expected));
    let squares: f64 = shown.iter().zip(&expected).map(|(s, e)| (s - e).powi(2)).sum();
    (squares / expected.iter().map(|e| e * e).sum::<f64>()).sqrt()
}

/// The spheres, all of one roughness, without what the camera sees of the sky: its mean is the same for all.
fn spheres(sky: &str, roughness: &str) -> run::Chapter {
    let sets = ["scene=spheres", "depth=2", "camera eye=0,3,9", "field of view=34"];
    chapter("96x48").sets(&sets).set("sky", sky).set("roughness", roughness)
}

const FRAMES: u32 = 16;

#[test]
#[ignore = "by hand: prints the noise of four samplers under two skies"]
fn noise() {
    let mut held = Map::new();
    for sky in ["day", "evening"] {
        for roughness in ["0.1", "0.6"] {
            let of = |sampler: &str, seed: u32, frames: u32| {
                let run = spheres(sky, roughness).set("sampling", sampler);
                run.set("seed", seed).frames(frames).run()
            };
            let expected = of("both", 77, 2048).picture;
            for sampler in SAMPLERS {
                let run = of(sampler, 1, FRAMES);
                let milliseconds =
                    run.report["gpu_milliseconds"]["median"].as_f64().expect("a time");
                // Specks are rare, so the error after a second is measured, not predicted from fewer samples.
                let frames = (1000.0 / milliseconds).round().max(1.0) as u32;
                let equal = relative(&of(sampler, 1, frames).picture, &expected);
                let error = relative(&run.picture, &expected);
                println!(
                    "{sky}, {roughness}, {sampler}: error {error:.4}, {milliseconds:.2} ms, in a second {equal:.4}"
                );
                let name = format!("{sampler}.{sky}_{}", roughness.replace('.', ""));
                held.insert(format!("{name}.error"), error.into());
                held.insert(format!("{name}.second"), equal.into());
            }
        }
    }
    expected::give_timed("46_environment/noise", held.into());
}

/// The sum at up to eight million texels.
#[test]
#[ignore = "nightly: eight million texels; quick: environment::table::a_sum_in_floats_forgets_texels_and_in_pairs_it_does_not"]
fn sums_of_large_skies() {
    let mut held = Map::new();
    for cut in [1, 2, 4, 8] {
        let [floats, pairs] = table::offs(cut);
        println!("cut={cut}: floats {floats:.3e}, pairs {pairs:.3e}");
        assert!(pairs.abs() < table::bound_of_pairs(cut), "cut={cut}: {pairs}");
        held.insert(format!("{cut}.floats"), floats.abs().into());
        held.insert(format!("{cut}.pairwise"), pairs.abs().into());
    }
    assert!(held["8.floats"].as_f64() > Some(0.01), "a naive sum is right: {held:?}");
    expected::hold_exact("46_environment/large_sums", held.into());
}
