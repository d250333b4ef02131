//! Folders created whole or not at all.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};

use super::{Made, unfinished};

/// Creates a folder and its parents, unless the process is about to end.
///
/// # Errors
/// If it cannot be created.
pub fn make(path: &Path) -> Result<()> {
    let _alone = unfinished();
    fs::create_dir_all(path).with_context(|| format!("cannot make '{}'", path.display()))
}

/// Writes a file of a [`NewFolder`] and creates its parents, unless the process is about to end.
///
/// # Errors
/// If it cannot be written.
pub fn write(path: &Path, bytes: &[u8]) -> Result<()> {
    let _alone = unfinished();
    let failed = || format!("cannot write '{}'", path.display());
    let above = path.parent().context("it has no folder").with_context(failed)?;
    fs::create_dir_all(above).with_context(failed)?;
    fs::write(path, bytes).with_context(failed)
}

/// A folder under construction. Its files are removed on drop, and if a signal ends the process, unless it is
/// kept; the folder is removed as well, unless it existed before.
pub struct NewFolder {
    path: PathBuf,
    is_kept: bool,
}

impl NewFolder {
    /// An empty folder at this path, created if it does not exist.
    ///
    /// # Errors
    /// If it cannot be created.
    pub fn at(path: &Path) -> Result<Self> {
        let failed = || format!("cannot make '{}'", path.display());
        let mut unfinished = unfinished();
        let was_there = path.is_dir();
        fs::create_dir_all(path).with_context(failed)?;
        let path = path.canonicalize().with_context(failed)?;
        let made = if was_there { Made::FilesOfFolder } else { Made::Folder };
        unfinished.insert(path.clone(), made);
        Ok(Self { path, is_kept: false })
    }

    /// A new folder in the system's temporary folder.
    ///
    /// # Errors
    /// If it cannot be created.
    pub fn temporary() -> Result<Self> {
        let mut unfinished = unfinished();
        let path = tempfile::tempdir().context("cannot make a temporary folder")?.keep();
        unfinished.insert(path.clone(), Made::Folder);
        Ok(Self { path, is_kept: false })
    }

    /// Its path.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Keeps the folder and its files.
    pub fn keep(mut self) {
        self.is_kept = true;
    }

    /// As [`NewFolder::keep`], for a caller that holds the lock.
    pub(super) fn keep_in(&mut self, unfinished: &mut BTreeMap<PathBuf, Made>) {
        unfinished.remove(&self.path);
        self.is_kept = true;
    }
}

impl Drop for NewFolder {
    fn drop(&mut self) {
        let mut unfinished = unfinished();
        if let Some(made) = unfinished.remove(&self.path).filter(|_| !self.is_kept) {
            made.remove(&self.path);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_stays_if_it_is_kept() {
        let work = tempfile::tempdir().unwrap();
        let path = work.path().join("a/b");
        let folder = NewFolder::at(&path).unwrap();
        fs::write(folder.path().join("file"), "text").unwrap();
        drop(folder);
        assert!(!path.exists() && work.path().join("a").is_dir());
        NewFolder::at(&path).unwrap().keep();
        assert!(path.is_dir());
        // An existing folder stays, empty as before.
        let folder = NewFolder::at(&path).unwrap();
        write(&folder.path().join("c/file"), b"text").unwrap();
        drop(folder);
        assert!(path.is_dir() && path.read_dir().unwrap().next().is_none());
        let folder = NewFolder::temporary().unwrap();
        let path = folder.path().to_owned();
        assert!(path.is_dir());
        drop(folder);
        assert!(!path.exists());
    }
}
