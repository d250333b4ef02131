//! Something wrong on a page or in the tree: the place, the fault, and the remedy.

use std::fmt;

/// The remedy for generated parts.
pub const SYNC: &str = "run: cargo chapters sync";

/// One thing that is wrong, shown as `file:line: what; what to do`.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Fault {
    /// The file, from the project's root.
    pub file: String,
    /// The line, from 1.
    pub line: usize,
    /// A description of the fault.
    pub what: String,
    /// The remedy.
    pub remedy: String,
}

impl Fault {
    /// A fault in a line.
    pub fn new(
        file: impl Into<String>,
        line: usize,
        what: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Self {
        Self { file: file.into(), line, what: what.into(), remedy: remedy.into() }
    }

    /// A fault in a generated part that no longer matches the code.
    pub fn stale(file: impl Into<String>, line: usize, what: impl Into<String>) -> Self {
        Self::new(file, line, what, SYNC)
    }

    /// The fault as an error.
    pub fn error(self) -> anyhow::Error {
        anyhow::Error::msg(self.to_string())
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { file, line, what, remedy } = self;
        write!(f, "{file}:{line}: {what}; {remedy}")
    }
}
