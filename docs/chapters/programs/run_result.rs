//! The result of a run of a chapter's program.

use std::fs;
use std::process::{Command, ExitStatus};

use anyhow::Result;
use common::app::Picture;
use common::files::NewFolder;
use serde_json::Value;
use time_limit::Limit;

use super::child;
use super::program::Programs;

/// The result of a run.
#[derive(Default)]
pub struct RunResult {
    /// The floats written by the shader; `None` if there is no picture.
    pub picture: Option<Picture>,
    /// `None` if it did not end.
    pub status: Option<ExitStatus>,
    /// Its standard error, in one line.
    pub said: String,
    /// Its standard output.
    pub told: String,
    /// Its report; null if there is none.
    pub report: Value,
}

impl RunResult {
    /// Runs a program headless and under validation, within a limit.
    ///
    /// # Errors
    /// If it does not start.
    pub fn of(command: Command, arguments: &[String], limit: Limit) -> Result<Self> {
        Self::saying(command, arguments, limit, "")
    }

    /// As [`RunResult::of`], and says what is waited for if it takes long.
    ///
    /// # Errors
    /// As there.
    pub fn saying(
        mut command: Command,
        arguments: &[String],
        limit: Limit,
        what: &str,
    ) -> Result<Self> {
        let folder = NewFolder::temporary()?;
        let (out, report) = (folder.path().join("out.exr"), folder.path().join("report.json"));
        command.args(["--headless", "--validate"]).args(arguments);
        command.arg("--out").arg(&out).arg("--report").arg(&report);
        let ended = child::run_saying(&mut command, limit, what)?;
        let said = ended.said_in_a_line();
        Ok(Self {
            picture: Picture::open_exr(&out).ok(),
            status: ended.status,
            said: said.trim_start_matches("error: ").to_owned(),
            told: ended.told,
            report: fs::read(&report)
                .ok()
                .and_then(|text| serde_json::from_slice(&text).ok())
                .unwrap_or_default(),
        })
    }

    /// Returns whether the program ended without an error.
    pub fn succeeded(&self) -> bool {
        self.status.is_some_and(|status| status.success())
    }

    /// The validation messages.
    pub fn messages(&self) -> Vec<&str> {
        let messages = self.report["validation_messages"].as_array().into_iter().flatten();
        messages.map(|message| message.as_str().unwrap_or_default()).collect()
    }

    /// The device's time for a frame, in milliseconds.
    pub fn milliseconds(&self) -> f64 {
        self.report["gpu_milliseconds"]["median"].as_f64().unwrap_or_default()
    }

    /// The device's name.
    pub fn device(&self) -> &str {
        self.report["device"].as_str().unwrap_or("unknown")
    }
}

/// Returns whether the device of this name is a software driver, according to the list printed by a chapter's
/// program.
///
/// # Errors
/// If the program is not built, or does not start.
pub fn is_software(programs: &Programs, chapter: &str, device: &str, limit: Limit) -> Result<bool> {
    let listed = child::run(programs.built(chapter)?.arg("--list-devices"), limit)?.told;
    let line = format!(": {device} (software;");
    Ok(listed.lines().any(|listed| listed.contains(&line)))
}
