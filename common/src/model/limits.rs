//! Limits for reading a model's files.

/// Limits of a model. Without them, a small file could demand all available memory.
#[derive(Clone, Copy)]
pub(crate) struct Limits {
    /// Bytes of the OBJ file.
    pub obj_bytes: u64,
    /// Bytes of all MTL files together.
    pub mtl_bytes: u64,
    /// Bytes needed for the OBJ file, by [`Tally::bytes`](super::tally::Tally::bytes).
    pub memory: u64,
    /// Statements that start a new mesh: objects, groups, changes of material.
    pub meshes: usize,
    /// Materials of all MTL files.
    pub materials: usize,
    /// Files named by `mtllib` statements, whether or not they exist.
    pub libraries: usize,
    /// Width and height of a texture.
    pub texture_side: u32,
    /// Bytes of all decoded textures, and of the memory for decoding.
    pub texture_bytes: u64,
}

impl Limits {
    /// Limits for a machine that is also used for other work.
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
