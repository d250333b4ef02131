//! The light that stays behind a moving shadow, without noise: the sun alone, as a point.

use common::app::Picture;
use run::expected;
use serde_json::{Value, json};

use super::{NO_NOISE, PLAIN, chapter, colors};

const MEMORY: u32 = 4;
const FRAMES: u32 = 12;

fn with_sun() -> run::Chapter {
    chapter().size("160x100").set("motion", "sun").sets(&NO_NOISE)
}

fn truth(frame: u32) -> Picture {
    with_sun().set("frame", frame).sets(&PLAIN).picture()
}

/// The history of a surface that stands still is the mean of all that was there, each frame's light weighted by its age.
/// So a shadow that passed n frames ago has left the part (1 - 1/N)^n of the old light behind, and the page's table
/// follows.
#[test]
fn a_shadow_leaves_light_behind_as_long_as_the_memory() {
    let mut means: Vec<f64> = colors(&truth(0)).collect();
    let mut changed = 0;
    for frame in 1..FRAMES {
        let count = f64::from((frame + 1).min(MEMORY));
        for (mean, color) in means.iter_mut().zip(colors(&truth(frame))) {
            *mean += (color - *mean) / count;
        }
    }
    let now: Vec<f64> = colors(&truth(FRAMES - 1)).collect();
    let history = with_sun().set("memory", MEMORY).frames(FRAMES).picture();
    for (at, color) in colors(&history).enumerate() {
        changed += usize::from((means[at] - now[at]).abs() > 0.1);
        // The previous pixel is off by some 10^-5 pixels, and so much of a neighbour's light comes in.
        assert!((color - means[at]).abs() < 1e-3, "pixel {}: {color} {}", at / 3, means[at]);
    }
    println!("{changed} colours still show a shadow that has moved on");
    assert!(changed > 20, "{changed}");

    let part = |frames: u32, memory: u32| {
        let left = (1.0 - 1.0 / f64::from(memory)).powi(frames as i32);
        (format!("{frames}.{memory}"), json!(left))
    };
    let frames = [1, 4, 8, 16, 32].into_iter();
    let held = frames.flat_map(|frames| [8, 32, 128].map(|memory| part(frames, memory)));
    expected::hold_exact("31_history_and_filter/ghosts", Value::Object(held.collect()));
}
