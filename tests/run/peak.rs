//! The memory that a run took.

use std::io::Read;
use std::os::unix::process::ExitStatusExt;
use std::process::{Command, ExitStatus, Output, Stdio};

/// What a command gave, and the most memory that it took: its resident set, in bytes.
///
/// A process begins with that of the one that started it, so that must be small.
pub fn peak(command: &mut Command) -> (Output, u64) {
    let command = command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped());
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
    (Output { status, stdout: Vec::new(), stderr }, (usage.ru_maxrss as u64) << 10)
}
