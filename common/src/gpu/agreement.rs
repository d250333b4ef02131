//! Whether shaders and Rust agree on structures, enumerations and bindings.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::Path;

use anyhow::Result;

use super::layout::Known;
use super::reflection::Reflection;
use super::shader::{Shader, cache_folder};
use crate::files;

/// Holds the shaders of a pipeline against what Rust has declared, and against what the program binds: so many
/// bindings in set 0, and perhaps the texture table.
///
/// What agrees is noted beside the shaders' words, and is not looked at again.
///
/// # Errors
/// On the first that differs, with where it stands and what would be right.
pub fn check(
    pipeline: &str,
    shaders: &[Shader],
    known: &Known,
    (bindings, has_textures): (usize, bool),
) -> Result<()> {
    let note = note(shaders, known, (bindings, has_textures));
    if note.is_file() {
        return Ok(());
    }
    for Shader { path, spirv, .. } in shaders {
        let reflection = Reflection::of(spirv)?;
        reflection.check_memory(path)?;
        reflection.check(path, &known.structs)?;
        reflection.check_addresses(path, &known.structs)?;
        reflection.check_bindings(path, bindings, has_textures)?;
    }
    for layout in &known.enums {
        layout.check(pipeline, shaders)?;
    }
    // A note that cannot be written costs time at the next start, nothing else.
    let _ = files::write_whole(&note, b"");
    Ok(())
}

/// The file that notes an agreement, by a hash of all that was compared, and of what compares.
fn note(shaders: &[Shader], known: &Known, bindings: (usize, bool)) -> std::path::PathBuf {
    let mut hasher = DefaultHasher::new();
    let ways = [include_str!("reflection.rs"), include_str!("reflection/memory.rs")];
    (ways, include_str!("enumeration.rs"), known, bindings).hash(&mut hasher);
    for Shader { path, spirv, constants, .. } in shaders {
        (path, spirv, constants).hash(&mut hasher);
    }
    Path::new(cache_folder()).join(format!("{:016x}.agreed", hasher.finish()))
}
