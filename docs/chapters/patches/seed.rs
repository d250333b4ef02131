//! Fills a copy's build folder with the results of the book's build, so that Cargo compiles only what a patch
//! changes.
//!
//! Cargo identifies its results by a package's place below its workspace, and considers them fresh while no
//! source is newer than the build. A copy has the book's files in the book's order with their times, so the
//! book's results are also fresh in the copy.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File, FileTimes};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use anyhow::{Context, Result};

use super::copy::files_below;

/// Cargo's records of its results, one folder each; the results; and those of build scripts.
const RECORDS: &str = ".fingerprint";
const RESULTS: &str = "deps";
const SCRIPTS: &str = "build";

/// Fills the folder `to` of a profile from `from`, unless it exists already. Results compiled from a file of
/// `changed` are left out: paths from the project's root.
///
/// # Errors
/// If a file cannot be copied.
pub fn plant(from: &Path, to: &Path, changed: &BTreeSet<String>) -> Result<()> {
    let mut results: BTreeMap<String, Vec<PathBuf>> = BTreeMap::new();
    for file in entries(&from.join(RESULTS)) {
        if let Some(hash) = hash(&file) {
            results.entry(hash).or_default().push(file);
        }
    }
    for record in entries(&from.join(RECORDS)) {
        let (Some(name), Some(hash)) = (record.file_name(), hash(&record)) else { continue };
        let there = to.join(RECORDS).join(name);
        if names_any(&record, changed) {
            remove(&there)?;
            continue;
        }
        if newest(&there).is_some_and(|time| Some(time) == newest(&record)) {
            continue;
        }
        remove(&there)?;
        for result in results.get(&hash).into_iter().flatten() {
            share(result, &to.join(RESULTS))?;
        }
        let script = from.join(SCRIPTS).join(name);
        if script.is_dir() {
            remove(&to.join(SCRIPTS).join(name))?;
            copy_all(&script, &to.join(SCRIPTS).join(name))?;
        }
        // Last, because Cargo ignores a result without a record.
        copy_all(&record, &there)?;
    }
    Ok(())
}

/// The hash by which Cargo distinguishes its results: `a1b2` of `libname-a1b2.rlib`.
fn hash(file: &Path) -> Option<String> {
    let name = file.file_name()?.to_str()?;
    let (_, hash) = name.split('.').next()?.rsplit_once('-')?;
    Some(hash.to_owned())
}

/// Returns whether a record lists one of the changed files by folder and name. Cargo compares the times of a
/// package's own files, but lists a file outside the package by its place in the book, where nothing has
/// changed.
fn names_any(record: &Path, changed: &BTreeSet<String>) -> bool {
    let ends: Vec<&[u8]> = changed.iter().map(|file| end(file).as_bytes()).collect();
    let is_list = |file: &PathBuf| {
        file.file_name().is_some_and(|name| name.to_string_lossy().starts_with("dep-"))
    };
    let mut lists = entries(record).into_iter().filter(is_list).map(fs::read);
    lists.any(|list| {
        let list = list.unwrap_or_default();
        ends.iter().any(|end| list.windows(end.len()).any(|part| part == *end))
    })
}

/// The last two parts of a path.
fn end(path: &str) -> &str {
    let mut slashes = path.rmatch_indices('/').skip(1);
    slashes.next().map_or(path, |(at, _)| &path[at + 1..])
}

/// The time of the newest file in a folder.
fn newest(folder: &Path) -> Option<SystemTime> {
    entries(folder).iter().filter_map(|file| fs::metadata(file).ok()?.modified().ok()).max()
}

fn entries(folder: &Path) -> Vec<PathBuf> {
    fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()).collect()
}

fn remove(path: &Path) -> Result<()> {
    let removed = if path.is_dir() { fs::remove_dir_all(path) } else { fs::remove_file(path) };
    match removed {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
            Err(error).with_context(|| format!("cannot remove '{}'", path.display()))
        }
        _ => Ok(()),
    }
}

/// Links a file into a folder. The compiler replaces its results but appends to its lists of sources, so
/// these are copied.
fn share(file: &Path, folder: &Path) -> Result<()> {
    let Some(name) = file.file_name() else { return Ok(()) };
    let to = folder.join(name);
    remove(&to)?;
    common::files::folder::make(folder)?;
    if file.extension().is_some_and(|extension| extension == "d")
        || fs::hard_link(file, &to).is_err()
    {
        copy_file(file, &to)?;
    }
    Ok(())
}

fn copy_all(from: &Path, to: &Path) -> Result<()> {
    for file in files_below(from) {
        let below = file.strip_prefix(from).unwrap_or(&file);
        copy_file(&file, &to.join(below))?;
    }
    Ok(())
}

/// Copies a file with its time.
fn copy_file(from: &Path, to: &Path) -> Result<()> {
    common::files::folder::make(to.parent().unwrap_or(to))?;
    let copied = || {
        fs::copy(from, to)?;
        let time = fs::metadata(from)?.modified()?;
        File::options().write(true).open(to)?.set_times(FileTimes::new().set_modified(time))
    };
    copied().with_context(|| format!("cannot copy '{}' to '{}'", from.display(), to.display()))
}

#[cfg(test)]
mod tests {
    use std::process::Command;

    use manuscript::project::Project;

    use super::*;
    use crate::patches::copy::{Changed, copy_code};

    const MANIFEST: &str = "[workspace]\nmembers = [\"common\"]\n\n[package]\nname = \"book\"\nversion = \"0.1.0\"\n\
        edition = \"2024\"\n\n[dependencies]\ncommon = { path = \"common\" }\n\n[package.metadata.chapters]\n\n\
        [[bin]]\nname = \"one\"\npath = \"samples/one.rs\"\n\n[[bin]]\nname = \"two\"\npath = \"samples/two.rs\"\n";
    const LIBRARY: &str = "[package]\nname = \"common\"\nversion = \"0.1.0\"\nedition = \"2024\"\n\n\
        [lib]\npath = \"lib.rs\"\n";
    const PROGRAM: &str = "fn main() {\n    println!(\"{}\", common::number() + 1);\n}\n";

    /// Builds and runs a program; returns the compiled packages and the output.
    fn built(folder: &Path, target: &Path, program: &str) -> (Vec<String>, String) {
        let output = Command::new(env!("CARGO"))
            .args(["build", "--offline", "--bin", program])
            .current_dir(folder)
            .env("CARGO_TARGET_DIR", target)
            .output()
            .unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.success(), "{said}");
        let compiled = said.lines().filter_map(|line| line.trim().strip_prefix("Compiling "));
        let compiled = compiled.filter_map(|line| line.split(' ').next()).map(str::to_owned);
        let printed = Command::new(target.join("debug").join(program)).output().unwrap().stdout;
        (compiled.collect(), String::from_utf8(printed).unwrap().trim().to_owned())
    }

    #[test]
    fn only_what_a_patch_changes_is_compiled() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path();
        for (file, text) in [
            ("Cargo.toml", MANIFEST),
            ("common/Cargo.toml", LIBRARY),
            ("common/lib.rs", "pub fn number() -> u32 {\n    1\n}\n"),
            ("samples/one.rs", PROGRAM),
            ("samples/two.rs", PROGRAM),
        ] {
            common::files::folder::write(&root.join(file), text.as_bytes()).unwrap();
        }
        let (target, copy) = (root.join("target"), root.join("target/mistakes/copy"));
        let build = root.join("target/mistakes/build");
        let from = |program| built(root, &target, program);
        assert_eq!(from("one"), (vec!["common".to_owned(), "book".to_owned()], "2".to_owned()));
        from("two");
        let project = Project::open(root).unwrap();
        let with = |changed: &[(&str, &str)], program: &str| {
            let changed: Changed = changed
                .iter()
                .map(|(file, text)| ((*file).to_owned(), (*text).to_owned()))
                .collect();
            copy_code(&project, &copy, &changed).unwrap();
            let files = changed.into_keys().collect();
            plant(&target.join("debug"), &build.join("debug"), &files).unwrap();
            let (compiled, printed) = built(&copy, &build, program);
            // A second build finds nothing to do.
            assert_eq!(built(&copy, &build, program), (vec![], printed.clone()));
            (compiled.join(" "), printed)
        };
        let is = |compiled: &str, printed: &str| (compiled.to_owned(), printed.to_owned());
        let more = PROGRAM.replace("+ 1", "+ 5");
        let (one, more) = ("samples/one.rs", &*more);
        let library = ("common/lib.rs", "pub fn number() -> u32 {\n    7\n}\n");
        assert_eq!(with(&[(one, more)], "one"), is("book", "6"));
        // A file that is no longer changed is the book's again.
        assert_eq!(with(&[], "one"), is("", "2"));
        assert_eq!(with(&[library], "two"), is("common book", "8"));
        assert_eq!(with(&[(one, more)], "two"), is("", "2"));
        assert_eq!(with(&[(one, more)], "one"), is("book", "6"));
        // The book is unchanged.
        for program in ["one", "two"] {
            assert_eq!(from(program), (vec![], "2".to_owned()));
        }
        // Results the book has compiled since are found.
        fs::write(root.join("samples/two.rs"), PROGRAM.replace("+ 1", "+ 2")).unwrap();
        assert_eq!(from("two").1, "3");
        assert_eq!(with(&[(one, more)], "two"), is("", "3"));
        // And so are changes that it has not compiled.
        fs::write(root.join("samples/two.rs"), PROGRAM.replace("+ 1", "+ 3")).unwrap();
        assert_eq!(with(&[(one, more)], "two"), is("book", "4"));
    }

    #[test]
    fn a_path_ends_in_folder_and_name() {
        assert_eq!(end("samples/05_shadow_miss/main.rs"), "05_shadow_miss/main.rs");
        assert_eq!(end("common/lib.rs"), "common/lib.rs");
        assert_eq!(end("lib.rs"), "lib.rs");
    }
}
