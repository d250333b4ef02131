//! The meshes of a model on the device: their arrays, each kind in one buffer, and their bottom levels.

use anyhow::Result;

use super::{InstanceRecord, Mesh, Scene, SceneOptions, Vertex, input_usage};
use crate::gpu::{
    AccelerationStructure, Address, Buffer, BuildOptions, Geometry, Gpu, Pack, order,
};

/// Every mesh of a model in device memory.
pub(super) struct MeshesOnGpu {
    /// One bottom level a mesh.
    pub blas: Vec<AccelerationStructure>,
    /// Where each mesh lies: what the record of an instance says, but for its material.
    pub records: Vec<InstanceRecord>,
    /// What the records point into.
    pub buffers: Vec<Buffer>,
}

impl MeshesOnGpu {
    pub(super) fn new(gpu: &Gpu, scene: &Scene, options: SceneOptions) -> Result<Self> {
        let meshes = &scene.model.meshes;
        let usage = input_usage();
        let orders: Vec<_> = meshes.iter().map(|mesh| triangle_order(gpu, mesh, options)).collect();
        let primitives = || orders.iter().map(Vec::len);
        let lengths = meshes.iter().map(|mesh| mesh.vertices.len());
        let mut vertices = Pack::<Vertex>::new(gpu, "vertices", lengths, usage)?;
        let lengths = meshes.iter().map(|mesh| mesh.triangles.len());
        let mut triangles = Pack::<[u32; 3]>::new(gpu, "triangles", lengths, usage)?;
        let mut original = Pack::<u32>::new(gpu, "original triangles", primitives(), usage)?;
        let mut ordered = Pack::<[u32; 3]>::new(gpu, "ordered triangles", primitives(), usage)?;
        let mut records = Vec::with_capacity(meshes.len());
        let mut geometries = Vec::with_capacity(meshes.len());
        let opaque = opaque(scene);
        for (index, (mesh, order)) in meshes.iter().zip(&orders).enumerate() {
            let in_order: Vec<_> = order.iter().map(|&i| mesh.triangles[i as usize]).collect();
            let first_vertex = vertices.push(&mesh.vertices)?;
            geometries.push([Geometry::Triangles {
                vertices: first_vertex,
                vertex_stride: size_of::<Vertex>() as u64,
                vertex_count: mesh.vertices.len() as u32,
                indices: ordered.push(&in_order)?,
                count: in_order.len() as u32,
                opaque: opaque[index],
                no_duplicate_any_hit: options.no_duplicate_any_hit,
            }]);
            let is_kept = !options.position_fetch;
            records.push(InstanceRecord {
                vertices: if is_kept { first_vertex.into() } else { Address::default() },
                triangles: triangles.push(&mesh.triangles)?.into(),
                original: original.push(order)?.into(),
                material: 0,
                mesh: index as u32,
            });
        }
        let (vertices, triangles) = (vertices.finish()?, triangles.finish()?);
        // Only the builds read the ordered copy; it is freed at the end of this function.
        let (original, _ordered) = (original.finish()?, ordered.finish()?);

        let fetch = options.position_fetch;
        let options = BuildOptions { compact: true, data_access: fetch, ..BuildOptions::default() };
        let inputs = meshes.iter().zip(&geometries);
        let inputs: Vec<_> = inputs.map(|(mesh, list)| (mesh.name.as_str(), &list[..])).collect();
        let blas = AccelerationStructure::bottoms(gpu, &inputs, options)?;
        let kept = (!fetch).then_some(vertices);
        Ok(Self { blas, records, buffers: [triangles, original].into_iter().chain(kept).collect() })
    }
}

/// Of each mesh, whether no material that it is placed with has holes: an any-hit shader is worth calling only
/// where it can say no.
fn opaque(scene: &Scene) -> Vec<bool> {
    let mut opaque = vec![true; scene.model.meshes.len()];
    for instance in &scene.instances {
        opaque[instance.mesh] &= !scene.model.materials[instance.material].has_cutout();
    }
    opaque
}

/// Which triangle of a mesh each primitive of the build is. A device may offer a triangle more than once,
/// unless that is ruled out.
pub fn triangle_order(gpu: &Gpu, mesh: &Mesh, options: SceneOptions) -> Vec<u32> {
    let order = order::for_build(gpu, &mesh.triangle_bounds(), options.ordering);
    if options.no_duplicate_any_hit { order } else { gpu.emulation.candidates(order) }
}
