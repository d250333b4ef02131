//! A window whose device is lost: it says so, and goes on with another where it was.

use std::path::Path;

use run::layer::Layer;

use crate::desk::{Desk, KEY_ESCAPE, KEY_F1, KEY_PERIOD, KEY_RETURN, wait};
use crate::{DEVICE_LOST, LIGHT_SHADOWS, SLIDER, alone, same, tells_error};

const SMALL: [&str; 2] = ["--size", "640x420"];

/// A sample that loses its device in the next call of a function, once that is asked for.
struct Losing {
    desk: Desk,
    folder: tempfile::TempDir,
    _layer: Layer,
}

/// The way to open a sample: with arguments and environment.
type Open = fn(&str, &[&str], &[(&str, &Path)]) -> Desk;

impl Losing {
    fn open(name: &str, more: &[&str], function: &str) -> Self {
        Self::by(Desk::open, false, name, more, function)
    }

    /// One that loses its device in the first call.
    fn from_the_start(name: &str, more: &[&str], function: &str) -> Self {
        Self::by(Desk::begin, true, name, more, function)
    }

    fn by(open: Open, at_once: bool, name: &str, more: &[&str], function: &str) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let [fault, calls] = ["fault", "calls"].map(|name| folder.path().join(name));
        if at_once {
            std::fs::write(&fault, "").expect("a file");
        }
        let layer = Layer::failing(&format!("{function}:{}:{DEVICE_LOST}", fault.display()));
        let environment = layer.environment();
        let mut environment: Vec<_> =
            environment.iter().map(|(name, value)| (*name, Path::new(value))).collect();
        environment.push(("CALLS", &calls));
        let arguments = [&["--validate"], more].concat();
        let desk = open(name, &arguments, &environment);
        Self { desk, folder, _layer: layer }
    }

    /// Loses the device, and waits for the offer to go on.
    fn lose(&self) {
        std::fs::write(self.folder.path().join("fault"), "").expect("a file");
        self.desk.key(KEY_F1);
        self.is_offered();
    }

    /// Waits for the offer to go on. Nothing of the old device is there any more: its instance is destroyed, and
    /// validation would have told of what had not been.
    fn is_offered(&self) {
        wait("the offer", || self.desk.named().ends_with("the device was lost").then_some(()));
        wait("its words", || tells_error(&self.desk).then_some(()));
        let calls = self.folder.path().join("calls");
        assert!(calls.exists(), "the old instance is there still");
        std::fs::remove_file(calls).expect("it is a file");
    }

    /// Takes the offer.
    fn go_on(&self) {
        self.desk.key(KEY_RETURN);
        wait("the sample", || (!self.desk.named().contains("lost")).then_some(()));
    }
}

#[test]
fn a_window_goes_on_with_another_device_where_it_was() {
    let _alone = alone();
    let functions =
        ["vkQueueSubmit2", "vkWaitForFences", "vkQueuePresentKHR", "vkAcquireNextImageKHR"];
    for function in functions {
        let losing = Losing::open("02_basic", &SMALL, function);
        let desk = &losing.desk;
        desk.drag((500, 300), (400, 260), 10);
        desk.drag(SLIDER[0], SLIDER[1], 10);
        let (before, _) = desk.picture();
        for _ in 0..2 {
            losing.lose();
            losing.go_on();
            let (after, _) = desk.picture();
            assert!(
                same(&before, &after),
                "{function}: the camera or a control is not what it was"
            );
        }
        desk.close();
        let output = losing.desk.end();
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{function}: {said}");
        assert_eq!(said.lines().count(), 2, "a line for each loss: {said}");
        for line in said.lines() {
            assert!(
                line.starts_with("warning: ") && line.contains("Enter in the window"),
                "{line}"
            );
        }
    }
}

/// In 08 the pipeline is made for the first picture.
#[test]
fn a_device_may_be_lost_before_the_first_picture() {
    let _alone = alone();
    let losing =
        Losing::from_the_start("08_intersection", &SMALL, "vkCreateRayTracingPipelinesKHR");
    losing.is_offered();
    losing.go_on();
    losing.desk.picture();
    losing.desk.close();
    let output = losing.desk.end();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn an_animation_goes_on_where_it_was() {
    let _alone = alone();
    let losing =
        Losing::open("14_animation", &[SMALL[0], SMALL[1], "--set", "play=off"], "vkQueueSubmit2");
    let desk = &losing.desk;
    let (start, _) = desk.picture();
    for _ in 0..7 {
        desk.key(KEY_PERIOD);
    }
    let before = wait("another time", || {
        let (shown, _) = desk.picture();
        (!same(&start, &shown)).then_some(shown)
    });
    losing.lose();
    losing.go_on();
    assert!(same(&before, &desk.picture().0), "the time is not what it was");
    desk.close();
    let output = losing.desk.end();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

/// In 25 another pipeline is made in the background for other controls.
#[test]
fn a_device_may_be_lost_while_a_pipeline_is_made() {
    let _alone = alone();
    let losing = Losing::open(
        "25_scene_effects",
        &["--size", "800x700", "--set", "scene=opening"],
        "vkQueueSubmit2",
    );
    let desk = &losing.desk;
    for _ in 0..3 {
        let (x, y) = LIGHT_SHADOWS;
        desk.drag((x, y), (x, y), 1);
        losing.lose();
        losing.go_on();
    }
    desk.picture();
    desk.close();
    let output = losing.desk.end();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn whoever_does_not_go_on_leaves_with_the_error() {
    let _alone = alone();
    let losing = Losing::open("02_basic", &SMALL, "vkQueueSubmit2");
    losing.lose();
    losing.desk.key(KEY_ESCAPE);
    let output = losing.desk.end();
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!((output.status.code(), said.lines().count()), (Some(1), 2), "{said}");
    let last = said.lines().last().unwrap_or_default();
    assert!(last.starts_with("error: the device failed while it worked: "), "{last}");
}

#[test]
fn a_device_that_is_lost_again_and_again_ends_the_window() {
    let _alone = alone();
    // From the second frame on, however many bands a frame has: that depends on how busy the machine is.
    let moving = ["--size", "160x100", "--set", "play=on"];
    let layer = Layer::failing(&format!("vkQueuePresentKHR:2+:{DEVICE_LOST}"));
    let output = crate::desk::outcome("14_animation", &moving, &layer.environment());
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.lines().filter(|line| line.starts_with("error: ")).count() == 1, "{said}");
}

#[test]
fn the_offer_can_be_resized_and_minimised() {
    let _alone = alone();
    let losing = Losing::open("02_basic", &SMALL, "vkQueueSubmit2");
    losing.lose();
    for (width, height) in [(300, 200), (1, 1), (700, 500)] {
        losing.desk.resize(width, height);
        wait("the size", || (losing.desk.shown().width() == width).then_some(()));
    }
    losing.desk.map(false);
    losing.desk.map(true);
    wait("its words", || tells_error(&losing.desk).then_some(()));
    losing.go_on();
    losing.desk.picture();
    losing.desk.close();
    let output = losing.desk.end();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn a_window_whose_frames_are_counted_ends_with_its_device() {
    let _alone = alone();
    let layer = Layer::failing(&format!("vkQueuePresentKHR:2:{DEVICE_LOST}"));
    let arguments = ["--size", "160x100", "--frames", "3"];
    let output = crate::desk::outcome("02_basic", &arguments, &layer.environment());
    assert_eq!(run::refusal(output).0, 1);
}
