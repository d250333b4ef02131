//! The histories of 31 and 32 in a window, which begin again where their light would be stale.

use std::path::Path;

use image::RgbImage;

use super::desk::{Desk, KEY_F5, wait};
use super::{alone, copy_shaders, ended_well};

const HISTORY: &str = "31_history_and_filter";

/// Checks that the longest history, which the brightest red of the picture shows, falls after a resize and a reload.
/// `long` is the sRGB value of 24 frames, `short` that of 8.
fn a_history_is_left_behind(name: &str, sets: &[&str], [long, short]: [u8; 2]) {
    let _alone = alone();
    let arguments = [&["--validate", "--size", "640x420"], &*run::set_arguments(sets)].concat();
    // The first picture may have one colour, so that it does not look like a picture.
    let desk = Desk::begin(name, &arguments, &[]);
    let longest = || {
        let (picture, _) = desk.picture();
        picture.pixels().map(|pixel| pixel.0[0]).max().unwrap_or_default()
    };
    let grown = || wait("a long history", || (longest() >= long).then_some(()));
    let fallen = |why: &str| wait(why, || (longest() < short).then_some(()));
    grown();
    desk.resize(660, 430);
    fallen("a new history after a resize");
    grown();
    desk.key(KEY_F5);
    fallen("a new history after a reload");
    grown();
    desk.close();
    ended_well(desk.end());
}

/// `show=history length` draws the length as a part of `memory`.
#[test]
#[ignore = "nightly: waits for long histories; quick: history::a_reload_leaves_no_light_of_the_old_shader"]
fn a_history_outlives_no_resize_and_no_reload() {
    let sets = ["play=off", "motion=still", "memory=255", "filter passes=0", "depth=0"];
    a_history_is_left_behind(HISTORY, &[&sets[..], &["show=history length"]].concat(), [84, 49]);
}

/// `show=count` draws the count of a reservoir as a part of 1,024.
#[test]
#[ignore = "nightly: waits for long histories; quick: samples reservoirs::state::a_cut_leaves_no_reservoirs"]
fn reservoirs_outlive_no_resize_and_no_reload() {
    let sets = ["reuse=time", "jitter=off", "candidates=1", "cap=1000", "show=count"];
    a_history_is_left_behind("32_reservoirs", &sets, [42, 22]);
}

/// Without noise, each picture with the new shader is the first one: a longer history is a mean of equal pictures.
#[test]
fn a_reload_leaves_no_light_of_the_old_shader() {
    let _alone = alone();
    let copy = tempfile::tempdir().expect("a temporary folder");
    copy_shaders(copy.path(), &["common", HISTORY]);
    let sets = ["play=off", "motion=still", "memory=255", "filter passes=0"];
    let no_noise = ["depth=0", "light size=0", "sky=black"];
    let sets = run::set_arguments(&[&sets[..], &no_noise].concat());
    let arguments = [&["--size", "240x150"], &*sets].concat();
    let desk = Desk::begin(HISTORY, &arguments, &[("SHADERS", copy.path())]);
    let (before, _) = desk.picture();
    let (from, to) = ("luminance(path.color);", "luminance(path.color *= 0.25);");
    run::replace_line(copy.path(), "31_history_and_filter/camera.rgen", from, to);
    let darker = || Some(desk.picture().0).filter(|picture| !near(picture, &before));
    let after = wait("darker light", darker);
    assert!(near(&after, &rendered(copy.path(), &arguments)), "light of the old shader is left");
    desk.close();
    ended_well(desk.end());
}

/// The picture of a run without a window.
fn rendered(shaders: &Path, arguments: &[&str]) -> RgbImage {
    let file = shaders.join("rendered.png");
    let mut headless = run::command(HISTORY);
    headless.env("SHADERS", shaders).arg("--headless").args(arguments).arg("--out").arg(&file);
    let output = headless.output().expect("the sample starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    image::open(file).expect("a whole PNG").to_rgb8()
}

/// Returns whether all pixels are equal except for rounding.
fn near(a: &RgbImage, b: &RgbImage) -> bool {
    let mut pairs = a.iter().zip(b.iter());
    a.dimensions() == b.dimensions() && pairs.all(|(a, b)| a.abs_diff(*b) <= 1)
}
