//! The ratio of a row, measured on this device.

use anyhow::{Context, Result, bail};
use common::files::NewFolder;
use serde_json::Value;
use time_limit::Limit;

use super::row::Row;
use crate::programs::child;
use crate::programs::command_line::{self, quoted};
use crate::programs::program::Programs;
use crate::values::given;
use crate::values::record::{Record, Records};

/// The chapter that measures accuracy. Its stored times come from a test that takes minutes; here it runs by
/// itself.
const LABORATORY: &str = "24_accuracy";
/// The primitive of a rung, by the first letter of its label.
const PRIMITIVES: [(char, &str); 5] =
    [('S', "sphere"), ('B', "box"), ('P', "plane"), ('T', "triangle"), ('C', "capsule")];

/// Quartiles of a ratio.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quartiles {
    pub low: f64,
    pub median: f64,
    pub high: f64,
}

impl Quartiles {
    /// The quartiles of the inverse, in order.
    fn inverse(self) -> Self {
        Self { low: 1.0 / self.high, median: 1.0 / self.median, high: 1.0 / self.low }
    }
}

/// The settings of a measurement.
pub struct Timing<'a> {
    pub programs: &'a Programs<'a>,
    pub stored: &'a Records,
    /// Rounds of each comparison.
    pub rounds: u32,
    /// The device, as given to `--device`.
    pub device: Option<&'a str>,
    /// The longest time of a program.
    pub limit: Limit,
}

/// The results on a device: its name and driver, and a ratio for each row.
pub struct Timed {
    pub device: String,
    pub driver: String,
    pub ratios: Vec<Quartiles>,
}

impl Timing<'_> {
    /// The program that measures the rows of a stored measurement.
    pub fn program(&self, record: &str) -> String {
        let stored = self.stored.get(record).map_or("", |record| &record.command);
        let bin = command_line::runs(stored).pop().and_then(|(_, run)| run.bin);
        // A test's measurement belongs to a chapter.
        bin.unwrap_or_else(|| record.split('/').next().unwrap_or(record).to_owned())
    }

    /// Measures rows of one stored measurement in one run.
    ///
    /// # Errors
    /// If the program fails, or does not know a value.
    pub fn measure(&self, record: &str, rows: &[&Row]) -> Result<Timed> {
        let measured = if self.program(record) == LABORATORY {
            self.laboratory(rows)?
        } else {
            let stored = self.stored.get(record);
            let stored = stored.with_context(|| format!("there is no measurement {record}"))?;
            let command = self.command(&stored.command, rows)?;
            let mut given = given::run_within(self.programs, &command, self.limit)?;
            given.pop_first().context("it gives nothing")?.1
        };
        let ratio = |row: &&Row| {
            let ratio = quartiles(&measured, &row.value)?;
            Ok(if row.inverted { ratio.inverse() } else { ratio })
        };
        let ratios = rows.iter().map(ratio).collect::<Result<_>>()?;
        Ok(Timed { device: measured.device, driver: measured.driver, ratios })
    }

    /// The stored command restricted to these values, with the requested number of rounds.
    fn command(&self, stored: &str, rows: &[&Row]) -> Result<String> {
        let runs = command_line::runs(stored);
        let [(_, run)] = &runs[..] else { bail!("'{stored}' is not one `cargo run`") };
        let mut arguments = run.arguments.clone();
        let at = |arguments: &[String], option: &str| {
            let place = arguments.iter().position(|word| word == option)?;
            (place + 1 < arguments.len()).then_some(place + 1)
        };
        let compare = at(&arguments, "--compare").context("the command compares nothing")?;
        let (control, values) = arguments[compare].split_once('=').context("it has no values")?;
        let wanted = |value: &&str| rows.iter().any(|row| row.value == value.replace(' ', "-"));
        let mut values = values.split('|').map(str::trim);
        let first = values.next().unwrap_or_default();
        let others = values.filter(wanted);
        let values: Vec<&str> = [first].into_iter().chain(others).collect();
        arguments[compare] = format!("{control}={}", values.join("|"));
        match at(&arguments, "--frames") {
            Some(frames) => arguments[frames] = self.rounds.to_string(),
            None => arguments.extend(["--frames".to_owned(), self.rounds.to_string()]),
        }
        arguments.extend(
            self.device.into_iter().flat_map(|device| ["--device", device]).map(str::to_owned),
        );
        let bin = run.bin.as_deref().context("the command names no program")?;
        Ok(format!("cargo run --bin {bin} -- {}", quoted(&arguments)))
    }

    /// Rungs of 24, each relative to the cheapest of its primitive.
    fn laboratory(&self, rows: &[&Row]) -> Result<Record> {
        let folder = NewFolder::temporary()?;
        let mut command = self.programs.built(LABORATORY)?;
        command.args(["--headless", "--rungs-alone", "--rays", "256", "--rounds"]);
        command.arg(self.rounds.to_string());
        let is_wanted = |letter: char| rows.iter().any(|row| row.value.starts_with(letter));
        let wanted = PRIMITIVES.iter().filter(|(letter, _)| is_wanted(*letter));
        command.args(wanted.flat_map(|(_, primitive)| ["--only", primitive]));
        command.args(self.device.into_iter().flat_map(|device| ["--device", device]));
        let ended = child::run(command.arg("--measure").arg(folder.path()), self.limit)?;
        if let Some(why) = ended.failed() {
            bail!("{why}");
        }
        let report = std::fs::read_to_string(folder.path().join("accuracy.json"))?;
        let report: Value = serde_json::from_str(&report)?;
        let text = |key: &str| report[key].as_str().unwrap_or_default().to_owned();
        let mut record = Record {
            command: String::new(),
            timed: true,
            device: text("device"),
            driver: text("driver"),
            date: String::new(),
            commit: None,
            values: serde_json::Map::new(),
        };
        for rung in report["rungs"].as_array().into_iter().flatten() {
            let text = |key: &str| rung[key].as_str().unwrap_or_default();
            let name = format!("{} {}", text("rung"), text("name")).replace(' ', "-");
            let ratio = &rung["time"]["ratio"];
            for (key, part) in [("ratio", "median"), ("low", "low"), ("high", "high")] {
                if ratio[part].is_number() {
                    record.values.insert(format!("{name}.{key}"), ratio[part].clone());
                }
            }
        }
        Ok(record)
    }
}

fn quartiles(measured: &Record, value: &str) -> Result<Quartiles> {
    let part = |part: &str| {
        let name = format!("{value}.{part}");
        measured.value(&name).with_context(|| format!("this device gives no '{name}'"))
    };
    Ok(Quartiles { low: part("low")?, median: part("ratio")?, high: part("high")? })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(value: &str) -> Row {
        let [what, software, h200] = [const { String::new() }; 3];
        let record = "22_solids/rungs".to_owned();
        Row { what, software, h200, record, value: value.to_owned(), inverted: false }
    }

    #[test]
    fn a_stored_command_is_shortened_to_the_values_of_the_rows() {
        let project = manuscript::project::Project::open(std::path::Path::new(concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../.."
        )));
        let project = project.expect("this project");
        let programs = Programs::beside_this(&project).expect("a place");
        let timing = Timing {
            programs: &programs,
            stored: &Records::new(),
            rounds: 7,
            device: Some("H 2"),
            limit: Limit::NONE,
        };
        let stored =
            "cargo run --bin 22_solids -- --headless --compare \"planes=8|16|a b\" --frames 20";
        let short = "cargo run --bin 22_solids -- --headless --compare \"planes=8|a b\" --frames 7 --device \"H 2\"";
        assert_eq!(timing.command(stored, &[&row("a-b")]).expect("a command"), short);
        assert!(timing.command("cargo test --test x", &[&row("a-b")]).is_err());
    }

    #[test]
    fn an_inverse_turns_quartiles_around() {
        let half = Quartiles { low: 0.25, median: 0.5, high: 1.0 };
        assert_eq!(half.inverse(), Quartiles { low: 1.0, median: 2.0, high: 4.0 });
    }
}
