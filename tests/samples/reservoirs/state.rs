//! Counts, weights and histories: exact, finite, and never those of another scene.

use std::fs;
use std::io::Cursor;

use image::AnimationDecoder;
use image::codecs::png::PngDecoder;
use run::{Chapter, bits, command};

use super::{NAME, chapter, colors, mean};

/// The counts of all pixels with a receiver.
fn counts(sets: &[&str], frames: u32) -> Vec<f64> {
    let still = ["show=count", "jitter=off", "reuse=time"];
    let picture = chapter().sets(&still).sets(sets).frames(frames).picture();
    let counts = picture.pixels.iter().map(|pixel| f64::from(pixel[0]) * 1024.0);
    counts.filter(|&count| count > 0.0).collect()
}

/// They are whole numbers, so that adding one to a large one is exact, and the cap keeps their sums far below 2^32.
#[test]
fn counts_are_those_of_the_frames_up_to_the_cap() {
    for (sets, frames, expected) in [
        (["candidates=256", "cap=1000"], 5, 5.0 * 256.0),
        (["candidates=8", "cap=3"], 6, 8.0 + 3.0 * 8.0),
    ] {
        let counts = counts(&sets, frames);
        assert!(counts.len() > 1500, "{}", counts.len());
        // A surface seen at its edge may have started again.
        let same = counts.iter().filter(|&&count| count == expected).count();
        assert!(same * 100 > counts.len() * 99, "{sets:?}: {same} of {}", counts.len());
        assert!(counts.iter().all(|&count| count <= expected), "{sets:?}");
    }
}

#[test]
fn all_light_is_finite() {
    for scene in ["chess", "furnace", "closed room", "low ball"] {
        let sets = ["candidates=1", "neighbours=2"];
        let chapter = Chapter::new(NAME).size("32x20").set("scene", scene).sets(&sets);
        let all: Vec<f64> = colors(&chapter.frames(3).picture()).collect();
        assert!(all.iter().all(|color| color.is_finite() && *color >= 0.0), "{scene}");
        assert!(mean(all.iter().copied()) > 0.0, "{scene} is black");
    }
}

/// Samples are chosen at random, so a rounding may choose another one; but the light is the same.
#[test]
#[ignore = "nightly: compiles all shaders in the worst arithmetic; quick: reservoirs::state::all_light_is_finite"]
fn the_worst_arithmetic_changes_no_light() {
    let of = |arithmetic: &[&str]| {
        let sets = ["reuse=both", "sky=black"];
        mean(colors(
            &Chapter::new(NAME).size("48x30").sets(&sets).frames(3).with(arithmetic).picture(),
        ))
    };
    let (plain, worst) = (of(&[]), of(&["--arithmetic", "worst"]));
    println!("{plain} {worst}");
    assert!((plain / worst - 1.0).abs() < 0.02, "{plain} {worst}");
}

/// A picture after a cut is that of a fresh start; a camera that moves on keeps its reservoirs.
#[test]
fn a_cut_leaves_no_reservoirs() {
    let here = || Chapter::new(NAME).size("48x30");
    let both = |set: &str| {
        let after = here().frames(3).with(&["--then", &format!("2:{set}")]).picture();
        (bits(&after), bits(&here().sets(&[set]).picture()))
    };
    for cut in ["camera eye=7,2,-3", "camera target=9,0.5,3", "scene=chess", "seed=5"] {
        let (after, fresh) = both(cut);
        assert!(after == fresh, "{cut}");
    }
    let (after, fresh) = both("camera eye=-7.3,2.6,3.6");
    assert!(after != fresh, "the reservoirs start again without a reason");
}

/// `--animate` writes the frames that `--frames` renders: the camera turns from one to the next.
#[test]
fn a_turn_can_be_animated() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let written = |name: &str, more: &[&str]| {
        let file = folder.path().join(name);
        let mut run = command(NAME);
        run.args(["--headless", "--size", "48x30", "--set", "turn=8"]).args(more);
        let output = run.arg("--out").arg(&file).output().expect("it starts");
        let errors = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success() && errors.is_empty(), "{errors}");
        fs::read(file).expect("a picture")
    };
    let all = written("all.png", &["--animate", "--frames", "3"]);
    let decoder = PngDecoder::new(Cursor::new(all)).expect("a PNG");
    let frames = decoder.apng().expect("an animation").into_frames().collect_frames();
    let frames = frames.expect("whole frames");
    for (number, frame) in (1..).zip(&frames) {
        let one = written("one.png", &["--frames", &number.to_string()]);
        let one = image::load_from_memory(&one).expect("a PNG").to_rgba8();
        assert!(*frame.buffer() == one, "frame {number}");
    }
    assert_eq!(frames.len(), 3);
}
