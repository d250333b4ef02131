//! The exercises a reader has solved, stored in a file.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use common::files::write_whole;
use common::output;
use manuscript::project::Project;
use serde::{Deserialize, Serialize};

use super::exercise::Exercise;

/// The names of the solved exercises, and the number of failures of the others.
#[derive(Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Solved {
    solved: BTreeSet<String>,
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    failures: BTreeMap<String, usize>,
}

/// The number of failures after which a reader may see the target.
const FAILURES: usize = 2;

/// A reader's progress.
pub struct Progress {
    file: PathBuf,
    solved: Solved,
}

impl Progress {
    /// Reads it. A damaged file is reported in one line and counts as empty.
    pub fn open(project: &Project) -> Self {
        let file = project.root.join("target/exercises/progress.json");
        let solved = read(&file).unwrap_or_else(|| {
            let line = "is damaged: what was solved is forgotten";
            output::warn(&[format!("target/exercises/progress.json {line}")]);
            Solved::default()
        });
        Self { file, solved }
    }

    /// Returns whether an exercise is solved.
    pub fn has(&self, exercise: &Exercise) -> bool {
        self.solved.solved.contains(&exercise.to_string())
    }

    /// Records that an exercise is solved.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn note(&mut self, exercise: &Exercise) -> Result<()> {
        self.change(|progress| {
            progress.solved.insert(exercise.to_string());
        })
    }

    /// Returns whether the target of an exercise may be shown.
    pub fn shows_target(&self, exercise: &Exercise) -> bool {
        self.has(exercise) || self.failures(exercise) >= FAILURES
    }

    /// The number of failed attempts at an exercise.
    pub fn failures(&self, exercise: &Exercise) -> usize {
        self.solved.failures.get(&exercise.to_string()).copied().unwrap_or_default()
    }

    /// Counts a failure.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn count_failure(&mut self, exercise: &Exercise) -> Result<()> {
        self.change(|progress| *progress.failures.entry(exercise.to_string()).or_default() += 1)
    }

    /// Re-reads the file before the change: another exercise may be in progress at the same time.
    fn change(&mut self, change: impl FnOnce(&mut Solved)) -> Result<()> {
        let folder = self.file.parent().unwrap_or(&self.file);
        fs::create_dir_all(folder)
            .with_context(|| format!("cannot make '{}'", folder.display()))?;
        // The lock is a separate file, because the other one is replaced as a whole. Closing it releases the
        // lock.
        let lock = File::create(folder.join("lock")).context("cannot make a lock")?;
        lock.lock().context("cannot wait for a lock")?;
        self.solved = read(&self.file).unwrap_or_default();
        change(&mut self.solved);
        write_whole(&self.file, (serde_json::to_string_pretty(&self.solved)? + "\n").as_bytes())
    }
}

/// The contents of a file, empty if there is none; `None` if it is damaged.
fn read(file: &Path) -> Option<Solved> {
    match fs::read_to_string(file) {
        Ok(text) => serde_json::from_str(&text).ok(),
        Err(error) if error.kind() == ErrorKind::NotFound => Some(Solved::default()),
        Err(_) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_who_write_at_once_lose_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("exercises/progress.json");
        std::thread::scope(|scope| {
            for writer in ["a", "b"] {
                let mut progress = Progress { file: file.clone(), solved: Solved::default() };
                scope.spawn(move || {
                    for count in 0..50 {
                        let solve = |progress: &mut Solved| {
                            progress.solved.insert(format!("{writer}{count}"));
                            *progress.failures.entry("01.1".to_owned()).or_default() += 1;
                        };
                        progress.change(solve).unwrap();
                    }
                });
            }
        });
        let Solved { solved, failures } = read(&file).unwrap();
        assert_eq!((solved.len(), failures["01.1"]), (100, 100));
    }
}
