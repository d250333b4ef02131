//! A scene on the device for a walk of our own: what hit shaders read, without acceleration structures.

use std::sync::Arc;

use anyhow::Result;
use ash::vk;
use common::bytemuck::cast_slice;
use common::gpu::{Buffer, Gpu, Texels, TextureTable};
use common::scene::{InstanceRecord, MaterialRecord, Scene, SceneAddresses};

use crate::{Bounds, Tree, TreesOnGpu, USAGE};

/// A scene in device memory, with trees.
pub struct OwnScene {
    /// What the walk reads.
    pub trees: TreesOnGpu,
    /// Every texture of the model.
    pub textures: Arc<TextureTable>,
    /// Where shaders find the rest.
    pub addresses: SceneAddresses,
    _buffers: [Buffer; 4],
}

impl OwnScene {
    /// Uploads a scene and builds its trees by `build`.
    ///
    /// # Errors
    /// If memory is short.
    pub fn new(gpu: &Gpu, scene: &Scene, build: impl Fn(&[Bounds]) -> Tree) -> Result<Self> {
        let Scene { model, instances, .. } = scene;
        let textures = model.textures.iter().map(|texture| Texels {
            name: &texture.name,
            extent: vk::Extent2D { width: texture.width, height: texture.height },
            rgba: &texture.rgba,
            srgb: texture.srgb,
        });
        let textures = TextureTable::new(gpu, &textures.collect::<Vec<_>>(), false)?;
        let trees = TreesOnGpu::new(gpu, scene, build)?;
        let vertices = model.meshes.iter().map(|mesh| &mesh.vertices);
        let (vertices, at_vertices) = Buffer::with_arrays(gpu, "vertices", vertices, USAGE)?;
        let triangles = model.meshes.iter().map(|mesh| &mesh.triangles);
        let (triangles, at_triangles) = Buffer::with_arrays(gpu, "triangles", triangles, USAGE)?;
        let (orders, at_orders) =
            Buffer::with_arrays(gpu, "triangle order", &trees.orders, USAGE)?;
        let records = instances.iter().map(|instance| InstanceRecord {
            vertices: at_vertices[instance.mesh].into(),
            triangles: at_triangles[instance.mesh].into(),
            original: at_orders[instance.mesh].into(),
            material: instance.material as u32,
            mesh: instance.mesh as u32,
        });
        let records: Vec<_> = records.collect();
        let materials: Vec<_> = model.materials.iter().map(MaterialRecord::from).collect();
        let records = [cast_slice::<_, u8>(&records), cast_slice(&materials)];
        let (records, at) = Buffer::with_arrays(gpu, "records", records, USAGE)?;
        let addresses = SceneAddresses { instances: at[0].into(), materials: at[1].into() };
        let buffers = [vertices, triangles, orders, records];
        Ok(Self { trees, textures: Arc::new(textures), addresses, _buffers: buffers })
    }
}
