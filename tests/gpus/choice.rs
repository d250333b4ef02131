//! The choice of the tests' device on a machine with a Radeon and the software driver. The card is a
//! stand-in: its driver is complete (Mesa's drm-shim), but computes nothing.

use std::process::Command;

use common::gpu::{Gpu, GpuOptions, Requirements};
use run::cards::Card;

/// The two chapters that create their own instance.
const CHAPTERS: [&str; 2] = ["01_foundation", "02_basic"];

/// The devices found by a test program started with `GPU`: by itself, by 01 and by another chapter; `None` if
/// there is no such card.
fn found(gpu: Option<&str>) -> Option<Vec<String>> {
    let this = std::env::current_exe().expect("a running program has a file");
    let mut command = Command::new(this);
    command.args(["--exact", "choice::say_which", "--ignored", "--nocapture"]);
    // As at the start of `cargo test`, when nothing has been chosen.
    if !Card("navi31").found_by(&mut command, gpu) {
        return None;
    }
    // Built before the stand-in is loaded.
    for chapter in CHAPTERS {
        command.env(format!("CARGO_BIN_EXE_{chapter}"), run::program(chapter));
    }
    let output = command.output().expect("it starts");
    let [told, errors] = [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text));
    assert!(output.status.success() && told.contains("1 passed"), "{told:.3000}{errors:.3000}");
    let named = told.lines().filter_map(|line| line.split_once("device: "));
    Some(named.map(|at| at.1.to_owned()).collect())
}

#[test]
fn a_radeon_is_left_alone_unless_it_is_asked_for() {
    let choices = [
        (None, "llvmpipe"),
        (Some("1"), "NAVI31"),
        (Some("llvm"), "llvmpipe"),
        (Some("navi31"), "NAVI31"),
    ];
    for (gpu, name) in choices {
        let Some(found) = found(gpu) else { return };
        assert!(found.len() == 3 && found.iter().all(|f| f.contains(name)), "{gpu:?}: {found:?}");
    }
}

#[test]
#[ignore = "run by a_radeon_is_left_alone_unless_it_is_asked_for"]
fn say_which() {
    let requirements = Requirements::ray_tracing();
    let gpu = Gpu::new(&GpuOptions { requirements, ..GpuOptions::default() }).expect("a device");
    println!("device: {}", gpu.name);
    for chapter in CHAPTERS {
        let mut command = run::command(chapter);
        command.args(["--headless", "--size", "8x8", "--report", "-"]);
        let output = command.output().expect("the sample starts");
        let report: serde_json::Value =
            serde_json::from_slice(&output.stdout).expect("the report is JSON");
        println!("device: {}", report["device"].as_str().expect("a name"));
    }
}
