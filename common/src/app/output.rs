//! What a program says on standard output and standard error, whoever listens.

use std::io::{ErrorKind, Write, stderr, stdout};

use anyhow::{Context, Result};

/// Writes to standard output. A reader that has closed it, as `head` does, has read enough.
///
/// # Errors
/// If it cannot be written for another reason, a full disk for one.
pub fn print(text: &str) -> Result<()> {
    let mut stdout = stdout().lock();
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        result => result.context("cannot write to standard output"),
    }
}

/// Writes a line to standard error; if nobody listens there, the exit code has to say it.
pub fn complain(line: &str) {
    let _ = writeln!(stderr(), "{line}");
}

/// Writes what is wrong with an input that is used all the same to standard error, a line each.
pub fn warn(warnings: &[String]) {
    for warning in warnings {
        complain(&format!("warning: {warning}"));
    }
}
