//! One run of a chapter or of the reader's own program, for a page's picture or for a panel of it.

use std::fs;
use std::path::Path;
use std::process::Command;

use anyhow::{Context, Result, ensure};
use common::app::Picture as Large;
use common::files::NewFolder;
use manuscript::project::Project;
use time_limit::Limit;

use super::downscale;
use super::stamp::Maker;
use crate::programs::child;
use crate::programs::command_line::{CommandLine, runs};
use crate::programs::own_program;
use crate::programs::program::Programs;

/// A run that writes a picture.
pub struct Rendering {
    /// The label above its panel, from the line `# LABEL` above the command.
    pub label: Option<String>,
    /// The chapter of the program, or the name of the reader's own program.
    pub chapter: String,
    /// The step of the page after which the reader's own program is run.
    step: usize,
    /// The program's arguments.
    arguments: Vec<String>,
}

impl Rendering {
    /// The runs in a shell text.
    ///
    /// # Errors
    /// The fault of one that does not run a chapter or writes no picture, and its remedy.
    pub fn all(
        project: &Project,
        text: &str,
        step: Option<&str>,
    ) -> Result<Vec<Self>, (String, &'static str)> {
        runs(text).iter().map(|(line, run)| Self::of(project, text, step, *line, run)).collect()
    }

    fn of(
        project: &Project,
        text: &str,
        step: Option<&str>,
        line: usize,
        run: &CommandLine,
    ) -> Result<Self, (String, &'static str)> {
        let chapter = run.program(project).unwrap_or_default().to_owned();
        let is_own = chapter == own_program::NAME;
        if project.named(&chapter).is_none() && !is_own {
            return Err((format!("'{chapter}' is no chapter"), "name one with --bin"));
        }
        if out(&run.arguments).is_none_or(|index| run.arguments.len() <= index + 1) {
            return Err(("the command writes no picture".to_owned(), "add --out FILE.png"));
        }
        let step = match own_program::step(step.filter(|_| is_own)) {
            Ok(step) => step,
            Err(steps) => return Err((format!("the step is none of {steps}"), "name one of them")),
        };
        let above = line.checked_sub(1).and_then(|above| text.lines().nth(above));
        let label = above.and_then(|above| above.strip_prefix("# ")).map(str::to_owned);
        Ok(Self { label, chapter, step, arguments: run.arguments.clone() })
    }

    /// Renders it into a PNG, and returns its maker. A picture larger than on the page is shrunk.
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
        if self.chapter == own_program::NAME {
            let shaders = NewFolder::temporary()?;
            let mut command = own_program::command(programs, self.step, shaders.path())?;
            run(command.args(&arguments))?;
            // The reader's program writes no report. The book's first program runs on the same device.
            let first = programs.project.default_run.as_deref().context("no program by default")?;
            let tiny = ["--headless", "--size", "8x8", "--report"];
            run(programs.built(first)?.args(tiny).arg(&report))?;
        } else {
            let mut command = programs.built(&self.chapter)?;
            run(command.args(&arguments).arg("--report").arg(&report))?;
        }
        if times > 1 {
            downscale::shrunk(&Large::open_exr(&large)?, times).save(picture)?;
        }
        let report: serde_json::Value = serde_json::from_slice(&fs::read(&report)?)?;
        Ok(Maker::of(&report))
    }
}

fn run(command: &mut Command) -> Result<()> {
    let ended = child::run(command, Limit::NONE)?;
    ensure!(ended.succeeded(), "{}", ended.said_in_a_line());
    Ok(())
}

/// The index of `--out` among a run's arguments.
fn out(arguments: &[String]) -> Option<usize> {
    arguments.iter().position(|word| word == "--out")
}
