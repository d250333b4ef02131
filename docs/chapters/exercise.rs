//! Exercises: the numbered items of a page's section *Try it*, each with what the reader checks.

use crate::fault::Fault;
use crate::page::Page;
use crate::project::Project;

/// The section's heading.
const HEADING: &str = "## Try it";
/// What begins the part of an exercise by which a reader knows that it has come out right.
const CHECK: &str = "*Check:*";

/// A numbered item.
struct Exercise {
    /// Its line, from 1.
    line: usize,
    /// Its number, as written.
    number: usize,
    /// What it says, in as many lines as it takes.
    text: String,
}

/// The number before the point that begins a numbered item.
fn number(line: &str) -> Option<usize> {
    line.split_once(". ").and_then(|(number, _)| number.parse().ok())
}

/// The heading's line and the exercises below it, if there is the section.
fn section(page: &Page) -> Option<(usize, Vec<Exercise>)> {
    let prose = page.prose();
    let start = prose.iter().position(|(_, text)| text.trim_end() == HEADING)?;
    let below = prose[start + 1..].iter().take_while(|(_, text)| !text.starts_with("## "));
    let mut exercises: Vec<Exercise> = Vec::new();
    for &(line, text) in below {
        match (number(text), exercises.last_mut()) {
            (Some(number), _) => exercises.push(Exercise { line, number, text: text.to_owned() }),
            (None, Some(last)) => last.text.push_str(text),
            (None, None) => {}
        }
    }
    Some((prose[start].0, exercises))
}

/// How many exercises a page has.
pub fn count(page: &Page) -> usize {
    section(page).map_or(0, |(_, exercises)| exercises.len())
}

/// What is wrong with a page's exercises; a chapter's page must have some.
pub fn check(project: &Project, page: &Page) -> Vec<Fault> {
    let fault = |line, what: String, remedy: &str| Fault::new(&*page.path, line, what, remedy);
    let example = format!("write `1. … {CHECK} …` below it");
    let Some((line, exercises)) = section(page) else {
        let chapter = project.chapters.iter().any(|chapter| chapter.page() == page.path);
        let what = format!("the page has no section `{HEADING}`");
        return chapter.then(|| fault(1, what, "add it, with exercises")).into_iter().collect();
    };
    if exercises.is_empty() {
        return vec![fault(line, format!("`{HEADING}` has no numbered exercise"), &example)];
    }
    let mut faults = Vec::new();
    for (expected, exercise) in (1..).zip(&exercises) {
        let Exercise { line, number, text } = exercise;
        if *number != expected {
            let what = format!("exercise {expected} has the number {number}");
            faults.push(fault(*line, what, "count from 1"));
        }
        let checked = text.split_once(CHECK).is_some_and(|(_, how)| !how.trim().is_empty());
        if !checked {
            let what = format!("exercise {number} does not say how to check it");
            faults.push(fault(*line, what, &format!("write `{CHECK}` and what a reader must see")));
        }
    }
    faults
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exercises_end_with_their_section_and_may_have_several_lines() {
        let text =
            "# T\n\n## Try it\n\nFirst this.\n\n1. a\n   *Check:* b\n2. c\n\n## Sources\n\n3. d\n";
        let (line, exercises) = section(&Page::parse("p.md", text)).unwrap();
        let found: Vec<(usize, usize, bool)> = exercises
            .iter()
            .map(|exercise| (exercise.line, exercise.number, exercise.text.contains(CHECK)))
            .collect();
        assert_eq!((line, &found[..]), (3, &[(7, 1, true), (9, 2, false)][..]));
        assert_eq!(count(&Page::parse("p.md", "# T\n")), 0);
    }
}
