//! Nothing of the past is left where it would be stale: a picture after a cut is that of a fresh start.

use common::app::Picture;
use run::{Chapter, bits};

use super::NAME;

/// The frame that follows the cut.
const FRAME: u32 = 3;

fn chapter() -> Chapter {
    Chapter::new(NAME).size("64x40")
}

/// The first picture with these settings, of the moment at which the cut ends.
fn fresh(sets: &[&str]) -> Picture {
    chapter().set("frame", FRAME).sets(sets).picture()
}

/// The picture of that frame with the past before it, where the settings change just before it.
fn after(sets: &[&str]) -> Picture {
    let then: Vec<String> = sets.iter().map(|set| format!("{FRAME}:{set}")).collect();
    let then: Vec<&str> = then.iter().flat_map(|set| ["--then", set]).collect();
    chapter().frames(FRAME + 1).with(&then).picture()
}

#[test]
fn a_cut_leaves_no_history() {
    let cuts: [&[&str]; 4] = [
        // From the other side, and the same view from afar.
        &["camera eye=-6,3,4"],
        &["camera eye=17,8,-9"],
        // Another time of the motion, before or after.
        &["frame=400"],
        &["scene=furnace"],
    ];
    for cut in cuts {
        assert!(bits(&after(cut)) == bits(&fresh(cut)), "{cut:?}");
    }
    // A camera that moves on keeps what it has seen.
    let move_on = &["camera eye=6.4,2.6,-2.7"];
    assert!(
        bits(&after(move_on)) != bits(&fresh(move_on)),
        "a history starts again without a reason"
    );
}

/// Nothing moves in a pause, so that each pixel finds itself.
#[test]
fn a_pause_stops_all_movement() {
    let paused = format!("{FRAME}:play=off");
    let sets = ["show=movement", "depth=0"];
    let picture = chapter().sets(&sets).frames(FRAME + 2).with(&["--then", &paused]).picture();
    let moved = picture.pixels.iter().flat_map(|pixel| [pixel[0], pixel[1]]);
    let most = moved.map(f32::abs).fold(0.0, f32::max);
    println!("{most} pixels");
    assert!(most < 1e-3, "{most} pixels");
    assert!(picture.pixels.iter().any(|pixel| pixel[2] > 0.99), "nothing was found");
}
