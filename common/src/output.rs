//! What a program says on standard output and standard error, also where nobody reads it.

use std::io::{ErrorKind, Write, stderr, stdout};

use anyhow::{Context, Result};

/// Writes to standard output. A reader that has closed it, as `head` does, has read enough.
///
/// # Errors
/// If it cannot be written for another reason, a full disk for one.
pub fn print(text: &str) -> Result<()> {
    write(text.as_bytes())
}

/// Prints what was asked for instead of a run, such as the help, and ends the process.
pub fn print_and_exit(text: &str) -> ! {
    let Err(error) = print(text) else { std::process::exit(0) };
    complain(&format!("error: {error:#}"));
    std::process::exit(1)
}

/// As [`print()`], for what is no text.
///
/// # Errors
/// As [`print()`].
pub fn write(bytes: &[u8]) -> Result<()> {
    let mut stdout = stdout().lock();
    match stdout.write_all(bytes).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        result => result.context("cannot write to standard output"),
    }
}

/// The most letters of a line on standard error: a file's name or key may be as long as the file.
const MOST: usize = 2000;

/// Writes a line to standard error; if that is closed, the exit code alone tells of the error.
///
/// A line may hold what a file says. What is no plain letter in it, a terminal's commands for one, is
/// written as `\u{1b}`, and a line that is too long is cut.
pub fn complain(line: &str) {
    let _ = writeln!(stderr(), "{}", short(line));
}

fn short(line: &str) -> String {
    let mut letters = line.chars();
    let mut text = plain(&letters.by_ref().take(MOST).collect::<String>());
    if letters.next().is_some() {
        text.push('…');
    }
    text
}

/// A text as a terminal may show it: what is no plain letter is escaped.
pub fn plain(text: &str) -> String {
    let mut plain = String::new();
    for letter in text.chars() {
        match is_plain(letter) {
            true => plain.push(letter),
            false => plain.extend(letter.escape_default()),
        }
    }
    plain
}

/// Whether a terminal shows a letter as a letter: no control, and nothing that turns the direction of text.
fn is_plain(letter: char) -> bool {
    let turns = matches!(letter, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    !letter.is_control() && !turns
}

/// The line of an error: what went wrong, and why.
pub fn line_of(error: &anyhow::Error) -> String {
    format!("error: {error:#}").replace('\n', " ")
}

/// Writes what is wrong with an input that is used all the same to standard error, a line each.
pub fn warn(warnings: &[String]) {
    for warning in warnings {
        complain(&format!("warning: {warning}"));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_holds_no_commands_for_a_terminal() {
        assert_eq!(plain("Größe 象: 'a b'"), "Größe 象: 'a b'");
        assert_eq!(plain("\x1b]0;title\x07\u{9b}2J\r\n"), "\\u{1b}]0;title\\u{7}\\u{9b}2J\\r\\n");
        assert_eq!(plain("a\u{202e}b"), "a\\u{202e}b");
    }

    #[test]
    fn a_line_has_an_end() {
        let line = short(&"x".repeat(15_000_000));
        assert_eq!((line.chars().count(), line.chars().last()), (MOST + 1, Some('…')));
    }
}
