//! One run of a chapter, for a page's picture or for a panel of it.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, ensure};
use common::app::Picture as Large;
use manuscript::project::Project;
use time_limit::Limit;

use super::downscale;
use super::stamp::Maker;
use crate::programs::child;
use crate::programs::command_line::{CommandLine, runs};
use crate::programs::program::Programs;

/// A run that writes a picture.
pub struct Rendering {
    /// The label over it where it is a panel: the line `# LABEL` above the command.
    pub label: Option<String>,
    /// The chapter whose program runs.
    pub chapter: String,
    /// The program's arguments.
    arguments: Vec<String>,
}

impl Rendering {
    /// The runs in a shell text.
    ///
    /// # Errors
    /// The fault of one that is no run of a chapter or writes no picture, and its remedy.
    pub fn all(project: &Project, text: &str) -> Result<Vec<Self>, (String, &'static str)> {
        runs(text).iter().map(|(line, run)| Self::of(project, text, *line, run)).collect()
    }

    fn of(
        project: &Project,
        text: &str,
        line: usize,
        run: &CommandLine,
    ) -> Result<Self, (String, &'static str)> {
        let chapter = run.program(project).unwrap_or_default().to_owned();
        if project.named(&chapter).is_none() {
            return Err((format!("'{chapter}' is no chapter"), "name one with --bin"));
        }
        if out(&run.arguments).is_none_or(|index| run.arguments.len() <= index + 1) {
            return Err(("the command writes no picture".to_owned(), "add --out FILE.png"));
        }
        let above = line.checked_sub(1).and_then(|above| text.lines().nth(above));
        let label = above.and_then(|above| above.strip_prefix("# ")).map(str::to_owned);
        Ok(Self { label, chapter, arguments: run.arguments.clone() })
    }

    /// Renders it into a PNG, and returns its maker. What is larger than a page shows it is shrunk.
    ///
    /// # Errors
    /// If the program is missing or fails.
    pub fn make(&self, programs: &Programs, picture: &Path) -> Result<Maker> {
        let (report, large) = (picture.with_extension("json"), picture.with_extension("exr"));
        let times = downscale::times(&self.arguments);
        let mut arguments = self.arguments.clone();
        let index = out(&arguments).context("the command writes no picture")?;
        let written = if times > 1 { &large } else { picture };
        arguments[index + 1] = written.to_string_lossy().into_owned();
        let mut command = programs.built(&self.chapter)?;
        command.args(&arguments).arg("--report").arg(&report);
        let ended = child::run(&mut command, Limit::NONE)?;
        ensure!(ended.succeeded(), "{}", ended.said_in_a_line());
        if times > 1 {
            downscale::shrunk(&Large::open_exr(&large)?, times).save(picture)?;
        }
        let report: serde_json::Value = serde_json::from_slice(&fs::read(&report)?)?;
        Ok(Maker::of(&report))
    }
}

/// The index of `--out` among a run's arguments.
fn out(arguments: &[String]) -> Option<usize> {
    arguments.iter().position(|word| word == "--out")
}
