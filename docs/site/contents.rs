//! The order of the pages: those listed in `docs/SUMMARY.md`, with the README before them.

use anyhow::Result;
use manuscript::fault::Fault;
use manuscript::project::{MEASUREMENTS, Project, README, SUMMARY};

/// A page of the site.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Entry {
    /// Its title in the contents.
    pub title: String,
    /// Its file, from the project's root.
    pub file: String,
    /// Its name on the site, without an extension.
    pub name: String,
    /// The heading of its part, such as `II · Shapes`; none before and after the parts.
    pub part: Option<String>,
}

impl Entry {
    fn new(title: &str, file: &str, name: &str, part: Option<&str>) -> Self {
        let part = part.map(str::to_owned);
        Self { title: title.to_owned(), file: file.to_owned(), name: name.to_owned(), part }
    }

    /// True for a page with a chapter's further tables, which is outside the reading order.
    pub fn is_apart(&self) -> bool {
        self.file.starts_with(&format!("docs/{MEASUREMENTS}/"))
    }

    /// Its address, from the site's root.
    pub fn address(&self) -> String {
        format!("{}.html", self.name)
    }
}

/// All pages in reading order.
///
/// # Errors
/// If a line of the summary is neither a heading nor a link; the message has the line.
pub fn read(project: &Project) -> Result<Vec<Entry>> {
    let mut entries = Vec::new();
    if project.has(README) {
        entries.push(Entry::new("All chapters", README, "index", None));
    }
    let mut part = None;
    for (index, line) in project.read(SUMMARY)?.lines().enumerate() {
        let line = line.trim_end();
        if let Some(heading) = line.strip_prefix("# ") {
            part = Some(heading.to_owned()).filter(|heading| heading != "Summary");
            continue;
        }
        if line.is_empty() {
            continue;
        }
        // A link outside a list is before or after the parts. Items may be nested.
        let line = line.trim_start();
        if !line.starts_with("- ") {
            part = None;
        }
        let link = line.trim_start_matches("- ").strip_prefix('[');
        let link = link.and_then(|rest| rest.strip_suffix(')')?.split_once("]("));
        let Some((title, name)) =
            link.and_then(|(title, file)| Some((title, file.strip_suffix(".md")?)))
        else {
            let what = format!("'{line}' is no heading and no link to a page");
            return Err(Fault::new(SUMMARY, index + 1, what, "run: cargo chapters sync").error());
        };
        let file = format!("docs/{name}.md");
        if !project.has(&file) {
            let what = format!("'{file}' does not exist");
            return Err(Fault::new(SUMMARY, index + 1, what, "run: cargo chapters sync").error());
        }
        // All pages of the site are in one folder.
        entries.push(Entry::new(title, &file, &name.replace('/', "-"), part.as_deref()));
    }
    for (title, file, name) in [
        ("Contributing", "CONTRIBUTING.md", "contributing"),
        ("Changelog", "CHANGELOG.md", "changelog"),
    ] {
        if project.has(file) {
            entries.push(Entry::new(title, file, name, None));
        }
    }
    Ok(entries)
}
