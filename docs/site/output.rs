//! The folder of a site: written as a whole or not at all, and never over anything but a site.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use anyhow::{Context, Result, bail};

/// The file that marks a folder as a site.
const MARK: &str = ".made-by-cargo-chapters-book";

/// The folder of the site in progress.
static UNFINISHED: Mutex<Option<PathBuf>> = Mutex::new(None);

/// Removes an unfinished site before the process ends.
pub fn abandon() {
    let unfinished = UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner);
    // While it is removed, the build may add new files.
    let tries = unfinished.iter().flat_map(|folder| [folder; 100]);
    let _ = tries.map(fs::remove_dir_all).find(Result::is_ok);
    std::mem::forget(unfinished);
}

/// Builds a site with `build`, which writes it into a new folder, and moves it to `out`.
///
/// # Errors
/// If `out` is something other than a site, in which case nothing is built; and the errors of `build`.
pub fn replace<T>(out: &Path, build: impl FnOnce(&Path) -> Result<T>) -> Result<T> {
    let out = std::path::absolute(out)?;
    refuse_others(&out)?;
    let beside = out.parent().map_or_else(|| PathBuf::from("/"), Path::to_owned);
    let cannot = || format!("cannot write '{}'", out.display());
    fs::create_dir_all(&beside).with_context(cannot)?;
    // On the same disk, so that the result can be renamed.
    let unfinished = || UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner);
    let work = {
        let mut unfinished = unfinished();
        let mut builder = tempfile::Builder::new();
        let work = builder.prefix(".book-").tempdir_in(&beside).with_context(cannot)?;
        *unfinished = Some(work.path().to_owned());
        work
    };
    let (made, old) = (work.path().join("made"), work.path().join("old"));
    let built = build(&made)?;
    // A signal comes either before the old site is removed, or after the new one is in place.
    let _alone = unfinished();
    fs::write(made.join(MARK), "").with_context(cannot)?;
    if out.exists() {
        fs::rename(&out, &old).with_context(cannot)?;
    }
    if let Err(error) = fs::rename(&made, &out) {
        let _ = fs::rename(&old, &out);
        return Err(error).with_context(cannot);
    }
    Ok(built)
}

fn refuse_others(out: &Path) -> Result<()> {
    let what = if out.join(MARK).is_file() || !out.exists() {
        return Ok(());
    } else if !out.is_dir() {
        "is no folder"
    } else if fs::read_dir(out)?.next().is_none() {
        return Ok(());
    } else {
        "has files that this command did not make"
    };
    bail!("'{}' {what}; name another folder with --out", out.display())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn made(text: &'static str) -> impl FnOnce(&Path) -> Result<()> {
        move |folder| {
            fs::create_dir(folder)?;
            Ok(fs::write(folder.join("index.html"), text)?)
        }
    }

    #[test]
    fn a_site_is_replaced_whole_or_not_at_all() {
        let work = tempfile::tempdir().unwrap();
        let out = work.path().join("a/book");
        replace(&out, made("one")).unwrap();
        let error = replace(&out, |folder| -> Result<()> {
            fs::create_dir(folder)?;
            bail!("halfway")
        });
        assert_eq!(error.unwrap_err().to_string(), "halfway");
        assert_eq!(fs::read_to_string(out.join("index.html")).unwrap(), "one");
        replace(&out, made("two")).unwrap();
        assert_eq!(fs::read_to_string(out.join("index.html")).unwrap(), "two");
        let left: Vec<_> = fs::read_dir(work.path().join("a")).unwrap().collect();
        assert_eq!(left.len(), 1, "{left:?}");
    }

    #[test]
    fn what_is_no_site_is_not_deleted() {
        let work = tempfile::tempdir().unwrap();
        fs::write(work.path().join("mine"), "kept").unwrap();
        for out in [work.path().to_owned(), work.path().join("mine")] {
            let error = replace(&out, |_| -> Result<()> { panic!("nothing is built") })
                .unwrap_err()
                .to_string();
            assert!(error.ends_with("name another folder with --out"), "{error}");
        }
        assert_eq!(fs::read_to_string(work.path().join("mine")).unwrap(), "kept");
    }
}
