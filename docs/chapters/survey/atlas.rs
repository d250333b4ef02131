//! The atlas of a report card: the errors of the device's own traversal.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, ensure};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::card::Device;
use super::command::{VALIDATE, device, read, told, words};

/// The schema that 24 writes.
const SCHEMA: &str = "rt-atlas/1";

/// The arithmetic of a card with chapters.
pub const DRIVER: &str = "driver";

/// The numbers that `docs/what-hardware-computes.md` and its charts show.
const SHOWN: [&str; 17] = [
    "t p99",
    "t max",
    "weights p99",
    "weights max",
    "t, part of what is excused",
    "weights, part of what is excused",
    "missed",
    "hit beside",
    "lost",
    "doubled",
    "meet it",
    "offered up to, ULP of way",
    "refused from, ULP of way",
    "first wins",
    "second wins",
    "called",
    "called again",
];

/// The part of `24_accuracy --atlas` that is kept on a card.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Atlas {
    /// The reason why there is none; `None` if there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub failed: Option<String>,
    /// The value of `--arithmetic`.
    pub arithmetic: String,
    /// Rays of each case.
    pub rays: u64,
    /// A row for each claim of the specification.
    pub rows: Vec<Row>,
}

/// The cases of a claim.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs, reason = "they are those of `--atlas`")]
pub struct Row {
    pub row: String,
    pub cases: Vec<Case>,
}

/// A family of rays.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs, reason = "they are those of `--atlas`")]
pub struct Case {
    pub case: String,
    pub found: Map<String, Value>,
}

/// The arguments of 24.
pub fn run(folder: &Path, arithmetic: &str) -> Vec<String> {
    let mut arguments = words(&["--headless", VALIDATE, "--arithmetic", arithmetic, "--atlas"]);
    arguments.push(folder.to_string_lossy().into_owned());
    arguments
}

/// Reads the files in the folder: the atlas, its device, and the whole atlas as Markdown.
pub fn found(failed: Option<String>, folder: &Path) -> (Atlas, Option<Device>, String) {
    let left = || -> Result<(Atlas, Option<Device>, String)> {
        let whole = read(&folder.join("atlas.json"))?;
        let text = fs::read_to_string(folder.join("atlas.md")).context("it has written no text")?;
        Ok((Atlas::of(&whole)?, device(&whole), text))
    };
    let why = match (failed, left()) {
        (None, Ok(found)) => return found,
        (Some(failed), _) => failed,
        (None, Err(error)) => told(&error),
    };
    (Atlas { failed: Some(why.clone()), ..Atlas::default() }, None, why + "\n")
}

impl Atlas {
    /// Extracts the part that is kept on a card.
    fn of(whole: &Value) -> Result<Self> {
        let text = |value: &Value, key: &str| value[key].as_str().map(str::to_owned);
        let schema = text(whole, "schema").unwrap_or_default();
        ensure!(schema == SCHEMA, "its atlas has the schema '{schema}', not '{SCHEMA}'");
        let case = |case: &Value| {
            let mut found = case["found"].as_object()?.clone();
            found.retain(|name, _| SHOWN.contains(&&**name));
            Some(Case { case: text(case, "case")?, found })
        };
        let row = |row: &Value| {
            let cases: Vec<Case> = row["cases"].as_array()?.iter().filter_map(case).collect();
            (!cases.is_empty()).then_some(Row { row: text(row, "row")?, cases })
        };
        Ok(Self {
            failed: None,
            arithmetic: text(whole, "arithmetic").context("its atlas names no arithmetic")?,
            rays: whole["rays"].as_u64().context("its atlas has no rays")?,
            rows: whole["rows"].as_array().into_iter().flatten().filter_map(row).collect(),
        })
    }

    /// The fault of a part that is invalid and does not say why there is no atlas.
    pub fn wrong(&self) -> Option<String> {
        if self.failed.is_some() {
            return None;
        }
        let cases = || self.rows.iter().flat_map(|row| &row.cases);
        let is_number = |value: &Value| value.is_number() || value.is_null();
        if let Some(case) = cases().find(|case| !case.found.values().all(is_number)) {
            return Some(format!("its atlas tells no numbers of '{}'", case.case));
        }
        (cases().count() == 0).then(|| "its atlas is empty".to_owned())
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn a_card_keeps_of_an_atlas_what_the_page_shows() {
        let found = json!({ "t p50": 0.4, "t max": 1.5 });
        let cases =
            json!([{ "case": "size 1", "rays": 9, "found": found, "buckets": { "t": [9] } }]);
        let whole = json!({
            "schema": SCHEMA, "arithmetic": "worst", "rays": 9, "date": "2026-11-22",
            "rows": [{ "row": "triangles", "cases": cases }, { "row": "corners", "cases": [] }],
        });
        let kept = json!({
            "arithmetic": "worst", "rays": 9,
            "rows": [{ "row": "triangles", "cases": [{ "case": "size 1", "found": { "t max": 1.5 } }] }],
        });
        let atlas = Atlas::of(&whole).expect("an atlas");
        assert_eq!(serde_json::to_value(&atlas).expect("JSON"), kept);
        assert_eq!(atlas.wrong(), None);
        let other = Atlas::of(&json!({ "schema": "rt-atlas/2" })).expect_err("another schema");
        assert_eq!(other.to_string(), "its atlas has the schema 'rt-atlas/2', not 'rt-atlas/1'");
        assert_eq!(Atlas::default().wrong().as_deref(), Some("its atlas is empty"));
    }
}
