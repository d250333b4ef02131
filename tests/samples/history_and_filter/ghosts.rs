//! The light that stays behind a moving shadow, without noise: the sun alone, as a point.

use common::app::Picture;
use serde_json::{Value, json};

use super::{NO_NOISE, PLAIN, chapter};
use run::expected;

fn truth(size: &str, frame: u32) -> Picture {
    let sets = [format!("frame={frame}"), "motion=sun".to_owned()];
    chapter().size(size).sets(&sets).sets(&NO_NOISE).sets(&PLAIN).picture()
}

fn history(size: &str, memory: u32, frame: u32) -> Picture {
    let sets = [format!("memory={memory}"), "motion=sun".to_owned()];
    chapter().size(size).sets(&sets).sets(&NO_NOISE).frames(frame + 1).picture()
}

/// The old light that is left in pixels whose light changed between two frames, from 0 to 1, and their number. `before`
/// is the last of the frames before that and some earlier ones: the old light must have lasted.
fn left(history: &Picture, now: &Picture, before: &[Picture], after: &Picture) -> (f64, usize) {
    let (mut left, mut whole, mut count) = (0.0, 0.0, 0);
    for index in 0..now.pixels.len() {
        let red = |picture: &Picture| f64::from(picture.pixels[index][0]);
        let (history, now, after) = (red(history), red(now), red(after));
        let was_dark = red(&before[0]) == 0.0;
        let lasted = before.iter().all(|picture| (red(picture) == 0.0) == was_dark);
        let is_edge = (after == 0.0) != was_dark && (now == 0.0) == (after == 0.0);
        let old = red(&before[0]).max(now);
        if is_edge && lasted && old > 0.05 {
            // Since then, only the angle of the sun has changed.
            left += if now == 0.0 { history } else { now - history };
            whole += old;
            count += 1;
        }
    }
    (left / whole, count)
}

/// A mean over N frames keeps the part 1 - 1/N of the old light in each further frame. Returns the measured parts for
/// each number of frames since and each memory; `lasted` has the times before the change at which the light is
/// compared.
fn compare(
    size: &str,
    end: u32,
    (since, lasted): (&[u32], &[u32]),
    memories: &[u32],
) -> Vec<(u32, u32, f64)> {
    let now = truth(size, end);
    let histories: Vec<_> = memories.iter().map(|&memory| history(size, memory, end)).collect();
    let mut all = Vec::new();
    for &frames in since {
        let after = truth(size, end - frames + 1);
        let before: Vec<_> =
            lasted.iter().map(|&earlier| truth(size, end - frames - earlier)).collect();
        for (&memory, history) in memories.iter().zip(&histories) {
            let (left, count) = left(history, &now, &before, &after);
            let expected = (1.0 - 1.0 / f64::from(memory)).powi(frames as i32);
            println!("memory {memory}, {frames} frames: {left:.3} of {count}, not {expected:.3}?");
            assert!(count >= 8, "{count} pixels");
            // The sun's angle changes meanwhile, and neighbours across the edge are mixed in.
            assert!((left - expected).abs() < 0.1, "{memory}, {frames}: {left} {expected}");
            all.push((memory, frames, left));
        }
    }
    all
}

#[test]
fn a_shadow_leaves_its_light_behind() {
    compare("160x100", 30, (&[2, 6], &[0, 4, 8, 12, 20]), &[8]);
}

#[test]
#[ignore = "nightly: 460 frames, for a table of the page; quick: history_and_filter::ghosts::a_shadow_leaves_its_light_behind"]
fn for_as_long_as_the_memory() {
    let all = compare("240x150", 152, (&[1, 4, 8, 16, 32], &[0, 4, 8, 16, 32, 64, 112]), &[8, 32, 128]);
    let held =
        all.into_iter().map(|(memory, frames, left)| (format!("{frames}.{memory}"), json!(left)));
    expected::hold("31_history_and_filter/ghosts", Value::Object(held.collect()));
}
