//! Something on a page or in the tree that is not as it should be: where, what, and what to do.

use std::fmt;

/// What mends everything that is generated.
pub const SYNC: &str = "run: cargo chapters sync";

/// One thing that is wrong, shown as `file:line: what; what to do`.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Fault {
    /// The file, from the project's root.
    pub file: String,
    /// The line, from 1.
    pub line: usize,
    /// What is wrong.
    pub what: String,
    /// What to do.
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

    /// A generated part that is no longer what the code says.
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
