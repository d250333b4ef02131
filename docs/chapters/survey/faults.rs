//! A report card's part about known faults of drivers, for which chapter 24 looks.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::command::{read, rows, words};

/// The names of its runs in the progress lines.
pub const KNOWN: &str = "known faults";
pub const RISKY: &str = "empty top level";

/// The circumstances of a fault, and how many rays show it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FaultRow {
    /// The circumstances; or the run that failed.
    pub what: String,
    /// The number of rays.
    #[serde(default)]
    pub rays: u64,
    /// The number of rays that show the fault.
    #[serde(default)]
    pub wrong: u64,
    /// The shaders in which it showed.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub places: Vec<String>,
    /// The reason why there is no result, such as a crash.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub failed: Option<String>,
}

impl FaultRow {
    /// True if the device has the fault.
    pub fn is_seen(&self) -> bool {
        self.wrong > 0 || self.failed.is_some()
    }

    /// Its result in words.
    pub fn result(&self) -> String {
        let Self { rays, wrong, places, failed, .. } = self;
        match (failed, wrong) {
            (Some(why), _) => why.clone(),
            (None, 0) => format!("not seen here: all {rays} rays are right"),
            _ => {
                format!("{wrong} of {rays} rays are wrong {}", places.join(", ")).trim().to_owned()
            }
        }
    }
}

/// The arguments of a run; its rows go to a folder.
pub fn run(folder: &Path, risky: bool) -> Vec<String> {
    let mut arguments = words(&["--headless", "--faults"]);
    arguments.extend(risky.then(|| "--risky".to_owned()));
    arguments.push("--report".to_owned());
    arguments.push(folder.join(FILE).to_string_lossy().into_owned());
    arguments
}

/// The file of a run's rows.
const FILE: &str = "faults.json";

/// The rows of a run. If it left none, the only row has the reason.
pub fn found(what: &str, failed: Option<String>, folder: &Path) -> Vec<FaultRow> {
    let file = folder.join(FILE);
    let found: Vec<FaultRow> = read(&file).map(|list| rows(&list)).unwrap_or_default();
    let _ = std::fs::remove_file(file);
    if !found.is_empty() {
        return found;
    }
    let failed = Some(failed.unwrap_or_else(|| "it has written no rows".to_owned()));
    vec![FaultRow { what: what.to_owned(), failed, ..FaultRow::default() }]
}
