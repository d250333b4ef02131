//! The differences between two chapters: files are matched by their role, and their lines compared.
//!
//! Chapter names do not count as differences: a line with `02_basic` here and `03_any_hit` there is equal.
//! Neither do anchors: the lines that mark one are left out.

use std::collections::BTreeSet;
use std::ops::Range;

use anyhow::Result;
use similar::{Algorithm, DiffOp, capture_diff_slices_by_key};

use crate::anchor::is_mark;
use crate::moved;
use crate::page::{Kind, Page};
use crate::project::{Chapter, Project};
use crate::shader;

/// The files of a chapter to compare.
#[derive(Clone, Copy, Debug)]
pub struct Parts {
    /// `samples/NN_name/`.
    pub code: bool,
    /// `shaders/NN_name/`, and what they include.
    pub shaders: bool,
    /// `docs/NN_name.md`.
    pub page: bool,
}

/// A line of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Line {
    /// Its number in the file, from 1.
    pub number: usize,
    /// Its text.
    pub text: String,
    /// Its text for comparisons, with either chapter's name replaced.
    pub key: String,
    /// True if the other chapter has the same line in another place.
    pub moved: bool,
}

/// One of the two files compared.
#[derive(Clone, Debug, Default)]
pub struct Side {
    /// Its path, from the project's root; `None` where the chapter has no such file.
    pub path: Option<String>,
    /// Its lines.
    pub lines: Vec<Line>,
}

/// A file of two chapters, compared.
#[derive(Clone, Debug)]
pub struct FileDiff {
    /// The name of both, such as `main.rs` or `camera.rgen`.
    pub role: String,
    /// The older file.
    pub old: Side,
    /// The newer file.
    pub new: Side,
    /// For a shader that both chapters could share: the file that includes it.
    pub included_by: Option<String>,
    /// The operations that turn the old file into the new one.
    pub ops: Vec<DiffOp>,
}

impl FileDiff {
    fn new(role: &str, old: Side, new: Side) -> Self {
        let ops = compare(&old.lines, &new.lines);
        Self { role: role.to_owned(), old, new, included_by: None, ops }
    }

    /// The number of new lines.
    pub fn added(&self) -> usize {
        self.new_lines().filter(|line| !line.moved).count()
    }

    /// The number of removed lines.
    pub fn removed(&self) -> usize {
        let lines = self.changes().flat_map(|op| &self.old.lines[op.old_range()]);
        lines.filter(|line| !line.moved).count()
    }

    /// The number of moved lines.
    pub fn moved(&self) -> usize {
        self.new_lines().filter(|line| line.moved).count()
    }

    fn new_lines(&self) -> impl Iterator<Item = &Line> {
        self.changes().flat_map(|op| &self.new.lines[op.new_range()])
    }

    /// The path of the newer file, or of the older where there is no newer.
    pub fn path(&self) -> &str {
        self.new.path.as_ref().or(self.old.path.as_ref()).map_or("", String::as_str)
    }

    /// The operations that change something.
    pub(crate) fn changes(&self) -> impl Iterator<Item = &DiffOp> {
        self.ops.iter().filter(|op| !matches!(op, DiffOp::Equal { .. }))
    }

    /// The part of the comparison within these lines of the newer file, counted from 0.
    pub fn within(mut self, lines: &Range<usize>) -> Self {
        let inside = |line: &Line| lines.contains(&(line.number - 1));
        let start = self.new.lines.iter().position(inside).unwrap_or(0);
        let end = self.new.lines.iter().rposition(inside).map_or(start, |last| last + 1);
        // Removed lines belong to the place where they would be now.
        let belongs = |at: usize| start <= at && at < end.max(start + 1);
        let old: BTreeSet<usize> = self
            .ops
            .iter()
            .flat_map(|op| {
                let (old, new) = (op.old_range(), op.new_range());
                let equal = matches!(op, DiffOp::Equal { .. });
                old.enumerate().filter_map(move |(i, at)| {
                    let at_new = if equal { new.start + i } else { new.start };
                    belongs(at_new).then_some(at)
                })
            })
            .collect();
        self.new.lines = self.new.lines[start..end].to_vec();
        self.old.lines = old.into_iter().map(|at| self.old.lines[at].clone()).collect();
        self.ops = compare(&self.old.lines, &self.new.lines);
        self
    }
}

fn compare(old: &[Line], new: &[Line]) -> Vec<DiffOp> {
    capture_diff_slices_by_key(Algorithm::Patience, old, new, |line| line.key.clone())
}

/// The changes between two files outside the chapters.
///
/// # Errors
/// If a file cannot be read.
pub fn files(project: &Project, old: &str, new: &str) -> Result<FileDiff> {
    let side = |path: &str| anyhow::Ok(Names(Vec::new()).side(path, &project.read(path)?));
    Ok(FileDiff::new(new, side(old)?, side(new)?))
}

/// Everything that differs between two chapters, `main.rs` first.
///
/// # Errors
/// If a file cannot be read.
pub fn chapters(
    project: &Project,
    old: &Chapter,
    new: &Chapter,
    parts: Parts,
) -> Result<Vec<FileDiff>> {
    let names = Names::new(old, new);
    let mut diffs = Vec::new();
    if parts.code {
        let files = |chapter: &Chapter| {
            let mut files = project.files(&format!("samples/{}", chapter.name));
            files.sort_by_key(|file| !file.ends_with("/main.rs"));
            files
        };
        let (old, mut new) = (files(old), files(new));
        // A file the newer chapter borrows from the older one is in the older one's folder, and is unchanged.
        let taken = project.with_borrowed(new.clone()).into_iter().skip(new.len());
        new.extend(taken.filter(|file| old.contains(file)));
        diffs.extend(folder(project, &names, &old, &new)?);
    }
    if parts.shaders {
        let [old_own, new_own] = [old, new].map(|chapter| shader::own(project, chapter));
        diffs.extend(folder(project, &names, &old_own, &new_own)?);
        let [old_shared, new_shared] = [old, new].map(|chapter| shader::shared(project, chapter));
        for (file, includer) in &new_shared {
            if !old_shared.contains_key(file) {
                let side = names.side(file, &project.read(file)?);
                let diff = FileDiff::new(file, Side::default(), side);
                diffs.push(FileDiff { included_by: Some(includer.clone()), ..diff });
            }
        }
    }
    if parts.page {
        let page = |chapter: &Chapter| {
            if project.has(&chapter.page()) {
                Ok(names.side(&chapter.page(), &told(project, &chapter.page())?))
            } else {
                anyhow::Ok(Side::default())
            }
        };
        diffs.push(FileDiff::new("page", page(old)?, page(new)?));
    }
    diffs.retain(|diff| diff.changes().next().is_some());
    renamed(&mut diffs);
    moved::mark(&mut diffs);
    Ok(diffs)
}

/// The share of equal text above which two files count as one file that was renamed.
const RENAMED: f64 = 0.8;

/// Merges the comparisons of a removed and a new file if the two are nearly equal.
fn renamed(diffs: &mut Vec<FileDiff>) {
    let is_gone = |diff: &FileDiff| diff.new.path.is_none();
    while let Some((gone, new, ops)) = diffs.iter().enumerate().find_map(|(at, gone)| {
        let alike = |(with, new): (usize, &FileDiff)| {
            let is_new = new.old.path.is_none() && new.new.path.is_some();
            let ops = is_new.then(|| compare(&gone.old.lines, &new.new.lines))?;
            let equal = ops.iter().filter(|op| matches!(op, DiffOp::Equal { .. }));
            let equal: usize = equal.map(|op| op.new_range().len()).sum();
            let lines = gone.old.lines.len() + new.new.lines.len();
            (2.0 * equal as f64 >= RENAMED * lines as f64).then_some((at, with, ops))
        };
        is_gone(gone).then(|| diffs.iter().enumerate().find_map(alike)).flatten()
    }) {
        diffs[new].old = std::mem::take(&mut diffs[gone].old);
        diffs[new].ops = ops;
        diffs.remove(gone);
    }
}

/// A page without the code it shows, which is compared as code.
fn told(project: &Project, path: &str) -> Result<String> {
    let page = Page::parse(path, &project.read(path)?);
    let emptied = |kind| matches!(kind, Kind::Snippet | Kind::Diff).then(String::new);
    let bodies: Vec<_> = page.blocks.iter().map(|block| emptied(block.kind)).collect();
    Ok(page.with_bodies(&bodies))
}

fn folder(
    project: &Project,
    names: &Names,
    old: &[String],
    new: &[String],
) -> Result<Vec<FileDiff>> {
    // The role is the path below the chapter's folder: samples/02_basic/main.rs is main.rs.
    let role = |path: &String| path.splitn(3, '/').nth(2).unwrap_or_default().to_owned();
    let mut roles: Vec<String> = new.iter().map(role).collect();
    roles.extend(old.iter().map(role).filter(|gone| !new.iter().any(|path| role(path) == *gone)));
    let side = |files: &[String], wanted: &str| -> Result<Side> {
        match files.iter().find(|path| role(path) == wanted) {
            Some(path) => Ok(names.side(path, &project.read(path)?)),
            None => Ok(Side::default()),
        }
    };
    let diff = |role: &String| Ok(FileDiff::new(role, side(old, role)?, side(new, role)?));
    roles.iter().map(diff).collect()
}

/// The names of two chapters, which are ignored in comparisons.
struct Names(Vec<String>);

impl Names {
    fn new(old: &Chapter, new: &Chapter) -> Self {
        Self(vec![old.name.clone(), new.name.clone(), old.heading(), new.heading()])
    }

    fn side(&self, path: &str, text: &str) -> Side {
        let numbered = text.lines().enumerate().filter(|(_, line)| !is_mark(line));
        let lines = numbered.map(|(index, text)| {
            // This character occurs in no source.
            let alike = |key: String, name: &String| key.replace(name, "\u{1}");
            let key = self.0.iter().fold(text.trim_end().to_owned(), alike);
            Line { number: index + 1, text: text.to_owned(), key, moved: false }
        });
        Side { path: Some(path.to_owned()), lines: lines.collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn diff(old: &str, new: &str) -> FileDiff {
        let chapter = |name: &str, title: &str| Chapter {
            name: name.to_owned(),
            title: title.to_owned(),
            ..Chapter::default()
        };
        let names = Names::new(&chapter("02_basic", "Basic"), &chapter("03_any_hit", "Any-hit"));
        FileDiff::new("main.rs", names.side("a", old), names.side("b", new))
    }

    #[test]
    fn a_rename_is_no_difference() {
        let old = "//! 02 · Basic\nrun(\"02_basic\")\nsame\n";
        let new = "//! 03 · Any-hit\nrun(\"03_any_hit\")\nsame\n";
        assert_eq!((diff(old, new).added(), diff(old, new).removed()), (0, 0));
        assert_eq!(diff("02_basic\n", "03_any_hit too\n").added(), 1);
    }

    #[test]
    fn anchors_are_no_difference() {
        let found = diff("a\n// ANCHOR: x\nb\n", "a\nb\n// ANCHOR_END: x\nc\n");
        assert_eq!((found.added(), found.removed()), (1, 0));
        assert_eq!(found.new.lines[2].number, 4);
    }

    #[test]
    fn what_only_stands_elsewhere_is_moved() {
        let block = "let pipeline = builder()\n    .raygen(\"camera.rgen\")\n    .build(gpu)\n";
        let mut diffs = [
            diff(&format!("fn new() {{\n    {block}}}\nkeep\n"), "fn new() {\n}\nkeep\n"),
            diff("a\n", &format!("a\nfn pipeline() {{\n{block}}}\n")),
        ];
        moved::mark(&mut diffs);
        assert_eq!((diffs[0].added(), diffs[0].removed(), diffs[0].moved()), (0, 0, 0));
        assert_eq!((diffs[1].added(), diffs[1].removed(), diffs[1].moved()), (2, 0, 3));
        // A bracket or two do not count as a moved block.
        let mut diffs = [diff("}\n}\nx\n", "x\n"), diff("y\n", "y\n}\n}\n")];
        moved::mark(&mut diffs);
        assert_eq!((diffs[1].added(), diffs[1].moved()), (2, 0));
    }

    #[test]
    fn a_part_has_what_was_removed_in_it_and_nothing_else() {
        let old = "1\n2\n3\nold\n4\n5\n6\n";
        let new = "changed\n2\n// ANCHOR: x\n3\nnew\n4\n// ANCHOR_END: x\n5\nmore\n";
        let found = diff(old, new).within(&(3..6));
        let texts =
            |side: &Side| side.lines.iter().map(|line| line.text.clone()).collect::<Vec<_>>();
        assert_eq!(texts(&found.old), ["3", "old", "4"]);
        assert_eq!(texts(&found.new), ["3", "new", "4"]);
        assert_eq!((found.added(), found.removed()), (1, 1));
    }
}
