//! The history of 31 in a window, which begins again where its light would be stale.

use super::desk::{Desk, KEY_F5, wait};
use super::{alone, ended_well};

/// The longest history of the picture, which `show=history length` draws as a part of `memory`: a value of sRGB.
fn longest(desk: &Desk) -> u8 {
    let (picture, _) = desk.picture();
    picture.pixels().map(|pixel| pixel.0[0]).max().unwrap_or_default()
}

/// Histories of 24 and of 8 frames with a memory of 255.
const LONG: u8 = 84;
const SHORT: u8 = 49;

#[test]
#[ignore = "nightly: waits for long histories; quick: samples history_and_filter::exact::a_still_history_is_the_mean_of_its_frames"]
fn a_history_outlives_no_resize_and_no_reload() {
    let _alone = alone();
    let sets = [
        "play=off",
        "motion=still",
        "memory=255",
        "filter passes=0",
        "depth=0",
        "show=history length",
    ];
    let sets = run::set_arguments(&sets);
    let arguments = [&["--validate", "--size", "640x420"], &*sets].concat();
    let desk = Desk::open("31_history_and_filter", &arguments, &[]);
    let grown = || wait("a long history", || (longest(&desk) >= LONG).then_some(()));
    grown();
    desk.resize(660, 430);
    wait("a new history after a resize", || (longest(&desk) < SHORT).then_some(()));
    grown();
    desk.key(KEY_F5);
    wait("a new history after a reload", || (longest(&desk) < SHORT).then_some(()));
    grown();
    desk.close();
    ended_well(desk.end());
}
