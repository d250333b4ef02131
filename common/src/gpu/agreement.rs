//! Whether shaders and Rust agree on structures, enumerations and bindings.

use std::hash::{DefaultHasher, Hash, Hasher};

use anyhow::Result;

use super::blueprint::Blueprint;
use super::enumeration;
use super::layout::Known;
use super::reflection::Reflection;
use super::shader::Shader;
use crate::files::{self, cache};

/// Holds the shaders of a pipeline against what Rust has declared, and against what the program binds.
///
/// What agrees is noted beside the shaders' words, by a hash of all that was compared and of what compares, and
/// is not looked at again.
///
/// # Errors
/// On the first that differs, with where it stands and what would be right.
pub fn check(blueprint: &Blueprint, shaders: &[Shader], known: &Known) -> Result<()> {
    let Blueprint { name, bindings, textures, .. } = blueprint;
    let mut hasher = DefaultHasher::new();
    let ways = [include_str!("reflection.rs"), include_str!("reflection/memory.rs")];
    (ways, include_str!("enumeration.rs"), known).hash(&mut hasher);
    (shaders, bindings, textures.is_some()).hash(&mut hasher);
    let file = format!("{:016x}.agreed", hasher.finish());
    let note = cache::folder("spirv").map(|folder| folder.join(file));
    if note.as_ref().is_some_and(|note| note.is_file()) {
        return Ok(());
    }
    let mut constants = Vec::new();
    for Shader { path, spirv, text, .. } in shaders {
        let reflection = Reflection::of(spirv)?;
        reflection.check_memory(path)?;
        reflection.check(path, &known.structs)?;
        reflection.check_addresses(path, &known.structs)?;
        reflection.check_bindings(path, bindings.len(), textures.is_some())?;
        constants.extend(enumeration::constants(path, text));
    }
    for layout in &known.enums {
        layout.check(name, &constants)?;
    }
    // A note that cannot be written costs time at the next start, nothing else.
    let _ = note.map(|note| files::write_whole(&note, b""));
    Ok(())
}
