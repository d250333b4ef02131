//! What keeps an exercise from being solved: in a line, with the run that showed it and the pictures that were
//! compared.

use std::fmt;

use common::app::Picture;

use crate::command::quoted;
use crate::expectation::Other;

/// What was seen instead of what an exercise expects.
#[derive(Default)]
pub struct Missed {
    /// In a line.
    pub what: String,
    /// The arguments of the run that showed it; `None` if it was no run of a program.
    pub arguments: Option<Vec<String>>,
    /// What it was compared with.
    pub compared: Option<(Other, Picture)>,
}

impl fmt::Display for Missed {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(&self.what)?;
        match &self.arguments {
            Some(arguments) => write!(f, " with {}", quoted(arguments)),
            None => Ok(()),
        }
    }
}

impl From<String> for Missed {
    fn from(what: String) -> Self {
        Self { what, ..Self::default() }
    }
}

impl Missed {
    /// The line for a reader, with where the pictures lie: the run's own, and what it was compared with.
    pub fn told(&self, own: &str, other: &str) -> String {
        match &self.compared {
            Some((with, _)) => format!("{self}: yours {own}, {with} {other}"),
            None if self.arguments.is_some() => format!("{self}: {own}"),
            None => self.to_string(),
        }
    }
}
