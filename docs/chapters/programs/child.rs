//! Runs a child process until it ends or exceeds its limit.

use std::fs::File;
use std::io::{Read, Seek};
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use anyhow::{Context, Result};
use common::output::complain;
use time_limit::{GLANCE, Limit, Work};

use super::interrupt;

/// The time after which a wait prints a message.
const SILENCE: Duration = Duration::from_secs(1);
/// The time between two messages: a build takes minutes, and silence looks like a fault.
const AGAIN: Duration = Duration::from_secs(60);

/// The start of the reason if a program exceeded its limit.
pub const STOPPED: &str = "stopped after";

/// The end of a program.
pub struct Ended {
    /// `None` if it was stopped.
    pub status: Option<ExitStatus>,
    /// Its standard error.
    pub said: String,
    /// Its standard output.
    pub told: String,
    limit: Limit,
}

impl Ended {
    /// Returns whether it ended without an error.
    pub fn succeeded(&self) -> bool {
        self.status.is_some_and(|status| status.success())
    }

    /// Its standard error, in one line.
    pub fn said_in_a_line(&self) -> String {
        self.said.trim().replace('\n', " ")
    }

    /// The error in its arguments, in one line, if it exited with code 2.
    pub fn refused(&self) -> Option<String> {
        let code = self.status.and_then(|status| status.code());
        self.failed().filter(|_| code == Some(2))
    }

    /// The reason why it failed, in one line; `None` if it did not.
    pub fn failed(&self) -> Option<String> {
        let Some(status) = self.status else {
            return Some(format!("{STOPPED} {} without an end", self.limit));
        };
        if status.success() {
            return None;
        }
        if let Some(name) = crash(status) {
            return Some(format!("crashed ({name})"));
        }
        let line = self.said.lines().find_map(|line| line.strip_prefix("error: "));
        let line = line.or_else(|| self.said.lines().find(|line| !line.trim().is_empty()));
        Some(line.map_or_else(|| status.to_string(), |line| line.trim().to_owned()))
    }
}

/// Cargo, in a folder: the one that runs this program, if there is one.
pub fn cargo(folder: &Path) -> Command {
    let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.current_dir(folder);
    cargo
}

/// Starts a command.
///
/// # Errors
/// If it does not start; the message names the program.
pub fn start(command: &mut Command) -> Result<Child> {
    command.spawn().with_context(|| {
        let program = Path::new(command.get_program()).file_name().unwrap_or_default();
        format!("{} does not start", program.display())
    })
}

/// Runs a command, and kills it if it exceeds its limit.
///
/// # Errors
/// If it does not start, or a signal requests termination.
pub fn run(command: &mut Command, limit: Limit) -> Result<Ended> {
    run_saying(command, limit, "")
}

/// As [`run`]; if it takes long, and then each minute, a line on standard error says what is waited for,
/// unless `what` is empty.
///
/// # Errors
/// As [`run`].
pub fn run_saying(command: &mut Command, limit: Limit, what: &str) -> Result<Ended> {
    // Files rather than pipes: nobody has to read them while the program runs.
    let file = || tempfile::tempfile().context("cannot make a temporary file");
    let (mut output, mut errors) = (file()?, file()?);
    command.stdin(Stdio::null()).stdout(output.try_clone()?).stderr(errors.try_clone()?);
    let status = wait_saying(&mut start(command)?, limit, what)?;
    let (told, said) = (read(&mut output)?, read(&mut errors)?);
    Ok(Ended { status, said, told, limit })
}

/// Runs a command that prints as it goes, without a limit.
///
/// # Errors
/// As [`run`].
pub fn show(command: &mut Command) -> Result<ExitStatus> {
    wait(&mut start(command)?, Limit::NONE)?.context("it was stopped")
}

/// Waits for its end; the status is `None` if it exceeded its limit and was killed.
///
/// # Errors
/// If a signal requests termination, in which case the child is killed, or the system call fails.
pub fn wait(child: &mut Child, limit: Limit) -> Result<Option<ExitStatus>> {
    wait_saying(child, limit, "")
}

fn wait_saying(child: &mut Child, limit: Limit, what: &str) -> Result<Option<ExitStatus>> {
    let (start, work) = (Instant::now(), Work::from(&*child));
    let mut next = SILENCE;
    loop {
        if let Some(status) = child.try_wait()? {
            return Ok(Some(status));
        }
        let asked = interrupt::asked();
        if limit.is_over(work, start) || asked.is_err() {
            child.kill()?;
            child.wait()?;
            return asked.map(|()| None);
        }
        if !what.is_empty() && start.elapsed() >= next {
            complain(&match next.as_secs() / AGAIN.as_secs() {
                0 => format!("waiting: {what}"),
                minutes => format!("waiting: {what}; {minutes} min so far"),
            });
            next += AGAIN;
        }
        thread::sleep(GLANCE);
    }
}

fn read(file: &mut File) -> Result<String> {
    let mut bytes = Vec::new();
    file.rewind()?;
    file.read_to_end(&mut bytes)?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// The system's name of a crash, if the status is one.
#[cfg(unix)]
fn crash(status: ExitStatus) -> Option<String> {
    use std::os::unix::process::ExitStatusExt;
    let signal = status.signal()?;
    let names = [
        (4, "SIGILL"),
        (6, "SIGABRT"),
        (7, "SIGBUS"),
        (8, "SIGFPE"),
        (9, "SIGKILL"),
        (11, "SIGSEGV"),
    ];
    let known = names.into_iter().find(|(number, _)| *number == signal);
    Some(known.map_or_else(|| format!("signal {signal}"), |(_, name)| name.to_owned()))
}

/// The system's name of a crash, if the status is one.
#[cfg(not(unix))]
fn crash(status: ExitStatus) -> Option<String> {
    let code = status.code()? as u32;
    (code >= 0xC000_0000).then(|| format!("{code:#010x}"))
}
