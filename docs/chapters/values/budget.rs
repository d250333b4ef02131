//! The compiled size of a chapter's default pipeline on a GPU, from `tests/gpus/budgets.json`: the tests of `gpus` ask
//! the compiler, and what they have recorded need not be asked a second time.

use manuscript::project::Project;
use serde_json::{Map, Value};

use super::record::Record;
use crate::programs::command_line;

const FILE: &str = "tests/gpus/budgets.json";

/// The recorded values for a stored measurement's command and compiler. None if the command sets anything, or
/// the pipeline is several programs, of which only the sums are recorded.
pub fn values(project: &Project, stored: &Record) -> Option<Map<String, Value>> {
    let runs = command_line::runs(&stored.command);
    let [(_, run)] = &runs[..] else { return None };
    let chapter = run.program(project)?;
    let mut words = run.arguments.iter().map(String::as_str);
    let mut family = None;
    while let Some(word) = words.next() {
        match word {
            "--size" => drop(words.next()),
            "--compile-for" => family = words.next(),
            _ => return None,
        }
    }
    let (_, version) = stored.driver.split_once("Mesa ")?;
    let version = version.split(['-', ' ']).next()?;
    let recorded: Value = serde_json::from_str(&project.read(FILE).ok()?).ok()?;
    let recorded = recorded[format!("Mesa {version}")][chapter][family?].as_object()?;
    (recorded.get("programs") == Some(&Value::from(1))).then(|| recorded.clone())
}
