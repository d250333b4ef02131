//! `cargo chapters list`: one line per chapter, grouped by part.

use anyhow::Result;
use manuscript::project::{Chapter, Project};

/// The list, or the same as JSON.
///
/// # Errors
/// No known errors: everything in the list can be written as JSON.
pub fn list(project: &Project, json: bool) -> Result<String> {
    if json {
        return Ok(serde_json::to_string_pretty(&project.chapters)? + "\n");
    }
    let width = |of: fn(&Chapter) -> &str| {
        project.chapters.iter().map(|chapter| of(chapter).chars().count()).max().unwrap_or(0)
    };
    let (names, titles) = (width(|chapter| &chapter.name), width(|chapter| &chapter.title));
    let line = |chapter: &Chapter| {
        let Chapter { name, title, teaches, from, needs, .. } = chapter;
        // In the form `diff` accepts: the number is enough.
        let from = from.as_deref().and_then(|from| from.split('_').next()).unwrap_or("–");
        let needs = match &needs[..] {
            [] => String::new(),
            _ => format!(" (needs {})", needs.join(", ")),
        };
        format!("{name:names$}  {title:titles$}  from {from:2}  {teaches}{needs}\n")
    };
    let parts = project.parted().into_iter().map(|(heading, chapters)| {
        let heading = if heading.is_empty() { heading } else { heading + "\n" };
        heading + &chapters.into_iter().map(line).collect::<String>()
    });
    Ok(parts.collect::<Vec<_>>().join("\n"))
}
