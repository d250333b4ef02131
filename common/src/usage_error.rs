//! The error for wrong arguments: the exit code is 2 instead of 1.

use std::fmt;

/// A wrong argument, in one line with the correct form.
#[derive(Debug)]
pub struct UsageError(pub String);

impl fmt::Display for UsageError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for UsageError {}
