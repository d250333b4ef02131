//! The meshes of a model on the device: their arrays, each kind in one buffer, and their bottom levels.

use anyhow::Result;

use ash::vk;

use super::{InstanceRecord, Mesh, Scene, SceneOptions, Vertex, input_usage};
use crate::gpu::{AccelerationStructure, Address, Buffer, BuildOptions, Geometry, Gpu, order};

/// Every mesh of a model in device memory, without a bottom level.
pub(super) struct MeshBuffers {
    /// The addresses of each mesh: the record of an instance, still without its material.
    pub records: Vec<InstanceRecord>,
    /// The buffers the records point into, vertices last.
    pub buffers: Vec<Buffer>,
}

impl MeshBuffers {
    /// Uploads meshes. Primitive `i` of mesh `m`, in the numbering of the intersection code, is triangle
    /// `orders[m][i]`.
    pub(super) fn new(
        gpu: &Gpu,
        meshes: &[Mesh],
        orders: &[Vec<u32>],
        usage: vk::BufferUsageFlags,
    ) -> Result<Self> {
        let vertices = meshes.iter().map(|mesh| &mesh.vertices);
        let (vertices, at_vertices) = Buffer::with_arrays(gpu, "vertices", vertices, usage)?;
        let triangles = meshes.iter().map(|mesh| &mesh.triangles);
        let (triangles, at_triangles) = Buffer::with_arrays(gpu, "triangles", triangles, usage)?;
        let (original, at_original) = Buffer::with_arrays(gpu, "triangle order", orders, usage)?;
        let records = (0..meshes.len()).map(|index| InstanceRecord {
            vertices: at_vertices[index].into(),
            triangles: at_triangles[index].into(),
            original: at_original[index].into(),
            material: 0,
            mesh: index as u32,
        });
        Ok(Self { records: records.collect(), buffers: vec![triangles, original, vertices] })
    }
}

/// Every mesh of a model in device memory, and its bottom level.
pub(super) struct MeshesOnGpu {
    /// One bottom level per mesh.
    pub blas: Vec<AccelerationStructure>,
    /// The addresses of each mesh: the record of an instance, still without its material.
    pub records: Vec<InstanceRecord>,
    /// The buffers the records point into.
    pub buffers: Vec<Buffer>,
}

impl MeshesOnGpu {
    pub(super) fn new(gpu: &Gpu, scene: &Scene, options: SceneOptions) -> Result<Self> {
        let meshes = &scene.model.meshes;
        let orders: Vec<_> = meshes.iter().map(|mesh| triangle_order(gpu, mesh, options)).collect();
        let usage = input_usage();
        let MeshBuffers { mut records, mut buffers } =
            MeshBuffers::new(gpu, meshes, &orders, usage)?;
        // Only the builds read the ordered copy; it is freed at the end of this function.
        let ordered = meshes.iter().zip(&orders).map(in_order);
        let (_ordered, at_ordered) = Buffer::with_arrays(gpu, "ordered triangles", ordered, usage)?;
        let (opaque, fetch) = (opaque(scene), options.position_fetch);
        // ANCHOR: bottom_levels
        let mut geometries = Vec::with_capacity(meshes.len());
        for (index, mesh) in meshes.iter().enumerate() {
            geometries.push([Geometry::Triangles {
                vertices: records[index].vertices.into(),
                vertex_stride: size_of::<Vertex>() as u64,
                vertex_count: mesh.vertices.len() as u32,
                indices: at_ordered[index],
                count: orders[index].len() as u32,
                opaque: opaque[index],
                no_duplicate_any_hit: options.no_duplicate_any_hit,
            }]);
        }

        let options = BuildOptions { compact: true, data_access: fetch, ..BuildOptions::default() };
        let inputs = meshes.iter().zip(&geometries);
        let inputs: Vec<_> = inputs.map(|(mesh, list)| (mesh.name.as_str(), &list[..])).collect();
        let blas = AccelerationStructure::build(gpu, &inputs, options)?;
        // ANCHOR_END: bottom_levels
        if fetch {
            records.iter_mut().for_each(|record| record.vertices = Address::default());
            buffers.pop();
        }
        Ok(Self { blas, records, buffers })
    }
}

/// The triangles of a mesh in the order of its build.
fn in_order((mesh, order): (&Mesh, &Vec<u32>)) -> Vec<[u32; 3]> {
    order.iter().map(|&i| mesh.triangles[i as usize]).collect()
}

/// For each mesh, true if no material it is placed with has holes. An any-hit shader is worth calling only where it
/// can ignore a hit.
fn opaque(scene: &Scene) -> Vec<bool> {
    let mut opaque = vec![true; scene.model.meshes.len()];
    for instance in &scene.instances {
        opaque[instance.mesh] &= !scene.model.materials[instance.material].has_cutout();
    }
    opaque
}

/// For each primitive of the build, its triangle of the mesh. A device may call any-hit shaders more than once for
/// a triangle, unless that is ruled out.
pub fn triangle_order(gpu: &Gpu, mesh: &Mesh, options: SceneOptions) -> Vec<u32> {
    let order = order::for_build(gpu, &mesh.triangle_bounds(), options.ordering);
    if options.no_duplicate_any_hit { order } else { gpu.driver_shim.candidates(order) }
}
