//! A measurement's file, `docs/figures/PAGE/NAME.json`: the values that a command gave, on which device,
//! when, and from which sources.

use std::collections::BTreeMap;
use std::fs;

use anyhow::Result;
use manuscript::fault::Fault;
use manuscript::project::Project;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

/// Where the measurements lie.
pub const FOLDER: &str = "docs/figures";

/// The device of what a test computes by itself.
pub const HOST: &str = "host";

/// What is known of a measurement.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Record {
    /// The command that made it.
    pub command: String,
    /// Whether its values are times: they differ from run to run.
    pub timed: bool,
    /// The device's name, or [`HOST`].
    pub device: String,
    /// The driver, in its maker's words.
    pub driver: String,
    /// The day, as `2026-11-22`.
    pub date: String,
    /// A hash of what it was made from.
    pub sources: String,
    /// The values, by name, in the order in which a page shows them.
    pub values: Map<String, Value>,
}

/// The file of a measurement, from the project's root.
pub fn file(name: &str) -> String {
    format!("{FOLDER}/{name}.json")
}

/// What renews a measurement.
pub fn renew(name: &str) -> String {
    format!("run: cargo chapters measure {name}")
}

impl Record {
    /// Every measurement, by page and name, and what is wrong with the files.
    pub fn all(project: &Project) -> (BTreeMap<String, Self>, Vec<Fault>) {
        let (mut found, mut faults) = (BTreeMap::new(), Vec::new());
        for file in project.files(FOLDER) {
            let name = file.strip_prefix(FOLDER).and_then(|rest| rest.strip_suffix(".json"));
            let Some(name) = name.map(|name| name.trim_start_matches('/').to_owned()) else {
                faults.push(Fault::new(file, 1, "a measurement is a file NAME.json", "rename it"));
                continue;
            };
            match Self::parse(&project.read(&file).unwrap_or_default()) {
                Ok(stored) => drop(found.insert(name, stored)),
                Err((line, what)) => {
                    let what = format!("this is no measurement: {what}");
                    faults.push(Fault::new(file, line, what, renew(&name)));
                }
            }
        }
        (found, faults)
    }

    /// Reads a file's text; else the line at which it is wrong, and why.
    fn parse(text: &str) -> Result<Self, (usize, String)> {
        let stored: Self = serde_json::from_str(text).map_err(|error| {
            let what = error.to_string();
            let what = what.split(" at line").next().unwrap_or_default().to_owned();
            (error.line().max(1), what)
        })?;
        match stored.values.iter().find(|(_, value)| !value.is_number()) {
            Some((name, value)) => Err((1, format!("'{name}' is {value}, which is no number"))),
            None => Ok(stored),
        }
    }

    /// The value of this name.
    pub fn value(&self, name: &str) -> Option<f64> {
        self.values.get(name)?.as_f64()
    }

    /// Whether two runs gave the same on the same device.
    pub fn agrees(&self, other: &Self) -> bool {
        let same = |of: fn(&Self) -> &str| of(self) == of(other);
        self.values == other.values
            && same(|stored| &stored.device)
            && same(|stored| &stored.driver)
            && same(|stored| &stored.command)
    }

    /// Writes its file.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn write(&self, project: &Project, name: &str) -> Result<()> {
        let path = project.root.join(file(name));
        fs::create_dir_all(path.parent().unwrap_or(&project.root))?;
        common::files::write_whole(&path, (serde_json::to_string_pretty(self)? + "\n").as_bytes())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_damaged_file_is_told_with_its_line() {
        let whole = "{\n\"command\": \"c\", \"timed\": false, \"device\": \"d\", \"driver\": \"e\",\n\
                     \"date\": \"2026-11-22\", \"sources\": \"0\",\n\"values\": { \"a\": 1.5 } }\n";
        assert_eq!(Record::parse(whole).unwrap().value("a"), Some(1.5));
        let cases = [
            (&whole[..whole.len() - 4], 4, "EOF while parsing an object"),
            (&whole.replace("timed", "time"), 2, "unknown field `time`, expected one of"),
            (&whole.replace("1.5", "\"x\""), 1, "'a' is \"x\", which is no number"),
            ("", 1, "EOF while parsing a value"),
        ];
        for (text, line, start) in cases {
            let (at, what) = Record::parse(text).unwrap_err();
            assert!(at == line && what.starts_with(start), "{at}: {what}");
        }
    }

    #[test]
    fn values_come_back_to_the_last_bit() {
        let value = 3.105_392_059_055_134_3e-7_f64;
        let text = serde_json::json!({ "a": value }).to_string();
        let read: Map<String, Value> = serde_json::from_str(&text).unwrap();
        assert_eq!(read["a"].as_f64().unwrap().to_bits(), value.to_bits());
    }
}
