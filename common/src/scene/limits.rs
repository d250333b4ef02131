//! How much of a model's files is read.

/// What a model may take. Without bounds a small file can ask for all the memory there is.
#[derive(Clone, Copy)]
pub(super) struct Limits {
    /// Bytes of the OBJ file.
    pub obj_bytes: u64,
    /// Bytes of an MTL file.
    pub mtl_bytes: u64,
    /// Positions, normals, texture coordinates and triangles, each.
    pub elements: usize,
    /// Statements that start a new mesh: objects, groups, changes of material.
    pub meshes: usize,
    /// Width and height of a texture.
    pub texture_side: u32,
    /// Bytes of all textures, decoded.
    pub texture_bytes: u64,
}

impl Limits {
    /// For a machine that people work at.
    pub const DEFAULT: Self = Self {
        obj_bytes: 512 << 20,
        mtl_bytes: 16 << 20,
        elements: 50_000_000,
        meshes: 1_000_000,
        texture_side: 16384,
        texture_bytes: 1 << 30,
    };
}
