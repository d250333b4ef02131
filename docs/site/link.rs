//! The targets of a page's links on the site.

use manuscript::link::local;
use manuscript::project::{Chapter, Project, README};

use crate::contents::Entry;

/// The target of a link.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Target {
    /// Out of the site.
    Web,
    /// An address of the site.
    Site(String),
    /// A file that is not a page, from the project's root.
    File(String),
}

/// A place of the site that must exist, and the page that links to it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Wanted {
    /// The page's file, from the project's root.
    pub file: String,
    /// Its line, from 1.
    pub line: usize,
    /// The address of the linked page.
    pub page: String,
    /// The id on it.
    pub id: Option<String>,
}

/// The target of a link of a page.
///
/// # Errors
/// The fault of the link.
pub fn resolve(
    project: &Project,
    entries: &[Entry],
    from: &Entry,
    target: &str,
) -> Result<Target, String> {
    let id = target.split_once('#').map_or(String::new(), |(_, id)| format!("#{id}"));
    let Some(file) = local(&from.file, target) else {
        return Ok(if target.starts_with('#') {
            Target::Site(target.to_owned())
        } else {
            Target::Web
        });
    };
    if let Some(entry) = entries.iter().find(|entry| entry.file == file) {
        return Ok(Target::Site(entry.address() + &id));
    }
    if project.has(&file) {
        Ok(Target::File(file))
    } else {
        Err(format!("the link leads to '{file}', which is no file"))
    }
}

/// The chapter that owns a file.
pub fn own<'a>(project: &'a Project, file: &str) -> Option<&'a Chapter> {
    let mut parts = file.split('/');
    let folder = parts.next()?;
    let name = parts.next()?;
    parts.next()?;
    let here = ["samples", "shaders"].contains(&folder);
    project.chapters.iter().find(|chapter| here && chapter.name == name)
}

/// The address where a file is shown: with the code of its chapter, or else with that of the page itself.
pub fn shown(
    project: &Project,
    entries: &[Entry],
    from: &Entry,
    file: &str,
    anchor: Option<&str>,
) -> String {
    let owner = own(project, file).map(Chapter::page);
    let entry = entries.iter().find(|entry| Some(&entry.file) == owner.as_ref()).unwrap_or(from);
    let anchor = anchor.map_or(String::new(), |anchor| format!(".{anchor}"));
    format!("{}.html#{}{anchor}", code_name(entry), id(file))
}

/// The name of the page with a page's code.
pub fn code_name(entry: &Entry) -> String {
    format!("{}-code", entry.name)
}

/// The id of a file on the page that shows it.
pub fn id(file: &str) -> String {
    file.replace(|c: char| !c.is_ascii_alphanumeric() && c != '_', "-")
}

/// The title of the page with a page's code.
pub fn code_title(project: &Project, entry: &Entry) -> String {
    match project.of_page(&entry.file) {
        Some(chapter) => format!("Code of {}", chapter.number()),
        None if entry.file == README => "Files of the first page".to_owned(),
        None => format!("Files of {}", entry.title),
    }
}
