//! Every rung of every ladder on the device: hard cases with known answers, and random rays by the ten
//! thousand, held to the bars that 24_accuracy states.

mod bars;
mod compiled;
mod files;
mod view;
mod worst;

use std::process::Output;

use serde_json::Value;

const NAME: &str = "24_accuracy";

/// Runs the laboratory under validation.
fn laboratory(arguments: &[&str]) -> Output {
    run::command(NAME)
        .args(["--headless", "--validate"])
        .args(arguments)
        .output()
        .expect("it starts")
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

#[test]
fn every_top_rung_is_right_on_every_hard_case() {
    let report = cases("tests/data/hard_cases.json");
    let found = serde_json::json!({ "cases": report["cases"] });
    run::figures::hold_exact("README/hard_cases", found);
    assert_eq!((&report["cases"], &report["skipped"]), (&114.into(), &0.into()));
    let rungs = report["rungs"].as_array().unwrap();
    // 43 rungs: the device's triangles have no direct way, the sums no traced one.
    assert_eq!(rungs.len(), 2 * 43 - 1 - 4);
    let mut tops = 0;
    for row in rungs {
        let number = |key: &str| row[key].as_u64().unwrap();
        if row.get("unavailable").is_some() {
            continue;
        }
        let verdicts = ["right", "inexact", "false_hits", "false_misses", "never_offered"];
        let told: u64 = verdicts.iter().map(|key| number(key)).sum();
        assert_eq!(told + number("not_finite"), number("run"), "{row}");
        // No rung, however simple, lets infinity or NaN out.
        assert_eq!(number("not_finite"), 0, "{row}");
        if row["top"] == true {
            assert_eq!(number("right"), number("cases"), "{row}");
            tops += 1;
        }
    }
    // The simplest rungs fail: or the cases are not hard.
    let wrong = |rung: &str| -> u64 {
        let rows = rungs.iter().filter(|row| row["rung"] == rung && row["way"] == "direct");
        rows.map(|row| row["run"].as_u64().unwrap() - row["right"].as_u64().unwrap()).sum()
    };
    for rung in ["S0", "B0", "P0", "C0", "I0", "H0", "O0", "A0"] {
        assert!(wrong(rung) > 0, "{rung} fails nothing");
    }
    // Direct and traced: S4, S5, B3, B4, P3, P4, T3, C2, C3, I2, H3 and O5, and A3 one way. Of these every
    // device has H3 and A3.
    let all_are_there = rungs.iter().all(|row| row.get("unavailable").is_none());
    let least = if all_are_there { 2 * 12 + 1 } else { 3 };
    assert!(tops >= least, "only {tops} top rungs, direct and traced");
}
