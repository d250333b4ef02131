//! A scene file's text, for messages that name a line of it.

use std::io::Read;
use std::path::Path;

use anyhow::{Result, anyhow};
use common::model::text::{open, shown};
use serde::Deserialize;
use toml::Spanned;
use toml::de::{DeTable, Deserializer};

use super::nesting::MOST;
use super::tally::Tally;

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
        let text = String::from_utf8(bytes).map_err(|error| {
            let good = &error.as_bytes()[..error.utf8_error().valid_up_to()];
            let line = 1 + good.iter().filter(|&&byte| byte == b'\n').count();
            anyhow!("{shown}:{line}: this is no UTF-8 text; a scene file is TOML")
        })?;
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
        DeTable::parse(&self.text).map_err(|error| self.wrong(&error))
    }

    /// Reads a table.
    pub fn read<'a, T: Deserialize<'a>>(&self, table: Spanned<DeTable<'a>>) -> Result<T> {
        T::deserialize(Deserializer::from(table)).map_err(|error| self.wrong(&error))
    }

    fn wrong(&self, error: &toml::de::Error) -> anyhow::Error {
        let what = error.message();
        let what = what.replace("expected a boolean", "expected true or false");
        let what = what.replace("expected a sequence", "expected tables, each under [[its name]]");
        self.error(error.span().map_or(0, |span| span.start), &what)
    }

    /// Refuses a list that is too long, at its first entry too many.
    pub fn check<T>(&self, list: &[Spanned<T>], most: usize, what: &str) -> Result<()> {
        match list.get(most) {
            Some(entry) => Err(self.error(entry.span().start, &format!("more than {most} {what}"))),
            None => Ok(()),
        }
    }
}
