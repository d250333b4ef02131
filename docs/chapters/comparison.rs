//! A comparison of two chapters for a terminal, coloured unless it is piped.

use std::fmt::Write as _;
use std::io::{ErrorKind, Write as _};
use std::ops::Range;

use anstyle::{AnsiColor, Effects, Style};
use anyhow::{Context, Result};
use manuscript::diff::{FileDiff, Line};
use manuscript::project::Chapter;
use similar::{Algorithm, DiffOp, capture_diff_slices_by_key, group_diff_ops};

const TITLE: Style = Style::new().effects(Effects::BOLD);
const FILE: Style = AnsiColor::Cyan.on_default().effects(Effects::BOLD);
const FAINT: Style = Style::new().effects(Effects::DIMMED);
const OLD: Style = AnsiColor::Red.on_default();
const NEW: Style = AnsiColor::Green.on_default();
/// A line the other chapter has in another place.
const MOVED: Style = AnsiColor::Blue.on_default();
/// A word that changed within a line that did not change as a whole.
const OLD_WORD: Style = AnsiColor::Red.on_default().effects(Effects::BOLD.insert(Effects::INVERT));
const NEW_WORD: Style =
    AnsiColor::Green.on_default().effects(Effects::BOLD.insert(Effects::INVERT));

/// Two lines that share less text than this count as different lines, not as one changed line.
const ALIKE: f64 = 0.5;

fn paint(style: Style, text: &str) -> String {
    format!("{style}{text}{style:#}")
}

/// Names that count as equal on both sides: those of the two chapters.
type Names<'a> = [&'a str; 2];

/// Prints to standard output, in colour only on a terminal.
///
/// # Errors
/// If writing fails. A closed pipe is not an error.
pub fn print(text: &str) -> Result<()> {
    match anstream::stdout().write_all(text.as_bytes()) {
        // A reader such as `head` may close the pipe early.
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        result => result.context("cannot write to standard output"),
    }
}

/// The two chapters, and the lesson of the newer one.
pub fn heading(old: &Chapter, new: &Chapter) -> String {
    let title = format!("{} → {}", old.heading(), new.heading());
    format!("{}\n{}: {}\n", paint(TITLE, &title), new.title, new.teaches)
}

/// The number of files to recommend first.
const FIRST: usize = 3;

/// The files to begin with, if there are many: the program, then those with the most new lines.
pub fn read_first(diffs: &[FileDiff]) -> String {
    let is_main = |diff: &FileDiff| diff.role == "main.rs";
    let mut first: Vec<&FileDiff> = diffs.iter().filter(|diff| diff.added() > 0).collect();
    if first.len() <= FIRST {
        return String::new();
    }
    first.sort_by_key(|diff| (!is_main(diff), std::cmp::Reverse(diff.added())));
    let names: Vec<&str> = first[..FIRST].iter().map(|diff| &*diff.role).collect();
    format!("Read these first: {}\n", names.join(", "))
}

/// Every file with its changed lines, and `context` lines around them.
pub fn changes(old: &Chapter, new: &Chapter, diffs: &[FileDiff], context: usize) -> String {
    let names = [&*old.name, &*new.name];
    let mut out = String::new();
    for diff in diffs {
        let _ = write!(
            out,
            "\n{}  {}\n",
            file_line(diff),
            counts(diff.added(), diff.removed(), diff.moved())
        );
        for group in group_diff_ops(diff.ops.clone(), context) {
            let _ = writeln!(out, "{}", paint(FAINT, &format!("  ⋯ {}", place(diff, &group))));
            for op in &group {
                show_op(&mut out, diff, op, names);
            }
        }
    }
    out
}

/// The number of lines each file gained and lost, and the sum.
pub fn statistics(diffs: &[FileDiff]) -> String {
    if diffs.is_empty() {
        return "\nNothing differs.\n".to_owned();
    }
    let width = diffs.iter().map(|diff| diff.role.chars().count()).max().unwrap_or(0).max(5);
    let mut out = "\n".to_owned();
    let (mut added, mut removed, mut moved) = (0, 0, 0);
    for diff in diffs {
        let counts = counts(diff.added(), diff.removed(), diff.moved());
        let _ = writeln!(out, "  {:width$}  {counts}  {}", diff.role, paint(FAINT, state(diff)));
        added += diff.added();
        removed += diff.removed();
        moved += diff.moved();
    }
    let _ = writeln!(out, "  {:width$}  {}", "total", counts(added, removed, moved));
    out
}

fn state(diff: &FileDiff) -> &'static str {
    match (&diff.old.path, &diff.new.path) {
        (None, _) => "new",
        (_, None) => "gone",
        _ => "",
    }
}

fn counts(added: usize, removed: usize, moved: usize) -> String {
    let [added, removed] = [format!("+{added}"), format!("−{removed}")];
    let counts =
        format!("{} {}", paint(NEW, &format!("{added:>5}")), paint(OLD, &format!("{removed:>5}")));
    match moved {
        0 => counts,
        _ => format!("{counts} {}", paint(MOVED, &format!("{moved} moved"))),
    }
}

fn file_line(diff: &FileDiff) -> String {
    let name = match (&diff.old.path, &diff.new.path, &diff.included_by) {
        (None, Some(new), Some(includer)) => format!("{new}, new: included by {includer}"),
        (None, Some(new), None) => format!("{new}, new"),
        (Some(old), None, _) => format!("{old}, gone"),
        (Some(old), Some(new), _) => format!("{old} → {new}"),
        (None, None, _) => diff.role.clone(),
    };
    paint(FILE, &name)
}

/// The place of a group of changes: its line, and the function or section around it.
fn place(diff: &FileDiff, group: &[DiffOp]) -> String {
    let Some(first) = group.first() else { return String::new() };
    let (side, at) = match &diff.new.path {
        Some(_) => (&diff.new, first.new_range().start),
        None => (&diff.old, first.old_range().start),
    };
    let number = side.lines.get(at).map_or(1, |line| line.number);
    let before = &side.lines[..at.min(side.lines.len())];
    let around = match &*diff.role {
        "page" => before.iter().rev().find(|line| line.text.starts_with('#')),
        _ => enclosing(before, side.lines.get(at)),
    };
    let around = around.map(|line| line.text.trim().trim_end_matches('{').trim_end());
    around.map_or(format!("line {number}"), |around| format!("line {number}, in {around}"))
}

/// The last line above that opens a block around the given line: no line between them is indented less.
fn enclosing<'a>(before: &'a [Line], line: Option<&Line>) -> Option<&'a Line> {
    let indent = |line: &Line| line.text.len() - line.text.trim_start().len();
    let mut depth = line.map_or(0, indent);
    let mut written = before.iter().rev().filter(|line| !line.text.trim().is_empty());
    written.find(|line| {
        let outside = indent(line) < depth;
        depth = depth.min(indent(line));
        outside && line.text.trim_end().ends_with('{')
    })
}

fn show_op(out: &mut String, diff: &FileDiff, op: &DiffOp, names: Names) {
    let old = &diff.old.lines[op.old_range()];
    let new = &diff.new.lines[op.new_range()];
    if let DiffOp::Equal { .. } = op {
        for (old, new) in old.iter().zip(new) {
            let _ = writeln!(out, "{}", row(Some(old), Some(new), &new.text));
        }
        return;
    }
    let (old_texts, new_texts) = by_word(old, new, names);
    let painted =
        |line: &Line, text: String| if line.moved { paint(MOVED, &line.text) } else { text };
    for (line, text) in old.iter().zip(old_texts) {
        let _ = writeln!(out, "{}", row(Some(line), None, &painted(line, text)));
    }
    for (line, text) in new.iter().zip(new_texts) {
        let _ = writeln!(out, "{}", row(None, Some(line), &painted(line, text)));
    }
}

fn row(old: Option<&Line>, new: Option<&Line>, text: &str) -> String {
    let number = |line: Option<&Line>| line.map_or(String::new(), |line| line.number.to_string());
    let numbers = format!("{:>4} {:>4}", number(old), number(new));
    let sign = match (old, new) {
        (Some(line), None) if line.moved => paint(MOVED, "<"),
        (None, Some(line)) if line.moved => paint(MOVED, ">"),
        (Some(_), None) => paint(OLD, "-"),
        (None, Some(_)) => paint(NEW, "+"),
        _ => " ".to_owned(),
    };
    format!("{} {sign} {text}", paint(FAINT, &numbers)).trim_end().to_owned()
}

/// The lines of a change, painted: words that differ stand out if most of the text is the same.
fn by_word(old: &[Line], new: &[Line], names: Names) -> (Vec<String>, Vec<String>) {
    let [old_words, new_words] = [old, new].map(words);
    let key = |word: &Word| if names.contains(&word.text) { "" } else { word.text }.to_owned();
    let ops = capture_diff_slices_by_key(Algorithm::Patience, &old_words, &new_words, key);
    let weight = |words: &[Word]| words.iter().map(|word| word.text.trim().len()).sum::<usize>();
    let equal: usize = ops
        .iter()
        .filter(|op| matches!(op, DiffOp::Equal { .. }))
        .map(|op| weight(&old_words[op.old_range()]))
        .sum();
    let all = (weight(&old_words) + weight(&new_words)) as f64;
    let alike = 2.0 * equal as f64 >= ALIKE * all && equal > 0;
    let painted = |words: &[Word], lines: usize, ranges: Vec<Range<usize>>, styles: [Style; 2]| {
        // Neighbours of the same style are merged, so that the output stays readable without a terminal.
        let mut pieces: Vec<Vec<(Style, String)>> = vec![Vec::new(); lines];
        for (op, range) in ops.iter().zip(ranges) {
            let changed = alike && !matches!(op, DiffOp::Equal { .. });
            for word in &words[range] {
                // A coloured blank at the start of a line would only be noise.
                let stands_out = changed && !word.text.trim().is_empty();
                let style = styles[usize::from(stands_out)];
                match pieces[word.line].last_mut() {
                    Some((last, text)) if *last == style => text.push_str(word.text),
                    _ => pieces[word.line].push((style, word.text.to_owned())),
                }
            }
        }
        let line = |pieces: &Vec<(Style, String)>| {
            pieces.iter().map(|(style, text)| paint(*style, text)).collect()
        };
        pieces.iter().map(line).collect::<Vec<String>>()
    };
    let old_ranges = ops.iter().map(DiffOp::old_range).collect();
    let new_ranges = ops.iter().map(DiffOp::new_range).collect();
    (
        painted(&old_words, old.len(), old_ranges, [OLD, OLD_WORD]),
        painted(&new_words, new.len(), new_ranges, [NEW, NEW_WORD]),
    )
}

/// A word, a run of blanks, or one other character.
struct Word<'a> {
    line: usize,
    text: &'a str,
}

fn words(lines: &[Line]) -> Vec<Word<'_>> {
    let mut found = Vec::new();
    for (index, line) in lines.iter().enumerate() {
        let mut rest = line.text.as_str();
        while let Some(first) = rest.chars().next() {
            let class = |c: char| match c {
                c if c.is_alphanumeric() || c == '_' => 0,
                c if c.is_whitespace() => 1,
                _ => 2,
            };
            let other = |c: char| class(first) == 2 || class(c) != class(first);
            let end =
                rest.char_indices().skip(1).find(|&(_, c)| other(c)).map_or(rest.len(), |(i, _)| i);
            let (text, after) = rest.split_at(end);
            found.push(Word { line: index, text });
            rest = after;
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    const NAMES: Names = ["02_basic", "03_any_hit"];

    fn line(text: &str) -> Line {
        Line { number: 1, text: text.to_owned(), key: text.to_owned(), moved: false }
    }

    #[test]
    fn what_encloses_a_line_is_still_open_there() {
        let lines =
            ["fn new() {", "    for x in y {", "        z", "    }", "    let a = b", ""].map(line);
        let found = enclosing(&lines, Some(&line("        .c()")));
        assert_eq!(found.map(|line| &*line.text), Some("fn new() {"));
    }

    #[test]
    fn only_the_changed_word_stands_out() {
        let (old, new) =
            by_word(&[line("let ä = sky(02_basic);")], &[line("let ä = sun(03_any_hit);")], NAMES);
        let painted = |line, word, changed, name| {
            [paint(line, "let ä = "), paint(word, changed), paint(line, name)].concat()
        };
        assert_eq!(old, [painted(OLD, OLD_WORD, "sky", "(02_basic);")]);
        assert_eq!(new, [painted(NEW, NEW_WORD, "sun", "(03_any_hit);")]);
    }

    #[test]
    fn lines_that_have_little_in_common_are_not_compared_by_word() {
        let (old, _) =
            by_word(&[line("alpha beta gamma")], &[line("one two gamma three four")], NAMES);
        assert!(!old[0].contains(&OLD_WORD.to_string()), "{}", old[0]);
    }

    #[test]
    fn words_are_split_between_characters_of_any_width() {
        let lines = [line("é_1→漢字  (a̐)")];
        let texts: Vec<&str> = words(&lines).iter().map(|word| word.text).collect();
        assert_eq!(texts.concat(), lines[0].text);
        assert_eq!(texts[..4], ["é_1", "→", "漢字", "  "]);
    }
}
