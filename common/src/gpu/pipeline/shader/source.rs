//! A shader's text, with its includes spliced in.

use std::fs;
use std::path::{Component, Path, PathBuf};

use anyhow::{Context, Result, ensure};

use super::folders;
use crate::model::text::utf8;

/// The extension for including files and for file names in `#line`.
const INCLUDE_EXTENSION: &str = "GL_GOOGLE_include_directive";

/// The maximum depth of `#include`; more is taken for a cycle.
const MAX_INCLUDE_DEPTH: usize = 16;

/// The maximum size of a shader with all its includes, in bytes. Without a bound, a few files that include each
/// other twice would fill any memory.
const MOST_BYTES: usize = 4 << 20;

/// The text of the shader at `path` with its includes in place and `#line` marking their origin.
///
/// Each file is included once, by a macro guard, because only the compiler knows which `#if` an include is in.
///
/// # Errors
/// If a file cannot be read, is outside the folder, or there are too many.
pub fn spliced(path: &str) -> Result<String> {
    let mut text = String::new();
    splice(path, &[], &mut text)?;
    Ok(text)
}

/// Adds a file and its includes to `text`; `includers` are the files it was reached through.
fn splice(path: &str, includers: &[&str], text: &mut String) -> Result<()> {
    if includers.contains(&path) {
        return Ok(());
    }
    ensure!(includers.len() <= MAX_INCLUDE_DEPTH, "shader '{path}': includes nest too deep");
    let inside = Path::new(path).components().all(|part| matches!(part, Component::Normal(_)));
    ensure!(inside, "shader '{path}' is not below '{}'", listed(&folders()));
    let file = find(path)?;
    let failed = || format!("cannot read the shader '{}'", file.display());
    // Opening a pipe of that name would block.
    let metadata = fs::metadata(&file).with_context(failed)?;
    ensure!(metadata.is_file(), "{}: it is not a file", failed());
    ensure!(
        metadata.len().saturating_add(text.len() as u64) <= MOST_BYTES as u64,
        "shader '{path}': with its includes it has more than {MOST_BYTES} bytes, the most that are read"
    );
    let own = utf8(fs::read(&file).with_context(failed)?, path)?;
    for (number, line) in (1..).zip(own.lines()) {
        let Some(rest) = line.trim_start().strip_prefix("#include") else {
            text.push_str(line);
            text.push('\n');
            // The first `#line` must follow `#version` and the extension that allows file names.
            if includers.is_empty() && line.contains(INCLUDE_EXTENSION) {
                *text += &format!("#line {} \"{path}\"\n", number + 1);
            }
            continue;
        };
        ensure!(
            text.contains(INCLUDE_EXTENSION),
            "{path}:{number}: #include takes the line `#extension {INCLUDE_EXTENSION} : require` above it"
        );
        let name = resolve(path, rest.trim().trim_matches(['"', '<', '>']));
        let guard = guard(&name);
        *text += &format!("#ifndef {guard}\n#define {guard}\n#line 1 \"{name}\"\n");
        splice(&name, &[includers, &[path]].concat(), text)
            .with_context(|| format!("{path}:{number}: #include \"{name}\""))?;
        *text += &format!("#endif\n#line {} \"{path}\"\n", number + 1);
    }
    Ok(())
}

/// Finds the shader at `path` in the first folder that has it.
fn find(path: &str) -> Result<PathBuf> {
    let folders = folders();
    if let Some(named) = std::env::var_os("SHADERS") {
        ensure!(
            !named.is_empty(),
            "SHADERS in the environment is empty: unset it, or name a folder of shaders"
        );
        let named = Path::new(&named);
        ensure!(
            !named.is_file(),
            "SHADERS names '{}', a file; a folder of shaders is right",
            named.display()
        );
    }
    let mut files = folders.iter().map(|folder| folder.join(path));
    let right = match (std::env::var_os("SHADERS"), &folders[..]) {
        (None, _) => "SHADERS in the environment names another folder for the first of them",
        (Some(_), [_]) => "SHADERS names it; a copy of the book's shaders is right",
        (Some(_), _) => "SHADERS names the first; a copy of the program's own shaders is right",
    };
    files
        .find(|file| file.try_exists().unwrap_or(true))
        .with_context(|| format!("there is no shader '{path}' in '{}'; {right}", listed(&folders)))
}

fn listed(folders: &[PathBuf]) -> String {
    let names: Vec<_> = folders.iter().map(|folder| folder.display().to_string()).collect();
    names.join("' nor in '")
}

/// The macro name for a path.
fn guard(path: &str) -> String {
    let letter = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_uppercase() } else { '_' };
    format!("INCLUDED_{}", path.chars().map(letter).collect::<String>())
}

/// An include's path below `shaders/`: beside the file that includes it, else from the top.
fn resolve(includer: &str, name: &str) -> String {
    let beside = includer.rsplit_once('/').map(|(folder, _)| format!("{folder}/{name}"));
    let exists = |path: &String| folders().iter().any(|folder| folder.join(path).is_file());
    beside.filter(exists).unwrap_or_else(|| name.to_owned())
}
