//! The text of a model's files, which are untrusted.
//!
//! Text is read within limits, line by line, so that every fault has a line number; files are opened only inside
//! the folder of the OBJ file.

use std::borrow::Cow;
use std::collections::BTreeSet;
use std::fmt::Display;
use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::{Component, Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use anyhow::{Result, anyhow, bail, ensure};

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
        let mut bytes = Vec::new();
        open(path, &shown, limit)?
            .take(limit)
            .read_to_end(&mut bytes)
            .map_err(|error| anyhow!("{shown}: cannot be read: {error}"))?;
        if let Some(zero) = bytes.iter().position(|&byte| byte == 0) {
            let line = 1 + bytes[..zero].iter().filter(|&&byte| byte == b'\n').count();
            bail!("{shown}:{line}: holds a zero byte: this is a binary file, not text");
        }
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
        ErrorKind::NotFound => anyhow!("{shown}: there is no such file"),
        _ => anyhow!("{shown}: cannot be read: {error}"),
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
        // A comment may end in a backslash, for example a Windows folder: it does not continue the line.
        let continued = |line: &[u8]| line.ends_with(b"\\") && !line.contains(&b'#');
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
            Cow::Borrowed(line) => String::from_utf8_lossy(line),
            Cow::Owned(lines) => String::from_utf8_lossy(&lines).into_owned().into(),
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

    /// The keyword and the rest, without white space around it.
    ///
    /// # Errors
    /// If the statement is too long.
    pub fn split(&self) -> Result<(&str, &str)> {
        let length = self.text.len();
        ensure!(
            length <= STATEMENT_BYTES,
            "the line is too long: {length} bytes, at most {STATEMENT_BYTES} are read"
        );
        let text = self.text.trim_end_matches('\\');
        let (keyword, rest) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
        Ok((keyword, rest.trim()))
    }

    /// The error with the place in front, and a hint if the file ends within this line.
    pub fn at(&self, error: impl Display) -> anyhow::Error {
        let hint = if self.cut { "; the file ends in this line, perhaps cut off" } else { "" };
        anyhow!("{}: {error}{hint}", self.place())
    }
}

/// The part before a comment. Names may contain a `#` ("Material #25"), numbers never do.
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

/// A word of the file on one line, shortened and escaped.
pub fn quoted(word: &str) -> String {
    let mut start: String = word.chars().take(60).collect();
    if start.len() < word.len() {
        start.push('…');
    }
    format!("{start:?}")
}

/// The folder of the OBJ file. Nothing outside it is opened: a model from elsewhere must not access the user's
/// other files.
pub struct Folder {
    given: PathBuf,
    root: PathBuf,
}

/// The reason why a named file is unavailable.
#[derive(Debug)]
pub(crate) enum Unavailable {
    /// It does not exist, or cannot be read: a model may do without it.
    Missing(String),
    /// It is outside the model's folder, and is not opened.
    Outside(String),
}

impl Display for Unavailable {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (Self::Missing(why) | Self::Outside(why)) = self;
        f.write_str(why)
    }
}

impl std::error::Error for Unavailable {}

/// A file named by a model.
pub struct Named {
    /// Its path, links resolved.
    pub path: PathBuf,
    /// Its path relative to the OBJ file's folder, with `/` between the parts.
    pub name: String,
    /// Its path in error messages.
    pub shown: String,
}

impl Folder {
    /// The folder of a file.
    ///
    /// # Errors
    /// If there is no such folder.
    pub fn of(file: &Path) -> Result<Self> {
        let given = file.parent().unwrap_or(Path::new(""));
        let here = if given.as_os_str().is_empty() { Path::new(".") } else { given };
        let root = here.canonicalize().map_err(|error| match error.kind() {
            ErrorKind::NotFound => anyhow!("{}: there is no such file", shown(file)),
            _ => anyhow!("{}: cannot be read: {error}", shown(file)),
        })?;
        Ok(Self { given: given.to_owned(), root })
    }

    /// Finds the file named by `keyword`; relative paths start at the file `from`, or else at the OBJ file.
    ///
    /// # Errors
    /// `Unavailable` if it does not exist, no name is given, or it is outside the folder, directly or through a
    /// symbolic link; another if the name is too long.
    pub fn find(&self, keyword: &str, named: &str, from: Option<&Named>) -> Result<Named> {
        let missing = |what: String| anyhow!(Unavailable::Missing(format!("{keyword} {what}")));
        ensure!(!named.is_empty(), missing("is not followed by a name".to_owned()));
        let name = name(keyword, named)?;
        let outside = || {
            let name = quoted(name);
            anyhow!(Unavailable::Outside(format!(
                "{keyword} names {name}, outside the OBJ file's folder; copy it into the folder"
            )))
        };
        // Exporters on Windows write backslashes, and drive letters, which are relative paths elsewhere.
        let relative = name.replace('\\', "/");
        let drive = relative.as_bytes().get(1) == Some(&b':');
        let parts = Path::new(&relative).components();
        let inside =
            parts.clone().all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
        ensure!(inside && !drive, outside());
        let mut path = from.and_then(|from| from.path.parent()).unwrap_or(&self.root).to_owned();
        path.extend(parts.filter(|part| *part != Component::CurDir));
        let path = path.canonicalize().map_err(|error| match error.kind() {
            ErrorKind::NotFound => missing(format!("names {}, which is not there", quoted(name))),
            _ => missing(format!("names {}, which cannot be read: {error}", quoted(name))),
        })?;
        let inside = path.strip_prefix(&self.root).map_err(|_| outside())?;
        ensure!(path.is_file(), missing(format!("names {}, which is no file", quoted(name))));
        let parts: Vec<_> = inside.iter().map(|part| part.to_string_lossy()).collect();
        let (name, shown) = (parts.join("/"), shown(&self.given.join(inside)));
        Ok(Named { name, shown, path })
    }
}

/// A path on one line.
pub fn shown(path: &Path) -> String {
    path.display().to_string().replace(char::is_control, "\u{fffd}")
}
