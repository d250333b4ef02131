//! Makes an exercise's diff from its author's edits.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use anyhow::{Context, Result, bail};
use common::UsageError;
use manuscript::project::Project;
use similar::TextDiff;

use super::exercise::FOLDER;
use crate::patches::copy::files_below;
use crate::programs::change;

/// The folders whose files an exercise may change.
const FOLDERS: [&str; 4] = ["common", "samples", "shaders", "tests"];

/// A file before and after an edit; before it, there may be none.
type Edited = BTreeMap<String, (Option<String>, String)>;

/// Writes the diff of the exercise `name`, below the existing text of its file or below placeholders, and
/// returns the file and the next steps. The edits are those in a copy of the shaders in `folder`, or else all
/// edits in the project since the last commit.
///
/// # Errors
/// If the name is invalid, nothing was edited, or a file cannot be read or written.
pub fn make(project: &Project, name: &str, folder: Option<&Path>) -> Result<String> {
    let wrong = || UsageError(format!("'{name}' is no exercise's name; write one such as 05.2"));
    let (chapter, number) = name.split_once('.').ok_or_else(wrong)?;
    let number: usize = number.parse().ok().filter(|number| *number > 0).ok_or_else(wrong)?;
    let chapter = project.chapter(chapter)?;
    let edited = match folder {
        Some(folder) => in_shaders(project, folder)?,
        None => since_commit(project)?,
    };
    if edited.is_empty() {
        let where_to = match folder {
            Some(folder) => format!("the shaders in '{}' are the book's", folder.display()),
            None => format!("nothing in {} was edited since the last commit", FOLDERS.join(", ")),
        };
        bail!("{where_to}: make the solution there first");
    }
    let file = format!("{FOLDER}/{}.{number}.diff", chapter.number());
    let head = match project.has(&file).then(|| project.read(&file)).transpose()? {
        Some(text) => {
            let lines = text.lines().take_while(|line| !line.starts_with("--- "));
            lines.flat_map(|line| [line, "\n"]).collect()
        }
        None => head(edited.keys().all(|file| file.starts_with("shaders/"))),
    };
    let text = format!("{}\n\n{}", head.trim_end(), diff(&edited));
    common::files::write_whole(&project.root.join(&file), text.as_bytes())?;
    let next = format!("cargo chapters exercise {}.{number} --prove\n", chapter.number());
    // The diff does not apply where the solution has been made.
    let undo = match folder {
        Some(_) => String::new(),
        None => {
            let (new, old): (Vec<_>, Vec<_>) =
                edited.iter().partition(|(_, (old, _))| old.is_none());
            let words = |command: &str, files: Vec<(&String, _)>| match &files[..] {
                [] => String::new(),
                _ => {
                    let names = files.iter().map(|(file, _)| file.as_str());
                    format!("{command} {}\n", names.collect::<Vec<_>>().join(" "))
                }
            };
            words("git restore --staged --worktree", old) + &words("rm", new)
        }
    };
    Ok(format!("{file}\n\nNext:\n{undo}{next}"))
}

/// The text above the diff of a new exercise.
fn head(shaders_alone: bool) -> String {
    let takes = if shaders_alone { "shader" } else { "Rust" };
    format!(
        "WRITE a title\n\nTakes: {takes}\nMinutes: 5\nText: WRITE the task, and name the section of the page.\n\
         Check: WRITE what is seen once it is done.\nHint: WRITE where to look.\nRun:\nExpect: as the solution\n"
    )
}

fn diff(edited: &Edited) -> String {
    let of = |(file, (old, new)): (&String, &(Option<String>, String))| {
        let from = if old.is_some() { file.as_str() } else { "/dev/null" };
        let diff = TextDiff::from_lines(old.as_deref().unwrap_or_default(), new.as_str());
        diff.unified_diff().context_radius(3).header(from, file).to_string()
    };
    edited.iter().map(of).collect()
}

/// The edits in a copy of the shaders.
fn in_shaders(project: &Project, folder: &Path) -> Result<Edited> {
    let mut edited = Edited::new();
    for path in files_below(folder) {
        let below = path.strip_prefix(folder).unwrap_or(&path).to_string_lossy().replace('\\', "/");
        let file = format!("shaders/{below}");
        let new = text(&path)?;
        let old = project.has(&file).then(|| project.read(&file)).transpose()?;
        if old.as_ref() != Some(&new) {
            edited.insert(file, (old, new));
        }
    }
    Ok(edited)
}

/// The edits since the last commit.
fn since_commit(project: &Project) -> Result<Edited> {
    let git = |arguments: &[&str]| {
        let arguments = [arguments, &["--"], &FOLDERS].concat();
        change::text(&project.root, &arguments)
    };
    let changed = git(&["diff", "--name-only", "--relative", "HEAD"]);
    let new = git(&["ls-files", "--others", "--exclude-standard"]);
    let mut edited = Edited::new();
    for file in changed.lines().chain(new.lines()) {
        if !project.has(file) {
            bail!("'{file}' is gone, and an exercise's diff removes no file: restore it");
        }
        let old = change::text(&project.root, &["show", &format!("HEAD:./{file}")]);
        let old = (!old.is_empty()).then_some(old);
        edited.insert(file.to_owned(), (old, project.read(file)?));
    }
    Ok(edited)
}

fn text(path: &Path) -> Result<String> {
    let text = fs::read_to_string(path);
    let text = text.with_context(|| format!("cannot read '{}'", path.display()))?;
    Ok(text.replace("\r\n", "\n"))
}
