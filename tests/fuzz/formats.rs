//! Input formats, one per file.

pub mod cases;
pub mod game;
pub mod gltf;
pub mod legs;
pub mod object;
pub mod scene;
pub mod settings;
pub mod shader;
pub mod sums;
pub mod texture;

use std::fs;
use std::path::Path;

use crate::format::{Format, Function};

/// Readers in this process, each with the number of inputs tried by `cargo test`, which take a few seconds.
pub const FUNCTIONS: [(Format, Function, usize); 9] = [
    (object::FORMAT, object::FUNCTION, 8000),
    (object::MATERIAL_FORMAT, object::MATERIAL_FUNCTION, 8000),
    (texture::FORMAT, texture::FUNCTION, 2000),
    (scene::FORMAT, scene::FUNCTION, 2000),
    (game::FORMAT, game::FUNCTION, 3000),
    (legs::FORMAT, legs::FUNCTION, 3000),
    (sums::FORMAT, sums::FUNCTION, 8000),
    (settings::FORMAT, settings::FUNCTION, 8000),
    (gltf::FORMAT, gltf::FUNCTION, 3000),
];

/// The files of a folder of the corpus, sorted by name.
fn corpus(name: &str) -> Vec<Vec<u8>> {
    let folder = run::root().join("tests/fuzz/corpus").join(name);
    let entries = folder.read_dir().unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut files: Vec<_> = entries.map(|entry| entry.expect("an entry").path()).collect();
    files.sort();
    files.iter().map(|file| fs::read(file).expect("a file of the corpus can be read")).collect()
}

/// The bytes of a file of the project.
fn ours(path: &str) -> Vec<u8> {
    fs::read(run::root().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// Writes no additional files.
pub fn nothing(_: &Path) {}
