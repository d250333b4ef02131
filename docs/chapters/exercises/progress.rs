//! What a reader has solved so far, in a file of the reader's.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io::ErrorKind;
use std::path::PathBuf;

use anyhow::Result;
use common::files::write_whole;
use common::output;
use manuscript::project::Project;
use serde::{Deserialize, Serialize};

use super::exercise::Exercise;

/// The names of the exercises that are solved, and how often others have failed.
#[derive(Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Solved {
    solved: BTreeSet<String>,
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    failures: BTreeMap<String, usize>,
}

/// After how many failures a reader may see the target.
const FAILURES: usize = 2;

/// A reader's progress.
pub struct Progress {
    file: PathBuf,
    solved: Solved,
}

impl Progress {
    /// Reads it. A file that is damaged is told in a line, and counts as none.
    pub fn open(project: &Project) -> Self {
        let file = project.root.join("target/exercises/progress.json");
        let read = fs::read_to_string(&file);
        let solved = match read.map(|text| serde_json::from_str(&text)) {
            Ok(Ok(solved)) => solved,
            Err(error) if error.kind() == ErrorKind::NotFound => Solved::default(),
            Ok(Err(_)) | Err(_) => {
                let line = "is damaged: what was solved is forgotten";
                output::warn(&[format!("target/exercises/progress.json {line}")]);
                Solved::default()
            }
        };
        Self { file, solved }
    }

    /// Whether an exercise is solved.
    pub fn has(&self, exercise: &Exercise) -> bool {
        self.solved.solved.contains(&exercise.to_string())
    }

    /// Notes that an exercise is solved.
    ///
    /// # Errors
    /// If that cannot be written.
    pub fn note(&mut self, exercise: &Exercise) -> Result<()> {
        if !self.solved.solved.insert(exercise.to_string()) {
            return Ok(());
        }
        self.write()
    }

    /// Whether the target of an exercise may be shown.
    pub fn shows_target(&self, exercise: &Exercise) -> bool {
        self.has(exercise) || self.failures(exercise) >= FAILURES
    }

    /// How often an exercise has failed.
    pub fn failures(&self, exercise: &Exercise) -> usize {
        self.solved.failures.get(&exercise.to_string()).copied().unwrap_or_default()
    }

    /// Counts a failure.
    ///
    /// # Errors
    /// If that cannot be written.
    pub fn count_failure(&mut self, exercise: &Exercise) -> Result<()> {
        *self.solved.failures.entry(exercise.to_string()).or_default() += 1;
        self.write()
    }

    fn write(&self) -> Result<()> {
        fs::create_dir_all(self.file.parent().unwrap_or(&self.file))?;
        write_whole(&self.file, (serde_json::to_string_pretty(&self.solved)? + "\n").as_bytes())
    }
}
