//! Failing Vulkan calls while a window is open: each is reported in one line, or handled.

use std::ffi::OsString;
use std::path::Path;

use run::failures::{all, chapters, each_is_answered, ends};
use run::layer::Layer;

use crate::{alone, desk};

/// Makes calls of a sample's window fail, which shows three frames; returns whether each is handled.
fn is_safe(sample: &str, numbers: impl Fn(usize) -> Vec<usize>) -> bool {
    let run = |layer: &Layer, calls: &Path| {
        let mut environment: Vec<(&str, OsString)> = layer.environment();
        environment.push(("CALLS", calls.into()));
        desk::outcome(sample, &["--size", "160x100", "--frames", "3"], &environment)
    };
    each_is_answered(sample, run, numbers)
}

#[test]
fn the_first_and_the_last_call_of_each_function_may_fail_in_a_window() {
    let _alone = alone();
    assert!(is_safe("02_basic", ends));
}

#[test]
#[ignore = "nightly: every call of every chapter, or of those that CHAPTERS names; quick: failures::the_first_and_the_last_call_of_each_function_may_fail_in_a_window"]
fn every_call_of_every_window_may_fail() {
    let _alone = alone();
    let mut chapters = chapters();
    chapters.retain(|sample| !is_safe(sample, all));
    assert!(chapters.is_empty(), "{chapters:?}");
}
