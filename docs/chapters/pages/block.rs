//! The text between the markers of a generated block.

use manuscript::anchor::{part, parts};
use manuscript::diff::{self, FileDiff, Line, Parts, Side};
use manuscript::fault::Fault;
use manuscript::page::{Block, Kind, Page};
use manuscript::project::Project;
use manuscript::shader;
use similar::{DiffOp, group_diff_ops};

use super::{gallery, map};
use crate::exercises::exercise;
use crate::mistakes::mistake;
use crate::programs::own_program;
use crate::programs::program::{BUILD, Programs};
use crate::survey::card;
use crate::survey::card_page;
use crate::values::record::{self, Record};
use crate::values::{stamp, table};

/// Lines around a change on a page.
const CONTEXT: usize = 2;

/// The text of a page's block, and its source in a few words.
///
/// # Errors
/// If the marker names something that does not exist.
pub fn body(programs: &Programs, page: &Page, block: &Block) -> Result<(String, String), Fault> {
    let wrong = |what: String, remedy: &str| Fault::new(&*page.path, block.line, what, remedy);
    let words: Vec<&str> = block.words.iter().map(String::as_str).collect();
    match (block.kind, &words[..]) {
        (Kind::Snippet, [source]) => {
            let text = snippet(programs.project, source).map_err(|wrong| wrong.at(page, block))?;
            Ok((text, (*source).to_owned()))
        }
        (Kind::Diff, [old, new]) if old.contains('/') => {
            let text = own_program_diff(programs.project, old, new);
            Ok((text.map_err(|wrong| wrong.at(page, block))?, words.join(" ")))
        }
        (Kind::Diff, [old, new, rest @ ..]) if rest.len() <= 1 => {
            let text = diff_block(programs.project, old, new, rest.first().copied());
            Ok((text.map_err(|wrong| wrong.at(page, block))?, words.join(" ")))
        }
        (Kind::Controls | Kind::Exercises, [name]) => {
            let known = programs.project.named(name);
            let Some(chapter) = known else {
                return Err(wrong(format!("no chapter '{name}'"), "name one of `chapters list`"));
            };
            if block.kind == Kind::Exercises {
                return Ok((
                    exercise::list(programs.project, chapter),
                    exercise::FOLDER.to_owned(),
                ));
            }
            let controls = programs.controls(name).map_err(|what| wrong(what, BUILD))?;
            Ok((controls.table(), format!("{name} --list-controls")))
        }
        (Kind::Devices, []) => {
            let (cards, _) = card::all(programs.project);
            Ok((card_page::devices(&cards), card::FOLDER.to_owned()))
        }
        (Kind::Mistakes, []) => {
            Ok((mistake::gallery(programs.project), mistake::FOLDER.to_owned()))
        }
        (Kind::Symptoms, []) => {
            Ok((mistake::symptoms(programs.project), mistake::FOLDER.to_owned()))
        }
        (Kind::Gallery, []) => {
            Ok((gallery::tables(programs.project, &page.path), "Cargo.toml".to_owned()))
        }
        (Kind::Stamp, []) => Ok((stamp::text(programs.project, page), record::FOLDER.to_owned())),
        (Kind::Table, [name]) => {
            let (stored, _) = Record::all(programs.project);
            let text = table::body(programs.project, page, block.line, name, &stored)?;
            Ok((text, table::file(page)))
        }
        (Kind::Map, ["ways"]) => Ok((map::ways(programs.project), "Cargo.toml".to_owned())),
        (Kind::Map, ["chapters"]) => Ok((map::chapters(programs.project), "Cargo.toml".to_owned())),
        (kind, _) => {
            let what = format!("<!-- {} {} --> is no marker", kind.word(), words.join(" "));
            Err(wrong(what, &format!("write {}", kind.form())))
        }
    }
}

/// The fault of a marker, or of a file it names.
enum Wrong {
    Marker(String, String),
    Source(Fault),
}

impl Wrong {
    fn new(what: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self::Marker(what.into(), remedy.into())
    }

    fn at(self, page: &Page, block: &Block) -> Fault {
        match self {
            Self::Marker(what, remedy) => Fault::new(&*page.path, block.line, what, remedy),
            Self::Source(fault) => fault,
        }
    }
}

fn read(project: &Project, file: &str) -> Result<String, Wrong> {
    let readable = project.has(file).then(|| project.read(file).ok()).flatten();
    readable
        .ok_or_else(|| Wrong::new(format!("there is no text file '{file}'"), "correct the marker"))
}

/// The lines of an item or anchor.
fn lines(file: &str, text: &str, name: &str) -> Result<std::ops::Range<usize>, Wrong> {
    let found = parts(file, text).map_err(Wrong::Source)?;
    if let Some(anchor) = found.iter().find(|anchor| anchor.name == name) {
        return Ok(anchor.lines.clone());
    }
    let names: Vec<&str> = found.iter().map(|anchor| &*anchor.name).collect();
    let there = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
    let remedy = format!("name one of its parts ({there}) or add // ANCHOR: {name} to it");
    Err(Wrong::new(format!("{file} has no part '{name}'"), remedy))
}

fn snippet(project: &Project, source: &str) -> Result<String, Wrong> {
    let (file, anchor) = split(source);
    let text = read(project, file)?;
    let lines = anchor.map(|name| lines(file, &text, name)).transpose()?;
    let shown = part(&text, lines);
    if shown.is_empty() {
        return Err(Wrong::new(format!("'{source}' is empty"), "name a part that says something"));
    }
    Ok(fenced(shader::language(file), &shown))
}

fn split(source: &str) -> (&str, Option<&str>) {
    source.split_once('#').map_or((source, None), |(file, anchor)| (file, Some(anchor)))
}

/// A fenced block, with a fence longer than any in its text.
fn fenced(language: &str, text: &str) -> String {
    let longest =
        text.lines().map(|line| line.trim_start().bytes().take_while(|b| *b == b'`').count());
    let fence = "`".repeat(longest.max().unwrap_or(0).max(2) + 1);
    format!("{fence}{language}\n{text}{fence}\n")
}

/// The changes from `OLD` to `NEW`: of one file, of a marked part of it, or of code and shaders.
fn diff_block(
    project: &Project,
    old: &str,
    new: &str,
    file: Option<&str>,
) -> Result<String, Wrong> {
    let chapter = |name: &str| {
        let found = project.named(name);
        found.ok_or_else(|| {
            Wrong::new(format!("no chapter '{name}'"), "name one of `chapters list`")
        })
    };
    let (old, new) = (chapter(old)?, chapter(new)?);
    let unreadable = |error| Wrong::new(format!("{error:#}"), "mend the file");
    let parts = Parts { code: true, shaders: true, page: false };
    let diffs = diff::chapters(project, old, new, parts).map_err(unreadable)?;
    let Some(wanted) = file else {
        let (shared, own): (Vec<_>, Vec<_>) =
            diffs.into_iter().partition(|diff| diff.included_by.is_some());
        let mut text = if own.is_empty() {
            "Code and shaders are the same.\n".to_owned()
        } else {
            fenced("diff", &own.iter().map(unified).collect::<String>())
        };
        if !shared.is_empty() {
            let name = |path: &str| path.trim_start_matches("shaders/").to_owned();
            let link = |diff: &FileDiff| format!("[{}](../{})", name(diff.path()), diff.path());
            let links: Vec<String> = shared.iter().map(link).collect();
            text.push_str(&format!("\nIncluded for the first time: {}.\n", links.join(", ")));
        }
        return Ok(text);
    };
    let (role, anchor) = split(wanted);
    let exists = ["samples", "shaders"].map(|folder| format!("{folder}/{}/{role}", new.name));
    let path = exists.iter().find(|path| project.has(path)).ok_or_else(|| {
        let what = format!("chapter {} has no '{role}'", new.name);
        Wrong::new(what, "name main.rs or one of its shaders")
    })?;
    let lines = match anchor {
        Some(name) => Some(lines(path, &read(project, path)?, name)?),
        None => None,
    };
    let found = diffs.into_iter().find(|diff| diff.role == role && diff.included_by.is_none());
    let found = found.map(|diff| match &lines {
        Some(lines) => diff.within(lines),
        None => diff,
    });
    match found.filter(|diff| diff.added() + diff.removed() > 0) {
        Some(diff) => Ok(fenced("diff", &unified(&diff))),
        None => Err(Wrong::new(format!("nothing differs in '{wanted}'"), "remove the block")),
    }
}

/// The changes from one file to another, under their paths in the reader's own crate.
fn own_program_diff(project: &Project, old: &str, new: &str) -> Result<String, Wrong> {
    for file in [old, new] {
        read(project, file)?;
    }
    let unreadable = |error| Wrong::new(format!("{error:#}"), "mend the file");
    let mut diff = diff::files(project, old, new).map_err(unreadable)?;
    if diff.added() + diff.removed() == 0 {
        return Err(Wrong::new("nothing differs", "remove the block"));
    }
    for side in [&mut diff.old, &mut diff.new] {
        side.path = side.path.take().map(|path| own_program::place(&path).to_owned());
    }
    Ok(fenced("diff", &unified(&diff)))
}

/// A file's changes as a unified diff.
fn unified(diff: &FileDiff) -> String {
    let path = |side: &Side| side.path.clone().unwrap_or_else(|| "/dev/null".to_owned());
    let mut text = format!("--- {}\n+++ {}\n", path(&diff.old), path(&diff.new));
    for group in group_diff_ops(diff.ops.clone(), CONTEXT) {
        let (Some(first), Some(last)) = (group.first(), group.last()) else { continue };
        let old = &diff.old.lines[first.old_range().start..last.old_range().end];
        let new = &diff.new.lines[first.new_range().start..last.new_range().end];
        text.push_str(&format!("@@ -{} +{} @@\n", span(old), span(new)));
        for op in &group {
            let mut put = |sign: &str, lines: &[Line]| {
                for line in lines {
                    text.push_str(format!("{sign}{}", line.text).trim_end());
                    text.push('\n');
                }
            };
            match op {
                DiffOp::Equal { .. } => put(" ", &diff.new.lines[op.new_range()]),
                _ => {
                    put("-", &diff.old.lines[op.old_range()]);
                    put("+", &diff.new.lines[op.new_range()]);
                }
            }
        }
    }
    text
}

fn span(lines: &[Line]) -> String {
    let first = lines.first().map_or(0, |line| line.number);
    format!("{first},{}", lines.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fence_is_longer_than_what_it_holds() {
        assert_eq!(fenced("rust", "x\n"), "```rust\nx\n```\n");
        assert_eq!(fenced("text", "```\nx\n```\n"), "````text\n```\nx\n```\n````\n");
    }
}
