//! The shader compiler in a process of its own: it may abort on an edit, and a window must not.

use std::sync::atomic::{AtomicBool, Ordering};

use anyhow::{Context, Result};
use serde::{Deserialize, Serialize};

use crate::{child, output};

/// What the child is asked to compile.
#[derive(Serialize, Deserialize)]
struct Question {
    path: String,
    text: String,
    defines: Vec<(String, String)>,
}

static WANTED: AtomicBool = AtomicBool::new(false);

/// From now on, this process compiles no shader itself.
pub fn want() {
    WANTED.store(true, Ordering::Relaxed);
}

/// Whether shaders are to be compiled in a child.
pub fn is_wanted() -> bool {
    WANTED.load(Ordering::Relaxed)
}

/// The words of a shader's whole text, as [`super::to_spirv`] makes them.
///
/// # Errors
/// If the text does not compile, or the compiler crashes.
pub fn compile(path: &str, text: &str, defines: &[(&str, String)]) -> Result<Vec<u32>> {
    let defines = defines.iter().map(|(name, value)| ((*name).to_owned(), value.clone()));
    let question =
        Question { path: path.to_owned(), text: text.to_owned(), defines: defines.collect() };
    let question = serde_json::to_vec(&question)?;
    let words = child::ask(child::command()?.arg("--answer-compile"), &question)?;
    Ok(bytemuck::pod_collect_to_vec(&words))
}

/// The child's part: reads a text from standard input, and writes its words to standard output.
///
/// # Errors
/// If it does not compile.
pub fn answer() -> Result<()> {
    let question: Question =
        serde_json::from_reader(std::io::stdin().lock()).context("no shader on standard input")?;
    let (_, stage) = super::stage(&question.path)?;
    let defines: Vec<_> =
        question.defines.iter().map(|(name, value)| (name.as_str(), value.clone())).collect();
    let words = super::to_spirv(&question.path, &question.text, stage, &defines)?;
    output::write(bytemuck::cast_slice(&words))
}
