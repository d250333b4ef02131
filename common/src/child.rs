//! This program started again, to answer one question: what it does may crash, and its parent must not.

use std::fmt::{Display, Formatter};
use std::io::Write;
use std::process::{Command, ExitStatus, Stdio};

use anyhow::{Context, Result, bail};

/// The end of a child that has given neither an answer nor a reason.
#[derive(Debug)]
pub struct Crashed(pub ExitStatus);

impl Display for Crashed {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        write!(f, "the compiler crashed ({})", self.0)
    }
}

impl std::error::Error for Crashed {}

/// This program, to be asked with [`ask`].
///
/// # Errors
/// If it cannot tell where it lies.
pub fn command() -> Result<Command> {
    Ok(Command::new(std::env::current_exe().context("cannot tell where this program lies")?))
}

/// Writes a question to a child's standard input, and returns what it has said on standard output.
///
/// # Errors
/// If it does not start, refuses, with its own line, or crashes: [`Crashed`].
pub fn ask(command: &mut Command, question: &[u8]) -> Result<Vec<u8>> {
    let mut child = command
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .context("cannot start this program again")?;
    let mut stdin = child.stdin.take().context("a child without standard input")?;
    // A child that has failed reads no further; its own words say why.
    let _ = stdin.write_all(question);
    drop(stdin);
    let output = child.wait_with_output()?;
    if output.status.success() {
        return Ok(output.stdout);
    }
    let said = String::from_utf8_lossy(&output.stderr);
    match said.lines().find_map(|line| line.strip_prefix("error: ")) {
        Some(error) => bail!("{error}"),
        None => bail!(Crashed(output.status)),
    }
}
