//! The contents of an OBJ file, counted while it is read, and the memory they need.

use anyhow::{Result, ensure};

use super::limits::Limits;

/// Bytes of a triangle in a mesh: three vertices, if it shares none, and their indices.
const MESH: usize = 3 * 32 + 12;
/// The most bytes of a triangle on a device: the same, and its share of the acceleration structure and of the
/// memory for building it. The software driver needs 370 to 420 (llvmpipe, Mesa 25.0.7).
const DEVICE: usize = 512;
/// The most bytes of a triangle, on the host and on a device.
pub(crate) const TRIANGLE: usize = MESH + DEVICE;

/// The number of each kind of element in an OBJ file.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Tally {
    /// Bytes of the file.
    pub text: usize,
    pub positions: usize,
    pub coordinates: usize,
    pub normals: usize,
    pub faces: usize,
    /// In all faces.
    pub corners: usize,
    /// After triangulation.
    pub triangles: usize,
    /// Meshes, and names of materials.
    pub meshes: usize,
}

impl Tally {
    /// The most memory the model needs, in bytes, including its share on a device that uses the host's memory.
    ///
    /// A triangle counts as it does on the device, which is more than it takes while the file is read: 40 bytes in a
    /// list, which grows by doubling; up to 204 as a mesh, whose list of vertices does the same; and for each corner
    /// that has a normal, an entry of 16 and a byte in a hash table, of which 7 of 16 are full, and which coexists
    /// with its half when it grows: 59. For a smoothing group, a corner needs 72 in such a table, and 48 for its
    /// normal: they are gone before the meshes are made. Positions have 24 bytes, texture coordinates 8 and normals
    /// 12, in lists that grow by doubling.
    pub fn bytes(&self) -> u64 {
        let &Self { text, positions, coordinates, normals, triangles, meshes, .. } = self;
        let attributes = 2 * (24 * positions + 8 * coordinates + 12 * normals);
        let bytes = text + attributes + TRIANGLE * triangles + 1024 * meshes;
        bytes as u64
    }

    /// Fails if it exceeds the limit.
    ///
    /// # Errors
    /// States the amount and its cause.
    pub fn check(&self, limits: &Limits) -> Result<()> {
        let (bytes, most) = (self.bytes(), limits.memory);
        let gigabytes = |bytes: u64| bytes as f64 / 1e9;
        ensure!(
            bytes <= most,
            "would take up to {:.1} GB of memory with its {} corners of {} faces, {} positions and {} \
             meshes; at most {:.1} GB are taken",
            gigabytes(bytes),
            self.corners,
            self.faces,
            self.positions,
            self.meshes,
            gigabytes(most)
        );
        Ok(())
    }
}

#[cfg(test)]
mod tests;
