//! The contents of an OBJ file, counted before it is parsed, and the memory they will need.

use anyhow::{Result, ensure};

use super::limits::Limits;

/// Bytes of a triangle of a mesh: three vertices, if it shares none, and their indices.
const MESH: usize = 3 * 32 + 12;
/// Bytes that a triangle takes on a device at most: the same, and its part of the acceleration structure and of
/// what building that takes. The software driver takes 370 to 420 (llvmpipe, Mesa 25.0.7).
const DEVICE: usize = 512;

/// The number of each kind of thing in an OBJ file.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Tally {
    /// Bytes of the file, and of the plain text that tobj reads in its place.
    pub text: usize,
    pub positions: usize,
    pub coordinates: usize,
    pub normals: usize,
    pub faces: usize,
    /// Of all faces.
    pub corners: usize,
    /// That they become.
    pub triangles: usize,
    /// Statements that start one.
    pub meshes: usize,
}

impl Tally {
    /// The most memory that the model takes, in bytes: while it is read, or after that, with what it takes on
    /// a device that has the host's memory.
    pub fn bytes(&self) -> u64 {
        let made = (MESH + DEVICE) * self.triangles + 1024 * self.meshes;
        (self.text as u64) + self.reading().max(made as u64)
    }

    /// The most memory that reading takes, host memory in bytes; the meshes that are made are a part of it.
    ///
    /// While tobj reads, each position, coordinate and normal is there, 12 bytes, and twice: in the file's
    /// order and in its mesh's. A face takes 104, a corner of a polygon 24. Corners that differ each make a
    /// vertex of 32 bytes and an entry of 32 in a hash table, of which 7 of 16 are full, and which stands
    /// beside its half when it grows: 113. A triangle takes 12. After that, a triangle without normals has
    /// three vertices of 32 bytes and indices of 12: less than those 113 of its corners.
    fn reading(&self) -> u64 {
        let &Self { positions, coordinates, normals, faces, corners, triangles, meshes, .. } = self;
        let attributes = 2 * 12 * (positions + coordinates + normals);
        let bytes =
            attributes + 104 * faces + (24 + 32 + 113) * corners + 12 * triangles + 1024 * meshes;
        bytes as u64
    }

    /// Fails if that is too much.
    ///
    /// # Errors
    /// With what it is, and of what.
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
