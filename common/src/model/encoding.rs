//! The encoding of text files: UTF-8, and in names also the bytes of older encodings, unchanged.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use anyhow::{Result, anyhow, bail, ensure};

/// The first of 256 characters for bytes that are not UTF-8: the last ones for private use, which no text needs.
const FOREIGN: u32 = 0x10_ff00;

/// The byte order mark that begins UTF-8 files from Windows.
const MARK: &str = "\u{feff}";

/// The text of these bytes. Each byte that is not UTF-8 becomes a character of its own, so that names are equal
/// only if their bytes are; [`quoted`] shows it as `\xE9`.
pub(super) fn letters(bytes: &[u8]) -> Cow<'_, str> {
    if let Ok(text) = str::from_utf8(bytes)
        && (bytes.is_ascii() || !text.contains(is_foreign))
    {
        return text.into();
    }
    let foreign = |byte: &u8| char::from_u32(FOREIGN + u32::from(*byte)).unwrap_or_default();
    let mut text = String::new();
    for chunk in bytes.utf8_chunks() {
        for c in chunk.valid().chars() {
            if is_foreign(c) {
                text.extend(c.encode_utf8(&mut [0; 4]).as_bytes().iter().map(foreign));
            } else {
                text.push(c);
            }
        }
        text.extend(chunk.invalid().iter().map(foreign));
    }
    text.into()
}

/// True for a character that represents a byte.
pub(super) fn is_foreign(c: char) -> bool {
    u32::from(c) >= FOREIGN
}

/// The path whose bytes [`letters`] has turned into this text.
#[cfg(unix)]
pub(super) fn path(text: &str) -> PathBuf {
    use std::os::unix::ffi::OsStringExt;
    let mut bytes = Vec::with_capacity(text.len());
    for c in text.chars() {
        match c {
            c if is_foreign(c) => bytes.push((u32::from(c) - FOREIGN) as u8),
            c => bytes.extend(c.encode_utf8(&mut [0; 4]).as_bytes()),
        }
    }
    std::ffi::OsString::from_vec(bytes).into()
}

/// As on Unix, except that no path of the system has such a byte.
#[cfg(not(unix))]
pub(super) fn path(text: &str) -> PathBuf {
    text.into()
}

/// A path as text, the reverse of [`path`].
#[cfg(unix)]
pub(super) fn path_letters(path: &Path) -> Cow<'_, str> {
    letters(std::os::unix::ffi::OsStrExt::as_bytes(path.as_os_str()))
}

/// A path as text, the reverse of [`path`].
#[cfg(not(unix))]
pub(super) fn path_letters(path: &Path) -> Cow<'_, str> {
    path.to_string_lossy()
}

/// Checks that bytes are text of an encoding that has that of ASCII in it.
///
/// # Errors
/// If they are UTF-16 or binary, with the line.
pub(super) fn check(bytes: &[u8], shown: &str) -> Result<()> {
    let starts = |mark: &[u8]| bytes.starts_with(mark);
    // Without a mark, ASCII in UTF-16 has a zero in every other byte.
    let head = bytes.get(..16).unwrap_or(&bytes[..bytes.len() & !1]);
    let alternates =
        |zero: usize| head.iter().enumerate().all(|(at, &byte)| (byte == 0) == (at % 2 == zero));
    let wide = if starts(b"\xff\xfe\0\0") || starts(b"\0\0\xfe\xff") {
        Some("UTF-32")
    } else if starts(b"\xff\xfe")
        || starts(b"\xfe\xff")
        || !head.is_empty() && (alternates(0) || alternates(1))
    {
        Some("UTF-16")
    } else {
        None
    };
    if let Some(wide) = wide {
        bail!("{shown}:1: this is {wide} text; save it as UTF-8");
    }
    let zero = bytes.iter().position(|&byte| byte == 0);
    ensure!(
        zero.is_none(),
        "{shown}:{}: holds a zero byte: this is a binary file, not text",
        line(bytes, zero.unwrap_or_default())
    );
    Ok(())
}

/// The text of a file that is all UTF-8, without the mark at its beginning.
///
/// # Errors
/// If it is not UTF-8, with the line.
pub fn utf8(bytes: Vec<u8>, shown: &str) -> Result<String> {
    check(&bytes, shown)?;
    let text = String::from_utf8(bytes).map_err(|error| {
        let (bytes, at) = (error.as_bytes(), error.utf8_error().valid_up_to());
        anyhow!(
            "{shown}:{}: the byte 0x{:02X} is not UTF-8, but perhaps Latin-1; save the file as UTF-8",
            line(bytes, at),
            bytes[at]
        )
    })?;
    Ok(text.strip_prefix(MARK).map(str::to_owned).unwrap_or(text))
}

/// The line of a byte.
fn line(bytes: &[u8], at: usize) -> usize {
    1 + bytes[..at].iter().filter(|&&byte| byte == b'\n').count()
}

/// A word of a file on one line, shortened and escaped.
pub fn quoted(word: &str) -> String {
    let mut start: String = word.chars().take(60).collect();
    if start.len() < word.len() {
        start.push('…');
    }
    let plain = |text: &str| {
        let quoted = format!("{text:?}");
        quoted[1..quoted.len() - 1].to_owned()
    };
    format!("\"{}\"", escaped(&start, plain))
}

/// A path on one line.
pub fn shown(path: &Path) -> String {
    escaped(&path_letters(path), |text| text.replace(char::is_control, "\u{fffd}"))
}

/// Text with its foreign bytes as `\xE9`, and the rest as `plain` turns it.
fn escaped(text: &str, plain: impl Fn(&str) -> String) -> String {
    let part = |part: &str| match part.chars().next_back().filter(|&c| is_foreign(c)) {
        Some(c) => {
            let text = &part[..part.len() - c.len_utf8()];
            format!("{}\\x{:02X}", plain(text), u32::from(c) - FOREIGN)
        }
        None => plain(part),
    };
    text.split_inclusive(is_foreign).map(part).collect()
}

#[cfg(test)]
mod tests;
