//! Faults that no input may cause, and the file that reproduces one.

use std::fmt::{Display, Formatter};
use std::fs;
use std::path::PathBuf;
use std::time::Duration;

use time_limit::Limit;

/// A fault that no input may cause.
#[derive(Clone, Debug, PartialEq)]
pub enum Fault {
    /// A panic, with its message.
    Panic(String),
    /// No answer within this limit.
    Endless(Limit),
    /// An answer that took this much processor time.
    Slow(Duration),
    /// More than this many bytes of memory.
    Memory(u64),
    /// An invalid message: several lines, empty, or without the name of the file.
    Line(String),
    /// An exit code other than 0, 1 and 2.
    Exit(String),
    /// Files that were left behind or removed.
    Left(Vec<String>),
}

impl Fault {
    /// The kind, in a word.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Panic(_) => "panic",
            Self::Endless(_) => "endless",
            Self::Slow(_) => "slow",
            Self::Memory(_) => "memory",
            Self::Line(_) => "line",
            Self::Exit(_) => "exit",
            Self::Left(_) => "left",
        }
    }
}

impl Display for Fault {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Panic(message) => write!(f, "it panics: {message}"),
            Self::Endless(time) => write!(f, "there is no answer within {time}"),
            Self::Slow(time) => write!(f, "the answer takes {time:?} of a processor"),
            Self::Memory(bytes) => write!(f, "it takes more than {bytes} bytes of memory"),
            Self::Line(line) => write!(f, "this is not one line that says where: {line:?}"),
            Self::Exit(how) => write!(f, "it ends with {how}"),
            Self::Left(files) => write!(f, "files are left behind, or gone: {}", files.join(", ")),
        }
    }
}

/// A fault, and the input that caused it.
#[derive(Clone, Debug)]
pub struct Found {
    /// The reader of the inputs.
    pub reader: &'static str,
    /// Seed of the random numbers.
    pub seed: u64,
    /// The number of inputs tried before.
    pub number: usize,
    /// The bytes.
    pub input: Vec<u8>,
    /// The fault that they caused.
    pub fault: Fault,
}

impl Found {
    /// Writes the input below `target/fuzz` and prints how to try it again.
    pub fn keep(&self) -> String {
        let Self { reader, seed, number, input, fault } = self;
        let file = PathBuf::from(format!("target/fuzz/{reader}-{}-{seed}-{number}", fault.kind()));
        let full = run::root().join(&file);
        let written = full.parent().map_or(Ok(()), fs::create_dir_all);
        let written = written.and_then(|()| fs::write(&full, input));
        let again = match written {
            Ok(()) => format!(
                "again: FUZZ_READER={reader} FUZZ_INPUT={} cargo test --test fuzz one_input -- --ignored",
                file.display()
            ),
            Err(error) => format!("the input cannot be kept: {error}"),
        };
        let bytes = input.len();
        format!("{reader}: {fault}\nseed {seed}, input {number}, {bytes} bytes\n{again}")
    }
}
