//! Input formats: their generators and their readers.

use std::path::Path;

use anyhow::Result;
use reference::random::Random;

use crate::fault::Fault;
use crate::grammar::Grammar;

/// A reader's message about a refused input, or its short summary of an accepted one.
#[derive(Clone, Debug, PartialEq)]
pub enum Answer {
    /// The input was accepted.
    Taken(String),
    /// The input was refused with this message.
    Refused(String),
}

impl Answer {
    /// The answer without numbers and quotations, so that it is equal for inputs that differ only in these.
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

/// A reader of inputs: a function in this process, or a program.
pub trait Reader {
    /// Reads an input.
    ///
    /// # Errors
    /// The fault the input caused.
    fn ask(&mut self, input: &[u8]) -> Result<Answer, Fault>;
}

/// One kind of input.
#[derive(Clone, Copy)]
pub struct Format {
    /// Its name, in a word.
    pub name: &'static str,
    /// The name of the file for an input, in a folder of the test's own.
    pub file: &'static str,
    /// The largest number of bytes of an input.
    pub most: usize,
    /// Generates a new input.
    pub make: fn(&mut Random) -> Vec<u8>,
    /// The grammar whose words mutations insert, if there is one.
    pub grammar: Option<fn() -> &'static Grammar>,
    /// Valid inputs, and inputs that once caused a fault.
    pub seeds: fn() -> Vec<Vec<u8>>,
    /// Repairs the checksums that a mutation has broken.
    pub seal: Option<fn(&mut [u8])>,
}

/// A function that reads, and its limits.
#[derive(Clone, Copy)]
pub struct Function {
    /// Writes the files that an input refers to.
    pub beside: fn(&Path),
    /// Reads the file, and summarises its contents. Panics if the result is inconsistent.
    pub read: fn(&Path) -> Result<String>,
    /// The largest number of bytes of memory.
    pub memory: usize,
}
