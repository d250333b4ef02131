//! Checks the section *Try it* of a chapter's page: it contains the list of exercises and nothing that looks
//! like one.

use manuscript::fault::Fault;
use manuscript::page::{Kind, Page};
use manuscript::project::{Chapter, Project};

use crate::exercises::exercise::Exercise;

/// The section's heading.
const HEADING: &str = "## Try it";

/// The number of exercises of a page's chapter.
pub fn count(project: &Project, page: &Page) -> usize {
    let Some(chapter) = chapter(project, page) else { return 0 };
    let (exercises, _) = Exercise::all(project);
    exercises.iter().filter(|exercise| exercise.chapter == chapter.name).count()
}

fn chapter<'a>(project: &'a Project, page: &Page) -> Option<&'a Chapter> {
    project.of_page(&page.path)
}

/// The faults of the section; a chapter's page must have it.
pub fn check(project: &Project, page: &Page) -> Vec<Fault> {
    let Some(chapter) = chapter(project, page) else { return Vec::new() };
    let fault = |line, what: String, remedy: String| Fault::new(&*page.path, line, what, remedy);
    let prose = page.prose();
    let Some(start) = prose.iter().position(|(_, text)| text.trim_end() == HEADING) else {
        let what = format!("the page has no section `{HEADING}`");
        return vec![fault(1, what, "add it, with exercises".to_owned())];
    };
    let line = prose[start].0;
    let below = prose[start + 1..].iter().take_while(|(_, text)| !text.starts_with("## "));
    let mut faults = Vec::new();
    for (line, number) in below.filter_map(|(line, text)| Some((*line, number(text)?))) {
        let file = format!("docs/exercises/{}.{number}.diff", chapter.number());
        let what = format!("exercise {number} has no definition");
        faults.push(fault(line, what, format!("move it to {file}; `chapters sync` lists it here")));
    }
    let marker = format!("<!-- exercises {} -->", chapter.name);
    let lists = page.blocks.iter().filter(|block| block.kind == Kind::Exercises);
    let own = lists.filter(|block| block.words == [&*chapter.name]).count();
    // A wrong marker has already been reported.
    if own == 0 && faults.is_empty() && page.faults.is_empty() {
        let what = format!("`{HEADING}` does not list the exercises");
        faults.push(fault(line, what, format!("add {marker} and <!-- /exercises --> below it")));
    } else if own == 1 && count(project, page) == 0 {
        let first = format!("docs/exercises/{}.1.diff", chapter.number());
        faults.push(fault(
            line,
            "the chapter has no exercise".to_owned(),
            format!("write {first}"),
        ));
    }
    faults
}

/// The number before the point that begins a numbered item.
fn number(line: &str) -> Option<usize> {
    line.split_once(". ").and_then(|(number, _)| number.parse().ok())
}
