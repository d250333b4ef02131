//! The command: measures every row and prints the table, or draws the picture instead.

use std::path::PathBuf;
use std::time::Instant;

use anyhow::{Context, Result};
use clap::Args;
use clap::builder::NonEmptyStringValueParser;
use common::files::check_writable;
use common::output::{complain, print};
use instruments::columns::columns;
use manuscript::project::Project;
use time_limit::Limit;

use super::row::Row;
use super::same_price;
use super::timing::{Quartiles, Timing};
use crate::programs::program::Programs;
use crate::programs::{interrupt, ready};
use crate::values::record::Record;

/// The arguments of `cargo chapters prices`.
#[derive(Debug, Args)]
pub struct PricesArguments {
    /// Rounds of each comparison, 3 to 1000
    #[arg(long, value_name = "N", default_value_t = 9, value_parser = rounds, allow_hyphen_values = true)]
    rounds: u32,
    /// Only rows that have this word
    #[arg(long, value_name = "WORD", value_parser = NonEmptyStringValueParser::new())]
    only: Option<String>,
    /// Use this device: a number of --list-devices or a part of its name
    #[arg(long, value_name = "N|NAME")]
    device: Option<String>,
    /// Draw the picture "Same price" instead: four pictures by the textbook and by ours
    #[arg(long, value_name = "FILE.png", conflicts_with = "only", value_parser = png)]
    picture: Option<PathBuf>,
}

fn rounds(text: &str) -> Result<u32, String> {
    let known = text.parse().ok().filter(|rounds| (3..=1000).contains(rounds));
    known.ok_or_else(|| "rounds are a whole number from 3 to 1000".to_owned())
}

fn png(text: &str) -> Result<PathBuf, String> {
    let file = PathBuf::from(text);
    let known = file.extension().is_some_and(|extension| extension == "png");
    known.then_some(file).ok_or_else(|| "the picture is a .png file".to_owned())
}

impl PricesArguments {
    /// Runs the command.
    ///
    /// # Errors
    /// If no row contains the word, or a program fails.
    pub fn run(&self, project: &Project) -> Result<()> {
        interrupt::listen();
        let programs = Programs::beside_this(project)?;
        let device = self.device.as_deref();
        if let Some(picture) = &self.picture {
            check_writable(picture)?;
            ready::build(&programs, &same_price::programs())?;
            let told = same_price::draw(&programs, self.rounds, device, picture)?;
            return print(&format!("{told}{}: drawn\n", picture.display()));
        }
        let (stored, _) = Record::all(project);
        let all = Row::all(project, &stored)?;
        let word = self.only.as_deref().unwrap_or_default();
        let rows: Vec<&Row> = all.iter().filter(|row| row.what.contains(word)).collect();
        if rows.is_empty() {
            let there: Vec<&str> = all.iter().map(|row| &*row.what).collect();
            let line = format!("no row has '{word}'; there is: {}", there.join("; "));
            return Err(common::UsageError(line).into());
        }
        let limit = Limit::NONE;
        let timing =
            Timing { programs: &programs, stored: &stored, rounds: self.rounds, device, limit };
        let records = Row::records(&rows);
        let names: Vec<String> = records.iter().map(|record| timing.program(record)).collect();
        ready::build(&programs, &names.iter().map(String::as_str).collect::<Vec<_>>())?;
        let start = Instant::now();
        let (mut lines, mut on) = (vec![None; rows.len()], String::new());
        for ((number, record), program) in (1..).zip(&records).zip(&names) {
            let here = || rows.iter().enumerate().filter(|(_, row)| row.record == **record);
            let own: Vec<&Row> = here().map(|(_, row)| *row).collect();
            complain(&format!("[{number}/{}] {program}", records.len()));
            let timed = timing.measure(record, &own).with_context(|| program.clone())?;
            interrupt::asked()?;
            for ((place, _), ratio) in here().zip(timed.ratios) {
                lines[place] = Some(ratio);
            }
            on = format!("{} · {}", timed.device, timed.driver);
        }
        let seconds = start.elapsed().as_secs();
        let head = "Time with it over time without it. No GPU with ray tracing hardware has been measured yet:\n\
                    the H200 traverses in software.";
        let tail = "The middle half of the rounds lies between the last two numbers. What is wrong without it: docs/prices.md";
        let (table, rounds) = (table(&rows, &lines), self.rounds);
        print(&format!(
            "{head}\n\nyours: {on} · {rounds} rounds · {seconds} s\n\n{table}\n{tail}\n"
        ))
    }
}

fn table(rows: &[&Row], ratios: &[Option<Quartiles>]) -> String {
    let heading = ["", "software driver", "H200", "yours", "middle half"].map(str::to_owned);
    let mut lines = vec![heading.to_vec()];
    lines.extend(rows.iter().zip(ratios).map(|(row, ratio)| {
        let [yours, middle] = match ratio {
            Some(Quartiles { low, median, high }) => {
                [format!("{median:.2}"), format!("{low:.2} to {high:.2}")]
            }
            None => [String::new(), String::new()],
        };
        vec![row.what.clone(), row.software.clone(), row.h200.clone(), yours, middle]
    }));
    columns(&lines, &[1, 2, 3, 4])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounds_are_enough_for_quartiles() {
        assert_eq!(rounds("9"), Ok(9));
        for wrong in ["2", "1001", "-3", "x"] {
            assert!(rounds(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn a_line_has_yours_beside_what_is_stored() {
        let row = Row {
            what: "a, by b".to_owned(),
            software: "1.10".to_owned(),
            h200: String::new(),
            record: "22_solids/rungs".to_owned(),
            value: "point".to_owned(),
            inverted: true,
        };
        let ratio = Quartiles { low: 1.0, median: 1.25, high: 1.5 };
        let text = table(&[&row], &[Some(ratio)]);
        let line = "a, by b             1.10         1.25  1.00 to 1.50";
        assert!(text.lines().any(|told| told == line), "{text}");
    }
}
