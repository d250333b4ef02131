//! A page of code: each file of a chapter with line numbers, and each change next to the lines of the parent
//! chapter.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::ops::Range;

use anyhow::Result;
use manuscript::anchor;
use manuscript::diff::{self, FileDiff, Line, Parts, Side};
use manuscript::project::{Chapter, Project};
use manuscript::shader;

use crate::color::{self, escaped};
use crate::contents::Entry;
use crate::link;

/// The code of a page as Markdown: its chapter's, and other files it shows; `None` if it has neither.
///
/// # Errors
/// If a file cannot be read, or its anchors are wrong.
pub fn compose(
    project: &Project,
    entry: &Entry,
    files: &BTreeSet<String>,
) -> Result<Option<String>> {
    let chapter = project.of_page(&entry.file);
    if chapter.is_none() && files.is_empty() {
        return Ok(None);
    }
    let mut text = String::new();
    if let Some(part) = &entry.part {
        let _ = writeln!(text, "<p class=\"part\">{}</p>\n", escaped(part));
    }
    let _ = writeln!(text, "# {}\n", link::code_title(project, entry));
    let page = format!("[{}]({})", entry.title, entry.address());
    let mut shown = Shown { project, text, contents: String::new(), listed: BTreeSet::new() };
    match chapter {
        Some(chapter) => shown.chapter(chapter, &page)?,
        None => {
            let _ =
                writeln!(shown.text, "The files that {page} shows or links to, whole. {MARKS}\n");
        }
    }
    let others: Vec<&String> = files.iter().filter(|file| !shown.listed.contains(*file)).collect();
    if chapter.is_some() && !others.is_empty() {
        shown.body("\n## Other files that the page shows\n\n");
    }
    for file in others {
        shown.alone(file, true)?;
    }
    let Shown { mut text, contents, .. } = shown;
    // The list of files comes before the first of them.
    let at = text.find(BODY).unwrap_or(text.len());
    text.replace_range(at..(at + BODY.len()).min(text.len()), &contents);
    Ok(Some(text))
}

/// An explanation of the comments a reader may wonder about.
const MARKS: &str = "A grey `ANCHOR` comment marks where a part that a page shows begins or ends.";

/// The placeholder of the list of files.
const BODY: &str = "\u{1}";

struct Shown<'a> {
    project: &'a Project,
    text: String,
    /// The list of files.
    contents: String,
    /// The files listed so far.
    listed: BTreeSet<String>,
}

impl Shown<'_> {
    fn body(&mut self, text: &str) {
        if !self.text.contains(BODY) {
            self.text.push_str(BODY);
        }
        self.text.push_str(text);
    }

    fn chapter(&mut self, chapter: &Chapter, page: &str) -> Result<()> {
        let project = self.project;
        let from = chapter.from.as_deref();
        let parent = from.and_then(|from| project.named(from));
        let mut own = project.files(&format!("samples/{}", chapter.name));
        own.sort_by_key(|file| !file.ends_with("/main.rs"));
        own.extend(shader::own(project, chapter));
        let Some(parent) = parent else {
            let _ = writeln!(self.text, "The whole code of {page}. {MARKS}\n");
            return own.iter().try_for_each(|file| self.alone(file, true));
        };
        let number = parent.number();
        let _ = writeln!(
            self.text,
            "The whole code of {page}, compared with that of [{}]({}.html). Green lines are new. The red \
             lines to their left are those of {number} that they replace. {number} has the yellow lines, too, \
             in another place or another file. {MARKS}\n",
            parent.heading(),
            parent.name
        );
        let parts = Parts { code: true, shaders: true, page: false };
        let diffs = diff::chapters(project, parent, chapter, parts)?;
        for diff in &diffs {
            self.compared(diff, number)?;
        }
        let same: Vec<&String> = own.iter().filter(|file| !self.listed.contains(*file)).collect();
        if !same.is_empty() {
            self.body(&format!("\n## As in {number}\n\n"));
            for file in same {
                self.alone(file, false)?;
            }
        }
        Ok(())
    }

    /// A single file, open or folded.
    fn alone(&mut self, file: &str, open: bool) -> Result<()> {
        let text = self.project.read(file)?;
        let named = named(file, &text)?;
        let painted = color::lines(shader::language(file), &text);
        let mut html = String::from("<div class=\"alone\"><div class=\"new\">");
        for (index, line) in text.lines().enumerate() {
            let class = if anchor::is_mark(line) { " mark" } else { "" };
            let line = painted.get(index).map_or("", String::as_str);
            html.push_str(&row(index + 1, line, class, named.get(&(index + 1)), file));
        }
        html.push_str("</div></div>");
        self.section(file, &format!("{} lines", kept(&text).count()), &html, open);
        Ok(())
    }

    fn compared(&mut self, diff: &FileDiff, number: &str) -> Result<()> {
        let Some(file) = &diff.new.path else {
            let old = Painted::new(self.project, &diff.old)?;
            let lines = old.lines("old", 0..diff.old.lines.len());
            let html = format!("<div class=\"alone\">{lines}</div>");
            let path = diff.path().to_owned();
            self.section(&path, &format!("gone; {number} has it"), &html, false);
            return Ok(());
        };
        let old = Painted::new(self.project, &diff.old)?;
        let new = Painted::new(self.project, &diff.new)?;
        let mut html = String::new();
        for (changed, olds, news) in sides(diff) {
            // In a new file, nothing counts as changed.
            let changed = changed && diff.old.path.is_some();
            let class = match (&diff.old.path, changed) {
                (None, _) => "alone",
                (_, true) => "change",
                (_, false) => "same",
            };
            let before = if changed { old.lines("old", olds) } else { String::new() };
            let _ = write!(html, "<div class=\"{class}\">{before}{}</div>", new.lines("new", news));
        }
        let moved = match diff.moved() {
            0 => String::new(),
            moved => format!(", {moved} moved"),
        };
        let included = diff.included_by.as_ref();
        let included = included.map_or(String::new(), |by| format!("; included by {by}"));
        let amount = match diff.old.path {
            None => format!("new: {} lines{included}", diff.added() + diff.moved()),
            Some(_) => format!("+{} −{}{moved}", diff.added(), diff.removed()),
        };
        self.section(file, &amount, &html, true);
        Ok(())
    }

    fn section(&mut self, file: &str, amount: &str, html: &str, open: bool) {
        let id = link::id(file);
        let entry =
            format!("- [{file}](#{id}) <span class=\"amount\">{}</span>\n", escaped(amount));
        self.contents.push_str(&entry);
        let open = if open { " open" } else { "" };
        self.body(&format!(
            "\n<h3 id=\"{id}\" class=\"file\">{}</h3>\n\n<details class=\"code\"{open}><summary>{}</summary>\n\
             {html}\n</details>\n",
            escaped(file),
            escaped(amount),
        ));
        self.listed.insert(file.to_owned());
    }
}

/// One side of a comparison, coloured.
struct Painted<'a> {
    side: &'a Side,
    lines: Vec<String>,
    named: BTreeMap<usize, Vec<String>>,
}

impl<'a> Painted<'a> {
    fn new(project: &Project, side: &'a Side) -> Result<Self> {
        let Some(file) = &side.path else {
            return Ok(Self { side, lines: Vec::new(), named: BTreeMap::new() });
        };
        let text = project.read(file)?;
        let lines = color::lines(shader::language(file), &text);
        Ok(Self { side, lines, named: named(file, &text)? })
    }

    /// Some of its lines, preceded by their marks, which a comparison leaves out; after the last line also
    /// the marks that end the file. Lines of the older side are not links.
    fn lines(&self, class: &str, lines: Range<usize>) -> String {
        let mut html = format!("<div class=\"{class}\">");
        let file = self.side.path.as_deref().unwrap_or_default();
        let all = &self.side.lines;
        let mut next = match lines.start.checked_sub(1) {
            Some(before) => all[before].number + 1,
            None => 1,
        };
        let mut put = |number: usize, class: &str, names| {
            let line = self.lines.get(number - 1).map_or("", String::as_str);
            html.push_str(&row(number, line, class, names, file));
        };
        for Line { number, moved, .. } in &all[lines.clone()] {
            (next..*number).for_each(|mark| put(mark, " mark", None));
            let moved = if *moved { " moved" } else { "" };
            put(*number, moved, self.named.get(number).filter(|_| class == "new"));
            next = number + 1;
        }
        if lines.end == all.len() && !lines.is_empty() {
            (next..=self.lines.len()).for_each(|mark| put(mark, " mark", None));
        }
        html + "</div>"
    }
}

/// A comparison in pieces: true if lines differ, and the lines of both sides.
fn sides(diff: &FileDiff) -> Vec<(bool, Range<usize>, Range<usize>)> {
    let mut pieces: Vec<(bool, Range<usize>, Range<usize>)> = Vec::new();
    for op in &diff.ops {
        let changed = !matches!(op, similar::DiffOp::Equal { .. });
        let (old, new) = (op.old_range(), op.new_range());
        match pieces.last_mut() {
            Some((before, olds, news)) if *before == changed => {
                (olds.end, news.end) = (old.end, new.end);
            }
            _ => pieces.push((changed, old, new)),
        }
    }
    pieces
}

/// The lines that are not marks, with their numbers from 1.
fn kept(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let numbered = text.lines().enumerate().map(|(index, line)| (index + 1, line));
    numbered.filter(|(_, line)| !anchor::is_mark(line))
}

/// The names of the parts that begin on each line.
fn named(file: &str, text: &str) -> Result<BTreeMap<usize, Vec<String>>> {
    let mut found: BTreeMap<usize, Vec<String>> = BTreeMap::new();
    // A patch only contains the marks near its changes.
    if shader::language(file) == "diff" {
        return Ok(found);
    }
    for part in anchor::parts(file, text).map_err(|fault| fault.error())? {
        let first = kept(text).map(|(number, _)| number).find(|number| *number > part.lines.start);
        found.entry(first.unwrap_or(part.lines.start)).or_default().push(part.name);
    }
    Ok(found)
}

fn row(number: usize, line: &str, class: &str, names: Option<&Vec<String>>, file: &str) -> String {
    let ids = names.into_iter().flatten();
    let ids: String =
        ids.map(|name| format!("<span id=\"{}.{name}\"></span>", link::id(file))).collect();
    format!("<span class=\"l{class}\" data-n=\"{number}\">{ids}{line}</span>")
}
