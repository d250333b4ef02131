//! The samples as built programs, in the same folder as this one. Each program lists its own controls.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Mutex;
use std::time::SystemTime;

use anyhow::{Context, Result, anyhow};
use common::workers;
use manuscript::project::Project;
use time_limit::Limit;

use super::child;
use super::controls::Controls;

/// The samples' programs.
pub struct Programs<'a> {
    /// The project in which they run.
    pub project: &'a Project,
    folder: PathBuf,
    known: Mutex<BTreeMap<String, Answer>>,
}

/// A sample's controls, or the reason why it cannot list them.
type Answer = Result<Controls, String>;

impl<'a> Programs<'a> {
    /// The programs in the folder of this one, run in a project.
    ///
    /// # Errors
    /// If the system does not report the path of this program.
    pub fn beside_this(project: &'a Project) -> Result<Self> {
        let this = std::env::current_exe().context("cannot tell where this program lies")?;
        let folder = this.parent().context("this program lies in no folder")?.to_owned();
        Ok(Self { project, folder, known: Mutex::default() })
    }

    /// A command that runs the program `name`.
    ///
    /// # Errors
    /// If it is missing, or older than its sources; the message says how to build it.
    pub fn command(&self, name: &str) -> Result<Command, String> {
        let root = &self.project.root;
        let file = self.folder.join(format!("{name}{}", std::env::consts::EXE_SUFFIX));
        let built = modified(&file).ok_or_else(|| format!("the program '{name}' is not built"))?;
        // Cargo lists a program's sources beside it.
        let listed = fs::read_to_string(self.folder.join(format!("{name}.d"))).unwrap_or_default();
        let newer = sources(&listed)
            .into_iter()
            .find(|source| modified(Path::new(source)).is_some_and(|changed| changed > built));
        if let Some(source) = newer {
            let source = Path::new(&source);
            let source = source.strip_prefix(root).unwrap_or(source).display();
            return Err(format!("the program '{name}' is older than {source}"));
        }
        let mut command = Command::new(file);
        command.current_dir(root).env("SHADERS", root.join("shaders"));
        Ok(command)
    }

    /// A command that runs the program `name` even if it is older than its sources; `None` if it is missing.
    pub fn old(&self, name: &str) -> Option<Command> {
        let file = self.folder.join(format!("{name}{}", std::env::consts::EXE_SUFFIX));
        let mut command = file.is_file().then(|| Command::new(file))?;
        command.current_dir(&self.project.root);
        Some(command)
    }

    /// The folder above the folder of a profile, in which Cargo builds them.
    pub fn target(&self) -> &Path {
        self.folder.parent().unwrap_or(&self.folder)
    }

    /// Returns whether they are built with `--release`.
    pub fn are_released(&self) -> bool {
        self.folder.ends_with("release")
    }

    /// The name of the profile's folder.
    pub fn profile(&self) -> &'static str {
        if self.are_released() { "release" } else { "debug" }
    }

    /// As [`Programs::command`]; the error also says what to do.
    ///
    /// # Errors
    /// As there.
    pub fn built(&self, name: &str) -> Result<Command> {
        self.command(name).map_err(|what| anyhow!("{what}; {BUILD}"))
    }

    /// Reads the controls of several programs at once; [`Programs::controls`] then returns the cached
    /// results.
    ///
    /// # Errors
    /// If one cannot be started.
    pub fn ask(&self, names: &[&str]) -> Result<()> {
        workers::each(names, |name| self.answer(name).map(drop)).into_iter().collect()
    }

    /// A sample's controls.
    ///
    /// # Errors
    /// If it cannot be run, or fails.
    pub fn controls(&self, name: &str) -> Result<Controls, String> {
        self.answer(name).unwrap_or_else(|error| Err(format!("{error:#}")))
    }

    /// Checks whether a sample itself accepts these arguments, which may be its own or depend on one another.
    ///
    /// # Errors
    /// If it cannot be run.
    pub fn takes(&self, name: &str, arguments: &[String]) -> Result<bool, String> {
        let mut command = self.command(name)?;
        let ended = child::run(command.args(arguments).arg("--list-controls"), Limit::NONE);
        ended.map(|ended| ended.succeeded()).map_err(|error| format!("{error:#}"))
    }

    /// The list of a sample's controls, or the reason why it is not available; cached.
    fn answer(&self, name: &str) -> Result<Answer> {
        let known = || self.known.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        if let Some(answer) = known().get(name) {
            return Ok(answer.clone());
        }
        let answer = match self.command(name) {
            Ok(command) => list_controls(name, command)?,
            Err(what) => Err(what),
        };
        known().insert(name.to_owned(), answer.clone());
        Ok(answer)
    }
}

fn list_controls(name: &str, mut command: Command) -> Result<Answer> {
    let ended = child::run(command.arg("--list-controls"), Limit::NONE)?;
    Ok(if ended.succeeded() {
        Ok(Controls::parse(&ended.told))
    } else {
        Err(format!("{name} --list-controls failed: {}", ended.said_in_a_line()))
    })
}

/// The remedy for a program that cannot be run.
pub const BUILD: &str = "run: cargo build --bins";

fn modified(file: &Path) -> Option<SystemTime> {
    fs::metadata(file).and_then(|found| found.modified()).ok()
}

/// The files after the colon of a make rule, where a blank in a name is written `\ `.
fn sources(rule: &str) -> Vec<String> {
    let files = rule.split_once(": ").map_or("", |(_, files)| files.trim_end());
    let files = files.replace("\\ ", "\0");
    files.split_whitespace().map(|file| file.replace('\0', " ")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rule_lists_its_sources() {
        assert_eq!(sources("/t/a: /s/b\\ c.rs /s/d.rs\n"), ["/s/b c.rs", "/s/d.rs"]);
        assert!(sources("").is_empty());
    }
}
