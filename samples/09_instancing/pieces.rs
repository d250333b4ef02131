//! The pieces: what they are made from, and their instances as two origins see them.

use anyhow::Result;
use ash::vk;
use common::gpu::Gpu;
use common::scene::{Mesh, Scene, SceneOnGpu};

use crate::formation::{Build, Formation};
use crate::placed::{PieceRecord, Placed, Placement};

/// The pieces, on the host and on the device.
pub struct Pieces {
    /// Of each mesh one instance, which the device needs to find it.
    pub meshes: Scene,
    formation: Formation,
    /// The instances about each of the two origins, where they were last needed.
    placed: [Option<Placed>; 2],
    built: Build,
}

impl Pieces {
    pub fn new(build: Build) -> Result<Self> {
        let (meshes, formation) = Formation::build(build)?;
        Ok(Self { meshes, formation, placed: [None, None], built: build })
    }

    /// Makes meshes and pieces again if they were made from something else.
    pub fn rebuild(&mut self, gpu: &Gpu, scene: &mut SceneOnGpu, build: Build) -> Result<()> {
        if build == self.built {
            return Ok(());
        }
        let copied = build.is_copied() || self.built.is_copied();
        *self = Self::new(build)?;
        if copied {
            scene.rebuild(gpu, &self.meshes, scene.options)?;
        }
        Ok(())
    }

    /// The instances about one of the two origins, made again if they were placed otherwise.
    pub fn place(
        &mut self,
        gpu: &Gpu,
        scene: &SceneOnGpu,
        which: usize,
        placement: Placement,
    ) -> Result<&Placed> {
        let known = self.placed[which].take().filter(|placed| placed.placement == placement);
        let placed = match known {
            Some(placed) => placed,
            None => Placed::new(gpu, &self.meshes, scene, &self.formation, placement)?,
        };
        Ok(self.placed[which].insert(placed))
    }

    // ANCHOR: memory
    /// Bytes of everything that grows with the pieces.
    pub fn memory(&self, scene: &SceneOnGpu) -> serde_json::Value {
        let meshes = &self.meshes.model.meshes;
        let bytes = |mesh: &Mesh| size_of_val(&*mesh.vertices) + size_of_val(&*mesh.triangles);
        let placed = self.placed.iter().flatten();
        let pieces = self.formation.pieces.len();
        serde_json::json!({
            "pieces": pieces,
            "meshes": meshes.len(),
            "triangles": self.formation.triangles(&self.meshes.model),
            "mesh_bytes": meshes.iter().map(bytes).sum::<usize>(),
            "bottom_level_bytes": scene.blas.iter().map(|blas| blas.size).sum::<u64>(),
            "top_level_bytes": placed.clone().map(|placed| placed.tlas.size).sum::<u64>(),
            "record_bytes": placed.map(|_| pieces * size_of::<PieceRecord>()).sum::<usize>(),
            "instance_bytes": pieces * size_of::<vk::AccelerationStructureInstanceKHR>(),
        })
    }
    // ANCHOR_END: memory
}
