//! 28_depth_of_field: where rays start on the lens, where they meet, and the blur outside the focus.

mod aperture;
mod circle;
mod focus;
mod mean;
mod plots;
#[allow(dead_code, reason = "37 has other sequences, too")]
#[expect(clippy::duplicate_mod, reason = "to 37 it is a part of its own")]
#[path = "sequences/points.rs"]
mod points;

use run::{Chapter, bits, compiled_for, same_answers, same_colors};

const NAME: &str = "28_depth_of_field";
const SIZE: &str = "240x150";
/// Enough pixels for many points, few enough for many frames.
const SMALL: &str = "64x40";
/// At the origin, looking along -z: a ray's origin is its point on the lens.
const AT_ORIGIN: [&str; 2] = ["camera eye=0,0,0", "camera target=0,0,-1"];
/// A model that looks the same in every chapter.
const MODEL: &str = "samples/assets/chess.obj";

fn chapter(size: &str) -> Chapter {
    Chapter::new(NAME).size(size)
}

#[test]
fn the_picture_repeats() {
    Chapter::new(NAME).frames(16).repeats();
}

#[test]
fn a_lens_of_size_0_gives_the_picture_of_37() {
    let both = ["camera eye=3,4,7", "camera target=0,0.5,0", "seed=5"];
    let pinhole = |more: &[&str], frames: &[&str]| {
        let chapter = Chapter::new("37_sequences").size(SMALL).scene(MODEL).with(frames);
        chapter.sets(&both).sets(&["filter=tent"]).sets(more).picture()
    };
    let lens = |more: &[&str], frames: &[&str]| {
        let chapter = chapter(SMALL).scene(MODEL).with(frames);
        chapter.sets(&both).sets(&["lens diameter=0"]).sets(more).picture()
    };
    let (few, parts) = (["--frames", "3"], ["--samples", "2..5"]);
    let picture = pinhole(&[], &few);
    for focus in ["focus distance=0.01", "focus distance=7", "focus distance=inf"] {
        same_colors(focus, NAME, &lens(&[focus, "blades=0"], &few), &picture);
        same_colors(focus, NAME, &lens(&[focus, "blades=5"], &few), &picture);
    }
    same_colors("the rung of the eye", NAME, &lens(&["rung=eye"], &few), &picture);
    for sets in [
        ["sequence=Halton", "scrambling=rotation", "filter=Blackman-Harris"],
        ["sequence=R2", "scrambling=none", "filter=box"],
        ["sequence=random", "scrambling=Owen", "filter=tent"],
        ["sequence=centre", "scrambling=none", "filter=box"],
    ] {
        same_colors(&format!("{sets:?}"), NAME, &lens(&sets, &few), &pinhole(&sets, &few));
    }
    same_colors("samples", NAME, &lens(&[], &parts), &pinhole(&[], &parts));
    for show in ["show=hit", "show=ray direction"] {
        same_answers(show, NAME, &lens(&[show], &few), &pinhole(&[show], &few));
    }
    // A lens with a size gives another picture; otherwise the comparison would be vacuous.
    let wide = lens(&["lens diameter=0.2"], &few);
    assert_ne!(bits(&wide), bits(&picture), "the lens does nothing");
}

#[test]
#[ignore = "nightly: compiles for a GPU; quick: gpus budgets::no_chapter_costs_a_gpu_more_than_is_recorded"]
fn its_program_spills_no_register() {
    for rung in ["world", "eye", "start"] {
        let set = format!("rung={rung}");
        let Some(programs) = compiled_for(NAME, "navi31", &["--set", &set]) else { return };
        assert_eq!(programs.len(), 1, "rays do not nest: one program");
        assert_eq!(programs[0]["spilled_registers"], 0, "{}", programs[0]);
    }
}
