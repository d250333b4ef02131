//! Placeholders for text that is still to be written.

use manuscript::fault::Fault;
use manuscript::page::Page;
use manuscript::project::Project;

use crate::exercises::exercise;

/// The placeholder lesson of a chapter made by `new`.
pub const TEACHES: &str = "say here, in a line, what it teaches";

/// The first words of a new program, after the chapter's number and title, and after its parent's name.
pub const OPENING: [&str; 2] = ["what it teaches, in a line.", "what is new."];

/// The placeholder of a figure in a cell of a table.
const CELLS: [&str; 3] = ["X", "TBD", "TODO"];

/// The word that `new` writes where text is missing.
const WRITE: &str = "WRITE";

/// The start of a comment that requests text.
const SAY: &str = "say here";

/// The placeholders of a page: a line that is only a word in capitals, a cell marked as empty, `WRITE` within
/// a line, or a request to say something.
pub fn check(page: &Page) -> Vec<Fault> {
    let mut faults = Vec::new();
    for (line, text) in page.prose() {
        let text = text.trim();
        let cell = || text.split('|').map(str::trim).find(|cell| CELLS.contains(cell));
        let found = if text.starts_with('|') {
            cell()
        } else {
            Some(text).filter(|text| is_word_of_capitals(text))
        };
        faults.extend(found.or_else(|| within(text)).map(|word| fault(&page.path, line, word)));
    }
    faults
}

/// The placeholders of exercises, and of the programs and tests of chapters.
pub fn check_files(project: &Project) -> Vec<Fault> {
    let mut faults = Vec::new();
    for folder in [exercise::FOLDER, "samples", "tests/samples"] {
        let is_comment = |line: &str| line.trim_start().starts_with("//");
        for file in project.files(folder) {
            let (exercise, rust) = (folder == exercise::FOLDER, file.ends_with(".rs"));
            let text = (exercise || rust).then(|| project.read(&file).ok()).flatten();
            // An exercise's diff may add anything.
            let text = text.unwrap_or_default();
            let lines = text.lines().take_while(|line| !(exercise && line.starts_with("--- ")));
            let asked = lines.enumerate().filter(|(_, line)| exercise || is_comment(line));
            faults.extend(
                asked.filter_map(|(index, line)| Some(fault(&file, index + 1, within(line)?))),
            );
        }
    }
    faults
}

/// A placeholder within a line. In a code span it is only quoted.
fn within(text: &str) -> Option<&str> {
    let is_letter = |c: char| c.is_ascii_alphanumeric() || ['-', '_'].contains(&c);
    let mut prose = text.split('`').step_by(2);
    let write = prose.any(|part| part.split(|c: char| !is_letter(c)).any(|word| word == WRITE));
    let words = text.trim_start_matches(['/', '!', ' ', '>', '*', '-']);
    let say = words.get(..SAY.len()).filter(|start| start.eq_ignore_ascii_case(SAY));
    if write { Some(WRITE) } else { say.map(|_| words) }
}

/// A fault that reports a placeholder in a file.
pub fn fault(file: &str, line: usize, words: &str) -> Fault {
    let what = format!("'{words}' holds a place for something");
    Fault::new(file, line, what, "write what belongs here")
}

/// Returns whether a line consists only of a word such as `ERRORTABLE`.
fn is_word_of_capitals(line: &str) -> bool {
    let word = line.trim_end_matches([':', '.', '…']);
    word.len() > 1 && word.bytes().all(|byte| byte.is_ascii_uppercase() || byte == b'_')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_placeholder_is_found_within_a_line() {
        let text = "![WRITE](a.png)\n\n> **Exact:** WRITE **Price:** none\n\n`WRITE` is a word.\n\n\
            SYNC-HAZARD-WRITE-AFTER-WRITE\n\nSay here which device set the tolerance\n\nWe say here no more.\n";
        let lines = check(&Page::parse("p.md", text)).into_iter().map(|fault| fault.line);
        assert_eq!(lines.collect::<Vec<_>>(), [1, 3, 9]);
        assert_eq!(
            within("    // Say here which device set it."),
            Some("Say here which device set it.")
        );
        assert_eq!(within("Text: WRITE it. Then run it."), Some("WRITE"));
    }

    #[test]
    fn only_a_line_or_a_cell_of_its_own_is_a_placeholder() {
        let text = "ERRORTABLE\n\n| a | X |\n\nA ULP is one.\n\nULP:\n\n```text\nTODO\n```\n\n| X-ray | NVIDIA |\n";
        let faults = check(&Page::parse("p.md", text));
        let lines: Vec<usize> = faults.iter().map(|fault| fault.line).collect();
        assert_eq!(lines, [1, 3, 7]);
        assert!(faults[0].to_string().starts_with("p.md:1: 'ERRORTABLE' holds a place for"));
    }
}
