//! Calls of Vulkan that fail: each is answered in one line, and nothing is left or freed too early.

use std::collections::BTreeMap;
use std::process::Output;

use run::layer::Layer;

const OUT_OF_HOST_MEMORY: i32 = -1;
const OUT_OF_DEVICE_MEMORY: i32 = -2;
const INITIALIZATION_FAILED: i32 = -3;
const DEVICE_LOST: i32 = -4;
const MEMORY_MAP_FAILED: i32 = -5;
const TIMEOUT: i32 = 2;

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

/// Runs it with a call that fails; also how often each function was called, if it came to an end.
fn run(sample: &str, fault: &str) -> (Output, BTreeMap<String, usize>) {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("calls");
    let layer = Layer::failing(fault);
    let mut command = layer.command(sample);
    command.args(["--headless", "--size", "8x8"]).env("CALLS", &file);
    let output = command.output().expect("the sample starts");
    (output, Layer::calls(&file))
}

/// Runs a sample once for each call that is to fail, and holds the answers. `numbers` chooses them: of a
/// function that is called so often, the calls with these numbers fail.
fn answered(sample: &str, numbers: impl Fn(usize) -> Vec<usize>) {
    let (whole, calls) = run(sample, "");
    assert!(whole.status.success());
    assert!(calls.len() > 20, "{calls:?}");
    let mut tried = 0;
    for (function, &count) in &calls {
        let needless = NEEDLESS.contains(&function.as_str());
        for (number, result) in numbers(count)
            .into_iter()
            .flat_map(|number| results(function).iter().map(move |result| (number, *result)))
        {
            let fault = format!("{function}:{number}:{result}");
            let (output, now) = run(sample, &fault);
            let errors = String::from_utf8_lossy(&output.stderr);
            // How many bands a picture has depends on the time: this run may have had fewer calls.
            let unmet = now.get(function).is_some_and(|&calls| calls < number);
            if output.status.success() && (needless || unmet) {
                assert!(errors.is_empty(), "{sample} {fault}: {errors}");
                continue;
            }
            tried += 1;
            assert_eq!(output.status.code(), Some(1), "{sample} {fault}: {errors}");
            assert!(
                errors.starts_with("error: ") && errors.lines().count() == 1,
                "{sample} {fault}: {errors}"
            );
        }
    }
    println!("{sample}: {tried} failures");
    assert!(tried > 30);
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
    let (output, _) = run("02_basic", "vkWaitForFences:1+:-1");
    let (code, line) = run::refusal(output);
    assert_eq!(code, 1);
    assert!(line.contains("cannot be waited for"), "{line}");
}

#[test]
fn a_device_that_does_not_answer_ends_the_process_in_one_line() {
    for sample in ["01_foundation", "02_basic"] {
        let (output, _) = run(sample, &format!("vkWaitForFences:1:{TIMEOUT}"));
        let (code, line) = run::refusal(output);
        assert_eq!(code, 1);
        assert!(line.contains("has not answered for "), "{line}");
    }
}
