//! Displays and cards unlike a software driver on an X server, simulated by the layer `display_faults`.

use std::fs;
use std::path::Path;
use std::process::{Child, Output};
use std::time::Duration;

use run::layer::Layer;
use serde_json::Value;

use super::desk::{Desk, KEY_ESCAPE, wait};
use super::{alone, desk, ended_well, same, xvfb};

/// The counts of a display.
#[derive(Debug, PartialEq)]
struct Counted {
    swapchains: u32,
    acquired: u32,
    presented: u32,
}

/// Opens a sample under the layer with these words, calls `act` with its window, and returns the counts.
fn under(
    mood: &str,
    name: &str,
    arguments: &[&str],
    act: impl FnOnce(&mut Desk),
) -> (Counted, Output) {
    let _alone = alone();
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("told");
    let moods = Layer::display_faults(&format!("{mood},tell={}", file.display()));
    let mut environment = moods.environment();
    environment.push(("RUST_LOG", "raybook=info".into()));
    let environment: Vec<_> =
        environment.iter().map(|(name, value)| (*name, Path::new(value))).collect();
    let mut desk = Desk::begin(name, &[&["--validate"], arguments].concat(), &environment);
    act(&mut desk);
    let output = desk.end();
    let told = std::fs::read_to_string(file).expect("the layer has counted");
    let numbers: Vec<u32> = told.split(' ').map(|number| number.parse().unwrap()).collect();
    let [swapchains, acquired, presented] = numbers[..] else { panic!("{told}") };
    (Counted { swapchains, acquired, presented }, output)
}

/// The numbers of frames and of pictures in the log, after the sample has ended successfully.
fn frames_and_pictures(output: &Output) -> [u32; 2] {
    let log = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && log.lines().count() == 1, "{}: {log}", output.status);
    let (before, after) = log.split_once(" frames of ").expect("a line of the log");
    let number = |text: Option<&str>| text.and_then(|text| text.parse().ok()).expect("a number");
    [number(before.split(' ').next_back()), number(after.split(' ').next())]
}

#[test]
fn a_display_that_calls_every_image_suboptimal_gets_new_ones_once() {
    let arguments = ["--size", "480x300", "--frames", "30"];
    let (counted, output) = under("suboptimal", "02_basic", &arguments, |_| ());
    let [frames, _] = frames_and_pictures(&output);
    assert_eq!(frames, 30);
    assert_eq!(counted, Counted { swapchains: 2, acquired: 30, presented: 30 });
}

#[test]
#[ignore = "nightly: another window; quick: stand_ins::a_display_that_calls_every_image_suboptimal_gets_new_ones_once"]
fn a_resize_is_followed_where_every_image_is_suboptimal() {
    let (counted, output) = under("suboptimal", "02_basic", &["--size", "480x300"], |desk| {
        // A window may be mapped long before it has images, and its first one would then have the new size.
        desk.wait_for_a_picture();
        desk.resize(400, 360);
        let sized = || Some(desk.picture().0).filter(|image| image.dimensions() == (400, 360));
        wait("a picture of the new size", sized);
        desk.close();
    });
    frames_and_pictures(&output);
    assert!((3..=4).contains(&counted.swapchains), "{counted:?}");
}

#[test]
fn what_a_present_did_not_show_is_drawn_again() {
    let arguments = ["--size", "480x300", "--frames", "20"];
    let (counted, output) = under("out-of-date=3", "02_basic", &arguments, |_| ());
    assert_eq!(frames_and_pictures(&output)[0], 20);
    assert_eq!(counted, Counted { swapchains: 2, acquired: 21, presented: 21 });
}

#[test]
#[ignore = "nightly: another window; quick: stand_ins::what_a_present_did_not_show_is_drawn_again"]
fn a_display_may_want_more_images() {
    let arguments = ["--size", "480x300", "--frames", "20"];
    let (counted, output) = under("images=6", "02_basic", &arguments, |_| ());
    assert_eq!(frames_and_pictures(&output)[0], 20);
    assert_eq!(counted, Counted { swapchains: 1, acquired: 20, presented: 20 });
}

/// A picture this small takes a fraction of a millisecond, and the display shows one in 12; on a busy
/// machine, larger ones take as long as that.
#[test]
fn pictures_are_added_to_a_mean_without_waiting_for_the_display() {
    let arguments = ["--size", "16x10", "--frames", "30"];
    let (_, output) = under("fast=30", "04_jitter_camera", &arguments, |_| ());
    let [frames, pictures] = frames_and_pictures(&output);
    println!("{frames} frames of {pictures} pictures");
    assert!(frames == 30 && pictures >= 2 * frames, "{frames} frames of {pictures} pictures");
}

#[test]
fn launches_are_widened_where_a_card_is_too_fast_to_be_timed() {
    let moods = Layer::display_faults("fast=30");
    let mut command = moods.command("02_basic");
    command.args(["--headless", "--size", "120x75", "--frames", "1"]);
    let output = command.args(["--compare", "show=picture|normal"]).output().expect("it starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let table = String::from_utf8(output.stdout).expect("text");
    assert!(table.contains("\n> Launches were widened to "), "{table}");
}

/// A few rays do not fill a card, so more invocations trace the same ones.
#[test]
#[ignore = "nightly: it measures; quick: stand_ins::launches_are_widened_where_a_card_is_too_fast_to_be_timed"]
fn rungs_are_timed_on_a_card_that_is_full() {
    let moods = Layer::display_faults("fast=30");
    let folder = tempfile::tempdir().expect("a folder");
    let mut command = moods.command("24_accuracy");
    command.args(["--headless", "--rays", "16", "--rounds", "1", "--only", "plane", "--measure"]);
    let output = command.arg(folder.path()).output().expect("it starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = fs::read_to_string(folder.path().join("accuracy.json")).expect("it has measured");
    let measured: Value = serde_json::from_str(&text).expect("JSON");
    let times = measured["rungs"].as_array().expect("rungs").iter().map(|rung| &rung["time"]);
    let copies: Vec<_> = times.filter_map(|time| time["copies"].as_u64()).collect();
    assert!(!copies.is_empty() && copies.iter().all(|&copies| copies >= 64), "{measured}");
}

/// For every result of the display: a window that shows its final picture does nothing.
#[test]
fn a_window_at_rest_takes_no_time() {
    windows_at_rest_take_no_time(&["suboptimal"]);
}

#[test]
#[ignore = "nightly: other displays; quick: stand_ins::a_window_at_rest_takes_no_time"]
fn so_it_is_on_other_displays() {
    windows_at_rest_take_no_time(&["images=6", "fast=30"]);
}

fn windows_at_rest_take_no_time(faults: &[&str]) {
    for mood in faults {
        under(mood, "02_basic", &["--size", "480x300"], |desk| {
            let (picture, _) = desk.picture();
            wait("the picture in the window", || same(&desk.shown(), &picture).then_some(()));
            wait("rest", || {
                let before = desk.worked();
                std::thread::sleep(Duration::from_millis(100));
                (desk.worked() == before).then_some(())
            });
            desk.close();
        });
    }
}

/// A screen whose colours have 10 bits.
fn deep_screen() -> (Child, String) {
    xvfb::start(&["-screen", "0", "1600x1000x30"])
}

#[test]
#[ignore = "nightly: another X server; quick: stand_ins::a_window_that_cannot_be_blitted_to_is_refused"]
fn a_window_of_ten_bits_shows_the_picture() {
    let _alone = alone();
    let moods = Layer::display_faults("deep");
    let environment = moods.environment();
    let environment: Vec<_> =
        environment.iter().map(|(name, value)| (*name, Path::new(value))).collect();
    let arguments = ["--validate", "--size", "640x420"];
    let desk = Desk::begin_on(deep_screen(), run::heeding("02_basic"), &arguments, &environment);
    desk.wait_for_a_picture();
    let (picture, _) = desk.picture();
    wait("the picture in the window", || same(&desk.shown(), &picture).then_some(()));
    desk.key(KEY_ESCAPE);
    ended_well(desk.end());
}

#[test]
fn a_window_that_cannot_be_blitted_to_is_refused() {
    let _alone = alone();
    let output = desk::outcome_on(deep_screen(), "02_basic", &["--validate"], &[], |_| ());
    let (_, line) = run::refusal(output);
    let words =
        "this window shows no sRGB colour of 8 bits, nor one of 10 that the device can blit to";
    assert!(line.contains(words), "{line}");
}
