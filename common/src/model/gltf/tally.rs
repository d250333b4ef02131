//! The memory that a glTF file needs, counted before it is taken.

use anyhow::{Result, ensure};
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::Checked;

use super::file::File;
use crate::model::limits::Limits;
use crate::model::tally;

/// Bytes of a vertex while it is read: its attributes from the file, packed and as numbers, in a pose, and the
/// vertex made of them.
const VERTEX: u64 = 512;

/// Counts of the primitives of a file.
#[derive(Default)]
pub(super) struct Tally {
    vertices: u64,
    triangles: u64,
    meshes: u64,
}

impl Tally {
    /// Counts a primitive that becomes a mesh of its own.
    pub fn add(&mut self, file: &File, primitive: &Primitive) {
        let count = |accessor| file.count(accessor).unwrap_or_default();
        let positions = primitive.attributes.get(&Checked::Valid(Semantic::Positions));
        let vertices = positions.map_or(0, |&accessor| count(accessor));
        let corners = primitive.indices.map_or(vertices, count);
        let triangles = match primitive.mode {
            Checked::Valid(Mode::Triangles) => corners / 3,
            _ => corners,
        };
        self.meshes += 1;
        self.vertices = self.vertices.saturating_add(vertices);
        self.triangles = self.triangles.saturating_add(triangles);
    }

    /// Fails if there is too much.
    ///
    /// # Errors
    /// States the amount and its cause.
    pub fn check(&self, instances: usize, limits: &Limits) -> Result<()> {
        let Self { vertices, triangles, meshes } = *self;
        let most = limits.meshes;
        ensure!(
            instances <= most && meshes <= most as u64,
            "places {instances} meshes, and at most {most} are taken"
        );
        let bytes = vertices
            .saturating_mul(VERTEX)
            .saturating_add(triangles.saturating_mul(tally::TRIANGLE as u64))
            .saturating_add(1024 * (instances as u64 + meshes));
        let gigabytes = |bytes: u64| bytes as f64 / 1e9;
        ensure!(
            bytes <= limits.memory,
            "would take up to {:.1} GB of memory with its {vertices} vertices and {triangles} triangles; at \
             most {:.1} GB are taken",
            gigabytes(bytes),
            gigabytes(limits.memory)
        );
        Ok(())
    }
}
