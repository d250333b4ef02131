//! The device's way: micromaps that traversal itself reads, and the bottom and top levels that name them.

use std::collections::BTreeMap;

use anyhow::{Context, Result};
use common::gpu::{AccelerationStructure, Buffer, BuildOptions, Geometry, Gpu, OpacityMicromap};
use common::scene::{Scene, SceneOnGpu, Vertex, input_usage, triangle_order};

use crate::micromaps::Pair;

/// A scene whose cut-outs have micromaps.
pub struct OnDevice {
    /// All instances, with the same custom indices as in the scene's own.
    pub tlas: AccelerationStructure,
    // The structures behind the addresses in the top level, dropped after it.
    _blas: BTreeMap<Pair, (AccelerationStructure, OpacityMicromap)>,
}

impl OnDevice {
    /// The finest level that the device takes.
    ///
    /// # Errors
    /// If it knows no micromaps.
    pub fn finest(gpu: &Gpu) -> Result<u32> {
        let lacks = || {
            format!(
                "{} has no VK_KHR_opacity_micromap: use way=shader, where the any-hit shader reads the states",
                gpu.name
            )
        };
        OpacityMicromap::finest(gpu).with_context(lacks)
    }

    /// Builds them of the states of each pair of mesh and texture, packed, all of one level.
    ///
    /// # Errors
    /// If the device knows no micromaps, or memory is short.
    pub fn new(
        gpu: &Gpu,
        scene: &Scene,
        meshes: &SceneOnGpu,
        states: &BTreeMap<Pair, Vec<u8>>,
        level: u32,
    ) -> Result<Self> {
        let mut blas = BTreeMap::new();
        for (&pair, states) in states {
            blas.insert(pair, cut_out(gpu, scene, meshes, (pair.mesh, states), level)?);
        }
        let tlas = SceneOnGpu::top_level(gpu, scene, meshes.options, |index| {
            let pair = Pair::of(scene, index).and_then(|pair| blas.get(&pair));
            pair.map_or(&meshes.blas[scene.instances[index].mesh], |(blas, _)| blas)
        });
        Ok(Self { tlas: tlas?, _blas: blas })
    }
}

/// The bottom level of a mesh with a micromap, and the micromap.
fn cut_out(
    gpu: &Gpu,
    scene: &Scene,
    meshes: &SceneOnGpu,
    (index, states): (usize, &[u8]),
    level: u32,
) -> Result<(AccelerationStructure, OpacityMicromap)> {
    let (mesh, record) = (&scene.model.meshes[index], &meshes.meshes[index]);
    let order = triangle_order(gpu, mesh, meshes.options);
    let triangles: Vec<_> = order.iter().map(|&i| mesh.triangles[i as usize]).collect();
    // Only the build reads them.
    let triangles = Buffer::with_data(gpu, "ordered triangles", &triangles, input_usage())?;
    let geometry = Geometry::Triangles {
        vertices: record.vertices.into(),
        vertex_stride: size_of::<Vertex>() as u64,
        vertex_count: mesh.vertices.len() as u32,
        indices: triangles.address,
        count: order.len() as u32,
        opaque: false,
        no_duplicate_any_hit: meshes.options.no_duplicate_any_hit,
    };
    // ANCHOR: attach
    let micromap = OpacityMicromap::new(gpu, &mesh.name, states, level)?;
    // Primitive `i` of the build is triangle `original[i]` of the model, and has its states.
    let by_triangle = micromap.by_indices(record.original.into());
    let options = BuildOptions { micromap: Some(by_triangle), ..BuildOptions::default() };
    let blas = AccelerationStructure::bottom(gpu, &mesh.name, &[geometry], options)?;
    // ANCHOR_END: attach
    Ok((blas, micromap))
}
