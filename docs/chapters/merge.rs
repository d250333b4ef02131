//! Merges files of sums written by `--save` into one file, or into the picture.

use std::ops::Range;
use std::path::{Path, PathBuf};

use anyhow::{Result, bail};
use common::UsageError;
use common::app::Format;
use common::files::check_writable;
use common::output;
use instruments::sums::{check_complete, merge};

/// Merges `files`. Writes a picture if `out` has a picture's extension, else a file of sums; returns a line
/// that describes the result.
///
/// # Errors
/// If the files do not match, share samples, or lack some of `whole`; if `out` cannot be written, or is an
/// existing file of sums that is not among the inputs, because its samples would be lost.
pub fn run(out: &Path, files: &[PathBuf], whole: Option<Range<u32>>) -> Result<String> {
    check_writable(out)?;
    if Format::of(out).is_err() && out.extension().is_none_or(|it| it != "sums") {
        let what = "a picture is .png or .exr, and sums are .sums";
        bail!(UsageError(format!("cannot write '{}': {what}", out.display())));
    }
    refuse_to_lose(out, files)?;
    let files: Vec<_> = files.iter().map(PathBuf::as_path).collect();
    let sums = merge(&files)?;
    let samples = &sums.header.samples;
    if let Some(whole) = whole {
        check_complete(samples, whole)?;
    }
    match Format::of(out) {
        Ok(_) => sums.mean().save(out)?,
        Err(_) => sums.save(out)?,
    }
    let [width, _] = sums.header.origin.size;
    output::warn(&Vec::from_iter(sums.header.spoiled.warning(width)));
    let gaps = samples.gaps();
    let gaps = match gaps.count() {
        0 => String::new(),
        _ => format!("; {gaps} are missing"),
    };
    Ok(format!("{}: {} samples, {samples}{gaps}\n", out.display(), samples.count()))
}

/// If the output name is forgotten, the first part becomes the output. Without this check, its samples would
/// be lost without a message.
fn refuse_to_lose(out: &Path, files: &[PathBuf]) -> Result<()> {
    let same = |file: &PathBuf| match (file.canonicalize(), out.canonicalize()) {
        (Ok(file), Ok(out)) => file == out,
        _ => false,
    };
    if Format::of(out).is_err() && out.exists() && !files.iter().any(same) {
        let name = out.display();
        bail!(UsageError(format!(
            "'{name}' exists: name it among the files, too, or give the output another name"
        )));
    }
    Ok(())
}
