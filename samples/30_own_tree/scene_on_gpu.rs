//! A scene on the device for a walk of our own: what hit shaders read, without acceleration structures.

use std::sync::Arc;

use anyhow::Result;
use common::gpu::{Buffer, Gpu, TextureTable};
use common::scene::{Scene, SceneAddresses, SceneOnGpu};

use crate::{Bounds, Tree, TreesOnGpu};

/// A scene in device memory, with trees.
pub struct OwnScene {
    /// What the walk reads.
    pub trees: TreesOnGpu,
    /// Every texture of the model.
    pub textures: Arc<TextureTable>,
    /// Where shaders find the rest.
    pub addresses: SceneAddresses,
    _buffers: Vec<Buffer>,
}

impl OwnScene {
    /// Uploads a scene and builds its trees by `build`.
    ///
    /// # Errors
    /// If memory is short.
    pub fn new(gpu: &Gpu, scene: &Scene, build: impl Fn(&[Bounds]) -> Tree) -> Result<Self> {
        let trees = TreesOnGpu::new(gpu, scene, build)?;
        let (addresses, textures, buffers) = SceneOnGpu::without_levels(gpu, scene, &trees.orders)?;
        Ok(Self { trees, textures, addresses, _buffers: buffers })
    }
}
