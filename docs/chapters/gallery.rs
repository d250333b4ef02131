//! Every chapter at a glance: the README's gallery, and mdBook's table of contents.

use crate::project::{Chapter, Project};

/// Pictures side by side.
const COLUMNS: usize = 3;

/// Pages beside the chapters, with their titles: the first before them, the others after.
const BEFORE: (&str, &str) = ("reading.md", "How to read this book");
const AFTER: &[(&str, &str)] = &[
    ("measured.md", "Everything measured"),
    ("compilers.md", "What a GPU's compiler says"),
    ("arithmetic.md", "The worst arithmetic that conforms"),
    ("needs.md", "What a device must offer"),
    ("long-renders.md", "Long renders"),
    ("wrong-pictures.md", "When the picture is wrong"),
    ("devices.md", "What was tested"),
];

/// Whether a page of the book is no chapter's.
pub fn is_other_page(file: &str) -> bool {
    file == BEFORE.0 || AFTER.iter().any(|(name, _)| file == *name)
}

/// A table of pictures, each with its chapter's title and what that teaches, all leading to the page.
pub fn table(project: &Project, page: &str) -> String {
    // The links are written as they lead from the page that shows the table.
    let up = "../".repeat(page.matches('/').count());
    let mut text = String::new();
    for (index, chapters) in project.chapters.chunks(COLUMNS).enumerate() {
        let picture = |chapter: &Chapter| {
            let title = chapter.heading();
            format!("[![{title}]({up}{})]({up}{})", chapter.picture(), chapter.page())
        };
        let words = |chapter: &Chapter| {
            format!("**[{}]({up}{})**<br>{}", chapter.heading(), chapter.page(), chapter.teaches)
        };
        text.push_str(&row(chapters, picture));
        if index == 0 {
            text.push_str(&format!("|{}\n", ":---:|".repeat(chapters.len())));
        }
        text.push_str(&row(chapters, words));
    }
    text
}

fn row(chapters: &[Chapter], cell: impl Fn(&Chapter) -> String) -> String {
    let cells: Vec<String> =
        chapters.iter().map(|chapter| cell(chapter).replace('|', "\\|")).collect();
    format!("| {} |\n", cells.join(" | "))
}

/// The whole of `docs/SUMMARY.md`.
pub fn summary(project: &Project) -> String {
    let other = |(file, title): (&str, &str)| match project.has(&format!("docs/{file}")) {
        true => format!("[{title}]({file})\n"),
        false => String::new(),
    };
    let mut text = "# Summary\n\n".to_owned();
    let before = other(BEFORE);
    if !before.is_empty() {
        text.push_str(&format!("{before}\n"));
    }
    for chapter in &project.chapters {
        text.push_str(&format!("- [{}]({}.md)\n", chapter.heading(), chapter.name));
    }
    let after: Vec<String> =
        AFTER.iter().copied().map(other).filter(|line| !line.is_empty()).collect();
    if !after.is_empty() {
        text.push_str(&format!("\n{}", after.join("\n")));
    }
    text
}
