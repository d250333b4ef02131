//! The reader's own program, as made by `chapters start` and after each step of its page.

use std::fs;
use std::path::Path;
use std::process::Command;

use anyhow::Result;
use common::files::folder;

use super::program::Programs;

/// The name of the program and its crate, which is a member of the workspace.
pub const NAME: &str = "my_tracer";

/// The folder of the crate that `chapters start` copies.
pub const TEMPLATE: &str = "docs/chapters/start/template";

/// The folder of the steps.
const FOLDER: &str = "docs/chapters/start";

/// The steps of the page in order: the folder with each step's files, and the program with these changes.
const STEPS: [(&str, &str); 6] = [
    ("template", NAME),
    ("second_light", "my_tracer_second_light"),
    ("sphere", "my_tracer_sphere"),
    ("bowl", "my_tracer_sphere"),
    ("lamps", "my_tracer_lamps"),
    ("smooth", "my_tracer_smooth"),
];

/// The number of the step with this name; without a name, the crate as first made.
///
/// # Errors
/// The existing names.
pub fn step(name: Option<&str>) -> Result<usize, String> {
    let Some(name) = name else { return Ok(0) };
    let found = STEPS.iter().position(|(step, _)| *step == name);
    found.ok_or_else(|| STEPS.map(|(step, _)| step).join(", "))
}

/// The path of a step's file in the reader's crate.
pub fn place(path: &str) -> &str {
    let below =
        path.strip_prefix(FOLDER).and_then(|below| below.trim_start_matches('/').split_once('/'));
    below.map_or(path, |(_, place)| place)
}

/// A command that runs the program after a step; its shaders are written below an empty folder.
///
/// # Errors
/// If the program is not built, or a shader cannot be copied.
pub fn command(programs: &Programs, step: usize, shaders: &Path) -> Result<Command> {
    let project = programs.project;
    for (changed, _) in &STEPS[..=step] {
        let own = format!("{FOLDER}/{changed}/shaders");
        for file in project.files(&own) {
            let copy = shaders.join(file[own.len()..].trim_start_matches('/'));
            folder::make(copy.parent().unwrap_or(shaders))?;
            fs::copy(project.root.join(&file), &copy)?;
        }
    }
    let mut command = programs.built(STEPS[step].1)?;
    command.env("SHADERS", shaders);
    Ok(command)
}
