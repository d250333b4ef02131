//! Checks the names in the text of a page or an exercise: chapters, files, commands, tests, links, formulas.

use manuscript::fault::Fault;
use manuscript::page::Page;
use manuscript::project::{Chapter, Project};

use super::markdown::{Markdown, check_formulas, check_links};
use super::reference::Files;
use super::{mention, placeholder, run_command, test_command};
use crate::exercises::exercise::{Exercise, Takes};
use crate::programs::program::Programs;

/// The names on a page that do not exist or are wrong; `written` is the author's own text.
pub fn check(programs: &Programs, files: &Files, page: &Page, written: &Markdown) -> Vec<Fault> {
    let path = &*page.path;
    let mut faults = placeholder::check(page);
    faults.extend(mention::check(programs.project, page));
    faults.extend(check_links(programs.project, path, &written.links));
    faults.extend(check_formulas(path, &written.formulas));
    faults.extend(run_command::check(programs, path, &written.code));
    faults.extend(test_command::check(programs.project, path, &written.code));
    faults.extend(files.check(page, written));
    faults
}

/// The faults of the names in the exercises.
pub fn check_exercises(programs: &Programs, files: &Files) -> Vec<Fault> {
    let mut faults = Vec::new();
    for exercise in Exercise::all(programs.project).0 {
        let texts = texts(programs.project, &exercise);
        let written = Markdown::parse(&texts.written());
        let wrong = check(programs, files, &texts, &written).into_iter();
        faults.extend(wrong.map(|fault| Fault { file: exercise.patch.file.clone(), ..fault }));
    }
    faults
}

/// The texts of an exercise as a page of its chapter, each on its line in the file, so that the same checks
/// apply.
fn texts(project: &Project, exercise: &Exercise) -> Page {
    let shown = |line: &str| {
        let (key, value) = line.split_once(": ")?;
        match key {
            "Text" | "Check" | "Hint" | "Why" => Some(value.to_owned()),
            // Rust code may add controls that the book's program lacks.
            "Run" if value.starts_with("--set ") && exercise.takes != Takes::Rust => {
                Some(format!("`{value}`"))
            }
            _ => None,
        }
    };
    let heading = exercise.patch.text.lines().take_while(|line| !line.starts_with("--- "));
    let text: String = heading.map(|line| shown(line).unwrap_or_default() + "\n").collect();
    let chapter = project.named(&exercise.chapter);
    Page::parse(&chapter.map(Chapter::page).unwrap_or_default(), &text)
}
