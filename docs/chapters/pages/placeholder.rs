//! Words that hold a place for what is still to be written.

use manuscript::fault::Fault;
use manuscript::page::Page;

/// The lesson of a chapter that `new` has made.
pub const TEACHES: &str = "say here, in a line, what it teaches";

/// The first words of its program, behind the chapter's number and title, and behind its parent's name.
pub const OPENING: [&str; 2] = ["what it teaches, in a line.", "what is new."];

/// The placeholder of a figure in a cell of a table.
const CELLS: [&str; 3] = ["X", "TBD", "TODO"];

/// Every placeholder: a line that is nothing but a word of capitals, or a cell that says it is empty.
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
        faults.extend(found.map(|word| fault(&page.path, line, word)));
    }
    faults
}

/// A place in a file that such words hold.
pub fn fault(file: &str, line: usize, words: &str) -> Fault {
    let what = format!("'{words}' holds a place for something");
    Fault::new(file, line, what, "write what belongs here")
}

/// Returns whether a line says nothing but a word such as `ERRORTABLE`.
fn is_word_of_capitals(line: &str) -> bool {
    let word = line.trim_end_matches([':', '.', '…']);
    word.len() > 1 && word.bytes().all(|byte| byte.is_ascii_uppercase() || byte == b'_')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_line_or_a_cell_of_its_own_is_a_placeholder() {
        let text = "ERRORTABLE\n\n| a | X |\n\nA ULP is one.\n\nULP:\n\n```text\nTODO\n```\n\n| X-ray | NVIDIA |\n";
        let faults = check(&Page::parse("p.md", text));
        let lines: Vec<usize> = faults.iter().map(|fault| fault.line).collect();
        assert_eq!(lines, [1, 3, 7]);
        assert!(faults[0].to_string().starts_with("p.md:1: 'ERRORTABLE' holds a place for"));
    }
}
