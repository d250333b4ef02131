//! Formats to read: the source of their inputs, and their reader.

use std::path::Path;

use anyhow::Result;
use reference::random::Random;

use crate::fault::Fault;
use crate::grammar::Grammar;

/// A reader's message about an input that it refuses, or its summary of one that it accepts, in a few words.
#[derive(Clone, Debug, PartialEq)]
pub enum Answer {
    /// Taken.
    Taken(String),
    /// Refused, by this line.
    Refused(String),
}

impl Answer {
    /// The answer without numbers and without what it quotes: the same for inputs that differ only in these.
    pub fn gist(&self) -> String {
        let (mark, text) = match self {
            Self::Taken(text) => ('+', text),
            Self::Refused(line) => ('-', line),
        };
        let mut gist = String::from(mark);
        let mut quoted = None;
        for letter in text.chars() {
            match quoted {
                Some(mark) if letter == mark => quoted = None,
                Some(_) => {}
                None if matches!(letter, '"' | '`') => quoted = Some(letter),
                None if letter.is_ascii_digit() => {}
                None => gist.push(letter),
            }
        }
        gist
    }
}

/// A reader of inputs: a function of this process, or a program.
pub trait Reader {
    /// Shows it an input.
    ///
    /// # Errors
    /// With what the input brought about, if that is not allowed.
    fn ask(&mut self, input: &[u8]) -> Result<Answer, Fault>;
}

/// One kind of input.
#[derive(Clone, Copy)]
pub struct Format {
    /// Its name, in a word.
    pub name: &'static str,
    /// The file that an input is written to, below a folder of the test's own.
    pub file: &'static str,
    /// Bytes of an input, at most.
    pub most: usize,
    /// A new input.
    pub make: fn(&mut Random) -> Vec<u8>,
    /// The words in inputs of this kind, for mutations: those of its grammar.
    pub grammar: Option<fn() -> &'static Grammar>,
    /// Inputs that are right, or were wrong once.
    pub seeds: fn() -> Vec<Vec<u8>>,
    /// Puts checksums right that a mutation has broken.
    pub seal: Option<fn(&mut [u8])>,
}

/// A function that reads, and what it may take.
#[derive(Clone, Copy)]
pub struct Function {
    /// Writes the files that an input names.
    pub beside: fn(&Path),
    /// Reads the file; what it returns says what the input held. What it makes must be whole: it panics if not.
    pub read: fn(&Path) -> Result<String>,
    /// Bytes of memory, at most.
    pub memory: usize,
}
