//! A shader's text, with its includes spliced in.

use std::fs;
use std::path::{Component, Path};

use anyhow::{Context, Result, bail, ensure};

use super::{UintConstant, folder};

/// What lets a shader include files, and `#line` name them.
const INCLUDE_EXTENSION: &str = "GL_GOOGLE_include_directive";

/// How deep `#include` may nest; more is taken for a circle.
const MAX_INCLUDE_DEPTH: usize = 16;

/// Bytes of a shader with all its includes. Without a bound, a few files that include each other twice are more
/// than any memory holds.
const MOST_BYTES: usize = 4 << 20;

/// A shader's text with its includes in place, `#line` telling which is which.
///
/// Each file counts once: by a guard, since only the compiler knows which `#if` an include is in.
#[derive(Default)]
pub struct Source {
    /// The text.
    pub text: String,
    /// The files that it is from, each once.
    pub files: Vec<String>,
    /// The whole numbers that are declared in it.
    pub constants: Vec<UintConstant>,
    /// The file at hand and those that include it.
    open: Vec<String>,
}

impl Source {
    /// Adds a file, and those that it includes.
    ///
    /// # Errors
    /// If one cannot be read, lies elsewhere, or there are too many.
    pub fn splice(&mut self, path: &str, depth: usize) -> Result<()> {
        if self.open.iter().any(|file| file == path) {
            return Ok(());
        }
        ensure!(depth <= MAX_INCLUDE_DEPTH, "shader '{path}': includes nest too deep");
        let inside = Path::new(path).components().all(|part| matches!(part, Component::Normal(_)));
        ensure!(inside, "shader '{path}' is not below '{}'", folder().display());
        let file = folder().join(path);
        let hint = match std::env::var_os("SHADERS") {
            Some(_) => {
                " in the folder that SHADERS names; a copy of the project's shaders is right"
            }
            None => "",
        };
        let failed = || format!("cannot read the shader '{}'{hint}", file.display());
        // A pipe by that name would keep the reader waiting.
        let metadata = fs::metadata(&file).with_context(failed)?;
        ensure!(metadata.is_file(), "{}: it is not a file", failed());
        let bytes = metadata.len().saturating_add(self.text.len() as u64);
        ensure!(
            bytes <= MOST_BYTES as u64,
            "shader '{path}': with its includes it has more than {MOST_BYTES} bytes, the most that are read"
        );
        let text = fs::read_to_string(&file).with_context(failed)?;
        if let Some(zero) = text.find('\0') {
            let line = 1 + text[..zero].matches('\n').count();
            bail!("{path}:{line}: holds a zero byte: this is a binary file, not text");
        }
        if !self.files.iter().any(|file| file == path) {
            self.files.push(path.to_owned());
        }
        self.open.push(path.to_owned());
        for (index, line) in text.lines().enumerate() {
            let number = index + 1;
            if let Some(rest) = line.trim_start().strip_prefix("#include") {
                ensure!(
                    self.text.contains(INCLUDE_EXTENSION),
                    "{path}:{number}: #include takes the line `#extension {INCLUDE_EXTENSION} : require` \
                     above it"
                );
                let name = resolve(path, rest.trim().trim_matches(['"', '<', '>']));
                let guard = guard(&name);
                self.text.push_str(&format!("#ifndef {guard}\n#define {guard}\n"));
                self.text.push_str(&format!("#line 1 \"{name}\"\n"));
                self.splice(&name, depth + 1)
                    .with_context(|| format!("{path}:{number}: #include \"{name}\""))?;
                self.text.push_str(&format!("#endif\n#line {} \"{path}\"\n", number + 1));
            } else {
                self.text.push_str(line);
                self.text.push('\n');
                if let Some((name, value)) = uint_constant(line) {
                    let (name, place) = (name.to_owned(), format!("{path}:{number}"));
                    self.constants.push(UintConstant { name, value, place });
                }
                // The first `#line` must follow `#version` and the extension that allows file names.
                if depth == 0 && line.contains(INCLUDE_EXTENSION) {
                    self.text.push_str(&format!("#line {} \"{path}\"\n", number + 1));
                }
            }
        }
        self.open.pop();
        Ok(())
    }
}

/// Name and value of a line `const uint NAME = 1;`.
fn uint_constant(line: &str) -> Option<(&str, u32)> {
    let (name, rest) = line.trim_start().strip_prefix("const uint ")?.split_once('=')?;
    let (value, _) = rest.split_once(';')?;
    Some((name.trim(), value.trim().trim_end_matches('u').parse().ok()?))
}

/// A macro's name for a path.
fn guard(path: &str) -> String {
    let letter = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_uppercase() } else { '_' };
    format!("INCLUDED_{}", path.chars().map(letter).collect::<String>())
}

/// An include's path below `shaders/`: beside the file that includes it, else from the top.
fn resolve(includer: &str, name: &str) -> String {
    let beside = includer.rsplit_once('/').map(|(folder, _)| format!("{folder}/{name}"));
    let exists = beside.filter(|path| folder().join(path).is_file());
    exists.unwrap_or_else(|| name.to_owned())
}
