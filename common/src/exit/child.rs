//! This program started again for a single task that may crash, while its parent must not.

use std::fmt::{Display, Formatter};
use std::io::Write;
use std::process::{Command, ExitStatus, Stdio};

use anyhow::{Context, Result, bail};

/// The end of a child that returned neither a result nor an error.
#[derive(Debug)]
pub struct Crashed {
    /// Its exit status.
    pub status: ExitStatus,
    /// Its standard error, including that of its libraries.
    pub said: String,
}

impl Display for Crashed {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        if is_late(self.status) {
            write!(f, "the compiler takes more than {SECONDS} s")
        } else {
            write!(f, "the compiler crashed ({})", self.status)
        }
    }
}

impl std::error::Error for Crashed {}

/// Time limit for a child, on the clock: far longer than it should need.
const SECONDS: u32 = 600;

/// The first step of a child: from now on it ends with its parent, and when its time is over.
pub fn bind() {
    // SAFETY: the call has no preconditions, and nothing else here sets the clock.
    #[cfg(unix)]
    unsafe {
        libc::alarm(SECONDS);
    }
    // SAFETY: it takes a signal's number.
    #[cfg(target_os = "linux")]
    unsafe {
        libc::prctl(libc::PR_SET_PDEATHSIG, libc::SIGKILL);
    }
}

/// Limits the memory that this process may ask for from now on. A limit that cannot be set is already lower.
pub fn bound_memory(bytes: u64) {
    #[cfg(unix)]
    {
        let limit = libc::rlimit { rlim_cur: bytes, rlim_max: bytes };
        // SAFETY: the limit is there for the length of the call.
        unsafe { libc::setrlimit(libc::RLIMIT_AS, &raw const limit) };
    }
    #[cfg(not(unix))]
    let _ = bytes;
}

#[cfg(unix)]
fn is_late(status: ExitStatus) -> bool {
    use std::os::unix::process::ExitStatusExt;
    status.signal() == Some(libc::SIGALRM)
}

#[cfg(not(unix))]
fn is_late(_: ExitStatus) -> bool {
    false
}

/// This program, to be started by [`ask`].
///
/// # Errors
/// If it cannot find its own path.
pub fn command() -> Result<Command> {
    Ok(Command::new(std::env::current_exe().context("cannot tell where this program lies")?))
}

/// Writes a child's standard input, and returns its standard output.
///
/// # Errors
/// If it does not start, if it fails, with its own line, or if it crashes: [`Crashed`].
pub fn ask(command: &mut Command, question: &[u8]) -> Result<Vec<u8>> {
    let mut child = command
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .context("cannot start this program again")?;
    let mut stdin = child.stdin.take().context("a child without standard input")?;
    // A child that has failed stops reading; its own error line gives the reason.
    let _ = stdin.write_all(question);
    drop(stdin);
    let output = child.wait_with_output()?;
    if output.status.success() {
        return Ok(output.stdout);
    }
    let said = String::from_utf8_lossy(&output.stderr);
    match said.lines().find_map(|line| line.strip_prefix("error: ")) {
        Some(error) => bail!("{error}"),
        None => bail!(Crashed { status: output.status, said: said.into_owned() }),
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn a_child_whose_time_is_over_is_told_of() {
        let mut late = Command::new("sh");
        let error = ask(late.args(["-c", "kill -ALRM $$"]), b"").unwrap_err();
        assert_eq!(error.to_string(), format!("the compiler takes more than {SECONDS} s"));
    }
}
