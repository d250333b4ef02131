//! The contents of an OBJ file, counted before it is parsed, and the memory they will need.

use anyhow::{Result, ensure};

use super::limits::Limits;

/// Bytes of a triangle in a mesh: three vertices, if it shares none, and their indices.
const MESH: usize = 3 * 32 + 12;
/// The most bytes of a triangle on a device: the same, and its share of the acceleration structure and of the
/// memory for building it. The software driver needs 370 to 420 (llvmpipe, Mesa 25.0.7).
const DEVICE: usize = 512;

/// The number of each kind of element in an OBJ file.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Tally {
    /// Bytes of the file, and of the plain text for tobj.
    pub text: usize,
    pub positions: usize,
    pub coordinates: usize,
    pub normals: usize,
    pub faces: usize,
    /// In all faces.
    pub corners: usize,
    /// After triangulation.
    pub triangles: usize,
    /// Statements that start a mesh.
    pub meshes: usize,
}

impl Tally {
    /// The most memory the model needs, in bytes: during reading, or afterwards, including its share on a device
    /// that uses the host's memory.
    pub fn bytes(&self) -> u64 {
        let made = (MESH + DEVICE) * self.triangles + 1024 * self.meshes;
        (self.text as u64) + self.reading().max(made as u64)
    }

    /// The most memory for reading, host memory in bytes; it includes the resulting meshes.
    ///
    /// While tobj reads, each position, coordinate and normal exists twice, 12 bytes each: in the file's order and
    /// in its mesh's. A face needs 104, a corner of a polygon 24. Each distinct corner needs a vertex of 32 bytes
    /// and an entry of 32 in a hash table, of which 7 of 16 are full, and which coexists with its half when it
    /// grows: 113. A triangle needs 12. Afterwards, a triangle without normals has three vertices of 32 bytes and
    /// indices of 12: less than those 113 of its corners.
    fn reading(&self) -> u64 {
        let &Self { positions, coordinates, normals, faces, corners, triangles, meshes, .. } = self;
        let attributes = 2 * 12 * (positions + coordinates + normals);
        let bytes =
            attributes + 104 * faces + (24 + 32 + 113) * corners + 12 * triangles + 1024 * meshes;
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
