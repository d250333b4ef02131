//! All chapters at a glance: the README's gallery, and mdBook's table of contents.

use manuscript::project::{Chapter, MEASUREMENTS, Project};

/// The number of pictures in a row.
const COLUMNS: usize = 3;

/// The pages before and after the chapters, with their titles.
const BEFORE: &[(&str, &str)] = &[
    ("reading.md", "How to read this book"),
    ("map.md", "The map"),
    ("from-raster.md", "From raster to rays"),
    ("raster-dictionary.md", "A dictionary for rasteriser people"),
    ("own-program.md", "Your own program"),
];
const AFTER: &[(&str, &str)] = &[
    ("command-line.md", "The command line"),
    ("own-models.md", "Your own models"),
    ("scene-format.md", "The format of scene files"),
    ("shadow-start.md", "How high a shadow ray starts"),
    ("depth-and-occlusion.md", "Depth and ambient occlusion"),
    ("reordering.md", "Threads that change places"),
    ("builders-and-boxes.md", "Builders and box tests"),
    ("prices.md", "What accuracy costs"),
    ("measured.md", "Everything measured"),
    ("on-a-gpu.md", "On a GPU"),
    ("this-gpu.md", "What this browser and GPU compute"),
    ("what-hardware-computes.md", "What hardware computes"),
    ("compilers.md", "What a GPU's compiler says"),
    ("arithmetic.md", "The worst arithmetic that conforms"),
    ("needs.md", "What a device must offer"),
    ("long-renders.md", "Long renders"),
    ("limits.md", "Limits"),
    ("wrong-pictures.md", "When the picture is wrong"),
    ("debugging.md", "Debugging a ray"),
    ("devices.md", "What was tested"),
    ("glossary.md", "Glossary"),
];

/// Returns whether a page of the book belongs to no chapter.
pub fn is_other_page(file: &str) -> bool {
    BEFORE.iter().chain(AFTER).any(|(name, _)| file == *name)
}

/// A table of pictures for each part: each picture with its chapter's title and lesson, linked to the
/// chapter's page.
pub fn tables(project: &Project, page: &str) -> String {
    let parts = project.parted().into_iter().map(|(heading, chapters)| match &heading[..] {
        "" => table(&chapters, page),
        _ => format!("### {heading}\n\n{}", table(&chapters, page)),
    });
    parts.collect::<Vec<_>>().join("\n")
}

fn table(chapters: &[&Chapter], page: &str) -> String {
    // Links are relative to the page that shows the table.
    let up = "../".repeat(page.matches('/').count());
    let mut text = String::new();
    for (index, chapters) in chapters.chunks(COLUMNS).enumerate() {
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

fn row(chapters: &[&Chapter], cell: impl Fn(&Chapter) -> String) -> String {
    let cells: Vec<String> =
        chapters.iter().map(|chapter| cell(chapter).replace('|', "\\|")).collect();
    format!("| {} |\n", cells.join(" | "))
}

/// A chapter's lines in the table of contents: its page, and below it the page of its further tables.
fn contents_of(project: &Project, chapter: &Chapter) -> String {
    let Chapter { name, .. } = chapter;
    let page = format!("- [{}]({name}.md)\n", chapter.heading());
    if project.has(&chapter.measurements()) {
        format!("{page}  - [{}]({MEASUREMENTS}/{name}.md)\n", measurements(chapter))
    } else {
        page
    }
}

/// The heading of the page with a chapter's further tables.
pub fn measurements(chapter: &Chapter) -> String {
    format!("{} · Measurements", chapter.number())
}

/// The text of `docs/SUMMARY.md`.
pub fn summary(project: &Project) -> String {
    let other = |(file, title): (&str, &str)| {
        if project.has(&format!("docs/{file}")) {
            format!("[{title}]({file})\n")
        } else {
            String::new()
        }
    };
    let listed = |pages: &[(&str, &str)]| -> Vec<String> {
        pages.iter().copied().map(other).filter(|line| !line.is_empty()).collect()
    };
    let mut text = "# Summary\n\n".to_owned();
    for before in listed(BEFORE) {
        text.push_str(&format!("{before}\n"));
    }
    let parts = project.parted().into_iter().map(|(heading, chapters)| {
        let heading = if heading.is_empty() { heading } else { format!("# {heading}\n\n") };
        heading + &chapters.iter().map(|chapter| contents_of(project, chapter)).collect::<String>()
    });
    text.push_str(&parts.collect::<Vec<_>>().join("\n"));
    let after = listed(AFTER);
    if !after.is_empty() {
        text.push_str(&format!("\n{}", after.join("\n")));
    }
    text
}
