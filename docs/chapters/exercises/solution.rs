//! The pictures of an exercise's solution, rendered on this device, to compare a reader's with.

use std::cell::{OnceCell, RefCell};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use common::app::Picture;

use super::attempt::LIMIT;
use super::exercise::Exercise;
use super::expectation::Expectation;
use super::fingerprint::fingerprint;
use super::proof::Run;
use crate::patches::edition::{Edition, Patched};
use crate::programs::program::Programs;
use crate::programs::run_result::RunResult;

/// The solution of an exercise, built on demand.
pub struct Solution<'a> {
    programs: &'a Programs<'a>,
    exercise: &'a Exercise,
    /// The folder of pictures kept before the book's own files were edited.
    kept: Option<PathBuf>,
    patched: OnceCell<Patched>,
    known: RefCell<BTreeMap<Vec<String>, Picture>>,
}

impl<'a> Solution<'a> {
    /// Renders the pictures on demand.
    pub fn new(programs: &'a Programs<'a>, exercise: &'a Exercise) -> Self {
        let (patched, known) = (OnceCell::new(), RefCell::default());
        Self { programs, exercise, kept: None, patched, known }
    }

    /// Reads the pictures from a folder.
    pub fn kept(programs: &'a Programs<'a>, exercise: &'a Exercise, folder: &Path) -> Self {
        Self { kept: Some(folder.to_owned()), ..Self::new(programs, exercise) }
    }

    /// Renders every picture a reader's is compared with into a folder.
    ///
    /// # Errors
    /// If one cannot be rendered or written.
    pub fn keep(&self, folder: &Path) -> Result<()> {
        for step in &self.exercise.steps {
            let judged =
                step.expectations.iter().any(|one| matches!(one, Expectation::AsSolution(_)));
            if let (true, Run::Program(arguments)) = (judged, &step.run) {
                self.picture(arguments)?.save(&folder.join(name(arguments)))?;
            }
        }
        Ok(())
    }

    /// The code with the solution applied.
    ///
    /// # Errors
    /// If it does not apply, or cannot be written.
    pub fn edition(&self) -> Result<&Edition> {
        if let Some(patched) = self.patched.get() {
            return Ok(&patched.edition);
        }
        let patched = Patched::of(self.programs, &self.exercise.patch)?;
        Ok(&self.patched.get_or_init(|| patched).edition)
    }

    /// The solution's picture with these arguments.
    ///
    /// # Errors
    /// If there is none.
    pub fn picture(&self, arguments: &[String]) -> Result<Picture> {
        if let Some(folder) = &self.kept {
            return Picture::open_exr(&folder.join(name(arguments)))
                .context("the solution's picture is lost; delete its folder");
        }
        if let Some(picture) = self.known.borrow().get(arguments) {
            return Ok(picture.clone());
        }
        let command = self.edition()?.command(self.programs, &self.exercise.chapter)?;
        let what = format!("rendering the target of {}", self.exercise);
        let seen = RunResult::saying(command, arguments, LIMIT, &what)?;
        let picture =
            seen.picture.with_context(|| format!("the solution has no picture: {}", seen.said))?;
        self.known.borrow_mut().insert(arguments.to_vec(), picture.clone());
        Ok(picture)
    }
}

/// The file of a picture that is kept.
fn name(arguments: &[String]) -> String {
    format!("solution-{}.exr", fingerprint([b"solution", arguments.join("\n").as_bytes()]))
}
