//! The top level of a scene with one moving instance.

use anyhow::Result;
use ash::vk;
use common::UsageError;
use common::gpu::{AccelerationStructure, Buffer, BuildOptions, Geometry, Gpu, order};
use common::scene::{
    Scene, SceneOnGpu, SceneOptions, input_usage, instance_bytes, instance_on_gpu,
};
use glam::Affine3A;

use super::moving::{moving, way};

/// A pixel has 16 bits for its instance, and one number is the sky's.
const MOST: usize = 0xffff;

/// A scene on the device, and a top level that follows its moving instance.
pub struct Levels {
    /// Everything but the top level.
    pub scene: SceneOnGpu,
    /// The top level.
    pub tlas: AccelerationStructure,
    /// The index of the moving instance.
    pub moving: usize,
    /// The length of its way.
    pub way: f64,
    /// A bound on the error of a distance between two computed points of the scene.
    pub rounding: f32,
    host: Scene,
    /// The instance of each primitive of the build.
    order: Vec<u32>,
    instances: Buffer,
    scratch: Buffer,
    placed: Affine3A,
}

impl Levels {
    /// Uploads a scene and builds its levels.
    ///
    /// # Errors
    /// If the scene has no instances or too many; if memory is short.
    pub fn new(gpu: &Gpu, host: Scene, options: SceneOptions) -> Result<Self> {
        let count = host.instances.len();
        if !(1..=MOST).contains(&count) {
            let line = format!("the scene has {count} instances: this chapter takes 1 to {MOST}");
            return Err(UsageError(line).into());
        }
        let scene = SceneOnGpu::new(gpu, &host, options)?;
        Self::with(gpu, host, scene)
    }

    /// Exchanges the scene for one with the same textures.
    ///
    /// # Errors
    /// If memory is short.
    pub fn rebuild(&mut self, gpu: &Gpu, host: Scene) -> Result<()> {
        let options = self.scene.options;
        let textures = Some(self.scene.textures.clone());
        let scene = SceneOnGpu::with_textures(gpu, &host, options, textures)?;
        *self = Self::with(gpu, host, scene)?;
        Ok(())
    }

    fn with(gpu: &Gpu, host: Scene, scene: SceneOnGpu) -> Result<Self> {
        let order = order::for_build(gpu, &host.bounds_of_instances(), scene.options.ordering);
        let bytes = instances(&host, &scene, &order);
        let usage = input_usage() | vk::BufferUsageFlags::TRANSFER_DST;
        let instances = Buffer::with_data(gpu, "instances", &bytes, usage)?;
        let options = BuildOptions { updatable: true, ..BuildOptions::default() };
        let count = order.len() as u32;
        let tlas = AccelerationStructure::top(gpu, "top level", &instances, count, options)?;
        let scratch = tlas.scratch()?;
        let moving = moving(&host);
        let placed = host.instances[moving].transform;
        let way = way(&host);
        let rounding = rounding(&host);
        Ok(Self { scene, tlas, moving, way, rounding, host, order, instances, scratch, placed })
    }

    /// The transform of the moving instance now.
    pub fn placed(&self) -> &Affine3A {
        &self.placed
    }

    /// Where the moving instance starts.
    pub fn home(&self, source: &Scene) -> Affine3A {
        source.instances[self.moving].transform
    }

    /// Records a move of the moving instance.
    ///
    /// # Errors
    /// If the update cannot be recorded.
    pub fn place(&mut self, cmd: vk::CommandBuffer, to: Affine3A) -> Result<()> {
        if self.placed == to {
            return Ok(());
        }
        self.host.instances[self.moving].transform = to;
        self.instances.update(cmd, &instances(&self.host, &self.scene, &self.order))?;
        let count = self.order.len() as u32;
        let input = [Geometry::Instances { instances: self.instances.address, count }];
        self.tlas.update(cmd, &input, &self.scratch)?;
        self.placed = to;
        Ok(())
    }
}

/// The instances in the order of the build. The custom index is that of the scene.
fn instances(host: &Scene, scene: &SceneOnGpu, order: &[u32]) -> Vec<u8> {
    let placed = order.iter().map(|&index| {
        let (index, instance) = (index as usize, &host.instances[index as usize]);
        let blas = &scene.blas[instance.mesh];
        instance_on_gpu(&instance.transform, index, instance.record_offset, blas)
    });
    placed.flat_map(|instance| instance_bytes(&instance)).collect()
}

/// The bound on the distance by which rounding moves a point of a scene along a direction, for two points.
///
/// Let R bound the coordinates in the world and in the mesh, and u = 2^-24. A point of a triangle is off by 13uR in
/// the mesh, because edges are at most 2R per axis; the transform multiplies that by at most √3 and adds a sum of
/// four terms, 11uR; the way back to the last frame adds another sum, 19uR. That is 53uR per axis, √3 times as much
/// along a direction, and twice that for two points: less than 2^-16 R.
fn rounding(scene: &Scene) -> f32 {
    let reach = scene.instances.iter().map(|instance| {
        let (low, high) = scene.instance_bounds(instance);
        let (inner_low, inner_high) = scene.model.meshes[instance.mesh].bounds();
        [low, high, inner_low, inner_high].map(|corner| corner.abs().max_element()).into_iter()
    });
    reach.flatten().fold(0.0, f32::max) * 2f32.powi(-16)
}
