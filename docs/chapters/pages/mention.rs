//! Chapters and exercises that a page's text names by their number: `chapter 05`, `05`, `exercise 3`.
//!
//! A chapter that is still to come is named as `chapter 11 (planned)`, and in no other way.

use manuscript::fault::Fault;
use manuscript::page::Page;
use manuscript::project::Project;

use super::exercise_list;

/// What follows the number of a chapter that is not there yet.
const PLANNED: &str = " (planned)";
/// Where the chapters of other books are named.
const SOURCES: &str = "## Sources";

/// A chapter's number in a line.
#[derive(Debug, PartialEq, Eq)]
pub struct Mention {
    /// Such as `05`.
    pub number: String,
    /// Whether the line says that the chapter is still to come.
    pub planned: bool,
}

/// What is wrong with the chapters and exercises that a page names.
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

/// The pieces of code in a line, each with the byte at which its text begins.
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

/// A line with blanks in place of code, of where links lead, and of formulas.
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
    // Blanks replace whole characters: what is taken out begins and ends beside an ASCII mark.
    String::from_utf8(bytes).unwrap_or_default()
}

/// The words of a text, letters, digits and `_`, each with the byte at which it begins.
fn words(text: &str) -> Vec<(usize, &str)> {
    let part = |c: char| c.is_alphanumeric() || c == '_';
    let mut found: Vec<(usize, &str)> = Vec::new();
    let mut rest = text;
    while let Some(start) = rest.find(part) {
        let word = &rest[start..];
        let word = &word[..word.find(|c| !part(c)).unwrap_or(word.len())];
        found.push((text.len() - rest.len() + start, word));
        rest = &rest[start + word.len()..];
    }
    found
}

/// Whether a word is two digits, as the number of a chapter is.
fn is_number(word: &str) -> bool {
    word.len() == 2 && word.bytes().all(|byte| byte.is_ascii_digit())
}

/// Every chapter that a line names: after the word *chapter*, or by a number that begins with 0.
pub fn chapters(line: &str) -> Vec<Mention> {
    let text = plain(line);
    let words = words(&text);
    let end = |index: usize| words[index].0 + words[index].1.len();
    let mut named = vec![false; words.len()];
    for (index, (start, word)) in words.iter().enumerate() {
        // After the word comes a number, after its plural a list such as `05, 06 and 12`.
        let most = match &*word.to_lowercase() {
            "chapter" => 1,
            "chapters" => words.len(),
            _ => 0,
        };
        for at in (index + 1..words.len()).take(most) {
            let gap = [" ", ", ", " (", ") "].contains(&&text[end(at - 1)..words[at].0]);
            let joins = ["and", "or", "to", "planned"].contains(&words[at].1);
            if !gap || !(joins || is_number(words[at].1)) {
                break;
            }
            named[at] = !joins;
        }
        // Neither the month of a date nor a part of a longer number.
        let before = text[..*start].chars().next_back();
        let after = &text[start + word.len()..];
        let longer = before.is_some_and(|c| ".,:/-−–#".contains(c))
            || (after.starts_with(['.', ',', ':', '/', '-'])
                && after[1..].starts_with(|c: char| c.is_ascii_digit()));
        named[index] |= is_number(word) && word.starts_with('0') && !longer;
    }
    let mention = |index: usize| Mention {
        number: words[index].1.to_owned(),
        planned: text[end(index)..].starts_with(PLANNED),
    };
    (0..words.len()).filter(|&index| named[index]).map(mention).collect()
}

/// Every chapter that a line names as its folder is called, in the text or as a piece of code.
fn names(line: &str) -> Vec<String> {
    let named = |word: &&str| {
        let (number, name) = word.split_once('_').unwrap_or_default();
        is_number(number) && name.starts_with(|c: char| c.is_ascii_lowercase())
    };
    let text = plain(line);
    let prose = words(&text).into_iter().map(|(_, word)| word);
    let alone = codes(line).into_iter().map(|(_, code)| code);
    let alone = alone.filter(|code| words(code).len() == 1);
    prose.chain(alone).filter(named).map(str::to_owned).collect()
}

/// The number of every exercise that a line names.
fn exercises(line: &str) -> Vec<usize> {
    let text = plain(line);
    let words = words(&text);
    let pairs = words.windows(2).filter(|pair| ["exercise", "Exercise"].contains(&pair[0].1));
    pairs.filter_map(|pair| pair[1].1.parse().ok()).collect()
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
