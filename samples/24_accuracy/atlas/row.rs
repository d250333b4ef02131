//! A row of the atlas: a claim of the specification, what chapters rely on, and what was found.

use std::fmt::Write as _;

use serde::Serialize;
use serde_json::{Map, Value};

use super::errors::{Errors, Spread};
use super::truth::Truth;

/// One row.
#[derive(Default, Serialize)]
pub struct Row {
    /// A word, by which pages and tests know it.
    pub row: &'static str,
    /// The question in words.
    pub title: &'static str,
    /// The section of the Vulkan specification, and its words.
    pub section: &'static str,
    pub claim: &'static str,
    /// True if this device does what is claimed; `None` where the words promise nothing, or nothing was tested.
    pub met: Option<bool>,
    /// The property that chapters rely on.
    pub relied: &'static str,
    /// True if this device has that property; `None` where nothing was tested.
    pub kept: Option<bool>,
    /// The reason why nothing was tested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unavailable: Option<String>,
    /// Truths that 64-bit floats decided, and rationals; how many rays both decided, and disagreed beyond the
    /// proved bound.
    pub by_floats: u64,
    pub by_rationals: u64,
    pub checked: u64,
    pub beyond: u64,
    pub cases: Vec<Case>,
}

/// A test of one kind, of one family of rays.
#[derive(Serialize)]
pub struct Case {
    pub case: String,
    pub rays: usize,
    /// Numbers by name, in the order of a table.
    pub found: Map<String, Value>,
    /// Number of errors of each size, by quantity: below 2^-4, then by powers of two, and from 2^20.
    #[serde(skip_serializing_if = "Map::is_empty")]
    pub buckets: Map<String, Value>,
}

impl Case {
    pub fn new(case: impl Into<String>, rays: usize) -> Self {
        Self { case: case.into(), rays, found: Map::new(), buckets: Map::new() }
    }

    /// Adds a number.
    pub fn tell(&mut self, name: &str, number: impl Into<Value>) {
        self.found.insert(name.to_owned(), number.into());
    }

    /// Adds the figures of errors.
    pub fn spread(&mut self, of: &str, errors: Errors) {
        let Spread { p50, p99, max, buckets } = errors.spread();
        for (part, value) in [("p50", p50), ("p99", p99), ("max", max)] {
            self.tell(&format!("{of} {part}"), value);
        }
        self.buckets.insert(of.to_owned(), buckets.into());
    }

    /// A figure of the row; 0 if it is missing.
    pub fn number(&self, name: &str) -> f64 {
        self.found.get(name).and_then(Value::as_f64).unwrap_or_default()
    }
}

impl Row {
    /// Adds how the truth came about.
    pub fn decided(mut self, truth: &Truth) -> Self {
        let Truth { by_floats, by_rationals, checked, beyond, .. } = *truth;
        (self.by_floats, self.by_rationals) = (by_floats, by_rationals);
        (self.checked, self.beyond) = (checked, beyond);
        self
    }

    /// As Markdown.
    pub fn markdown(&self) -> String {
        let mut text = format!("\n## {}\n\n", self.title);
        let kept = match (self.kept, &self.unavailable) {
            (_, Some(why)) => format!(" (not asked: {why})"),
            (Some(true), _) => " (kept here)".to_owned(),
            (Some(false), _) => " (**not kept here**)".to_owned(),
            (None, None) => String::new(),
        };
        let met = match self.met {
            Some(true) => " Met here.",
            Some(false) => " **Not met here.**",
            None => "",
        };
        let _ = writeln!(text, "> {} (*{}*){met}\n", self.claim, self.section);
        let _ = writeln!(text, "Chapters rely on: {}{kept}.\n", self.relied);
        let Some(first) = self.cases.first() else { return text };
        let heads: Vec<&str> = first.found.keys().map(String::as_str).collect();
        let _ = writeln!(text, "| case | rays | {} |", heads.join(" | "));
        let _ = writeln!(text, "|---|--:|{}", "--:|".repeat(heads.len()));
        for case in &self.cases {
            let cells = heads.iter().map(|head| cell(case.found[*head].as_f64()));
            let cells = cells.collect::<Vec<_>>().join(" | ");
            let _ = writeln!(text, "| {} | {} | {cells} |", case.case, case.rays);
        }
        text
    }
}

fn cell(number: Option<f64>) -> String {
    match number {
        None => "–".to_owned(),
        Some(number) if number.fract() == 0.0 && number.abs() < 1e9 => format!("{number}"),
        Some(number) if number.abs() < 1e5 => format!("{number:.3}"),
        Some(number) => format!("{number:.3e}"),
    }
}
