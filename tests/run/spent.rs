//! The memory and the time that a run took.

use std::io::Read;
use std::os::unix::process::ExitStatusExt;
use std::process::{Command, ExitStatus, Output, Stdio};
use std::time::Duration;

/// The result of a run, and its costs.
pub struct Spent {
    /// Its standard error, and its exit status.
    pub output: Output,
    /// Its largest resident set, in bytes. A process begins with that of the one that started it, so that must
    /// be small.
    pub memory: u64,
    /// Time that processors worked for it. Other programs do not change that much.
    pub time: Duration,
}

/// Runs a command to its end.
pub fn spend(command: &mut Command) -> Spent {
    let command = command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped());
    // It is waited for below, by the call that also tells what it has used.
    #[allow(clippy::zombie_processes)]
    let mut child = command.spawn().expect("the program starts");
    let mut stderr = Vec::new();
    let errors = child.stderr.as_mut().expect("it is piped");
    errors.read_to_end(&mut stderr).expect("a pipe can be read");
    let mut status = 0;
    // SAFETY: all zeros is a value of this structure of numbers.
    let mut usage: libc::rusage = unsafe { std::mem::zeroed() };
    // SAFETY: the child is this process's own, and nobody else has waited for it.
    let waited = unsafe { libc::wait4(child.id() as i32, &mut status, 0, &mut usage) };
    assert_eq!(waited, child.id() as i32, "the child is waited for");
    let status = ExitStatus::from_raw(status);
    let time = |time: libc::timeval| {
        Duration::from_secs(time.tv_sec as u64) + Duration::from_micros(time.tv_usec as u64)
    };
    Spent {
        output: Output { status, stdout: Vec::new(), stderr },
        memory: (usage.ru_maxrss as u64) << 10,
        time: time(usage.ru_utime) + time(usage.ru_stime),
    }
}
