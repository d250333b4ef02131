//! What a report card has of the atlas: what the device's own traversal computes.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};
use instruments::report::Limits;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::card::Device;
use super::command::{VALIDATE, read, words};

/// The schema that 24 writes.
const SCHEMA: &str = "rt-atlas/1";

/// The arithmetic of a card of chapters.
pub const DRIVER: &str = "driver";

/// The atlas of a device, as `24_accuracy --atlas` writes it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Atlas {
    /// Why there is none; `None` if there is.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub failed: Option<String>,
    /// What its fields mean.
    pub schema: String,
    /// The device's name, as its driver gives it.
    pub device: String,
    /// Its driver, in its maker's words.
    pub driver: String,
    /// The value of `--arithmetic`.
    pub arithmetic: String,
    /// Whose triangles were measured.
    pub traversal: String,
    /// The day, as `2026-11-22`.
    pub date: String,
    /// Rays of each case.
    pub rays: u64,
    /// The limits that the chapters heed.
    pub limits: Limits,
    /// A row a claim of the specification.
    pub rows: Vec<Row>,
    /// What validation had to say.
    pub validation_messages: Vec<String>,
}

/// A claim, what chapters rely on, and what was found.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[allow(missing_docs, reason = "they are those of `--atlas`")]
pub struct Row {
    pub row: String,
    pub title: String,
    pub section: String,
    pub claim: String,
    pub met: Option<bool>,
    pub relied: String,
    pub kept: Option<bool>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unavailable: Option<String>,
    pub by_floats: u64,
    pub by_rationals: u64,
    pub checked: u64,
    pub beyond: u64,
    pub cases: Vec<Case>,
}

/// A family of rays.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[allow(missing_docs, reason = "they are those of `--atlas`")]
pub struct Case {
    pub case: String,
    pub rays: u64,
    pub found: Map<String, Value>,
    #[serde(skip_serializing_if = "Map::is_empty")]
    pub buckets: Map<String, Value>,
}

/// What 24 is asked.
pub fn run(folder: &Path, arithmetic: &str) -> Vec<String> {
    let mut arguments = words(&["--headless", VALIDATE, "--arithmetic", arithmetic, "--atlas"]);
    arguments.push(folder.to_string_lossy().into_owned());
    arguments
}

/// What it has left in the folder: the atlas, and the same as Markdown.
pub fn found(failed: Option<String>, folder: &Path) -> (Atlas, String) {
    let left = || -> Result<(Atlas, String)> {
        let atlas = serde_json::from_value(read(&folder.join("atlas.json"))?)?;
        let text = fs::read_to_string(folder.join("atlas.md")).context("it has written no text")?;
        Ok((atlas, text))
    };
    match (failed, left()) {
        (None, Ok(found)) => found,
        (failed, left) => {
            let why = failed.or_else(|| Some(super::command::told(&left.err()?)));
            (Atlas { failed: why.clone(), ..Atlas::default() }, why.unwrap_or_default() + "\n")
        }
    }
}

impl Atlas {
    /// The device that it is of; `None` if there is no atlas.
    pub fn of_device(&self) -> Option<Device> {
        let Self { device: name, driver, limits, .. } = self.clone();
        self.failed.is_none().then_some(Device { name, driver, limits })
    }

    /// What is wrong with it; nothing if it is an atlas, or says why there is none.
    pub fn wrong(&self) -> Option<String> {
        if self.failed.is_some() {
            return None;
        }
        if self.schema != SCHEMA {
            return Some(format!("its atlas has the schema '{}', not '{SCHEMA}'", self.schema));
        }
        let cases = || self.rows.iter().flat_map(|row| &row.cases);
        let is_number = |value: &Value| value.is_number() || value.is_null();
        if let Some(case) = cases().find(|case| !case.found.values().all(is_number)) {
            return Some(format!("its atlas tells no numbers of '{}'", case.case));
        }
        (cases().count() == 0).then(|| "its atlas is empty".to_owned())
    }
}
