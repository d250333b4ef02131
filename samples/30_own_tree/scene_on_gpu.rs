//! A scene on the device for a walk of our own: what hit shaders read, without acceleration structures.

use std::sync::Arc;

use anyhow::Result;
use common::gpu::{Buffer, Gpu, TextureTable};
use common::scene::{Scene, SceneAddresses, SceneOnGpu};

use crate::{Builder, TreesOnGpu};

/// A scene in device memory, with trees.
pub struct OwnScene {
    /// The trees that the walk reads.
    pub trees: TreesOnGpu,
    /// Every texture of the model.
    pub textures: Arc<TextureTable>,
    /// Addresses of the rest.
    pub addresses: SceneAddresses,
    _buffers: Vec<Buffer>,
}

impl OwnScene {
    /// Uploads a scene and builds its trees.
    ///
    /// # Errors
    /// If memory is short.
    pub fn new(gpu: &Gpu, scene: &Scene, builder: Builder) -> Result<Self> {
        Self::build(gpu, scene, builder, None)
    }

    /// Builds everything but the textures again; pipelines stay valid.
    ///
    /// # Errors
    /// As [`OwnScene::new`].
    pub fn rebuild(&mut self, gpu: &Gpu, scene: &Scene, builder: Builder) -> Result<()> {
        *self = Self::build(gpu, scene, builder, Some(self.textures.clone()))?;
        Ok(())
    }

    fn build(
        gpu: &Gpu,
        scene: &Scene,
        builder: Builder,
        textures: Option<Arc<TextureTable>>,
    ) -> Result<Self> {
        let trees = TreesOnGpu::new(gpu, scene, builder)?;
        let (addresses, textures, buffers) =
            SceneOnGpu::without_levels(gpu, scene, &trees.orders, textures)?;
        Ok(Self { trees, textures, addresses, _buffers: buffers })
    }
}
