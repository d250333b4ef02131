//! The scene on the device: bottom levels of every kind, and top levels over them.

use anyhow::Result;
use ash::vk;
use common::Frame;
use common::gpu::order::{self, around};
use common::gpu::{AccelerationStructure, Buffer, BuildOptions, Geometry, Gpu, padded};
use common::model::panorama::Panorama;
use common::scene::{
    Camera, Mesh, SceneOnGpu, boxes_on_gpu, build_top, build_updatable_top, input_usage,
    instance_bytes, transform,
};
use effects::{Composition, EmitterAddresses, Environment, Lamps, Sphere, Torus};
use glam::{Affine3A, Vec3};

use crate::microfacets::{MicrofacetRecord, RoughOnGpu};
use crate::normal_map::NormalMapRecord;
use crate::recipe::{GeometryKind, Recipe};
use crate::sky::{SkyOnGpu, SkyTable, Sum};
use crate::world::Shapes;

/// Everything rays can hit, except the plane.
pub struct SceneGeometry {
    /// Meshes, materials, textures.
    pub scene: SceneOnGpu,
    /// Addresses of the shapes.
    pub shapes: Shapes,
    /// Bound on the error of the distance between two computed points of the scene.
    pub rounding: f32,
    /// Bound on the distance from a ray's origin to a shape, which its box allows for.
    reach: f32,
    instances: Vec<Placed>,
    /// True if meshes move from frame to frame.
    moves: bool,
    /// A top level for each set of hit records needed by a pipeline.
    tops: Vec<Top>,
    _levels: Vec<AccelerationStructure>,
    _buffers: Vec<Buffer>,
    _rough: Option<RoughOnGpu>,
    _sky: Option<SkyOnGpu>,
}

/// A top level for the hit records of a pipeline.
struct Top {
    /// The cull mask of its pipeline.
    mask: u32,
    level: AccelerationStructure,
    /// The instances in the order of the build.
    order: Vec<u32>,
    /// Where they are.
    places: Vec<Affine3A>,
    /// The instances for an update, and its scratch memory, if anything moves.
    update: Option<(Buffer, Buffer)>,
}

/// An instance before it knows its hit record.
struct Placed {
    kind: GeometryKind,
    transform: Affine3A,
    custom_index: u32,
    address: vk::DeviceAddress,
    bounds: order::Bounds,
}

impl SceneGeometry {
    /// Uploads what the scene has, and nothing for what it has not.
    ///
    /// # Errors
    /// If memory is short.
    pub fn new(gpu: &Gpu, from: &Composition, scene: SceneOnGpu, camera: &Camera) -> Result<Self> {
        let mut geometry = Self {
            scene,
            shapes: Shapes::default(),
            rounding: rounding(from),
            reach: reach(from, camera),
            instances: Vec::new(),
            moves: from.motion.is_some(),
            tops: Vec::new(),
            _levels: Vec::new(),
            _buffers: Vec::new(),
            _rough: None,
            _sky: None,
        };
        let bounds = from.scene.bounds_of_instances();
        for ((index, instance), bounds) in from.scene.instances.iter().enumerate().zip(bounds) {
            geometry.instances.push(Placed {
                kind: GeometryKind::Mesh,
                transform: instance.transform,
                custom_index: index as u32,
                address: geometry.scene.blas[instance.mesh].address,
                bounds,
            });
        }
        let bounds: Vec<_> = from.spheres.iter().map(sphere_bounds).collect();
        let order = geometry.level(gpu, GeometryKind::Sphere, &bounds)?;
        geometry.shapes.spheres = geometry.records(gpu, "spheres", &from.spheres, &order)?;
        if let Some(lamps) = from.lamps()? {
            geometry.shapes.emitters = Some(geometry.lamps(gpu, &lamps, &order)?);
        }
        let bounds: Vec<_> = from.boxes.iter().map(|b| (b.low, b.high)).collect();
        let order = geometry.level(gpu, GeometryKind::Box, &bounds)?;
        geometry.shapes.boxes = geometry.records(gpu, "boxes", &from.boxes, &order)?;
        let order = geometry.level(gpu, GeometryKind::Solid, &from.solid_bounds)?;
        geometry.shapes.solids = geometry.records(gpu, "solids", &from.solids, &order)?;
        let as_they_come: Vec<u32> = (0..from.faces.len() as u32).collect();
        geometry.shapes.faces = geometry.records(gpu, "faces", &from.faces, &as_they_come)?;
        let order = geometry.level(gpu, GeometryKind::Strand, &from.strands.bounds())?;
        geometry.shapes.segments =
            geometry.records(gpu, "segments", &from.strands.segments, &order)?;
        let as_they_come: Vec<u32> = (0..from.strands.nodes.len() as u32).collect();
        geometry.shapes.nodes =
            geometry.records(gpu, "nodes", &from.strands.nodes, &as_they_come)?;
        let bounds: Vec<_> = from.tori.iter().map(Torus::bounds).collect();
        let order = geometry.level(gpu, GeometryKind::Torus, &bounds)?;
        geometry.shapes.tori = geometry.records(gpu, "tori", &from.tori, &order)?;
        let finishes = from.finishes_to_read();
        let as_they_come: Vec<u32> = (0..finishes.len() as u32).collect();
        geometry.shapes.finishes = geometry.records(gpu, "finishes", finishes, &as_they_come)?;
        let glasses = from.glasses_to_read();
        let as_they_come: Vec<u32> = (0..glasses.len() as u32).collect();
        geometry.shapes.glasses = geometry.records(gpu, "glasses", &glasses, &as_they_come)?;
        geometry.shapes.glass_count = glasses.len() as u32;
        let microfacets = from.microfacets_to_read().into_iter();
        let records: Vec<_> = microfacets.map(|own| MicrofacetRecord::new(own, -1.0)).collect();
        if !records.is_empty() {
            let rough = RoughOnGpu::new(gpu, &records)?;
            geometry.shapes.rough = rough.rough.address;
            geometry.shapes.rough_count = records.len() as u32;
            geometry._rough = Some(rough);
        }
        let maps = from.materials_to_map().iter();
        let maps: Vec<_> = maps.map(|m| NormalMapRecord::new(Some(m), 1.0)).collect();
        let as_they_come: Vec<u32> = (0..maps.len() as u32).collect();
        geometry.shapes.normal_maps = geometry.records(gpu, "normal maps", &maps, &as_they_come)?;
        geometry.shapes.map_count = maps.len() as u32;
        if let Some(environment) = &from.environment {
            let sky = SkyOnGpu::new(gpu, &table(environment))?;
            geometry.shapes.sky = sky.sky.address;
            geometry._sky = Some(sky);
        }
        let bounds: Vec<_> = from.heightfield.iter().map(crate::ground::bounds).collect();
        geometry.level(gpu, GeometryKind::Ground, &bounds)?;
        Ok(geometry)
    }

    /// Tests whether rays may begin at a camera.
    pub fn reaches(&self, from: &Composition, camera: &Camera) -> bool {
        reach(from, camera) <= self.reach
    }

    /// Moves the meshes to where a scene has them.
    pub fn place(&mut self, scene: &Composition) {
        // Instances begin with the scene's, in their order.
        for (placed, instance) in self.instances.iter_mut().zip(&scene.scene.instances) {
            placed.transform = instance.transform;
        }
    }

    /// Boxes for the intersection shader of a kind, near beside near; returns their order.
    fn level(
        &mut self,
        gpu: &Gpu,
        kind: GeometryKind,
        bounds: &[order::Bounds],
    ) -> Result<Vec<u32>> {
        let order = order::for_build(gpu, bounds, self.scene.options.ordering);
        if order.is_empty() {
            return Ok(order);
        }
        let boxes: Vec<[Vec3; 2]> =
            order.iter().map(|&i| padded(bounds[i as usize], self.reach)).collect();
        let input = boxes_on_gpu(gpu, "boxes of shapes", &boxes)?;
        let count = boxes.len() as u32;
        let input = Geometry::Aabbs { boxes: input.address, count, opaque: true };
        let options = BuildOptions { compact: true, ..BuildOptions::default() };
        let name = format!("{kind:?}");
        let blas = AccelerationStructure::bottom(gpu, &name, &[input], options)?;
        self.instances.push(Placed {
            kind,
            transform: Affine3A::IDENTITY,
            custom_index: 0,
            address: blas.address,
            bounds: around(bounds),
        });
        self._levels.push(blas);
        Ok(order)
    }

    /// Records in the order of the build; no buffer for none.
    fn records<T: bytemuck::Pod>(
        &mut self,
        gpu: &Gpu,
        name: &str,
        records: &[T],
        order: &[u32],
    ) -> Result<vk::DeviceAddress> {
        if records.is_empty() {
            return Ok(0);
        }
        let ordered: Vec<T> = order.iter().map(|&i| records[i as usize]).collect();
        let buffer = Buffer::with_data(gpu, name, &ordered, input_usage())?;
        let address = buffer.address;
        self._buffers.push(buffer);
        Ok(address)
    }

    /// Uploads the emitters; `order` is that of the spheres.
    fn lamps(&mut self, gpu: &Gpu, lamps: &Lamps, order: &[u32]) -> Result<EmitterAddresses> {
        let Lamps { emitters, of_instances, of_spheres } = lamps;
        let as_they_come = |count: usize| (0..count as u32).collect::<Vec<_>>();
        let (list, columns) = (&emitters.list, &emitters.table.columns);
        let instances = as_they_come(of_instances.len());
        Ok(EmitterAddresses {
            emitters: self.records(gpu, "emitters", list, &as_they_come(list.len()))?.into(),
            columns: self.records(gpu, "columns", columns, &as_they_come(columns.len()))?.into(),
            first: self.records(gpu, "emitters of instances", of_instances, &instances)?.into(),
            sphere_ids: self.records(gpu, "emitters of spheres", of_spheres, order)?.into(),
            count: list.len() as u32,
            column_count: columns.len() as u32,
        })
    }

    /// The top level whose instances name the hit records of a pipeline, and the bits of its cull mask. Records its
    /// update if something has moved.
    ///
    /// # Errors
    /// If memory is short.
    pub fn top_level(&mut self, frame: &Frame, recipe: Recipe) -> Result<&AccelerationStructure> {
        let gpu = frame.gpu;
        let known = self.tops.iter().position(|top| top.mask == recipe.mask());
        let place = known.unwrap_or(self.tops.len());
        let places: Vec<_> = self.instances.iter().map(|placed| placed.transform).collect();
        let on_device = |order: &[u32]| -> Vec<_> {
            order.iter().map(|&i| self.instances[i as usize].for_device(recipe)).collect()
        };
        if known.is_none() {
            let bounds: Vec<_> = self.instances.iter().map(|placed| placed.bounds).collect();
            let order = order::for_build(gpu, &bounds, self.scene.options.ordering);
            let instances = on_device(&order);
            let (level, update) = if self.moves {
                let level = build_updatable_top(gpu, &instances)?;
                let bytes: Vec<_> = instances.iter().map(instance_bytes).collect();
                let usage = input_usage() | vk::BufferUsageFlags::TRANSFER_DST;
                let buffer = Buffer::with_data(gpu, "moving instances", &bytes, usage)?;
                let scratch = level.scratch()?;
                (level, Some((buffer, scratch)))
            } else {
                (build_top(gpu, &instances)?, None)
            };
            self.tops.push(Top { mask: recipe.mask(), level, order, places, update });
        } else if let Top { level, order, places: before, update: Some((buffer, scratch)), .. } =
            &mut self.tops[place]
            && *before != places
        {
            let bytes: Vec<_> = on_device(order).iter().flat_map(instance_bytes).collect();
            buffer.update(frame.cmd, &bytes)?;
            let count = order.len() as u32;
            let input = [Geometry::Instances { instances: buffer.address, count }];
            level.update(frame.cmd, &input, scratch)?;
            *before = places;
        }
        Ok(&self.tops[place].level)
    }
}

impl Placed {
    fn for_device(&self, recipe: Recipe) -> vk::AccelerationStructureInstanceKHR {
        let mask = self.kind.mask() as u8;
        vk::AccelerationStructureInstanceKHR {
            transform: transform(&self.transform),
            instance_custom_index_and_mask: vk::Packed24_8::new(self.custom_index, mask),
            instance_shader_binding_table_record_offset_and_flags: vk::Packed24_8::new(
                recipe.record(self.kind),
                0,
            ),
            acceleration_structure_reference: vk::AccelerationStructureReferenceKHR {
                device_handle: self.address,
            },
        }
    }
}

/// The table that chooses directions of the sky, as bright as the scene has it.
fn table(environment: &Environment) -> SkyTable {
    let mut map = Panorama::clone(&environment.map);
    for part in map.texels.iter_mut().flatten() {
        *part *= environment.brightness;
    }
    SkyTable::new(&map, Sum::Exact)
}

/// Corners of the box around a sphere and its way, never inside it by rounding.
fn sphere_bounds(sphere: &Sphere) -> order::Bounds {
    let end = sphere.center + sphere.moves;
    let (low, high) = (sphere.center.min(end), sphere.center.max(end));
    let radius = sphere.radius + (low.abs().max(high.abs()).max_element() + sphere.radius) * 1.2e-7;
    (low - radius, high + radius)
}

/// Boxes around everything rays can hit except the plane, wherever it moves.
fn bounds(scene: &Composition) -> Vec<order::Bounds> {
    let meshes = scene.scene.bounds_of_instances().into_iter();
    let moving = scene.motion.iter().flat_map(|motion| motion.bounds(&scene.scene));
    let spheres = scene.spheres.iter().map(sphere_bounds);
    let boxes = scene.boxes.iter().map(|b| (b.low, b.high));
    let ground = scene.heightfield.iter().map(crate::ground::bounds);
    let solids = scene.solid_bounds.iter().copied();
    let strands = scene.strands.bounds();
    let tori = scene.tori.iter().map(Torus::bounds);
    let shapes = spheres.chain(boxes).chain(ground).chain(solids).chain(strands).chain(tori);
    meshes.chain(moving).chain(shapes).collect()
}

/// Bound on the distance by which rounding moves a point along a direction, for two points. On a mesh each is off by
/// 53 roundings of the largest coordinate per axis, as in 31, and on a shape by 76, as in report.glsl.
fn rounding(scene: &Composition) -> f32 {
    let meshes = scene.scene.model.meshes.iter().map(Mesh::bounds);
    let corners = bounds(scene).into_iter().chain(meshes).flat_map(|(low, high)| [low, high]);
    corners.map(|corner| corner.abs().max_element()).fold(0.0, f32::max) * 2f32.powi(-15)
}

/// Bound on the distance from a ray's origin to a shape: at the eye, on the plane below the eye, or
/// on the scene. Rounded up to a power of two, so that few steps of a camera change it.
fn reach(scene: &Composition, camera: &Camera) -> f32 {
    let eye = camera.eye.as_vec3();
    let orbits = scene.motion.as_ref().is_some_and(|motion| motion.orbit != 0.0);
    let way = if orbits { 2.0 * camera.eye.distance(camera.target) as f32 } else { 0.0 };
    let lens = 0.5 * scene.lens.diameter + way;
    let (low, high) = around(&[around(&bounds(scene)), (eye - lens, eye + lens)]);
    // A plane goes on beyond all that; a shadow's ray that begins ten times as far is a speck.
    let beyond = if scene.plane.is_some() { 10.0 } else { 1.0 };
    (beyond * (high - low).length().max(1.0)).log2().ceil().exp2()
}
