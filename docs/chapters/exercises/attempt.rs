//! Checks an exercise against an edition of the code: whether it is solved, and whether its file describes it
//! correctly.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use anyhow::{Context, Result, bail};
use common::app::Picture;
use flip::near::Near;
use time_limit::Limit;

use super::code;
use super::exercise::{Exercise, Takes};
use super::expectation::{Expectation, Other};
use super::fingerprint::fingerprint;
use super::mismatch::Mismatch;
use super::proof::{Run, Step, sized};
use super::solution::Solution;
use crate::patches::edition::Edition;
use crate::pictures::difference::marked;
use crate::programs::program::Programs;
use crate::programs::run_result::{RunResult, is_software};

/// The longest time of a program.
pub const LIMIT: Limit = Limit::worked(120);

/// The book's own pictures, each rendered once.
pub struct Originals<'a> {
    programs: &'a Programs<'a>,
    /// The folder of pictures kept before the book's own files were edited.
    kept: Option<PathBuf>,
    known: Mutex<BTreeMap<(String, Vec<String>), Picture>>,
}

impl<'a> Originals<'a> {
    /// Renders the pictures on demand.
    pub fn new(programs: &'a Programs<'a>) -> Self {
        Self { programs, kept: None, known: Mutex::default() }
    }

    /// Reads the pictures from a folder.
    pub fn kept(programs: &'a Programs<'a>, folder: &Path) -> Self {
        Self { kept: Some(folder.to_owned()), ..Self::new(programs) }
    }

    /// Renders every picture an exercise is compared with into a folder; nothing is left there if one fails.
    ///
    /// # Errors
    /// If one cannot be rendered or written.
    pub fn keep(&self, exercise: &Exercise, solution: &Solution, folder: &Path) -> Result<()> {
        let above = folder.parent().context("a folder lies in a folder")?;
        fs::create_dir_all(above).with_context(|| format!("cannot make '{}'", above.display()))?;
        let whole = tempfile::tempdir_in(above).context("cannot make a temporary folder")?;
        for (run, expectation) in exercise.steps.iter().flat_map(expected) {
            if let Some(other) = expectation.other().filter(|other| !other.own) {
                let (chapter, arguments) = self.meant(exercise, run, other);
                let picture = self.picture(&chapter, &arguments)?;
                picture.save(&whole.path().join(name(&chapter, &arguments)))?;
            }
        }
        solution.keep(whole.path())?;
        fs::rename(whole.keep(), folder)
            .with_context(|| format!("cannot make '{}'", folder.display()))
    }

    /// The chapter and the arguments of the picture to compare with.
    fn meant(&self, exercise: &Exercise, run: &[String], other: &Other) -> (String, Vec<String>) {
        let mut arguments = other.arguments.clone().unwrap_or_else(|| run.to_vec());
        let named = |word: &String| self.programs.project.named(word).is_some();
        let chapter = if arguments.first().is_some_and(named) {
            arguments.remove(0)
        } else {
            exercise.chapter.clone()
        };
        (chapter, sized(arguments))
    }

    fn picture(&self, chapter: &str, arguments: &[String]) -> Result<Picture> {
        if let Some(folder) = &self.kept {
            let file = folder.join(name(chapter, arguments));
            return Picture::open_exr(&file)
                .context("the book's picture is lost; delete its folder");
        }
        let known = || self.known.lock().unwrap_or_else(PoisonError::into_inner);
        let key = (chapter.to_owned(), arguments.to_vec());
        if let Some(picture) = known().get(&key) {
            return Ok(picture.clone());
        }
        let command = Edition::Book.command(self.programs, chapter)?;
        let what = format!("rendering the book's {chapter}");
        let seen = RunResult::saying(command, arguments, LIMIT, &what)?;
        let picture =
            seen.picture.with_context(|| format!("{chapter} fails as it is: {}", seen.said))?;
        known().insert(key, picture.clone());
        Ok(picture)
    }
}

/// The expectations of a step's run of the program, each with the run's arguments.
fn expected(step: &Step) -> Vec<(&[String], &Expectation)> {
    let Run::Program(arguments) = &step.run else { return Vec::new() };
    step.expectations.iter().map(|expectation| (&arguments[..], expectation)).collect()
}

/// The file of a picture that is kept.
fn name(chapter: &str, arguments: &[String]) -> String {
    format!("{chapter}-{}.exr", fingerprint([chapter.as_bytes(), arguments.join("\n").as_bytes()]))
}

/// The outcome of an exercise under an edition.
pub struct Verdict {
    /// The first expectation that is not met; `None` if the exercise is solved.
    pub missed: Option<Mismatch>,
    /// The picture of the run that showed it, else the first.
    pub picture: Option<Picture>,
}

/// An exercise, with everything needed to check an edition against it.
pub struct Attempt<'a> {
    /// Its programs.
    pub programs: &'a Programs<'a>,
    /// The book's pictures.
    pub originals: &'a Originals<'a>,
    /// The exercise.
    pub exercise: &'a Exercise,
    /// Its solution.
    pub solution: &'a Solution<'a>,
}

/// The expectations that an edition is checked against.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Held {
    /// Those that decide whether a reader has solved it.
    Reader,
    /// As for a reader, without tests, which take minutes to build.
    Pictures,
    /// All of them, including what the page says about the solution's picture.
    All,
}

impl Attempt<'_> {
    /// Checks whether an edition solves the exercise. Code that does not compile or run does not.
    ///
    /// # Errors
    /// If there is no verdict, because a program is not built or the book's own run fails.
    pub fn verdict(&self, edition: &Edition) -> Result<Verdict> {
        self.verdict_of(edition, Held::Reader)
    }

    /// Checks whether an edition solves the exercise, judging only by runs of the program.
    ///
    /// # Errors
    /// As [`Attempt::verdict`].
    pub fn looks_solved(&self, edition: &Edition) -> Result<bool> {
        Ok(self.verdict_of(edition, Held::Pictures)?.missed.is_none())
    }

    fn verdict_of(&self, edition: &Edition, held: Held) -> Result<Verdict> {
        let mut first = None;
        for step in &self.exercise.steps {
            let missed = match &step.run {
                Run::Program(arguments) => {
                    let command = edition.command(self.programs, &self.exercise.chapter)?;
                    let what = format!("rendering {}", self.exercise);
                    let seen = RunResult::saying(command, arguments, LIMIT, &what)?;
                    let missed = self.missed((edition, held), step, arguments, &seen)?;
                    if let Some(missed) = missed {
                        let picture = seen.picture;
                        return Ok(Verdict { missed: Some(missed), picture });
                    }
                    first = first.or(seen.picture);
                    None
                }
                Run::Test(..) if held == Held::Pictures => None,
                Run::Test(program, filter) => {
                    let tested = edition.test(self.programs, (program, filter))?;
                    let mut expectations = step.expectations.iter();
                    let missed =
                        expectations.find_map(|expected| expected.missed_by_tests(&tested));
                    missed
                        .map(|missed| format!("{missed} with cargo test --test {program} {filter}"))
                        .map(Mismatch::from)
                }
            };
            if let Some(missed) = missed {
                return Ok(Verdict { missed: Some(missed), picture: first });
            }
        }
        Ok(Verdict { missed: None, picture: first })
    }

    /// The first expectation that one run of the program does not meet.
    fn missed(
        &self,
        (edition, held): (&Edition, Held),
        step: &Step,
        arguments: &[String],
        seen: &RunResult,
    ) -> Result<Option<Mismatch>> {
        let (mut refused, mut heard) = (false, false);
        for expectation in &step.expectations {
            refused |= matches!(expectation, Expectation::Refused(_));
            heard |= matches!(expectation, Expectation::Validation(_));
        }
        let Some(status) = seen.status else {
            let what = format!("the program does not end within {LIMIT}");
            return Ok(Some(what.into()));
        };
        if let (false, Some(message)) = (heard, seen.messages().first()) {
            return Ok(Some(format!("validation says: {message}").into()));
        }
        if !status.success() && !refused && !heard {
            let said = if seen.said.is_empty() { status.to_string() } else { seen.said.clone() };
            return Ok(Some(said.into()));
        }
        let other = |other: &Other| {
            if other.own {
                let command = edition.command(self.programs, &self.exercise.chapter)?;
                let arguments = sized(other.arguments.clone().unwrap_or_default());
                let seen = RunResult::of(command, &arguments, LIMIT)?;
                seen.picture.with_context(|| format!("no picture: {}", seen.said))
            } else {
                let (chapter, arguments) = self.originals.meant(self.exercise, arguments, other);
                self.originals.picture(&chapter, &arguments)
            }
        };
        let is_as_solution = |one: &Expectation| matches!(one, Expectation::AsSolution(_));
        let judged = step.expectations.iter().any(is_as_solution) && held != Held::All;
        let asked = step.expectations.iter().filter(|one| !(judged && one.describes()));
        for expectation in asked {
            if let Expectation::Gone(code) = expectation {
                let read = |file: &str| edition.read(self.programs.project, file);
                match code::left(code, &self.exercise.patch.files(), read)? {
                    Some(what) => return Ok(Some(what.into())),
                    None => continue,
                }
            }
            let as_solution = is_as_solution(expectation);
            let with = match expectation.other() {
                Some(with) => Some((with.to_string(), other(with)?)),
                None if as_solution => {
                    Some(("where they differ".to_owned(), self.solution.picture(arguments)?))
                }
                None => None,
            };
            let picture = with.as_ref().map(|(_, picture)| picture);
            let near = || self.near(seen.device());
            if let Some(what) = expectation.missed(seen, picture, &near)? {
                let arguments = Some(arguments.to_vec());
                // Showing the target would give the solution away.
                let beside = with.map(|(what, picture)| match (&seen.picture, as_solution) {
                    (Some(own), true) => (what, marked(own, &picture)),
                    _ => (what, picture),
                });
                return Ok(Some(Mismatch { what, arguments, beside }));
            }
        }
        Ok(None)
    }

    /// The largest difference between pictures of two pipelines that compute the same: Vulkan promises equal bits of
    /// identical pipelines alone (appendix Invariance). The software driver makes all of them equal; in arithmetic of a
    /// seed of their own its pipelines are as another device's. `None`: not a bit.
    fn near(&self, device: &str) -> Result<Option<Near>> {
        let chapter = &self.exercise.chapter;
        let to_the_bit = std::env::var_os("ARITHMETIC_SEED").is_none()
            && is_software(self.programs, chapter, device, LIMIT)?;
        Ok(if to_the_bit { None } else { Near::if_any(chapter).map(Near::both) })
    }

    /// Checks that the exercise is unsolved before its solution and solved after it; the returned line says
    /// what was missing before.
    ///
    /// # Errors
    /// If either check fails.
    pub fn prove(&self) -> Result<String> {
        let (exercise, file) = (self.exercise, &self.exercise.patch.file);
        let before = self.verdict(&Edition::Book).with_context(|| file.clone())?.missed;
        if exercise.takes == Takes::Look {
            let Some(missed) = before else { return Ok(format!("{exercise}: its answer holds")) };
            bail!("{file}: its answer does not hold: {missed}");
        }
        let before = before.with_context(|| format!("{file}: solved before its solution"))?;
        let solved = || self.verdict_of(self.solution.edition()?, Held::All);
        let after = solved().with_context(|| file.clone())?.missed;
        match after {
            None => Ok(format!("{exercise}: {before}; solved by its solution")),
            Some(missed) => bail!("{file}: not solved by its solution: {missed}"),
        }
    }
}
