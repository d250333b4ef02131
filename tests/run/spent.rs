//! The memory and the time of a run.

use std::io::Read;
use std::os::unix::process::ExitStatusExt;
use std::process::{Command, ExitStatus, Output, Stdio};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::Duration;
use std::{fs, thread};

/// The result of a run, and its costs.
pub struct Spent {
    /// Its standard error, and its exit status.
    pub output: Output,
    /// Its largest resident set, in bytes.
    pub memory: u64,
    /// Its processor time, which other programs hardly affect.
    pub time: Duration,
}

/// Runs a command to its end.
pub fn spend(command: &mut Command) -> Spent {
    let command = command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped());
    // Reaped below, by the call that also returns its resource usage.
    #[allow(clippy::zombie_processes)]
    let mut child = command.spawn().expect("the program starts");
    let mut stderr = Vec::new();
    let (ended, end) = mpsc::channel();
    let id = child.id();
    let memory = thread::spawn(move || largest(id, &end));
    let errors = child.stderr.as_mut().expect("it is piped");
    errors.read_to_end(&mut stderr).expect("a pipe can be read");
    drop(ended);
    let memory = memory.join().expect("no panic");
    let mut status = 0;
    // SAFETY: all zeros is a value of this structure of numbers.
    let mut usage: libc::rusage = unsafe { std::mem::zeroed() };
    // SAFETY: the child belongs to this process, and no other code has waited for it.
    let waited = unsafe { libc::wait4(child.id() as i32, &mut status, 0, &mut usage) };
    assert_eq!(waited, child.id() as i32, "the child is waited for");
    let status = ExitStatus::from_raw(status);
    let time = |time: libc::timeval| {
        Duration::from_secs(time.tv_sec as u64) + Duration::from_micros(time.tv_usec as u64)
    };
    Spent {
        output: Output { status, stdout: Vec::new(), stderr },
        memory,
        time: time(usage.ru_utime) + time(usage.ru_stime),
    }
}

/// The largest resident set of a process, in bytes, polled every millisecond until the other end is dropped.
/// `wait4` also reports one, but that begins with the largest of the parent process.
fn largest(process: u32, end: &mpsc::Receiver<()>) -> u64 {
    let mut most = 0;
    loop {
        // The kernel's own maximum, so that nothing between two polls is lost.
        let status = fs::read_to_string(format!("/proc/{process}/status")).unwrap_or_default();
        let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        let kilobytes = line.and_then(|line| line.trim().trim_end_matches(" kB").parse().ok());
        most = most.max(kilobytes.unwrap_or(0u64));
        if end.recv_timeout(Duration::from_millis(1)) == Err(RecvTimeoutError::Disconnected) {
            return most << 10;
        }
    }
}
