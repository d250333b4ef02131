//! The results of a measurement's command.
//!
//! The result of a `cargo run` is the part of its report for `--compare` or `--compile-for`, or else its
//! times, its memory and the numbers of its chapter. The result of a `cargo test` consists of the values
//! passed to `figures::hold`, which the test writes to the folder in the environment variable `FIGURES`.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;

use anyhow::{Context, Result, bail};
use common::files::NewFolder;
use serde_json::{Map, Value, json};
use time_limit::Limit;

use super::record::Record;
use crate::programs::program::Programs;
use crate::programs::{child, command_line};

/// The results of a command: measurements by name, or a single one without.
pub type Values = BTreeMap<String, Record>;

/// Runs a command: `NAME=value … cargo run …` or `cargo test …`.
///
/// # Errors
/// If it is neither, cannot be run, or fails; in one line.
pub fn run(programs: &Programs, command: &str) -> Result<Values> {
    run_within(programs, command, Limit::NONE)
}

/// As [`run`], with a limit.
///
/// # Errors
/// As [`run`], or if the command exceeds the limit.
pub fn run_within(programs: &Programs, command: &str, limit: Limit) -> Result<Values> {
    let folder = NewFolder::temporary()?;
    let words = shlex::split(command).unwrap_or_default();
    // The words before it set the environment, `NAME=value`.
    let start = words.iter().take_while(|word| word.contains('=')).count();
    let (environment, words) = words.split_at(start);
    if words.iter().map(String::as_str).take(2).eq(["cargo", "test"]) {
        let mut test = child::cargo(&programs.project.root);
        test.args(&words[1..]).env("FIGURES", folder.path());
        test.envs(environment.iter().filter_map(|word| word.split_once('=')));
        finish(&mut test, limit)?;
        return held(folder.path());
    }
    let runs = command_line::runs(command);
    let [(_, run)] = &runs[..] else { bail!("it is neither a `cargo run` nor a `cargo test`") };
    let program = run.program(programs.project).context("it runs no program")?;
    let file = folder.path().join("report.json");
    let mut arguments = run.arguments.clone();
    // The page's command writes a picture to the reader's folder, or prints a report. Neither is needed here.
    for (option, own) in [("--out", Some("out.png")), ("--report", None)] {
        let Some(at) = arguments.iter().position(|word| word == option) else { continue };
        arguments.drain(at..arguments.len().min(at + 2));
        let own = own.map(|name| folder.path().join(name).to_string_lossy().into_owned());
        arguments.extend(own.into_iter().flat_map(|file| [option.to_owned(), file]));
    }
    finish(programs.built(program)?.args(&arguments).arg("--report").arg(&file), limit)?;
    let report: Value = serde_json::from_slice(&fs::read(&file)?)?;
    Ok(BTreeMap::from([(String::new(), reported(&report)?)]))
}

fn finish(command: &mut Command, limit: Limit) -> Result<()> {
    let ended = child::run(command, limit)?;
    let is_why = |line: &&str| line.contains("error") || line.contains("panicked");
    let why = ended.said.lines().chain(ended.told.lines()).find(is_why).map(str::to_owned);
    match ended.failed() {
        Some(failed) => {
            let why = why.as_deref().map(|line| line.strip_prefix("error: ").unwrap_or(line));
            bail!("{}", why.unwrap_or(&failed))
        }
        None => Ok(()),
    }
}

/// The results a test has written to a folder, one file `PAGE/NAME.json` each.
fn held(folder: &Path) -> Result<Values> {
    let mut found = BTreeMap::new();
    for page in fs::read_dir(folder)?.flatten() {
        for file in fs::read_dir(page.path())?.flatten() {
            let (page, file) = (page.file_name(), file.path());
            let stem = file.file_stem().unwrap_or_default().to_string_lossy();
            let given: Value = serde_json::from_slice(&fs::read(&file)?)?;
            let text = |key: &str| given[key].as_str().unwrap_or_default().to_owned();
            let values = given["values"].as_object().context("a test holds no values")?.clone();
            let timed = given["timed"] == true;
            found.insert(
                format!("{}/{stem}", page.to_string_lossy()),
                measured(timed, (text("device"), text("driver")), values),
            );
        }
    }
    Ok(found)
}

fn measured(timed: bool, (device, driver): (String, String), values: Map<String, Value>) -> Record {
    let [command, date] = [const { String::new() }; 2];
    Record { command, timed, device, driver, date, commit: None, values }
}

/// The values in a sample's report: of `--compare`, of `--compile-for`, or else its times, its memory and the
/// numbers of its chapter.
fn reported(report: &Value) -> Result<Record> {
    let text = |key: &str| report[key].as_str().unwrap_or_default().to_owned();
    let device = (text("device"), text("driver"));
    let mut values = Map::new();
    if let Some(rows) = report["comparison"]["values"].as_array() {
        let middle = |values: &mut Map<String, Value>, name: &str, ratio: &Value| {
            for (key, part) in [("ratio", "median"), ("low", "low"), ("high", "high")] {
                values.insert(format!("{name}.{key}"), ratio[part].clone());
            }
        };
        for row in rows {
            let name = row["value"].as_str().context("a value has a name")?.replace(' ', "-");
            values.insert(format!("{name}.ms"), row["milliseconds"].clone());
            middle(&mut values, &name, &row["ratio"]);
        }
        middle(&mut values, "noise", &report["comparison"]["noise"]);
        return Ok(measured(true, device, values));
    }
    let rows = report["compiled_for"].as_array().map_or(&[][..], Vec::as_slice);
    // Not every machine has Intel's cards, so of `all` families only Radeons are stored.
    let is_radeon = |row: &Value| row["registers"].is_u64();
    let radeon: Vec<Value> = rows.iter().filter(|row| is_radeon(row)).cloned().collect();
    let rows = if radeon.is_empty() { rows.to_vec() } else { radeon };
    if let Some(first) = rows.first() {
        let mut families: Vec<&str> =
            rows.iter().filter_map(|row| row["family"].as_str()).collect();
        families.dedup();
        for family in &families {
            let each = |key: &'static str| {
                rows.iter()
                    .filter(move |row| row["family"] == **family)
                    .filter_map(move |row| row[key].as_u64())
            };
            let figures = [
                ("programs", Some(each("instructions").count() as u64)),
                ("instructions", Some(each("instructions").sum())),
            ];
            let own = if is_radeon(first) {
                vec![
                    ("registers", each("registers").max()),
                    ("spilled_registers", Some(each("spilled_registers").sum())),
                    ("scratch_bytes", each("scratch_bytes").max()),
                    ("waves", each("waves").min()),
                ]
            } else {
                vec![
                    ("live_registers", each("live_registers").max()),
                    ("spills", Some(each("spills").sum())),
                    ("fills", Some(each("fills").sum())),
                ]
            };
            let figures = [&figures[..], &own].concat();
            let prefix = if families.len() == 1 { String::new() } else { format!("{family}.") };
            let all = figures.iter();
            values.extend(all.map(|(name, value)| (format!("{prefix}{name}"), json!(value))));
            // For several programs also each one alone, in the compiler's order.
            let programs = rows.iter().filter(|row| row["family"] == **family);
            for (number, row) in (1..).zip(programs.filter(|_| figures[0].1 != Some(1))) {
                let own = figures[1..].iter();
                values.extend(
                    own.map(|(name, _)| (format!("{prefix}{number}.{name}"), row[name].clone())),
                );
            }
        }
        let generation = |family: &&str| match *family {
            "navi21" => "RDNA2",
            "navi31" => "RDNA3",
            "gfx1201" => "RDNA4",
            "dg2" => "Arc A-series",
            "bmg" => "Arc B-series",
            _ => "",
        };
        let generations: Vec<&str> = families.iter().map(generation).collect();
        let compiler = first["compiler"].as_str().unwrap_or_default();
        let driver = format!("{compiler}, {}", generations.join(", "));
        let by = if is_radeon(first) { "RADV" } else { "ANV" };
        return Ok(measured(false, (by.to_owned(), driver), values));
    }
    for (name, key) in [("ms", "gpu_milliseconds"), ("band", "band_milliseconds")] {
        for part in ["min", "median", "max"] {
            values.insert(format!("{name}.{part}"), report[key][part].clone());
        }
    }
    for name in [
        "primary_rays_per_second",
        "acceleration_structure_bytes",
        "acceleration_structure_milliseconds",
        "bytes_allocated",
    ] {
        values.insert(name.to_owned(), report[name].clone());
    }
    let first = report["first_frame_milliseconds"].as_f64().unwrap_or_default();
    values.insert("first_frame_seconds".to_owned(), (first / 1e3).into());
    let chapter = report["chapter"].as_object().into_iter().flatten();
    let numbers = chapter.filter(|(_, value)| value.is_number());
    values.extend(numbers.map(|(name, value)| (format!("chapter.{name}"), value.clone())));
    Ok(measured(true, device, values))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_comparison_gives_its_table_row_by_row() {
        let ratio = |median: f64| json!({ "low": 1.0, "median": median, "high": 2.0 });
        let report = json!({ "device": "d", "driver": "e", "comparison": { "noise": ratio(1.1), "values": [
            { "value": "first hit", "milliseconds": 5.0, "ratio": ratio(1.5) } ] } });
        let stored = reported(&report).unwrap();
        let names: Vec<&String> = stored.values.keys().collect();
        let row = ["first-hit.ms", "first-hit.ratio", "first-hit.low", "first-hit.high"];
        assert_eq!(names, [&row[..], &["noise.ratio", "noise.low", "noise.high"]].concat());
        assert!(stored.timed && stored.value("first-hit.ratio") == Some(1.5));
    }

    #[test]
    fn a_run_gives_the_numbers_of_its_chapter() {
        let chapter = json!({ "pieces": 16, "scene": "x", "rows": [1] });
        let report =
            json!({ "device": "d", "driver": "e", "bytes_allocated": 5, "chapter": chapter });
        let stored = reported(&report).unwrap();
        let of_chapter = stored.values.keys().filter(|name| name.starts_with("chapter."));
        assert_eq!(of_chapter.collect::<Vec<_>>(), ["chapter.pieces"]);
        assert_eq!(stored.value("bytes_allocated"), Some(5.0));
    }
}
