//! The map in words, for readers who cannot see the drawing: the ways through the book, and the parent of
//! each chapter.

use manuscript::page::Page;
use manuscript::project::{Chapter, Project, Way};

fn link(chapter: &Chapter) -> String {
    format!("[{}]({}.md)", chapter.heading(), chapter.name)
}

/// The file of the drawn map.
pub const FILE: &str = "docs/images/map.svg";

/// The drawn map as it should be, if a page shows it.
pub fn drawing(project: &Project, pages: &[Page]) -> Option<String> {
    let name = FILE.trim_start_matches("docs/");
    let shows = |page: &Page| page.lines.iter().any(|line| line.contains(name));
    let shown = pages.iter().any(shows) && !project.ways.is_empty();
    shown.then(|| drawings::map::draw(project))
}

/// A table with one row per way.
pub fn ways(project: &Project) -> String {
    let mut text = "| way | chapters | what it gives |\n|---|---|---|\n".to_owned();
    for Way { title, gives, chapters } in &project.ways {
        let of = |number: &String| project.chapters.iter().find(|c| c.number() == *number);
        let links: Vec<String> = chapters.iter().filter_map(of).map(link).collect();
        text.push_str(&format!("| **{title}** | {} | {gives} |\n", links.join(", ")));
    }
    text
}

/// A list of all chapters, each an item below the chapter it builds on.
pub fn chapters(project: &Project) -> String {
    let line = |(depth, chapter): (usize, &Chapter)| {
        format!("{}- {}: {}\n", "  ".repeat(depth), link(chapter), chapter.teaches)
    };
    project.tree().into_iter().map(line).collect()
}
