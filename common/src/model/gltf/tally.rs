//! The memory that a glTF file needs, counted before it is taken.

use std::collections::BTreeSet;

use anyhow::{Result, ensure};
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::Checked;

use super::file::File;
use super::nodes::Placed;
use crate::model::limits::Limits;
use crate::model::tally;

/// Bytes of a vertex while it is read: its attributes from the file, packed and as numbers, in a pose, and the
/// vertex made of them.
const VERTEX: u64 = 512;

/// Bytes of a vertex for each target that moves it.
const TARGET: u64 = 24;
/// Bytes of a joint of a skin.
const JOINT: u64 = 256;

/// Counts the memory that all meshes will take.
///
/// # Errors
/// If it is more than the limit; states the amount and its cause.
pub(super) fn check(file: &File, placed: &[Placed], limits: &Limits) -> Result<()> {
    let mut tally = Tally::default();
    let mut seen = BTreeSet::new();
    let mut instances = 0;
    for Placed { node, number, .. } in placed {
        let Some(index) = node.mesh else { continue };
        let Some(mesh) = file.root.get(index) else { continue };
        instances += mesh.primitives.len();
        let skin = node.skin.and_then(|skin| file.root.get(skin));
        tally.joints += skin.map_or(0, |skin| skin.joints.len() as u64);
        let weights = node.weights.is_some() || mesh.weights.is_some();
        let own = (skin.is_some() || weights).then_some(*number);
        if seen.insert((index.value(), own)) {
            mesh.primitives.iter().for_each(|primitive| tally.add(file, primitive));
        }
    }
    tally.check(instances, limits)
}

/// Counts of the primitives of a file.
#[derive(Default)]
struct Tally {
    vertices: u64,
    triangles: u64,
    meshes: u64,
    /// The number of vertices, counted once for each target.
    moves: u64,
    /// The number of joints in the skins of all nodes.
    joints: u64,
}

impl Tally {
    /// Counts a primitive that becomes a mesh of its own.
    fn add(&mut self, file: &File, primitive: &Primitive) {
        let count = |accessor| file.count(accessor).unwrap_or_default();
        let positions = primitive.attributes.get(&Checked::Valid(Semantic::Positions));
        let vertices = positions.map_or(0, |&accessor| count(accessor));
        let corners = primitive.indices.map_or(vertices, count);
        let triangles = match primitive.mode {
            Checked::Valid(Mode::Triangles) => corners / 3,
            _ => corners,
        };
        self.meshes += 1;
        let targets = primitive.targets.as_ref().map_or(0, |targets| targets.len() as u64);
        self.moves = self.moves.saturating_add(vertices.saturating_mul(targets));
        self.vertices = self.vertices.saturating_add(vertices);
        self.triangles = self.triangles.saturating_add(triangles);
    }

    /// Fails if there is too much.
    ///
    /// # Errors
    /// States the amount and its cause.
    fn check(&self, instances: usize, limits: &Limits) -> Result<()> {
        let Self { vertices, triangles, meshes, moves, joints } = *self;
        let most = limits.meshes;
        ensure!(
            instances <= most && meshes <= most as u64,
            "places {instances} meshes, and at most {most} are taken"
        );
        let bytes = vertices
            .saturating_mul(VERTEX)
            .saturating_add(triangles.saturating_mul(tally::TRIANGLE as u64))
            .saturating_add(moves.saturating_mul(TARGET))
            .saturating_add(joints.saturating_mul(JOINT))
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
