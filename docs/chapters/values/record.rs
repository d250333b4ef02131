//! The stored values of a page, `docs/values/PAGE.json`: for each measurement its command, device, driver and
//! date, and the resulting numbers.

use std::collections::BTreeMap;
use std::fs;

use anyhow::Result;
use manuscript::fault::Fault;
use manuscript::project::Project;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

/// The folder of the stored values.
pub const FOLDER: &str = "docs/values";

/// The device of values that a test computes without one.
pub const HOST: &str = "host";

/// Every stored measurement, by `PAGE/NAME`.
pub type Records = BTreeMap<String, Record>;

/// One stored measurement.
#[derive(Clone, Debug, Deserialize, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Record {
    /// The command that made it.
    pub command: String,
    /// True for times: they differ from run to run.
    #[serde(default)]
    pub timed: bool,
    /// The device's name, or [`HOST`].
    #[serde(default)]
    pub device: String,
    /// The driver, as its maker names it.
    #[serde(default)]
    pub driver: String,
    /// The day, as `2026-11-22`; empty before the first measurement.
    #[serde(default)]
    pub date: String,
    /// The last commit with this command, if it can no longer be run; the values then stay unchanged.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub commit: Option<String>,
    /// The numbers, by name, in the order of the command's output.
    #[serde(default)]
    pub values: Map<String, Value>,
}

/// The file of a page's values, from the project's root.
pub fn file(page: &str) -> String {
    format!("{FOLDER}/{page}.json")
}

/// The remedy for a measurement that is missing or out of date.
pub fn renew(name: &str) -> String {
    format!("run: cargo chapters measure {name}")
}

impl Record {
    /// Every stored measurement, and faults of the files.
    pub fn all(project: &Project) -> (Records, Vec<Fault>) {
        let (mut found, mut faults) = (BTreeMap::new(), Vec::new());
        for file in project.files(FOLDER).into_iter().filter(|file| !file.ends_with(".md")) {
            let name = file.strip_prefix(FOLDER).and_then(|rest| rest.strip_suffix(".json"));
            let Some(page) = name.map(|name| name.trim_start_matches('/').to_owned()) else {
                faults.push(Fault::new(file, 1, "stored values are a file PAGE.json", "rename it"));
                continue;
            };
            match Self::of_page(&project.read(&file).unwrap_or_default()) {
                Ok(records) => {
                    found.extend(records.into_iter().map(|(name, r)| (format!("{page}/{name}"), r)))
                }
                Err((line, what)) => {
                    let what = format!("these are no stored values: {what}");
                    faults.push(Fault::new(file, line, what, renew(&page)));
                }
            }
        }
        (found, faults)
    }

    /// The measurements in a page's file, by name; otherwise the line of the first mistake, and its
    /// description.
    fn of_page(text: &str) -> Result<BTreeMap<String, Self>, (usize, String)> {
        let stored: BTreeMap<String, Self> = serde_json::from_str(text).map_err(|error| {
            let what = error.to_string();
            let what = what.split(" at line").next().unwrap_or_default().to_owned();
            (error.line().max(1), what)
        })?;
        let values = stored.values().flat_map(|record| &record.values);
        match values.into_iter().find(|(_, value)| !value.is_number()) {
            Some((name, value)) => Err((1, format!("'{name}' is {value}, which is not a number"))),
            None => Ok(stored),
        }
    }

    /// The value of this name.
    pub fn value(&self, name: &str) -> Option<f64> {
        self.values.get(name)?.as_f64()
    }

    /// True if both have the same device and driver.
    pub fn is_of_device_of(&self, other: &Self) -> bool {
        (&self.device, &self.driver) == (&other.device, &other.driver)
    }

    /// True if two runs of one command gave the same values on the same device.
    pub fn agrees(&self, other: &Self) -> bool {
        self.values == other.values && self.command == other.command && self.is_of_device_of(other)
    }

    /// Stores it in its page's file, next to the others; an unchanged file is not written.
    ///
    /// # Errors
    /// If the file cannot be read or written.
    pub fn write(self, project: &Project, name: &str) -> Result<()> {
        let (page, own) = name.split_once('/').unwrap_or((name, ""));
        let path = project.root.join(file(page));
        let old = fs::read_to_string(&path).unwrap_or_default();
        let mut records = Self::of_page(&old).unwrap_or_default();
        records.insert(own.to_owned(), self);
        let new = serde_json::to_string_pretty(&records)? + "\n";
        if new != old {
            fs::create_dir_all(path.parent().unwrap_or(&project.root))?;
            common::files::write_whole(&path, new.as_bytes())?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_damaged_file_is_reported_with_its_line() {
        let whole = "{ \"n\": {\n\"command\": \"c\", \"timed\": false, \"device\": \"d\", \"driver\": \"e\",\n\
                     \"date\": \"2026-11-22\",\n\"values\": { \"a\": 1.5 } } }\n";
        assert_eq!(Record::of_page(whole).unwrap()["n"].value("a"), Some(1.5));
        let cases = [
            (&whole[..whole.len() - 6], 4, "EOF while parsing an object"),
            (&whole.replace("timed", "time"), 2, "unknown field `time`, expected one of"),
            (&whole.replace("1.5", "\"x\""), 1, "'a' is \"x\", which is not a number"),
            ("", 1, "EOF while parsing a value"),
        ];
        for (text, line, start) in cases {
            let (at, what) = Record::of_page(text).unwrap_err();
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
