//! The map in words, for those who see no drawing: the ways through the book, and who comes from whom.

use manuscript::project::{Chapter, Project, Way};

fn link(chapter: &Chapter) -> String {
    format!("[{}]({}.md)", chapter.heading(), chapter.name)
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
