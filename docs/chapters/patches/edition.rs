//! An edition of the book's code that can be run: unchanged, with other shaders, or a changed copy.

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, ensure};
use common::files::NewFolder;
use common::output::complain;
use manuscript::project::Project;
use time_limit::{ASLEEP, Limit};

use super::patch::Patch;
use super::seed;
use crate::programs::child;
use crate::programs::program::Programs;

/// The folder in which patched code is built, one patch after the other, starting from the book's own build
/// ([`seed`]).
const COPY: &str = "target/mistakes/copy";
const BUILT: &str = "target/mistakes/build";
const LOCK: &str = "target/mistakes/lock";

/// The longest time of tests after the build.
const LIMIT: Limit = Limit::waited(ASLEEP);

/// An edition.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Edition {
    /// The book's programs and shaders.
    Book,
    /// The book's programs with the shaders in a folder.
    Shaders(PathBuf),
    /// A copy of all code in a folder, built before it runs.
    Copy(PathBuf),
    /// The book's own files as a reader has edited them, built before they run.
    Edited,
}

/// An edition with a patch, valid until it is dropped.
pub struct Patched {
    /// The edition.
    pub edition: Edition,
    _shaders: Option<NewFolder>,
    _lock: Option<File>,
}

impl Patched {
    /// Applies the patch. A patch of shaders gets a folder of its own; any other waits until the single copy
    /// of all code is free.
    ///
    /// # Errors
    /// If the patch does not apply, or the copy cannot be written.
    pub fn of(programs: &Programs, patch: &Patch) -> Result<Self> {
        let project = programs.project;
        if patch.is_in_shaders() {
            let folder = NewFolder::temporary()?;
            patch.copy_to(project, folder.path())?;
            let edition = Edition::Shaders(folder.path().to_owned());
            return Ok(Self { edition, _shaders: Some(folder), _lock: None });
        }
        let copy = project.root.join(COPY);
        fs::create_dir_all(&copy).with_context(|| format!("cannot make '{}'", copy.display()))?;
        let lock = File::create(project.root.join(LOCK)).context("cannot make a lock")?;
        if lock.try_lock().is_err() {
            complain("waiting: another command builds in the same copy");
            lock.lock().context("cannot wait for a lock")?;
        }
        patch.copy_to(project, &copy)?;
        let profile = programs.profile();
        let changed = patch.files().into_iter().map(str::to_owned).collect();
        let build = project.root.join(BUILT).join(profile);
        seed::plant(&programs.target().join(profile), &build, &changed)?;
        Ok(Self { edition: Edition::Copy(copy), _shaders: None, _lock: Some(lock) })
    }
}

/// The result of tests.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Tested {
    /// The number that passed.
    pub passed: usize,
    /// The number that failed.
    pub failed: usize,
    /// All that was printed.
    pub said: String,
}

impl Edition {
    /// A command that runs a chapter's program.
    ///
    /// # Errors
    /// If it is not built, or does not build; in one line.
    pub fn command(&self, programs: &Programs, chapter: &str) -> Result<Command> {
        let book = || programs.built(chapter);
        match self {
            Self::Book => book(),
            Self::Shaders(folder) => {
                let mut command = book()?;
                command.env("SHADERS", folder);
                Ok(command)
            }
            Self::Copy(_) | Self::Edited => {
                let (mut cargo, target) = self.cargo("build", programs);
                let what = match self {
                    Self::Copy(_) => format!("building {chapter} in a copy"),
                    _ => format!("building {chapter}"),
                };
                cargo.args(["--quiet", "--bin", chapter]);
                let built = child::run_saying(&mut cargo, Limit::NONE, &what)?;
                let why = || first_error(&built.said);
                ensure!(built.succeeded(), "{chapter} does not build: {}", why());
                if *self == Self::Edited {
                    return book();
                }
                let name = format!("{chapter}{}", std::env::consts::EXE_SUFFIX);
                let mut command = Command::new(target.join(programs.profile()).join(name));
                command
                    .current_dir(&programs.project.root)
                    .env("SHADERS", self.shaders(programs.project));
                Ok(command)
            }
        }
    }

    /// Runs the tests of a test program whose names contain `filter`.
    ///
    /// # Errors
    /// If they do not build, or none is found; in one line.
    pub fn test(&self, programs: &Programs, (program, filter): (&str, &str)) -> Result<Tested> {
        // The build has no time limit and runs first. With a test, Cargo builds all programs of its package.
        let (mut build, _) = self.cargo("test", programs);
        build.args(["--no-run", "--test", program]);
        let what = format!(
            "building all programs and the tests of {program}, minutes if they are not built yet"
        );
        let built = child::run_saying(&mut build, Limit::NONE, &what)?;
        ensure!(built.succeeded(), "the tests do not build: {}", first_error(&built.said));
        let tested = self.run_tests(programs, (program, filter), &[])?;
        // A test that plain `cargo test` leaves to the nightly run is requested here by its name.
        match tested.passed + tested.failed {
            0 => {
                let tested = self.run_tests(programs, (program, filter), &["--ignored"])?;
                let any = tested.passed + tested.failed > 0;
                ensure!(any, "no test of '{program}' is called '{filter}'");
                Ok(tested)
            }
            _ => Ok(tested),
        }
    }

    /// Runs tests that are already built, with further arguments.
    fn run_tests(
        &self,
        programs: &Programs,
        (program, filter): (&str, &str),
        more: &[&str],
    ) -> Result<Tested> {
        let (mut cargo, _) = self.cargo("test", programs);
        cargo
            .args(["--test", program, filter, "--"])
            .args(more)
            .env("SHADERS", self.shaders(programs.project));
        // A reader's changes give other figures than the page's.
        cargo.env("EXERCISE", "1");
        let what = format!("running cargo test --test {program} {filter}");
        let ended = child::run_saying(&mut cargo, LIMIT, &what)?;
        ensure!(ended.status.is_some(), "the tests '{filter}' do not end");
        let results = ended.told.lines().filter_map(|line| line.strip_prefix("test result: "));
        let results: Vec<&str> = results.collect();
        ensure!(!results.is_empty(), "the tests do not run: {}", first_error(&ended.said));
        let count = |word: &str| -> usize {
            let found = results.iter().flat_map(|line| line.split([';', '.']));
            let numbers = found.filter_map(|part| part.trim().strip_suffix(word));
            numbers.filter_map(|number| number.trim().parse::<usize>().ok()).sum()
        };
        let (passed, failed) = (count("passed"), count("failed"));
        Ok(Tested { passed, failed, said: ended.told })
    }

    /// The contents of one of its files.
    ///
    /// # Errors
    /// If it cannot be read.
    pub fn read(&self, project: &Project, file: &str) -> Result<String> {
        let path = match (self, file.strip_prefix("shaders/")) {
            (Self::Copy(folder), None) => folder.join(file),
            (_, Some(shader)) => self.shaders(project).join(shader),
            _ => project.root.join(file),
        };
        fs::read_to_string(path).with_context(|| format!("cannot read '{file}'"))
    }

    /// The folder of its shaders.
    fn shaders(&self, project: &Project) -> PathBuf {
        match self {
            Self::Book | Self::Edited => project.root.join("shaders"),
            Self::Shaders(folder) => folder.clone(),
            Self::Copy(folder) => folder.join("shaders"),
        }
    }

    /// Cargo in the edition's folder, and its target folder.
    fn cargo(&self, verb: &str, programs: &Programs) -> (Command, PathBuf) {
        let (folder, target): (&Path, PathBuf) = match self {
            Self::Copy(folder) => (folder, programs.project.root.join(BUILT)),
            _ => (&programs.project.root, programs.target().to_owned()),
        };
        let mut cargo = child::cargo(folder);
        cargo.args([verb, "--message-format", "short"]).env("CARGO_TARGET_DIR", &target);
        if programs.are_released() {
            cargo.arg("--release");
        }
        (cargo, target)
    }
}

/// The first error in Cargo's output, in one line.
fn first_error(said: &str) -> String {
    let mut lines = said.lines().filter(|line| line.contains("error"));
    let line = lines.next().or_else(|| said.lines().last()).unwrap_or("Cargo does not say why");
    line.trim().trim_start_matches("error: ").to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_error_is_told() {
        let said = "warning: x\nsamples/a.rs:3:1: error[E0425]: no `y`\nerror: could not compile\n";
        assert_eq!(first_error(said), "samples/a.rs:3:1: error[E0425]: no `y`");
        assert_eq!(first_error("error: no bin target named `x`\n"), "no bin target named `x`");
        assert_eq!(first_error(""), "Cargo does not say why");
    }
}
