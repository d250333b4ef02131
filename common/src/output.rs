//! A program's standard output and standard error, safe even if nobody reads them.

use std::io::{ErrorKind, Write, stderr, stdout};

use anyhow::{Context, Result};

/// Writes to standard output. It is not an error if the reader has closed it, as `head` does.
///
/// # Errors
/// If it cannot be written for another reason, for example a full disk.
pub fn print(text: &str) -> Result<()> {
    write(text.as_bytes())
}

/// Prints a text, such as the help, and ends the process.
pub fn print_and_exit(text: &str) -> ! {
    let Err(error) = print(text) else { std::process::exit(0) };
    complain(&format!("error: {error:#}"));
    std::process::exit(1)
}

/// As [`print()`], for bytes.
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

/// The most characters of a line on standard error: a name or key in a file may be as long as the file.
const MOST: usize = 2000;

/// Writes a line to standard error; if that is closed, only the exit code reports the error.
///
/// A line may quote a file. Special characters in it, for example the start of a terminal's commands, are written
/// as `\u{1b}`, and a line that is too long is cut.
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

/// A text that is safe for a terminal: special characters are escaped.
pub fn plain(text: &str) -> String {
    let mut plain = String::new();
    for letter in text.chars() {
        if is_plain(letter) {
            plain.push(letter);
        } else {
            plain.extend(letter.escape_default());
        }
    }
    plain
}

/// True if a terminal can show a character as it is: not a control character, and none that changes the direction
/// of text.
fn is_plain(letter: char) -> bool {
    let turns = matches!(letter, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    !letter.is_control() && !turns
}

/// The line of an error with its causes.
pub fn line_of(error: &anyhow::Error) -> String {
    format!("error: {error:#}").replace('\n', " ")
}

/// Writes warnings about an input to standard error, one line each.
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
