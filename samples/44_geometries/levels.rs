//! Bottom levels of several geometries, for meshes in the same place.

use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

use anyhow::Result;
use common::gpu::order::{self, around};
use common::gpu::{
    AccelerationStructure, Buffer, BuildOptions, Geometry, Gpu, Limits, TextureTable,
};
use common::scene::{
    Instance, Mesh, Scene, SceneAddresses, SceneOnGpu, SceneOptions, build_top, input_usage,
    instance_on_gpu, moved_bounds, triangle_order,
};
use glam::Vec3;

common::shader_enum! {
    /// Bottom levels per place: one with all its meshes, or one per mesh.
    pub enum Levels { One, Many }
}

/// Sorts instances so that those with the same transform are neighbours. Returns the range of each place, with at
/// most `most` instances.
pub fn places(instances: &mut [Instance], most: usize) -> Vec<Range<usize>> {
    let key = |instance: &Instance| instance.transform.to_cols_array().map(f32::to_bits);
    let mut first = HashMap::new();
    for (index, instance) in instances.iter().enumerate() {
        first.entry(key(instance)).or_insert(index);
    }
    // Places are in the order of their first instance, and so are the instances of each.
    instances.sort_by_key(|instance| first[&key(instance)]);
    let mut places: Vec<Range<usize>> = Vec::new();
    for index in 0..instances.len() {
        match places.last_mut() {
            Some(place)
                if place.len() < most && key(&instances[place.start]) == key(&instances[index]) =>
            {
                place.end = index + 1;
            }
            _ => places.push(index..index + 1),
        }
    }
    places
}

/// The most geometries of a bottom level that a device allows.
pub fn most_geometries(limits: &Limits) -> usize {
    usize::try_from(limits.acceleration_structure.max_geometry_count).unwrap_or(usize::MAX)
}

/// A scene's levels on the device, and what shaders read of it.
pub struct LevelsOnGpu {
    /// The top level: an instance per place, or per mesh of a place.
    pub tlas: AccelerationStructure,
    /// The bottom levels.
    pub blas: Vec<AccelerationStructure>,
    /// The addresses of the scene's arrays.
    pub addresses: SceneAddresses,
    /// The textures.
    pub textures: Arc<TextureTable>,
    _buffers: Vec<Buffer>,
}

impl LevelsOnGpu {
    /// Uploads a scene and builds a bottom level for each different list of meshes in `places`.
    ///
    /// # Errors
    /// If the scene is wrong, a limit of the device is exceeded, or memory is short.
    pub fn new(
        gpu: &Gpu,
        scene: &Scene,
        places: &[Range<usize>],
        options: SceneOptions,
        textures: Option<Arc<TextureTable>>,
    ) -> Result<Self> {
        let meshes = &scene.model.meshes;
        let orders: Vec<_> = meshes.iter().map(|mesh| triangle_order(gpu, mesh, options)).collect();
        let (addresses, textures, _buffers) =
            SceneOnGpu::without_levels(gpu, scene, &orders, textures)?;

        // Only the builds read these copies; they are freed at the end of this function.
        let positions = meshes
            .iter()
            .map(|mesh| mesh.vertices.iter().map(|vertex| vertex.position).collect::<Vec<_>>());
        let ordered = meshes.iter().zip(&orders).map(|(mesh, order)| {
            order.iter().map(|&i| mesh.triangles[i as usize]).collect::<Vec<_>>()
        });
        let (_positions, vertices) =
            Buffer::with_arrays(gpu, "positions", positions, input_usage())?;
        let (_ordered, indices) =
            Buffer::with_arrays(gpu, "ordered triangles", ordered, input_usage())?;
        let (lists, level_of) = lists(&scene.instances, places);
        // ANCHOR: geometries
        let geometry = |&mesh: &usize| Geometry::Triangles {
            vertices: vertices[mesh],
            vertex_stride: size_of::<Vec3>() as u64,
            vertex_count: meshes[mesh].vertices.len() as u32,
            indices: indices[mesh],
            count: orders[mesh].len() as u32,
            opaque: true,
            no_duplicate_any_hit: false,
        };
        // The position in its level's list is a geometry's `gl_GeometryIndexEXT`.
        let levels = lists.iter().map(|list| list.iter().map(geometry).collect());
        let levels: Vec<Vec<Geometry>> = levels.collect();
        let names = lists.iter().map(|list| meshes[list[0]].name.as_str());
        let inputs: Vec<_> = names.zip(levels.iter().map(Vec::as_slice)).collect();
        let compact = BuildOptions { compact: true, ..BuildOptions::default() };
        let blas = AccelerationStructure::build(gpu, &inputs, compact)?;
        // ANCHOR_END: geometries

        // ANCHOR: instance
        let instance = |place: u32| {
            let (place, level) = (&places[place as usize], level_of[place as usize]);
            let first = &scene.instances[place.start];
            instance_on_gpu(&first.transform, place.start, first.record_offset, &blas[level])
        };
        // ANCHOR_END: instance
        let order = order::for_build(gpu, &bounds(scene, places), options.ordering);
        let tlas = build_top(gpu, &order.into_iter().map(instance).collect::<Vec<_>>())?;
        Ok(Self { tlas, blas, addresses, textures, _buffers })
    }
}

/// The different lists of meshes in the places, and which of them each place has. Places with the same meshes share a
/// bottom level.
fn lists(instances: &[Instance], places: &[Range<usize>]) -> (Vec<Vec<usize>>, Vec<usize>) {
    let mut lists = Vec::new();
    let mut known = HashMap::new();
    let list_of = places.iter().map(|place| {
        let list: Vec<usize> = instances[place.clone()].iter().map(|one| one.mesh).collect();
        *known.entry(list.clone()).or_insert_with(|| {
            lists.push(list);
            lists.len() - 1
        })
    });
    let list_of = list_of.collect();
    (lists, list_of)
}

/// The box around each place, in the world.
fn bounds(scene: &Scene, places: &[Range<usize>]) -> Vec<order::Bounds> {
    let of = |mesh: &Mesh| around(&mesh.triangle_bounds());
    let boxes: Vec<_> = scene.model.meshes.iter().map(of).collect();
    let placed = |instance: &Instance| moved_bounds(boxes[instance.mesh], &instance.transform);
    let place = |place: &Range<usize>| -> order::Bounds {
        around(&scene.instances[place.clone()].iter().map(placed).collect::<Vec<_>>())
    };
    places.iter().map(place).collect()
}
