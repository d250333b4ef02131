//! Runs every chapter on a GPU's complete driver without the GPU: stand-ins for Radeon cards.

use std::process::Command;

use run::cards::{Card, refusal, report, said};
use run::layer::Layer;
use run::{chapters, command};

use crate::sweep::{TINY, runs_all, shows_all};

/// The card used by every plain run of the tests.
const CARD: Card = Card("navi31");
const NAME: &str = "AMD Radeon RX 7900 XTX (RADV NAVI31)";
/// The other cards with ray tracing: the first four in the shim of Mesa 25.0.7, all but `gfx1150` in that of 26.2.6.
const OTHERS: [Card; 9] = [
    Card("navi21"),
    Card("vangogh"),
    Card("raphael_mendocino"),
    Card("gfx1150"),
    Card("gfx1201"),
    Card("navi33"),
    Card("strix1"),
    Card("phoenix"),
    Card("rembrandt"),
];
/// A card without ray tracing.
const OLD: Card = Card("navi10");
const OLD_NAME: &str = "AMD Radeon RX 5700 XT (RADV NAVI10)";

/// In a window, the figures are requested from every driver; without them it stays open.
#[test]
fn a_driver_that_tells_no_figures_of_its_compiler_is_a_warning() {
    let Some(mut command) = CARD.command("02_basic") else { return };
    let moods = Layer::display_faults("no-figures");
    command.envs(moods.environment()).args(TINY).arg("--compiler-figures");
    let output = command.output().expect("it starts");
    assert!(output.status.success(), "{}", said(&output));
    let line = format!(
        "warning: {NAME} reports no compiler statistics: A host memory allocation has failed"
    );
    assert_eq!(said(&output).trim(), line);
}

#[test]
fn every_chapter_runs_on_a_radeon_that_is_not_there() {
    runs_all(CARD);
}

#[test]
#[ignore = "nightly: each card; quick: cards::every_chapter_runs_on_a_radeon_that_is_not_there"]
fn every_chapter_runs_on_every_card_that_the_shim_has() {
    OTHERS.into_iter().filter(|card| card.is_known()).for_each(runs_all);
}

/// Recursive mirrors need another pipeline of the same shaders, and each view one more.
#[test]
fn each_view_of_a_chapter_runs_there_too() {
    shows_all(CARD, "06_reflection", &[]);
}

#[test]
#[ignore = "nightly: 140 runs; quick: cards::each_view_of_a_chapter_runs_there_too"]
fn each_view_and_preset_of_every_chapter_runs_there_too() {
    chapters().iter().for_each(|sample| shows_all(CARD, sample, &[]));
}

/// A machine with a Radeon and the software driver, for a sample.
fn both(card: Card, sample: &str, arguments: &[&str]) -> Option<Command> {
    let mut command = command(sample);
    command.envs(card.beside_software()?).args(arguments);
    Some(command)
}

#[test]
fn of_a_radeon_and_a_software_driver_the_radeon_is_taken_unless_the_other_is_named() {
    for sample in ["01_foundation", "02_basic"] {
        let Some(mut list) = both(CARD, sample, &["--list-devices"]) else { return };
        let output = list.output().expect("it starts");
        assert_eq!(said(&output), "", "{sample}");
        let list = String::from_utf8(output.stdout).expect("text");
        let [first, second] = list.lines().collect::<Vec<_>>()[..] else { panic!("{list}") };
        assert!(first.starts_with(&format!("0: {NAME} (")), "{list}");
        assert!(second.starts_with("1: llvmpipe ("), "{list}");
        assert!(list.lines().all(|line| line.ends_with(": suitable")), "{list}");
        for (named, taken) in [
            (None, "AMD Radeon"),
            (Some("0"), "AMD Radeon"),
            (Some("radeon"), "AMD Radeon"),
            (Some("1"), "llvmpipe"),
            (Some("LLVM"), "llvmpipe"),
        ] {
            let mut command = both(CARD, sample, &TINY).expect("the shim is there");
            command.args(["--report", "-"]);
            if let Some(named) = named {
                command.args(["--device", named]);
            }
            let report = report(sample, &command.output().expect("it starts"));
            let device = report["device"].as_str().expect("a name");
            assert!(device.starts_with(taken), "{sample}, {named:?}: {device}");
        }
        let mut command = both(CARD, sample, &TINY).expect("the shim is there");
        let output = command.args(["--device", "GeForce"]).output().expect("it starts");
        let (code, line) = refusal(&output);
        assert_eq!(code, 2, "{line}");
        assert!(line.contains("no device 'GeForce'; there is 0: AMD Radeon"), "{line}");
    }
}

#[test]
fn a_radeon_without_ray_tracing_is_refused_by_name_and_another_device_is_taken() {
    let lacks = ["VK_KHR_acceleration_structure", "VK_KHR_ray_tracing_pipeline"];
    for sample in ["01_foundation", "02_basic"] {
        let Some(mut command) = OLD.command(sample) else { return };
        let (code, line) = refusal(&command.args(TINY).output().expect("it starts"));
        assert_eq!(code, 1, "{line}");
        assert!(line.contains(&format!("no device can run this: 0: {OLD_NAME}")), "{line}");
        assert!(lacks.iter().all(|lacks| line.contains(lacks)), "{line}");
        let mut command = both(OLD, sample, &TINY).expect("the shim is there");
        let report = report(sample, &command.args(["--report", "-"]).output().expect("it starts"));
        assert!(report["device"].as_str().unwrap().starts_with("llvmpipe"), "{report:.200}");
        let mut command = both(OLD, sample, &TINY).expect("the shim is there");
        let (_, line) = refusal(&command.args(["--device", "5700"]).output().expect("it starts"));
        assert!(line.contains(OLD_NAME) && line.contains(lacks[0]), "{line}");
    }
}

#[test]
fn a_card_s_limits_and_memory_bound_a_picture() {
    let Some(mut command) = CARD.command("03_any_hit") else { return };
    let output = command.args(TINY).args(["--report", "-"]).output().expect("it starts");
    let limits = report("03_any_hit", &output)["limits"].clone();
    let limit = |name: &str| limits[name].as_u64().expect("a whole number");
    let side = limit("max_image_dimension");
    let rays = limit("max_ray_dispatch_invocation_count");
    // A list of all hits needs 384 bytes per pixel, in one buffer.
    let room = limit("max_buffer_size") / 384;
    let square = |pixels: u64| pixels.isqrt() + 1;
    let size = |side: u64| format!("{side}x{side}");
    let most = format!("at most {side} a side and {rays} pixels");
    let lists = "a list of all hits takes 384 bytes per pixel";
    for (size, settings, words) in [
        (format!("{}x10", side + 1), &[][..], ["is too large for", &most]),
        (size(square(rays)), &[][..], ["is too large for", &most]),
        (
            size(square(room)),
            &["--set", "mode=all hits"][..],
            [lists, &format!("has room for {room} pixels")],
        ),
        // The buffer's size is allowed, but the driver is out of memory; both report that.
        (
            size(square(room) - 16),
            &["--set", "mode=all hits"][..],
            ["no memory for the buffer 'hits' of ", "Out of memory"],
        ),
    ] {
        let mut command = CARD.command("03_any_hit").expect("the shim is there");
        command.args(["--headless", "--validate", "--size", &size]).args(settings);
        let (_, line) = refusal(&command.output().expect("it starts"));
        assert!(words.iter().all(|word| line.contains(word)), "{size}: {line}");
        assert!(line.contains(NAME) || line.contains(words[1]), "{size}: {line}");
    }
}

/// A request to one card's compiler uses another process, whichever card this one has.
#[test]
fn one_card_s_program_asks_another_card_s_compiler() {
    let Some(mut command) = Card("navi21").command("02_basic") else { return };
    let output = command.args(TINY).args(["--compile-for", "navi31", "--report", "-"]).output();
    let report = report("02_basic", &output.expect("it starts"));
    assert!(report["device"].as_str().unwrap().ends_with("(RADV NAVI21)"), "{}", report["device"]);
    let rows = report["compiled_for"].as_array().expect("rows");
    assert!(!rows.is_empty() && rows.iter().all(|row| row["family"] == "navi31"), "{rows:?}");
}
