//! A scene file's text, for messages that name a line of it.

use std::io::Read;
use std::path::Path;

use anyhow::{Result, anyhow};
use common::model::text::{open, shown, utf8};
use serde::Deserialize;
use toml::Spanned;
use toml::de::{DeTable, Deserializer};

use super::nesting::MOST;
use super::tally::Tally;
use super::words;

/// Bytes of a scene file.
const FILE_BYTES: u64 = 16 << 20;

/// The text and its name.
pub(super) struct Source {
    shown: String,
    text: String,
}

impl Source {
    /// Reads a scene file.
    ///
    /// # Errors
    /// If it is missing, too large or not text.
    pub fn open(path: &Path) -> Result<Self> {
        let shown = shown(path);
        let mut bytes = Vec::new();
        open(path, &shown, FILE_BYTES)?
            .take(FILE_BYTES)
            .read_to_end(&mut bytes)
            .map_err(|error| anyhow!("{shown}: cannot be read: {error}"))?;
        let text = utf8(bytes, &shown)?;
        Ok(Self { shown, text })
    }

    /// The line that begins with a key.
    pub fn line_of(&self, key: &str) -> Option<usize> {
        let mut at = 0;
        self.text.split_inclusive('\n').find_map(|line| {
            let start = at;
            at += line.len();
            line.trim_start().starts_with(key).then_some(start)
        })
    }

    /// An error at a byte of the text.
    pub fn error(&self, at: usize, what: &str) -> anyhow::Error {
        let before = &self.text.as_bytes()[..at.min(self.text.len())];
        let line = 1 + before.iter().filter(|&&byte| byte == b'\n').count();
        anyhow!("{}:{line}: {}", self.shown, what.trim().replace('\n', "; "))
    }

    /// The text as a table, unless that would take too much memory or goes too deep.
    pub fn table(&self) -> Result<Spanned<DeTable<'_>>> {
        let tally = Tally::of(&self.text)
            .and_then(|tally| tally.check().map(|()| tally))
            .map_err(|error| anyhow!("{}: {error}", self.shown))?;
        if let Some(at) = tally.too_deep {
            let what = format!("this stands in more than {MOST} tables and lists");
            return Err(self.error(at, &what));
        }
        DeTable::parse(&self.text).map_err(|error| {
            let at = error.span().map_or(0, |span| span.start).min(self.text.len());
            let (before, after) = self.text.as_bytes().split_at(at);
            let start = before.rsplit(|&byte| byte == b'\n').next().map_or(0, <[u8]>::len);
            let end = after.iter().position(|&byte| byte == b'\n').unwrap_or(after.len());
            let line = self.text.get(at - start..at + end).unwrap_or_default();
            self.error(at, &words::syntax(line, error.message()))
        })
    }

    /// Reads a table.
    pub fn read<'a, T: Deserialize<'a>>(&self, table: Spanned<DeTable<'a>>) -> Result<T> {
        T::deserialize(Deserializer::from(table)).map_err(|error| {
            let at = error.span().map_or(0, |span| span.start);
            self.error(at, &words::value(error.message()))
        })
    }

    /// Refuses a list that is too long, at its first entry too many.
    pub fn check<T>(&self, list: &[Spanned<T>], most: usize, what: &str) -> Result<()> {
        match list.get(most) {
            Some(entry) => Err(self.error(entry.span().start, &format!("more than {most} {what}"))),
            None => Ok(()),
        }
    }
}
