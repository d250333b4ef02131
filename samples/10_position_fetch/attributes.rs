//! Attributes of a vertex without its position: normal and texture coordinates, 20 bytes of 32.

use anyhow::Result;
use common::gpu::{Address, Buffer, Gpu};
use common::scene::{Mesh, input_usage};
use glam::{Vec2, Vec3};

common::shader_struct! {
    /// A vertex whose position the acceleration structure keeps.
    struct Attributes {
        normal: Vec3,
        uv: Vec2,
    }
}

common::shader_struct! {
    /// The address of a mesh's vertices.
    pub struct MeshRecord {
        vertices: Address<Attributes>,
    }
}

/// The attributes of meshes, in buffers that shaders read by address.
pub struct AttributesOnGpu {
    /// A [`MeshRecord`] for each mesh.
    pub table: Buffer,
    _meshes: Vec<Buffer>,
}

impl AttributesOnGpu {
    /// Uploads the attributes of these meshes.
    ///
    /// # Errors
    /// If memory is short.
    pub fn new(gpu: &Gpu, meshes: &[Mesh]) -> Result<Self> {
        let upload = |mesh: &Mesh| {
            let attributes: Vec<_> = mesh
                .vertices
                .iter()
                .map(|vertex| Attributes { normal: vertex.normal, uv: vertex.uv })
                .collect();
            Buffer::with_data(gpu, &mesh.name, &attributes, input_usage())
        };
        let meshes: Vec<Buffer> = meshes.iter().map(upload).collect::<Result<_>>()?;
        let records = meshes.iter().map(|mesh| MeshRecord { vertices: mesh.address.into() });
        let records: Vec<_> = records.collect();
        let table = Buffer::with_data(gpu, "attributes", &records, input_usage())?;
        Ok(Self { table, _meshes: meshes })
    }
}
