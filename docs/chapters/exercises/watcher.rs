//! Folders whose files a reader edits: told of when one is saved.

use std::collections::hash_map::DefaultHasher;
use std::fs;
use std::hash::{Hash, Hasher};
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::Duration;

use anyhow::{Context, Result, ensure};
use notify::{PollWatcher, RecursiveMode, Watcher, recommended_watcher};

use crate::patches::copy::files_below;
use crate::programs::interrupt;

/// Editors save in several steps; look once they are done.
const DEBOUNCE: Duration = Duration::from_millis(100);
/// How often to look for a signal, and for changes where the system does not tell of them.
const GLANCE: Duration = Duration::from_millis(500);

/// Folders that are watched.
pub struct FolderWatcher {
    folders: Vec<PathBuf>,
    saved: Receiver<()>,
    last: Option<u64>,
    _watcher: Box<dyn Watcher>,
}

impl FolderWatcher {
    /// Watches some folders and all below them.
    ///
    /// # Errors
    /// If one is not there.
    pub fn of(folders: Vec<PathBuf>) -> Result<Self> {
        let (watcher, saved) = watch(&folders)?;
        Ok(Self { folders, saved, last: None, _watcher: watcher })
    }

    /// Waits until a file holds something else than the last time; the first time there is nothing to
    /// wait for.
    ///
    /// # Errors
    /// If the folders cannot be watched any more, or a signal asks for the end.
    pub fn wait(&mut self) -> Result<()> {
        loop {
            let now = contents(&self.folders);
            if self.last.replace(now) != Some(now) {
                return Ok(());
            }
            while let Err(error) = self.saved.recv_timeout(GLANCE) {
                interrupt::asked()?;
                let lost = error == RecvTimeoutError::Disconnected;
                ensure!(!lost, "the folder cannot be watched any more");
            }
            while self.saved.recv_timeout(DEBOUNCE).is_ok() {}
        }
    }
}

/// Tells of every change below some folders.
fn watch(folders: &[PathBuf]) -> Result<(Box<dyn Watcher>, Receiver<()>)> {
    let (sender, saved) = channel();
    let tell = move |event: notify::Result<notify::Event>| {
        // Rendering reads the files, and reading changes none.
        if event.is_ok_and(|event| !event.kind.is_access()) {
            // Nobody waits any more once the exercise is solved.
            let _ = sender.send(());
        }
    };
    let mut watcher: Box<dyn Watcher> = match recommended_watcher(tell.clone()) {
        Ok(watcher) => Box::new(watcher),
        Err(_) => {
            let settings = notify::Config::default().with_poll_interval(GLANCE);
            Box::new(PollWatcher::new(tell, settings).context("no folder can be watched")?)
        }
    };
    for folder in folders {
        let failed = || format!("cannot watch '{}'", folder.display());
        watcher.watch(folder, RecursiveMode::Recursive).with_context(failed)?;
    }
    Ok((watcher, saved))
}

/// A hash of every file below some folders.
fn contents(folders: &[PathBuf]) -> u64 {
    let mut files: Vec<PathBuf> = folders.iter().flat_map(|folder| files_below(folder)).collect();
    files.sort();
    let mut hasher = DefaultHasher::new();
    for file in files {
        let bytes = fs::read(&file).unwrap_or_default();
        (file, bytes).hash(&mut hasher);
    }
    hasher.finish()
}
