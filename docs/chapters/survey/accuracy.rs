//! A report card's part of chapter 24: the hard cases, and a short measurement on random rays.

use std::path::Path;

use anyhow::{Context, Result};
use serde_json::Value;

use super::card::{HardCase, HardCases, Measured, MeasuredRung};
use super::command::{read, rows, told, words};

/// The chapter.
pub const NAME: &str = "24_accuracy";

/// The names of its two runs in the progress lines.
pub const HARD_CASES: &str = "hard cases";
pub const RANDOM_RAYS: &str = "random rays";

/// Its hard cases.
const CASES: &str = "tests/data/hard_cases.json";

/// The arguments of the run of its hard cases, whose results go to a folder.
pub fn hard(folder: &Path) -> Vec<String> {
    let mut cases = words(&["--headless", "--cases", CASES, "--report"]);
    cases.push(folder.join(ANSWERS).to_string_lossy().into_owned());
    cases
}

/// The arguments of the run of its random rays, whose results go to a folder.
pub fn random(folder: &Path) -> Vec<String> {
    let mut measure = words(&["--headless", "--rays", "256", "--rounds", "5"]);
    measure.extend(words(&["--only", "sphere", "--only", "triangle", "--measure"]));
    measure.push(folder.to_string_lossy().into_owned());
    measure
}

/// The file of the results on the hard cases.
const ANSWERS: &str = "cases.json";

/// The number of cases in which each rung is right.
pub fn hard_cases(failed: Option<String>, folder: &Path) -> HardCases {
    let rungs = || Ok(rows::<HardCase>(&read(&folder.join(ANSWERS))?["rungs"]));
    let (failed, rungs) = rungs_or_failure(failed, rungs);
    HardCases::new(failed, rungs)
}

/// The error of each rung, and its time.
pub fn measured(failed: Option<String>, folder: &Path) -> Measured {
    let rungs = || errors_and_times(&read(&folder.join("accuracy.json"))?);
    let (failed, rungs) = rungs_or_failure(failed, rungs);
    Measured { failed, rungs }
}

/// The rungs reported by a run, or the reason for its failure.
fn rungs_or_failure<Rung>(
    failed: Option<String>,
    rungs: impl FnOnce() -> Result<Vec<Rung>>,
) -> (Option<String>, Vec<Rung>) {
    match rungs() {
        Ok(rungs) => (failed, rungs),
        Err(error) => (Some(failed.unwrap_or_else(|| told(&error))), Vec::new()),
    }
}

fn errors_and_times(report: &Value) -> Result<Vec<MeasuredRung>> {
    let rungs = report["rungs"].as_array().context("it has measured nothing")?;
    let row = |rung: &Value| {
        let text = |key: &str| rung[key].as_str().unwrap_or_default().to_owned();
        let errors: Vec<&Value> = rung["errors"].as_array().into_iter().flatten().collect();
        let number = |row: &Value, key: &str| row[key].as_f64().unwrap_or_default();
        let ratio = &rung["time"]["ratio"];
        let wrong = ["false_hits", "false_misses", "never_offered", "not_finite"];
        let wrong = errors.iter().flat_map(|row| wrong.map(|key| number(row, key))).sum::<f64>();
        MeasuredRung {
            primitive: text("primitive"),
            rung: text("rung"),
            name: text("name"),
            worst_ulp: errors.iter().map(|row| number(row, "max")).fold(0.0, f64::max),
            wrong: wrong as u64,
            time_ratio: ratio["median"].as_f64(),
            time_quartiles: ratio["low"].as_f64().zip(ratio["high"].as_f64()).map(<[f64; 2]>::from),
        }
    };
    Ok(rungs.iter().map(row).collect())
}
