//! Calls of Vulkan that fail: each is answered in one line, and nothing is left or freed too early.

use std::fs;
use std::process::{Command, Output};

use run::layer::Layer;

const OUT_OF_HOST_MEMORY: i32 = -1;
const OUT_OF_DEVICE_MEMORY: i32 = -2;
const INITIALIZATION_FAILED: i32 = -3;
const DEVICE_LOST: i32 = -4;
const MEMORY_MAP_FAILED: i32 = -5;

/// What a function may return, by the specification, that is treated differently here.
fn results(function: &str) -> &'static [i32] {
    match function {
        "vkQueueSubmit2" | "vkWaitForFences" | "vkDeviceWaitIdle" | "vkGetQueryPoolResults" => {
            &[OUT_OF_HOST_MEMORY, DEVICE_LOST]
        }
        "vkCreateDevice" => &[OUT_OF_HOST_MEMORY, INITIALIZATION_FAILED, DEVICE_LOST],
        "vkAllocateMemory" => &[OUT_OF_HOST_MEMORY, OUT_OF_DEVICE_MEMORY],
        "vkMapMemory" => &[OUT_OF_HOST_MEMORY, MEMORY_MAP_FAILED],
        _ => &[OUT_OF_HOST_MEMORY],
    }
}

/// Functions without which a run can do: their failures may go unsaid.
const NEEDLESS: [&str; 5] = [
    "vkCreatePipelineCache",
    "vkGetPipelineCacheData",
    "vkSetDebugUtilsObjectNameEXT",
    // The last wait of all: what it waits for was waited for.
    "vkDeviceWaitIdle",
    // It is begun again.
    "vkWaitForFences",
];

fn started(sample: &str, layer: &Layer) -> Command {
    let mut command = layer.command(sample);
    command.args(["--headless", "--size", "8x8"]);
    command
}

fn output(sample: &str, fault: &str) -> Output {
    started(sample, &Layer::failing(fault)).output().expect("the sample starts")
}

/// The functions that a run calls, and how often.
fn calls(sample: &str) -> Vec<(String, usize)> {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("calls");
    let status = started(sample, &Layer::failing("")).env("CALLS", &file).status();
    assert!(status.expect("the sample starts").success());
    let told = fs::read_to_string(file).unwrap();
    let pair = |line: &str| {
        let (name, number) = line.split_once(' ').unwrap();
        (name.to_owned(), number.parse().unwrap())
    };
    told.lines().map(pair).collect()
}

/// Lets calls of each function fail, those of these numbers among so many, and holds the answers.
fn answered(sample: &str, numbers: impl Fn(usize) -> Vec<usize>) {
    let calls = calls(sample);
    assert!(calls.len() > 20, "{calls:?}");
    let mut tried = 0;
    for (function, count) in calls {
        let needless = NEEDLESS.contains(&function.as_str());
        for (number, result) in numbers(count)
            .into_iter()
            .flat_map(|number| results(&function).iter().map(move |result| (number, *result)))
        {
            let fault = format!("{function}:{number}:{result}");
            let output = output(sample, &fault);
            let errors = String::from_utf8_lossy(&output.stderr);
            tried += 1;
            if output.status.success() && needless {
                assert!(errors.is_empty(), "{sample} {fault}: {errors}");
                continue;
            }
            assert_eq!(output.status.code(), Some(1), "{sample} {fault}: {errors}");
            assert!(
                errors.starts_with("error: ") && errors.lines().count() == 1,
                "{sample} {fault}: {errors}"
            );
        }
    }
    println!("{sample}: {tried} failures");
}

/// The first and the last call.
fn ends(count: usize) -> Vec<usize> {
    if count == 1 { vec![1] } else { vec![1, count] }
}

#[test]
fn the_first_and_the_last_call_of_each_function_may_fail() {
    answered("01_foundation", ends);
    answered("02_basic", ends);
}

#[test]
#[ignore = "an hour: every call of every chapter"]
fn every_call_of_every_chapter_may_fail() {
    for sample in run::chapters() {
        answered(&sample, |count| (1..=count).collect());
    }
}

#[test]
fn a_device_that_is_never_to_be_waited_for_ends_the_process_in_one_line() {
    let output = output("02_basic", "vkWaitForFences:1+:-1");
    let (code, line) = run::refusal(output);
    assert_eq!(code, 1);
    assert!(line.contains("cannot be waited for"), "{line}");
}
