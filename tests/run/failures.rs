//! Failing Vulkan calls, one per run: each must be reported in one line.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Output;

use crate::layer::Layer;

const OUT_OF_HOST_MEMORY: i32 = -1;
const OUT_OF_DEVICE_MEMORY: i32 = -2;
const INITIALIZATION_FAILED: i32 = -3;
const DEVICE_LOST: i32 = -4;
const MEMORY_MAP_FAILED: i32 = -5;
const FRAGMENTED_POOL: i32 = -12;
const OUT_OF_POOL_MEMORY: i32 = -1_000_069_000;
const SURFACE_LOST: i32 = -1_000_000_000;
const OUT_OF_DATE: i32 = -1_000_001_004;

/// Results that a function may return according to the specification, and that are treated differently here.
fn results(function: &str) -> &'static [i32] {
    match function {
        "vkQueueSubmit"
        | "vkQueueSubmit2"
        | "vkWaitForFences"
        | "vkDeviceWaitIdle"
        | "vkGetQueryPoolResults" => &[OUT_OF_HOST_MEMORY, DEVICE_LOST],
        "vkCreateDevice" => &[OUT_OF_HOST_MEMORY, INITIALIZATION_FAILED, DEVICE_LOST],
        "vkAllocateMemory" | "vkCreateImage" | "vkBindBufferMemory" | "vkBindImageMemory" => {
            &[OUT_OF_HOST_MEMORY, OUT_OF_DEVICE_MEMORY]
        }
        "vkAllocateDescriptorSets" => &[OUT_OF_HOST_MEMORY, FRAGMENTED_POOL, OUT_OF_POOL_MEMORY],
        "vkMapMemory" => &[OUT_OF_HOST_MEMORY, MEMORY_MAP_FAILED],
        "vkAcquireNextImageKHR" | "vkQueuePresentKHR" => {
            &[OUT_OF_HOST_MEMORY, DEVICE_LOST, SURFACE_LOST, OUT_OF_DATE]
        }
        "vkCreateSwapchainKHR" => &[OUT_OF_HOST_MEMORY, DEVICE_LOST, SURFACE_LOST],
        _ => &[OUT_OF_HOST_MEMORY],
    }
}

/// Returns whether a run can continue without the call, so that its failure may go unreported.
fn needless(function: &str, result: i32) -> bool {
    match function {
        "vkCreatePipelineCache" | "vkGetPipelineCacheData" | "vkSetDebugUtilsObjectNameEXT" => true,
        // The last wait of all: everything it waits for has already been waited for.
        "vkDeviceWaitIdle" => true,
        // These calls are repeated.
        "vkWaitForFences" | "vkQueueWaitIdle" => result == OUT_OF_HOST_MEMORY,
        // A device can be chosen without it, and the swapchain calls it again.
        "vkGetPhysicalDeviceSurfaceCapabilitiesKHR" => true,
        // Objects lost by the window system are recreated.
        _ => matches!(result, SURFACE_LOST | OUT_OF_DATE),
    }
}

/// Runs a program once for each call to fail, prints the number of failures and those not reported with one
/// line and exit code 1, and returns whether all were reported.
///
/// `run` starts the program under a layer, with the file in `CALLS` to which its calls are written. `numbers`
/// chooses the calls: given the number of calls of a function, it returns those to fail.
pub fn each_is_answered(
    name: &str,
    run: impl Fn(&Layer, &Path) -> Output,
    numbers: impl Fn(usize) -> Vec<usize>,
) -> bool {
    let run = |fault: &str| {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let file = folder.path().join("calls");
        let output = run(&Layer::fail_nth_call(fault), &file);
        (output, Layer::calls(&file))
    };
    let (whole, calls) = run("");
    assert!(whole.status.success(), "{name}: {}", String::from_utf8_lossy(&whole.stderr));
    assert!(calls.len() > 20, "{name}: {calls:?}");
    let (mut failures, mut all_right) = (0, true);
    for (function, result, number) in faults(&calls, numbers) {
        let fault = format!("{function}:{number}:{result}");
        let (output, now) = run(&fault);
        let errors = String::from_utf8_lossy(&output.stderr);
        // The number of bands depends on the time, so this run may have had fewer calls.
        let unmet = now.get(function).is_some_and(|&calls| calls < number);
        // A card has several types of memory; after a failure in one, another is tried.
        let elsewhere = ["vkAllocateMemory", "vkMapMemory"].contains(&function)
            && now.get(function) > calls.get(function);
        let may_succeed = needless(function, result) || unmet || elsewhere;
        let right = match output.status.code() {
            Some(0) if may_succeed => errors.is_empty(),
            Some(1) => {
                errors.starts_with("error: ")
                    && errors.lines().count() == 1
                    && !crate::MISTAKES.iter().any(|mistake| errors.contains(mistake))
            }
            _ => false,
        };
        failures += usize::from(!output.status.success());
        if !right {
            println!("{name} {fault}: {}: {errors}", output.status);
            all_right = false;
        }
    }
    println!("{name}: {failures} failures");
    assert!(failures > 30);
    all_right
}

/// The function, the result and the number of each call to fail.
fn faults(
    calls: &BTreeMap<String, usize>,
    numbers: impl Fn(usize) -> Vec<usize>,
) -> Vec<(&str, i32, usize)> {
    let mut faults = Vec::new();
    for (function, &count) in calls {
        for number in numbers(count) {
            faults.extend(
                results(function).iter().map(|&result| (function.as_str(), result, number)),
            );
        }
    }
    faults
}

/// The first and the last call.
pub fn ends(count: usize) -> Vec<usize> {
    if count == 1 { vec![1] } else { vec![1, count] }
}

/// Every call.
pub fn all(count: usize) -> Vec<usize> {
    (1..=count).collect()
}

/// The chapters whose calls are made to fail: those whose names begin with the words in `CHAPTERS`, or all.
pub fn chapters() -> Vec<String> {
    let chosen = std::env::var("CHAPTERS").unwrap_or_default();
    let mut all = crate::chapters();
    if !chosen.is_empty() {
        all.retain(|name| chosen.split_whitespace().any(|first| name.starts_with(first)));
    }
    all
}
