//! Counts of a scene file's contents before it is read, and the memory that reading takes.

use anyhow::{Result, ensure};
use toml::Spanned;
use toml::de::{DeString, DeValue};
use toml_parser::Source;
use toml_parser::lexer::Token;
use toml_parser::parser::{Event, EventKind, RecursionGuard, parse_document};

use super::nesting::Nesting;

/// Bytes that reading may take. A hundred thousand spheres take half of it.
const MOST: u64 = 800_000_000;

/// Depth of the parser's recursion: as deep as `toml` reads.
const DEPTH: u32 = 80;

/// Counts of everything that takes memory.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Tally {
    text: usize,
    /// Words, signs and spaces.
    tokens: usize,
    /// Events of the parser.
    events: usize,
    /// Under a headline, in braces, or by a dot in a key.
    tables: usize,
    keys: usize,
    lists: usize,
    /// Commas: values of a list, or keys in braces.
    values: usize,
    /// The byte at which the number of tables and lists exceeds the limit.
    pub too_deep: Option<usize>,
}

impl Tally {
    /// Counts what a text has. It need not be right.
    ///
    /// # Errors
    /// If its words alone are too many.
    pub fn of(text: &str) -> Result<Self> {
        let tokens = Source::new(text).lex().count();
        let mut tally = Self { text: text.len(), tokens, ..Self::default() };
        tally.check()?;
        let tokens = Source::new(text).lex().into_vec();
        let mut nesting = Nesting::default();
        let mut add = |event: Event| {
            tally.add(event.kind());
            nesting.add(&event);
        };
        parse_document(&tokens, &mut RecursionGuard::new(&mut add, DEPTH), &mut ());
        tally.too_deep = nesting.too_deep;
        Ok(tally)
    }

    fn add(&mut self, event: EventKind) {
        use EventKind as Kind;
        self.events += 1;
        match event {
            Kind::StdTableOpen | Kind::ArrayTableOpen | Kind::InlineTableOpen | Kind::KeySep => {
                self.tables += 1
            }
            Kind::SimpleKey => self.keys += 1,
            Kind::ArrayOpen => self.lists += 1,
            Kind::ValueSep => self.values += 1,
            _ => {}
        }
    }

    /// The most memory that reading takes, in bytes.
    ///
    /// `toml` makes a list of the tokens and one of the events, then a tree. A table is a `BTreeMap`, whose
    /// nodes have room for 11 entries: one node for each table, and for many keys nodes of which 5 of 11 are
    /// full, and those above them. A list is a `Vec`, with room for 4 at least, or for twice as many as it has.
    /// Text is there once more where something in it is escaped.
    pub fn bytes(&self) -> u64 {
        let &Self { text, tokens, events, tables, keys, lists, values, .. } = self;
        let value = size_of::<Spanned<DeValue>>();
        let entry = size_of::<Spanned<DeString>>() + value;
        let (token, event) = (size_of::<Token>(), size_of::<Event>());
        // Wrong text can give more events than tokens, for which there was room: then they are copied once.
        let copies = if events > tokens { 2 } else { 1 };
        let table = 11 * entry + 2 * value + 16;
        let bytes = 2 * text
            + token * tokens
            + copies * event * events
            + table * tables
            + 3 * entry * keys
            + 4 * value * lists
            + 2 * value * values;
        bytes as u64
    }

    /// Fails if that is too much.
    ///
    /// # Errors
    /// With what it is, and of what.
    pub fn check(&self) -> Result<()> {
        // Upwards, so that what is too much is more than what is allowed.
        let gigabytes = |bytes: u64| (bytes as f64 / 1e8).ceil() / 10.0;
        let Self { tokens, tables, keys, lists, .. } = self;
        ensure!(
            self.bytes() <= MOST,
            "would take up to {:.1} GB of memory with its {tokens} words and signs, {tables} tables, {keys} \
             keys and {lists} lists; at most {:.1} GB are taken",
            gigabytes(self.bytes()),
            gigabytes(MOST)
        );
        Ok(())
    }
}

#[cfg(test)]
mod tests;
