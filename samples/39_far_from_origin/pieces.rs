//! The pieces: what they are made from, and their instances as two origins see them.

use anyhow::Result;
use ash::vk;
use common::gpu::Gpu;
use common::scene::{Mesh, Scene, SceneOnGpu};

use crate::formation::{Build, Formation};
use crate::top_level::{PieceRecord, TopLevel, TopLevelBuild};

/// The pieces, on the host and on the device.
pub struct Pieces {
    /// Of each mesh one instance, which the device needs to find it.
    pub meshes: Scene,
    formation: Formation,
    /// About each of the two origins, as it was last needed.
    top_levels: [Option<TopLevel>; 2],
    built: Build,
}

impl Pieces {
    pub fn new(build: Build) -> Result<Self> {
        let (meshes, formation) = Formation::build(build)?;
        Ok(Self { meshes, formation, top_levels: [None, None], built: build })
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

    /// The top level about one of the two origins, made again if it was made for something else.
    pub fn top_level(
        &mut self,
        gpu: &Gpu,
        scene: &SceneOnGpu,
        which: usize,
        build: TopLevelBuild,
    ) -> Result<&TopLevel> {
        let known = self.top_levels[which].take().filter(|known| known.build == build);
        let top_level = match known {
            Some(known) => known,
            None => TopLevel::new(gpu, &self.meshes, scene, &self.formation, build)?,
        };
        Ok(self.top_levels[which].insert(top_level))
    }

    /// Bytes of everything that grows with the pieces.
    pub fn memory(&self, scene: &SceneOnGpu) -> serde_json::Value {
        let meshes = &self.meshes.model.meshes;
        let bytes = |mesh: &Mesh| size_of_val(&*mesh.vertices) + size_of_val(&*mesh.triangles);
        let top_levels = self.top_levels.iter().flatten();
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
