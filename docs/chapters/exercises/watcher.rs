//! Folders whose files a reader edits: who waits is told when one is saved.

use std::collections::hash_map::DefaultHasher;
use std::fs;
use std::hash::{Hash, Hasher};
use std::path::PathBuf;
use std::thread;
use std::time::Duration;

use anyhow::Result;

use crate::patches::copy::files_below;
use crate::programs::interrupt;

/// The time between two looks.
const GLANCE: Duration = Duration::from_millis(200);

/// Folders that are watched.
pub struct FolderWatcher {
    folders: Vec<PathBuf>,
    last: Option<u64>,
}

impl FolderWatcher {
    /// Watches some folders and all below them.
    pub fn of(folders: Vec<PathBuf>) -> Self {
        Self { folders, last: None }
    }

    /// Waits until a file has been saved since the last time; the first time there is nothing to wait for.
    ///
    /// # Errors
    /// If a signal asks for the end.
    pub fn wait(&mut self) -> Result<()> {
        let mut before = None;
        loop {
            let now = Some(self.saved());
            // Editors save in several steps; look once they are done.
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
