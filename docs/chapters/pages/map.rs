//! The map in words, for those who see no drawing: the ways through the book, and who comes from whom.

use manuscript::page::Page;
use manuscript::project::{Chapter, Project, Way};

fn link(chapter: &Chapter) -> String {
    format!("[{}]({}.md)", chapter.heading(), chapter.name)
}

/// The map that is drawn.
pub const FILE: &str = "docs/images/map.svg";

/// What the drawn map should be, if a page shows it.
pub fn drawing(project: &Project, pages: &[Page]) -> Option<String> {
    let name = FILE.trim_start_matches("docs/");
    let shows = |page: &Page| page.lines.iter().any(|line| line.contains(name));
    let shown = pages.iter().any(shows) && !project.ways.is_empty();
    shown.then(|| drawings::map::draw(project))
}

/// A row for each way.
pub fn ways(project: &Project) -> String {
    let mut text = "| way | chapters | what it gives |\n|---|---|---|\n".to_owned();
    for Way { title, gives, chapters } in &project.ways {
        let of = |number: &String| project.chapters.iter().find(|c| c.number() == *number);
        let links: Vec<String> = chapters.iter().filter_map(of).map(link).collect();
        text.push_str(&format!("| **{title}** | {} | {gives} |\n", links.join(", ")));
    }
    text
}

/// Every chapter as an item below the one that it builds on.
pub fn chapters(project: &Project) -> String {
    let line = |(depth, chapter): (usize, &Chapter)| {
        format!("{}- {}: {}\n", "  ".repeat(depth), link(chapter), chapter.teaches)
    };
    project.tree().into_iter().map(line).collect()
}
