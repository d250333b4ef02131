//! Copies of the shaders, or of all code, with some files replaced.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use anyhow::{Context, Result};
use common::files::folder;
use manuscript::project::Project;

/// The folders and files that a copy needs to be built and tested.
const FOLDERS: [&str; 8] = [
    "common",
    "docs/chapters",
    "docs/drawings",
    "docs/manuscript",
    "docs/site",
    "samples",
    "shaders",
    "tests",
];
const FILES: [&str; 2] = ["Cargo.toml", "Cargo.lock"];

/// The new contents of some files, by their path from the root.
pub type Changed = BTreeMap<String, String>;

/// Makes a folder a copy of the shaders.
///
/// # Errors
/// If it cannot be written.
pub fn copy_shaders(project: &Project, folder: &Path, changed: &Changed) -> Result<()> {
    copy(project, folder, changed, (&["shaders"], &[]), "shaders/")
}

/// Makes a folder a copy of everything a build needs.
///
/// # Errors
/// If it cannot be written.
pub fn copy_code(project: &Project, folder: &Path, changed: &Changed) -> Result<()> {
    copy(project, folder, changed, (&FOLDERS, &FILES), "")
}

/// Makes a folder a copy of some folders and files, with those in `changed` replaced.
///
/// A file gets the project's modification time and a changed one the present time, so that Cargo builds only
/// what has changed. Files that only the copy has are removed.
fn copy(
    project: &Project,
    above: &Path,
    changed: &Changed,
    (folders, beside): (&[&str], &[&str]),
    without: &str,
) -> Result<()> {
    let mut files: BTreeMap<String, Option<&String>> = BTreeMap::new();
    let found = folders.iter().flat_map(|part| project.files(part));
    let found = found.chain(beside.iter().map(|file| (*file).to_owned()));
    files.extend(found.map(|file| (file, None)));
    files.extend(changed.iter().map(|(file, text)| (file.clone(), Some(text))));
    let place = |file: &str| above.join(file.trim_start_matches(without));
    let kept: BTreeSet<PathBuf> = files.keys().map(|file| place(file)).collect();
    for old in files_below(above).iter().filter(|old| !kept.contains(*old)) {
        fs::remove_file(old).with_context(|| format!("cannot remove '{}'", old.display()))?;
    }
    for (file, text) in files {
        let to = place(&file);
        let own = project.root.join(&file);
        let (bytes, time) = match text {
            Some(text) => (text.clone().into_bytes(), SystemTime::now()),
            None => (fs::read(&own)?, fs::metadata(&own)?.modified()?),
        };
        if fs::read(&to).is_ok_and(|there| there == bytes) {
            if fs::metadata(&to)?.modified()? == time {
                continue;
            }
        } else {
            folder::write(&to, &bytes)?;
        }
        let stamped =
            File::options().write(true).open(&to).and_then(|file| file.set_modified(time));
        stamped.with_context(|| format!("cannot write '{}'", to.display()))?;
    }
    Ok(())
}

/// Every file below a folder.
pub fn files_below(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    entries.flat_map(|path| if path.is_dir() { files_below(&path) } else { vec![path] }).collect()
}

/// A file at the path, or above it, that keeps it from being a folder.
pub fn file_on_the_way(folder: &Path) -> Option<&Path> {
    folder.ancestors().find(|part| part.exists()).filter(|part| !part.is_dir())
}
