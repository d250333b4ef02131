//! Compiles shaders in a separate process: the compiler may abort on an edit, which must not close a window. Nor
//! may a short text from an untrusted source use all memory, or run for ever: macros and structures can double
//! line by line.

use anyhow::{Context, Result, anyhow};
use serde::{Deserialize, Serialize};

use super::child::{self, Crashed};
use crate::gpu::shader;
use crate::output;

/// The child's argument.
const ASKED: &str = "--answer-compile";
/// The child's limit of processor time, in seconds.
const SECONDS: u64 = 30;
/// The limit of the child's address space, in bytes.
#[cfg(unix)]
const BYTES: u64 = 4 << 30;

/// The child's input: the shader to compile.
#[derive(Serialize, Deserialize)]
struct Question {
    path: String,
    text: String,
    defines: Vec<(String, String)>,
}

/// From now on, this process does not compile shaders itself.
pub fn want() {
    shader::compile_by(compile);
}

/// True if this process is such a child.
pub fn is_asked() -> bool {
    std::env::args_os().nth(1).is_some_and(|argument| argument == ASKED)
}

/// Compiles a shader's whole text, as [`shader::to_spirv`].
///
/// # Errors
/// If the text does not compile, or the compiler crashes or does not finish.
fn compile(path: &str, text: &str, defines: &[(&str, String)]) -> Result<Vec<u32>> {
    let defines = defines.iter().map(|(name, value)| ((*name).to_owned(), value.clone()));
    let question =
        Question { path: path.to_owned(), text: text.to_owned(), defines: defines.collect() };
    let question = serde_json::to_vec(&question)?;
    let words = child::ask(child::command()?.arg(ASKED), &question).map_err(|error| match error
        .downcast_ref()
    {
        Some(Crashed { status, .. }) if is_late(*status) => {
            anyhow!("shader '{path}' does not compile: the compiler takes more than {SECONDS} s")
        }
        Some(crashed) => anyhow!("shader '{path}' does not compile: {crashed}"),
        None => error,
    })?;
    Ok(bytemuck::pod_collect_to_vec(&words))
}

/// The child's part: reads a text from standard input, and writes SPIR-V to standard output.
///
/// # Errors
/// If it does not compile.
pub fn answer() -> Result<()> {
    child::bind();
    #[cfg(unix)]
    bound();
    let question: Question =
        serde_json::from_reader(std::io::stdin().lock()).context("no shader on standard input")?;
    let defines: Vec<_> =
        question.defines.iter().map(|(name, value)| (name.as_str(), value.clone())).collect();
    let words = shader::to_spirv(&question.path, &question.text, &defines)?;
    output::write(bytemuck::cast_slice(&words))
}

/// Limits this process. A limit that cannot be set is already lower.
#[cfg(unix)]
fn bound() {
    // A process gets a second to react to the first limit.
    let cpu = libc::rlimit { rlim_cur: SECONDS, rlim_max: SECONDS + 1 };
    let memory = libc::rlimit { rlim_cur: BYTES, rlim_max: BYTES };
    let core = libc::rlimit { rlim_cur: 0, rlim_max: 0 };
    // SAFETY: the limits are there for the length of the calls.
    unsafe {
        libc::setrlimit(libc::RLIMIT_CPU, &cpu);
        libc::setrlimit(libc::RLIMIT_AS, &memory);
        libc::setrlimit(libc::RLIMIT_CORE, &core);
    }
}

/// True if a child exceeded its time limit.
#[cfg(unix)]
fn is_late(status: std::process::ExitStatus) -> bool {
    use std::os::unix::process::ExitStatusExt;
    status.signal() == Some(libc::SIGXCPU)
}

#[cfg(not(unix))]
fn is_late(_: std::process::ExitStatus) -> bool {
    false
}
