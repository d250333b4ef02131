//! The light that stays behind a moving shadow, without noise: the sun alone, as a point.

use common::app::Picture;
use serde_json::{Map, json};

use super::{NO_NOISE, PLAIN, chapter};
use run::expected;

/// A frame in which the longest history is full.
const FRAME: u32 = 140;

fn truth(frame: u32) -> Picture {
    let sets = [format!("frame={frame}"), "motion=sun".to_owned()];
    chapter().sets(&sets).sets(&NO_NOISE).sets(&PLAIN).picture()
}

fn history(memory: u32) -> Picture {
    let sets = [format!("memory={memory}"), "motion=sun".to_owned()];
    chapter().sets(&sets).sets(&NO_NOISE).frames(FRAME + 1).picture()
}

/// The old light that is left in pixels whose light last changed so many frames ago, from 0 to 1, and their number.
fn left(history: &Picture, now: &Picture, before: &Picture, after: &Picture) -> (f64, usize) {
    let (mut left, mut whole, mut count) = (0.0, 0.0, 0);
    for index in 0..now.pixels.len() {
        let [history, now, before, after] =
            [history, now, before, after].map(|picture| f64::from(picture.pixels[index][0]));
        // A shadow's edge passed between the two frames. Since then only the angle of the sun has changed.
        let is_edge = before.min(after) == 0.0 && before.max(after) > 0.05;
        if is_edge && (now == 0.0) == (after == 0.0) {
            let old = before.max(now);
            left += if now == 0.0 { history } else { now - history };
            whole += old;
            count += 1;
        }
    }
    (left / whole, count)
}

/// A mean over N frames keeps the part 1 - 1/N of the old light in each further frame.
#[test]
fn a_shadow_leaves_its_light_behind_as_long_as_the_memory() {
    let now = truth(FRAME);
    let memories = [8, 32, 128];
    let histories = memories.map(history);
    let mut held = Map::new();
    for frames in [1, 4, 8, 16, 32] {
        let [before, after] = [FRAME - frames, FRAME - frames + 1].map(truth);
        for (memory, history) in memories.iter().zip(&histories) {
            let (left, count) = left(history, &now, &before, &after);
            let expected = (1.0 - 1.0 / f64::from(*memory)).powi(frames as i32);
            println!("memory {memory}, {frames} frames: {left:.3} of {count}, not {expected:.3}?");
            assert!(count > 20, "{count} pixels");
            // The sun's angle changes meanwhile, and neighbours across the edge are mixed in.
            assert!((left - expected).abs() < 0.12, "{memory}, {frames}: {left} {expected}");
            held.insert(format!("{frames}.{memory}"), json!(left));
            held.insert(format!("{frames}.{memory}_theory"), json!(expected));
        }
    }
    expected::hold("31_history_and_filter/ghosts", held.into());
}
