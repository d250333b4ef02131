//! The pieces: what they are made from, and their instances.

use anyhow::Result;
use ash::vk;
use ash::vk::GeometryInstanceFlagsKHR as Flags;
use common::gpu::Gpu;
use common::scene::{Mesh, Scene, SceneOnGpu};

use crate::formation::{Build, Formation};
use crate::top_level::{PieceRecord, TopLevel};

/// The pieces, on the host and on the device.
pub struct Pieces {
    /// Of each mesh one instance, which the device needs to find it.
    pub meshes: Scene,
    formation: Formation,
    /// As it was last needed.
    top_level: Option<TopLevel>,
    built: Build,
}

impl Pieces {
    pub fn new(build: Build) -> Result<Self> {
        let (meshes, formation) = Formation::build(build)?;
        Ok(Self { meshes, formation, top_level: None, built: build })
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

    /// The top level, made again if it was made with other flags of the white pieces.
    pub fn top_level(&mut self, gpu: &Gpu, scene: &SceneOnGpu, white: Flags) -> Result<&TopLevel> {
        let known = self.top_level.take().filter(|known| known.flags == white);
        let top_level = match known {
            Some(known) => known,
            None => TopLevel::new(gpu, &self.meshes, scene, &self.formation, white)?,
        };
        Ok(self.top_level.insert(top_level))
    }

    /// Bytes of everything that grows with the pieces.
    pub fn memory(&self, scene: &SceneOnGpu) -> serde_json::Value {
        let meshes = &self.meshes.model.meshes;
        let bytes = |mesh: &Mesh| size_of_val(&*mesh.vertices) + size_of_val(&*mesh.triangles);
        let top_levels = self.top_level.iter();
        let pieces = self.formation.pieces.len();
        serde_json::json!({
            "pieces": pieces,
            "meshes": meshes.len(),
            "triangles": self.formation.triangles(&self.meshes.model),
            "mesh_bytes": meshes.iter().map(bytes).sum::<usize>(),
            "bottom_level_bytes": scene.blas.iter().map(|blas| blas.size).sum::<u64>(),
            "top_level_bytes": top_levels.clone().map(|level| level.tlas.size).sum::<u64>(),
            "record_bytes": top_levels.map(|_| pieces * size_of::<PieceRecord>()).sum::<usize>(),
            "instance_bytes": pieces * size_of::<vk::AccelerationStructureInstanceKHR>(),
        })
    }
}
