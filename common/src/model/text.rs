//! The text of a model's files, which are untrusted.
//!
//! Text is read within limits, line by line, so that every fault has a line number.

use std::borrow::Cow;
use std::collections::BTreeSet;
use std::fmt::Display;
use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use anyhow::{Result, anyhow, ensure};

use super::encoding::{check, is_foreign, letters};
pub use super::encoding::{quoted, shown, utf8};
pub use super::folder::{Folder, Named, Unavailable};

/// Bytes of one statement; a polygon of 1024 corners needs about half.
const STATEMENT_BYTES: usize = 64 << 10;

/// Bytes of a name. Each mesh has its own copy.
const NAME_BYTES: usize = 1024;

/// A text file in memory.
pub struct Text {
    /// The path in error messages.
    pub shown: String,
    bytes: Vec<u8>,
}

impl Text {
    /// Reads a file of at most `limit` bytes.
    ///
    /// # Errors
    /// If it is missing, larger, not a regular file, or not text.
    pub fn read(path: &Path, shown: String, limit: u64) -> Result<Self> {
        let bytes = read(path, &shown, limit)?;
        check(&bytes, &shown).map_err(|error| anyhow!(Unavailable(error.to_string())))?;
        Ok(Self { shown, bytes })
    }

    /// Its size in bytes.
    pub fn size(&self) -> usize {
        self.bytes.len()
    }

    /// The statements in order.
    pub fn statements(&self) -> Statements<'_> {
        let rest = self.bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&self.bytes);
        Statements { shown: &self.shown, rest, line: 0, open_end: !self.bytes.ends_with(b"\n") }
    }
}

/// Every opened file: the inputs of a picture.
static OPENED: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

/// The files opened by [`open`] in this process.
pub fn opened() -> Vec<PathBuf> {
    OPENED.lock().unwrap_or_else(PoisonError::into_inner).iter().cloned().collect()
}

/// Opens a file of a scene like [`regular`], and records it.
///
/// # Errors
/// As [`regular`].
pub fn open(path: &Path, shown: &str, limit: u64) -> Result<File> {
    let file = regular(path, shown, limit)?;
    note_opened([path]);
    Ok(file)
}

/// The bytes of a file of a scene.
///
/// # Errors
/// As [`regular`], or if it cannot be read.
pub(crate) fn read(path: &Path, shown: &str, limit: u64) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    open(path, shown, limit)?
        .take(limit)
        .read_to_end(&mut bytes)
        .map_err(|error| anyhow!("{shown}: cannot be read: {error}"))?;
    Ok(bytes)
}

/// Records files of a scene that were opened in another way.
pub fn note_opened<'a>(paths: impl IntoIterator<Item = &'a Path>) {
    let paths = paths.into_iter().map(Path::to_owned);
    OPENED.lock().unwrap_or_else(PoisonError::into_inner).extend(paths);
}

/// Opens a regular file of at most `limit` bytes; a pipe or a device might never end.
///
/// # Errors
/// If it is missing, larger, or not a regular file.
pub fn regular(path: &Path, shown: &str, limit: u64) -> Result<File> {
    let failed = |error: std::io::Error| match error.kind() {
        ErrorKind::NotFound => anyhow!(Unavailable(format!("{shown}: there is no such file"))),
        _ => anyhow!(Unavailable(format!("{shown}: cannot be read: {error}"))),
    };
    let metadata = std::fs::metadata(path).map_err(failed)?;
    ensure!(
        metadata.is_file(),
        "{shown}: is not a file that can be read, but a folder or a device"
    );
    let size = metadata.len();
    ensure!(size <= limit, "{shown}: is too large: {size} bytes, at most {limit} are read");
    File::open(path).map_err(failed)
}

/// Iterates over a text's statements, without comments and empty lines.
pub struct Statements<'a> {
    shown: &'a str,
    rest: &'a [u8],
    line: usize,
    open_end: bool,
}

impl<'a> Statements<'a> {
    /// The next line without white space around it. Ends at LF, CR LF, or CR as on old Macs.
    fn physical(&mut self) -> &'a [u8] {
        let end = self.rest.iter().position(|byte| matches!(byte, b'\n' | b'\r'));
        let (line, rest) = self.rest.split_at(end.unwrap_or(self.rest.len()));
        let ends = if rest.starts_with(b"\r\n") { 2 } else { rest.len().min(1) };
        self.rest = &rest[ends..];
        self.line += 1;
        line.trim_ascii()
    }
}

impl<'a> Iterator for Statements<'a> {
    type Item = Statement<'a>;

    fn next(&mut self) -> Option<Statement<'a>> {
        // A comment may end in a backslash, for example a Windows folder, and so may a letter of Shift-JIS: neither
        // continues the line.
        let continued = |line: &[u8]| {
            let is_letter = || ends_in_letter(&letters(line));
            line.ends_with(b"\\") && !line.contains(&b'#') && !is_letter()
        };
        let line = loop {
            if self.rest.is_empty() {
                return None;
            }
            let line = self.physical();
            if !line.is_empty() && line[0] != b'#' {
                break line;
            }
        };
        let number = self.line;
        let mut text = Cow::Borrowed(line);
        while continued(&text) && !self.rest.is_empty() && text.len() <= STATEMENT_BYTES {
            let text = text.to_mut();
            text.pop();
            text.push(b' ');
            text.extend(self.physical());
        }
        let text = match text {
            Cow::Borrowed(line) => letters(line),
            Cow::Owned(lines) => letters(&lines).into_owned().into(),
        };
        let cut = self.open_end && self.rest.is_empty();
        Some(Statement { shown: self.shown, line: number, text, cut })
    }
}

/// A keyword and its arguments, with their place.
pub struct Statement<'a> {
    shown: &'a str,
    line: usize,
    text: Cow<'a, str>,
    cut: bool,
}

impl Statement<'_> {
    /// File and line.
    pub fn place(&self) -> String {
        format!("{}:{}", self.shown, self.line)
    }

    /// The keyword and the rest, without white space around it and without a comment.
    ///
    /// # Errors
    /// If the statement is too long.
    pub fn split(&self) -> Result<(&str, &str)> {
        let length = self.text.len();
        ensure!(
            length <= STATEMENT_BYTES,
            "the line is too long: {length} bytes, at most {STATEMENT_BYTES} are read"
        );
        let text: &str = match &self.text {
            text if ends_in_letter(text) => text,
            text => text.trim_end_matches('\\'),
        };
        let (keyword, rest) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
        Ok((keyword, without_comment(rest).trim()))
    }

    /// The error with the place in front, and a hint if the file ends within this line.
    pub fn at(&self, error: impl Display) -> anyhow::Error {
        let hint = if self.cut { "; the file ends in this line, perhaps cut off" } else { "" };
        anyhow!("{}: {error}{hint}", self.place())
    }
}

/// True if the last byte is the second one of a letter, which in Shift-JIS, Big5 and GBK may be that of a
/// backslash.
fn ends_in_letter(text: &str) -> bool {
    text.strip_suffix('\\').is_some_and(|text| text.ends_with(is_foreign))
}

/// The part before a comment: a `#` after a blank. That of "Material #25", a name of 3ds Max, begins none, and
/// neither does that of "#ff8000", a colour as a name.
fn without_comment(rest: &str) -> &str {
    let begins = |at: usize| {
        let (before, after) = (&rest[..at], &rest[at + 1..]);
        if before.is_empty() {
            return after.is_empty() || after.starts_with(char::is_whitespace);
        }
        before.ends_with(char::is_whitespace) && !after.starts_with(|c: char| c.is_ascii_digit())
    };
    let comment = rest.match_indices('#').find(|&(at, _)| begins(at));
    comment.map_or(rest, |(at, _)| &rest[..at])
}

/// The part before a `#` anywhere. Names may contain one, numbers never do.
pub fn uncommented(rest: &str) -> &str {
    rest.split('#').next().unwrap_or_default()
}

/// A name: everything after the keyword, including spaces.
///
/// # Errors
/// If there is none, or it is too long.
pub(crate) fn name<'a>(keyword: &str, rest: &'a str) -> Result<&'a str> {
    ensure!(!rest.is_empty(), "{keyword} is not followed by a name");
    let bytes = rest.len();
    ensure!(
        bytes <= NAME_BYTES,
        "the name is too long: {bytes} bytes, at most {NAME_BYTES} are read"
    );
    Ok(rest)
}
