//! Limits for reading a model's files.

/// Limits of a model. Without them, a small file could demand all available memory.
#[derive(Clone, Copy)]
pub(crate) struct Limits {
    /// Bytes of the OBJ file.
    pub obj_bytes: u64,
    /// Bytes of all MTL files together.
    pub mtl_bytes: u64,
    /// Bytes that [`Tally::bytes`](super::tally::Tally::bytes) makes of the OBJ file.
    pub memory: u64,
    /// Statements that start a new mesh: objects, groups, changes of material.
    pub meshes: usize,
    /// Materials of all MTL files.
    pub materials: usize,
    /// Files that `mtllib` statements name, there or not.
    pub libraries: usize,
    /// Width and height of a texture.
    pub texture_side: u32,
    /// Bytes of all textures, decoded, and of what decoding takes.
    pub texture_bytes: u64,
}

impl Limits {
    /// For a machine that people work at.
    pub const DEFAULT: Self = Self {
        obj_bytes: 512 << 20,
        mtl_bytes: 16 << 20,
        memory: 4_000_000_000,
        meshes: 1_000_000,
        materials: 100_000,
        libraries: 1000,
        texture_side: 16384,
        texture_bytes: 512 << 20,
    };
}
