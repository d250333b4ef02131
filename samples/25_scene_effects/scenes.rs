//! The chapter's own scenes, in `samples/assets/scenes`.

use std::path::PathBuf;

use common::scene::assets;

/// From the least to everything. The last is a file of the reader's.
pub const SCENES: [&str; 24] = [
    "one sphere",
    "two kings",
    "empty board",
    "opening",
    "lamp at night",
    "soft evening",
    "fretwork",
    "knight",
    "bauhaus",
    "mirror balls",
    "solids",
    "knot",
    "chain",
    "lake",
    "colonnade",
    "painted room",
    "crystal",
    "close up",
    "globes",
    "billiards",
    "rough gold",
    "in motion",
    "everything",
    "file",
];

/// Number of the scene at the start of the chapter.
pub const EVERYTHING: u32 = 22;
/// Number of the scene that `--scene` opens.
pub const FILE: u32 = 23;

/// The file of one of them.
pub fn path(number: u32) -> PathBuf {
    let name = SCENES[number as usize].replace(' ', "_");
    assets().join("scenes").join(name).with_extension("toml")
}
