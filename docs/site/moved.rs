//! Moved pages and places: the site redirects from their old addresses, which readers may have saved.

use std::collections::{BTreeMap, BTreeSet};

use anyhow::Result;
use manuscript::fault::Fault;
use manuscript::project::Project;

use crate::contents::Entry;
use crate::link::Wanted;

/// The file of old and new addresses.
pub const FILE: &str = "docs/moved.toml";

/// A place that has moved.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Moved {
    /// Its line in the file, from 1.
    pub line: usize,
    /// Its old address: a page, or a place on one.
    pub old: String,
    /// Its new address.
    pub new: String,
}

/// All places that have moved; none if there is no such file.
///
/// # Errors
/// If the file cannot be read, or a line leads to no page of the book.
pub fn read(project: &Project, entries: &[Entry]) -> Result<Vec<Moved>> {
    if !project.has(FILE) {
        return Ok(Vec::new());
    }
    let text = project.read(FILE)?;
    let table: BTreeMap<String, String> = toml::from_str(&text).map_err(|error| {
        let before = error.span().map_or("", |span| &text[..span.start]);
        let what = error.message().replace('\n', " ");
        let remedy = "write \"page.md#place\" = \"page.md#place\"";
        Fault::new(FILE, before.matches('\n').count() + 1, what, remedy).error()
    })?;
    // Lines of exercises are read by `cargo chapters exercise`.
    let places = table.into_iter().filter(|(old, _)| !old.starts_with("exercise "));
    let moved = places.map(|(old, new)| {
        let line = text.lines().position(|line| line.starts_with(&format!("\"{old}\"")));
        let line = line.map_or(1, |index| index + 1);
        let fault = |what: String| Fault::new(FILE, line, what, "correct it").error();
        let [old, new] = [old, new].map(|place| {
            let (page, id) = place.split_once('#').map_or((&*place, None), |(p, id)| (p, Some(id)));
            let page = page.strip_suffix(".md");
            let page = page.ok_or_else(|| fault(format!("'{place}' is no place of a page")))?;
            // A page's name on the site has no folder.
            anyhow::Ok((page.replace('/', "-"), id.map_or(String::new(), |id| format!("#{id}"))))
        });
        let ((from, gone), (to, id)) = (old?, new?);
        if !entries.iter().any(|entry| entry.name == to) {
            return Err(fault(format!("'{to}.md' is no page of the book")));
        }
        if gone.is_empty() && entries.iter().any(|entry| entry.name == from) {
            return Err(fault(format!("'{from}.md' has not moved: it is a page of the book")));
        }
        Ok(Moved { line, old: format!("{from}.html{gone}"), new: format!("{to}.html{id}") })
    });
    moved.collect()
}

/// The redirects in mdBook's settings.
pub fn redirects(moved: &[Moved]) -> BTreeMap<String, &str> {
    moved.iter().map(|Moved { old, new, .. }| (format!("/{old}"), &**new)).collect()
}

/// The new places, which must exist.
pub fn wanted(moved: &[Moved]) -> impl Iterator<Item = Wanted> {
    moved.iter().map(|Moved { line, new, .. }| {
        let (page, id) = new.split_once('#').map_or((&**new, None), |(p, id)| (p, Some(id)));
        let (file, page) = (FILE.to_owned(), page.to_owned());
        Wanted { file, line: *line, page, id: id.map(str::to_owned) }
    })
}

/// The fault of a moved place whose old address still exists, so that its redirect is never used. `ids` are
/// those of its page.
pub fn still_there(moved: &Moved, ids: &BTreeSet<String>) -> Option<Fault> {
    let (page, id) = moved.old.split_once('#')?;
    let there = ids.contains(id).then(|| format!("'{page}' still has a place '{id}'"));
    there.map(|what| Fault::new(FILE, moved.line, what, "take this line out"))
}
