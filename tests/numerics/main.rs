//! Every rung of every ladder on the device: hard cases with known answers, and random rays by the ten
//! thousand, compared with the bounds stated by 24_accuracy.

mod atlas;
mod bars;
mod compiled;
mod faults;
mod files;
mod hard;
mod tables;
mod times;
mod view;
mod worst;

use std::process::Output;

use serde_json::Value;

const NAME: &str = "24_accuracy";

/// Runs chapter 24 under validation.
fn laboratory(arguments: &[&str]) -> Output {
    unwatched(&[&["--validate"], arguments].concat())
}

/// Runs it without validation, which would distort the times.
fn unwatched(arguments: &[&str]) -> Output {
    run::command(NAME).arg("--headless").args(arguments).output().expect("it starts")
}

/// The report for a file of cases; any fault of the run fails the test.
fn cases(path: &str) -> Value {
    let output = laboratory(&["--cases", path, "--report", "-"]);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{errors}");
    let report: Value = serde_json::from_slice(&output.stdout).expect("the report is JSON");
    assert_eq!(report["validation_messages"], serde_json::json!([]));
    report
}
