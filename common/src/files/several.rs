//! Several files written together, or none of them.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};

use super::{NewFolder, Unfinished, unfinished};

/// Writes several files, all or none of them, each as by [`write_whole`](super::write_whole), and keeps the
/// folders created for them.
///
/// # Errors
/// As [`write_whole`](super::write_whole).
pub fn write_all(files: &[(&Path, &[u8])], mut folders: Vec<NewFolder>) -> Result<()> {
    let failed = |path: &Path| format!("cannot write '{}'", path.display());
    let mut all = Vec::new();
    for &(path, bytes) in files {
        all.push(Unfinished::new(path, bytes).with_context(|| failed(path))?);
    }
    // A signal takes effect before the first is in its place, or after the last.
    let mut unfinished = unfinished();
    let mut done = Vec::new();
    for (file, (path, _)) in all.iter_mut().zip(files) {
        let old = if files.len() > 1 { fs::read(&file.target).ok() } else { None };
        if let Err(error) = file.finish() {
            for (target, old) in done {
                let _ = match old {
                    Some(bytes) => fs::write(target, bytes),
                    None => fs::remove_file(target),
                };
            }
            return Err(error).with_context(|| failed(path));
        }
        done.push((file.target.clone(), old));
    }
    folders.iter_mut().for_each(|folder| folder.keep_in(&mut unfinished));
    Ok(())
}
