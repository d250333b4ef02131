//! Chapters and exercises mentioned by number in a page's text: `chapter 05`, `05`, `exercise 3`.
//!
//! A chapter that does not exist yet is mentioned as `chapter 11 (planned)`.

use std::sync::LazyLock;

use manuscript::fault::Fault;
use manuscript::page::Page;
use manuscript::project::Project;
use regex_lite::{Match, Regex};

use super::exercise_list;

/// The words after the number of a chapter that does not exist yet.
const PLANNED: &str = " (planned)";
/// The section that mentions chapters of other books.
const SOURCES: &str = "## Sources";

static NUMBER: LazyLock<Regex> = LazyLock::new(|| regex(r"\b\d\d\b"));
/// The word is followed by a number, its plural by a list such as `05, 06 and 12`.
static LIST: LazyLock<Regex> = LazyLock::new(|| {
    let gap = r"(?: |, | \(|\) )";
    regex(&format!(r"(?i)\bchapter{gap}\d\d\b|\bchapters(?:{gap}(?:and|or|to|planned|\d\d)\b)+"))
});
static NAME: LazyLock<Regex> = LazyLock::new(|| regex(r"\b\d\d_[a-z]\w*"));
static EXERCISE: LazyLock<Regex> = LazyLock::new(|| regex(r"\b[Ee]xercise\W+(\d+)\b"));

fn regex(pattern: &str) -> Regex {
    Regex::new(pattern).expect("the pattern is right")
}

/// A chapter's number in a line.
#[derive(Debug, PartialEq, Eq)]
pub struct Mention {
    /// Such as `05`.
    pub number: String,
    /// True if the line says that the chapter is planned.
    pub planned: bool,
}

/// The faults of the chapters and exercises that a page mentions.
pub fn check(project: &Project, page: &Page) -> Vec<Fault> {
    let mut faults = Vec::new();
    let own = project.of_page(&page.path).is_some();
    let count = exercise_list::count(project, page);
    let mut sources = false;
    for (line, text) in page.prose() {
        if text.starts_with("## ") {
            sources = text.trim_end() == SOURCES;
        }
        let fault = |what: String, remedy: &str| Fault::new(&*page.path, line, what, remedy);
        for Mention { number, planned } in chapters(text).into_iter().filter(|_| !sources) {
            let there = project.chapters.iter().any(|chapter| chapter.number() == number);
            match (there, planned) {
                (false, false) => {
                    let remedy = format!("correct it, or write `chapter {number}{PLANNED}`");
                    faults.push(fault(format!("there is no chapter {number}"), &remedy));
                }
                (true, true) => {
                    let what = format!("chapter {number} is there");
                    faults.push(fault(what, "do not call it planned"));
                }
                _ => {}
            }
        }
        for name in names(text) {
            if project.named(&name).is_none() {
                faults.push(fault(format!("there is no chapter '{name}'"), "correct its name"));
            }
        }
        for number in exercises(text).into_iter().filter(|number| own && *number > count) {
            let what = format!("there is no exercise {number}, only {count}");
            faults.push(fault(what, "correct the number"));
        }
    }
    faults
}

/// The code spans in a line, each with the byte at which its text begins.
pub fn codes(line: &str) -> Vec<(usize, &str)> {
    let mut found = Vec::new();
    let mut at = 0;
    while let Some(start) = line[at..].find('`').map(|start| at + start) {
        let marks = line[start..].len() - line[start..].trim_start_matches('`').len();
        let text = start + marks;
        let Some(length) = line[text..].find(&line[start..text]) else { break };
        found.push((text, &line[text..text + length]));
        at = text + length + marks;
    }
    found
}

/// A line with its code, link targets and formulas replaced by blanks.
fn plain(line: &str) -> String {
    let mut bytes = line.as_bytes().to_vec();
    let mut blank = |start: usize, end: usize| bytes[start..end].fill(b' ');
    for (start, code) in codes(line) {
        blank(start, start + code.len());
    }
    for (start, _) in line.match_indices("](") {
        let end = line[start..].find(')').map_or(line.len(), |length| start + length);
        blank(start + 1, end);
    }
    let dollars: Vec<usize> = line.match_indices('$').map(|(at, _)| at).collect();
    for pair in dollars.chunks_exact(2) {
        blank(pair[0], pair[1]);
    }
    // Whole characters are replaced: every removed part begins and ends next to an ASCII character.
    String::from_utf8(bytes).unwrap_or_default()
}

/// All chapters mentioned in a line: after the word *chapter*, or by a number that begins with 0.
pub fn chapters(line: &str) -> Vec<Mention> {
    let text = plain(line);
    let lists: Vec<Match> = LIST.find_iter(&text).collect();
    let is_named = |number: &Match| {
        let (before, after) = (&text[..number.start()], &text[number.end()..]);
        // Skips the month of a date and parts of longer numbers.
        let longer = before.ends_with(['.', ',', ':', '/', '-', '−', '–', '#'])
            || after.starts_with(['.', ',', ':', '/', '-'])
                && after[1..].starts_with(|c: char| c.is_ascii_digit());
        lists.iter().any(|list| list.range().contains(&number.start()))
            || number.as_str().starts_with('0') && !longer
    };
    let mention = |number: Match| Mention {
        number: number.as_str().to_owned(),
        planned: text[number.end()..].starts_with(PLANNED),
    };
    NUMBER.find_iter(&text).filter(is_named).map(mention).collect()
}

/// All chapters mentioned in a line by their folder's name, in the text or in code.
fn names(line: &str) -> Vec<String> {
    let text = plain(line);
    let alone = |code: &&str| NAME.find(code).is_some_and(|name| name.range() == (0..code.len()));
    let codes = codes(line).into_iter().map(|(_, code)| code).filter(alone);
    let prose = NAME.find_iter(&text).map(|name| name.as_str());
    prose.chain(codes).map(str::to_owned).collect()
}

/// The numbers of all exercises mentioned in a line.
fn exercises(line: &str) -> Vec<usize> {
    let text = plain(line);
    EXERCISE.captures_iter(&text).filter_map(|found| found[1].parse().ok()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers(line: &str) -> Vec<(String, bool)> {
        chapters(line).into_iter().map(|mention| (mention.number, mention.planned)).collect()
    }

    #[test]
    fn chapters_are_found_by_word_and_by_number() {
        let cases: [(&str, &[(&str, bool)]); 9] = [
            ("As chapter 11 does, and 12 more.", &[("11", false)]),
            ("Chapters 05, 06 and 12 do: 30 %.", &[("05", false), ("06", false), ("12", false)]),
            ("chapter 11 (planned) and 02", &[("11", true), ("02", false)]),
            ("chapters 11 (planned) and 19 (planned).", &[("11", true), ("19", true)]),
            ("The noise of 03 and of (05, 06)", &[("03", false), ("05", false), ("06", false)]),
            ("2026-11-03, 0.05, 1e-05, 03:430, 10", &[]),
            ("`chapter 99` and $u_{05}$ and [a](05_b.md)", &[]),
            ("Real-Time Rendering, chapter 6.8, chapters 1 to 3", &[]),
            ("die Äste von 04.", &[("04", false)]),
        ];
        for (line, expected) in cases {
            let expected: Vec<_> = expected.iter().map(|(n, p)| ((*n).to_owned(), *p)).collect();
            assert_eq!(numbers(line), expected, "{line}");
        }
    }

    #[test]
    fn names_and_exercises_are_found() {
        assert_eq!(
            names("See 03_ant and `04_bee`, not `05_cat.md` or `a 06_dog`."),
            ["03_ant", "04_bee"]
        );
        assert_eq!(exercises("(exercise 6), in exercise 4; exercises 7"), [6, 4]);
        assert_eq!(codes("a `b` and ``c`d``"), [(3, "b"), (12, "c`d")]);
    }
}
