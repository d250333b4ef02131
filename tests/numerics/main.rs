//! Every rung of every ladder on the device: hard cases with known answers, and random rays by the ten
//! thousand, held to the bars that 24_accuracy states.

mod atlas;
mod bars;
mod compiled;
mod files;
mod hard;
mod tables;
mod times;
mod view;
mod worst;

use std::process::Output;

use serde_json::Value;

const NAME: &str = "24_accuracy";

/// Runs the laboratory under validation.
fn laboratory(arguments: &[&str]) -> Output {
    unwatched(&[&["--validate"], arguments].concat())
}

/// Runs it without validation, which would be timed as well.
fn unwatched(arguments: &[&str]) -> Output {
    run::command(NAME).arg("--headless").args(arguments).output().expect("it starts")
}

/// The report of a file of cases; whatever is wrong with the run is a failed test.
fn cases(path: &str) -> Value {
    let output = laboratory(&["--cases", path, "--report", "-"]);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{errors}");
    let report: Value = serde_json::from_slice(&output.stdout).expect("the report is JSON");
    assert_eq!(report["validation_messages"], serde_json::json!([]));
    report
}
