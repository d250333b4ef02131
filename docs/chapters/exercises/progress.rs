//! What a reader has solved so far, in a file of the reader's.

use std::collections::BTreeSet;
use std::fs;
use std::io::ErrorKind;
use std::path::PathBuf;

use anyhow::Result;
use common::files::write_whole;
use common::output;
use manuscript::project::Project;
use serde::{Deserialize, Serialize};

use super::exercise::Exercise;

/// The names of the exercises that are solved.
#[derive(Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Solved {
    solved: BTreeSet<String>,
}

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
        fs::create_dir_all(self.file.parent().unwrap_or(&self.file))?;
        write_whole(&self.file, (serde_json::to_string_pretty(&self.solved)? + "\n").as_bytes())
    }
}
