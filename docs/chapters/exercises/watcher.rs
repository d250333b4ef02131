//! Watches folders for files that a reader saves.

use std::collections::hash_map::DefaultHasher;
use std::fs;
use std::hash::{Hash, Hasher};
use std::path::PathBuf;
use std::thread;
use std::time::Duration;

use anyhow::Result;

use crate::patches::copy::files_below;
use crate::programs::interrupt;

/// The polling interval.
const GLANCE: Duration = Duration::from_millis(200);

/// The watched folders.
pub struct FolderWatcher {
    folders: Vec<PathBuf>,
    last: Option<u64>,
}

impl FolderWatcher {
    /// Watches these folders and their subfolders.
    pub fn of(folders: Vec<PathBuf>) -> Self {
        Self { folders, last: None }
    }

    /// Waits until a file has been saved since the last call; the first call returns at once.
    ///
    /// # Errors
    /// If a signal requests termination.
    pub fn wait(&mut self) -> Result<()> {
        let mut before = None;
        loop {
            let now = Some(self.saved());
            // Editors save in several steps: wait until the files are stable.
            if now != self.last && (now == before || self.last.is_none()) {
                self.last = now;
                return Ok(());
            }
            before = now;
            thread::sleep(GLANCE);
            interrupt::asked()?;
        }
    }

    /// A hash of every file's name, length and time.
    fn saved(&self) -> u64 {
        let mut files: Vec<PathBuf> = self.folders.iter().flat_map(|of| files_below(of)).collect();
        files.sort();
        let mut hasher = DefaultHasher::new();
        for file in files {
            let found = fs::metadata(&file).ok();
            let found = found.map(|found| (found.len(), found.modified().ok()));
            (file, found).hash(&mut hasher);
        }
        hasher.finish()
    }
}
