//! A window whose device is lost ends with one line and exit code 1, and does not hang.

use std::path::Path;
use std::process::Output;

use run::layer::Layer;

use crate::desk::{Desk, KEY_F1, KEY_PERIOD, wait};
use crate::{DEVICE_LOST, LIGHT_SHADOWS, alone, same};

const SMALL: [&str; 2] = ["--size", "640x420"];

/// A sample that loses its device in the next call of a function, on request.
struct Losing {
    desk: Desk,
    folder: tempfile::TempDir,
    _layer: Layer,
}

impl Losing {
    fn open(name: &str, more: &[&str], function: &str) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let [fault, calls] = ["fault", "calls"].map(|name| folder.path().join(name));
        let layer = Layer::fail_nth_call(&format!("{function}:{}:{DEVICE_LOST}", fault.display()));
        let environment = layer.environment();
        let mut environment: Vec<_> =
            environment.iter().map(|(name, value)| (*name, Path::new(value))).collect();
        environment.push(("CALLS", &calls));
        let arguments = [&["--validate"], more].concat();
        let desk = Desk::open(name, &arguments, &environment);
        Self { desk, folder, _layer: layer }
    }

    /// Loses the device, and waits for the end: one line, and every object of the device is destroyed,
    /// because otherwise validation would have reported it.
    fn lose(self) {
        std::fs::write(self.folder.path().join("fault"), "").expect("a file");
        self.desk.key(KEY_F1);
        is_told(&self.desk.end());
        assert!(self.folder.path().join("calls").exists(), "the instance is not destroyed");
    }
}

/// Checks for one line about a lost device, and exit code 1.
#[track_caller]
fn is_told(output: &Output) {
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!((output.status.code(), said.lines().count()), (Some(1), 1), "{said}");
    assert!(said.starts_with("error: ") && said.contains("device has been lost"), "{said}");
}

#[test]
#[ignore = "nightly: four windows; quick: lost::a_window_whose_frames_are_counted_ends_with_its_device"]
fn a_window_ends_in_one_line_wherever_its_device_is_lost() {
    let _alone = alone();
    let functions =
        ["vkQueueSubmit2", "vkWaitForFences", "vkQueuePresentKHR", "vkAcquireNextImageKHR"];
    for function in functions {
        println!("{function}");
        Losing::open("02_basic", &SMALL, function).lose();
    }
}

/// In 08, the pipeline is created for the first picture.
#[test]
fn a_device_may_be_lost_before_the_first_picture() {
    let _alone = alone();
    let layer = Layer::fail_nth_call(&format!("vkCreateRayTracingPipelinesKHR:1:{DEVICE_LOST}"));
    is_told(&crate::desk::outcome("08_intersection", &SMALL, &layer.environment()));
}

#[test]
#[ignore = "nightly: two windows; quick: lost::a_window_whose_frames_are_counted_ends_with_its_device"]
fn a_device_may_be_lost_in_an_animation() {
    let _alone = alone();
    let losing =
        Losing::open("14_animation", &[SMALL[0], SMALL[1], "--set", "play=off"], "vkQueueSubmit2");
    let desk = &losing.desk;
    let (start, _) = desk.picture();
    for _ in 0..7 {
        desk.key(KEY_PERIOD);
    }
    wait("another time", || (!same(&start, &desk.picture().0)).then_some(()));
    losing.lose();
    // While it plays: from the second frame on, whatever the number of bands, which depends on how busy the
    // machine is.
    let moving = ["--size", "160x100", "--set", "play=on"];
    let layer = Layer::fail_nth_call(&format!("vkQueuePresentKHR:2+:{DEVICE_LOST}"));
    is_told(&crate::desk::outcome("14_animation", &moving, &layer.environment()));
}

/// In 25, another pipeline is created in the background for other controls.
#[test]
#[ignore = "nightly: a large window; quick: lost::a_window_whose_frames_are_counted_ends_with_its_device"]
fn a_device_may_be_lost_while_a_pipeline_is_made() {
    let _alone = alone();
    let losing = Losing::open(
        "25_scene_effects",
        &["--size", "800x700", "--set", "scene=opening"],
        "vkQueueSubmit2",
    );
    losing.desk.drag(LIGHT_SHADOWS, LIGHT_SHADOWS, 1);
    losing.lose();
}

#[test]
fn a_window_whose_frames_are_counted_ends_with_its_device() {
    let _alone = alone();
    let layer = Layer::fail_nth_call(&format!("vkQueuePresentKHR:2:{DEVICE_LOST}"));
    let arguments = ["--size", "160x100", "--frames", "3"];
    let output = crate::desk::outcome("02_basic", &arguments, &layer.environment());
    assert_eq!(run::refusal(output).0, 1);
}
