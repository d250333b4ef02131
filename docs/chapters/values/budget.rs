//! The compiled size of a chapter's default pipeline on a GPU, from `tests/gpus/budgets.json`: the tests of
//! `gpus` run the compiler, and their recorded values need not be computed again.

use std::collections::BTreeSet;

use manuscript::fault::Fault;
use manuscript::project::Project;
use serde_json::{Map, Value};

use super::record::Record;
use crate::programs::command_line;

const FILE: &str = "tests/gpus/budgets.json";

/// The recorded values for a stored measurement's command and compiler. `None` if the command sets anything,
/// or the pipeline is several programs, of which only the sums are recorded.
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
    let (_, version) = stored.driver.rsplit_once("Mesa ")?;
    let version = version.split(['-', ' ']).next()?;
    let recorded: Value = serde_json::from_str(&project.read(FILE).ok()?).ok()?;
    let recorded = recorded[format!("Mesa {version}")][chapter][family?].as_object()?;
    (recorded.get("programs") == Some(&Value::from(1))).then(|| recorded.clone())
}

/// Chapters without recorded figures, and records of chapters that no longer exist.
pub fn check(project: &Project) -> Vec<Fault> {
    let Ok(text) = project.read(FILE) else { return Vec::new() };
    let renew = "run: UPDATE=1 cargo test --test gpus";
    let fault = |what: String| Fault::new(FILE, 1, what, renew);
    let Ok(Value::Object(recorded)) = serde_json::from_str(&text) else {
        return vec![fault("this is no table of figures".to_owned())];
    };
    let known: BTreeSet<&str> = recorded
        .values()
        .filter_map(Value::as_object)
        .flat_map(Map::keys)
        .map(String::as_str)
        .collect();
    let missing = project.chapters.iter().filter(|chapter| {
        // The first chapter calls Vulkan itself, without the compiler's statistics.
        chapter.from.is_some() && !known.contains(&*chapter.name)
    });
    let missing = missing.map(|chapter| format!("nothing is recorded of '{}'", chapter.name));
    let gone = known.iter().filter(|name| project.named(name).is_none());
    let gone = gone.map(|name| format!("'{name}' is no chapter any more"));
    missing.chain(gone).map(fault).collect()
}
