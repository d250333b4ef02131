//! The end of a program: always in one line, with no half-written file, and without affecting other processes.
//!
//! - [`signals`]: Ctrl-C, a closed terminal, the signals of batch systems
//! - [`panic_hook`]: panics, crashes of the driver, lack of memory
//! - [`open_files`]: too few of them
//! - [`compile_process`]: the shader compiler in a process of its own, with bounds
//! - [`child`]: this program started again for a single task

pub mod child;
pub mod compile_process;
mod open_files;
mod panic_hook;
mod signals;

use std::process::ExitCode;

use crate::UsageError;
use crate::gpu::shader::are_others;
use crate::output;
use anyhow::Result;

pub use self::signals::{Interrupt, Stopped, watch};

/// Runs a program and returns its exit code; any failure is printed as one line, and a signal leaves no
/// half-written file. Shaders outside the project's own folder are compiled in a separate process.
///
/// Exit codes: 0 done, 1 failed, with the reason in one line, 2 wrong arguments, 3 stopped on request, with the
/// results saved.
pub fn finish(program: impl FnOnce() -> Result<()>) -> ExitCode {
    watch();
    exit_code(|| {
        if compile_process::is_asked() {
            return compile_process::answer();
        }
        if are_others() {
            compile_process::want();
        }
        program()
    })
}

/// As [`finish`], for a program that handles signals itself.
pub fn exit_code(program: impl FnOnce() -> Result<()>) -> ExitCode {
    panic_hook::for_panics();
    // The parent reports errors of its compiler process, because it can name the shader.
    if !compile_process::is_asked() {
        panic_hook::for_crashes();
    }
    let Err(error) = open_files::check().and_then(|()| program()) else { return ExitCode::SUCCESS };
    let line = output::line_of(&error);
    if error.is::<Stopped>() {
        panic_hook::say(line.trim_start_matches("error: "));
        return ExitCode::from(3);
    }
    panic_hook::say(&line);
    if error.is::<UsageError>() { ExitCode::from(2) } else { ExitCode::FAILURE }
}
