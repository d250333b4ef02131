//! Failing Vulkan calls: each is reported in one line, and nothing is leaked or freed too early.

use std::path::Path;
use std::process::Output;

use run::failures::{all, chapters, each_is_answered, ends};
use run::layer::Layer;

const TIMEOUT: i32 = 2;

/// Runs a sample under a layer that counts its calls in a file.
fn counted(sample: &str, layer: &Layer, calls: &Path) -> Output {
    let mut command = layer.command(sample);
    command.args(["--headless", "--size", "8x8"]).env("CALLS", calls);
    command.arg("--out").arg(calls.with_extension("png")).output().expect("the sample starts")
}

/// Makes calls of a sample fail; returns whether each is reported.
fn is_safe(sample: &str, numbers: impl Fn(usize) -> Vec<usize>) -> bool {
    each_is_answered(sample, |layer, calls| counted(sample, layer, calls), numbers)
}

#[test]
fn the_first_and_the_last_call_of_each_function_may_fail() {
    assert!(is_safe("01_foundation", ends));
    // In addition to the framework's usual objects, it has a compute shader, updates and copies.
    assert!(is_safe("14_animation", ends));
}

#[test]
fn on_a_card_with_memory_of_its_own_the_first_and_the_last_may_fail_too() {
    assert!(is_safe_on_a_card(ends));
}

#[test]
#[ignore = "nightly: every call; quick: failures::on_a_card_with_memory_of_its_own_the_first_and_the_last_may_fail_too"]
fn on_a_card_with_memory_of_its_own_each_of_them_may_fail_too() {
    assert!(is_safe_on_a_card(all));
}

/// Uploads go to device memory the host can map, or to host memory if there is no room.
fn is_safe_on_a_card(numbers: impl Fn(usize) -> Vec<usize>) -> bool {
    let card = Layer::minimum_limits("bar");
    let run = |layer: &Layer, calls: &Path| {
        let mut command = run::command("02_basic");
        command.envs(layer.above(&card)).env("CALLS", calls);
        command.args(["--headless", "--size", "8x8", "--out"]).arg(calls.with_extension("png"));
        command.output().expect("the sample starts")
    };
    each_is_answered("02_basic", run, numbers)
}

#[test]
#[ignore = "nightly: every call of every chapter, or of those that CHAPTERS names; quick: failures::the_first_and_the_last_call_of_each_function_may_fail"]
fn every_call_of_every_chapter_may_fail() {
    let mut chapters = chapters();
    chapters.retain(|sample| !is_safe(sample, all));
    assert!(chapters.is_empty(), "{chapters:?}");
}

/// Runs a sample with a failing call.
fn run(sample: &str, fault: &str) -> Output {
    let folder = tempfile::tempdir().unwrap();
    counted(sample, &Layer::fail_nth_call(fault), &folder.path().join("calls"))
}

#[test]
fn a_device_that_is_never_to_be_waited_for_ends_the_process_in_one_line() {
    let output = run("02_basic", "vkWaitForFences:1+:-1");
    let (code, line) = run::refusal(output);
    assert_eq!(code, 1);
    assert!(line.contains("cannot be waited for"), "{line}");
}

#[test]
fn a_device_that_does_not_answer_ends_the_process_in_one_line() {
    for sample in ["01_foundation", "02_basic"] {
        let output = run(sample, &format!("vkWaitForFences:1:{TIMEOUT}"));
        let (code, line) = run::refusal(output);
        assert_eq!(code, 1);
        assert!(line.contains("has not answered for "), "{line}");
    }
}

#[test]
fn memory_that_is_mapped_nowhere_is_not_written_to() {
    let (code, line) = run::refusal(run("02_basic", "vkMapMemory:1:0"));
    assert_eq!(code, 1);
    assert!(line.contains("no address space for the buffer '"), "{line}");
}
