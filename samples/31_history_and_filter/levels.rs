//! The top level of a scene with moving instances.

use anyhow::Result;
use ash::vk;
use common::UsageError;
use common::gpu::{AccelerationStructure, Buffer, BuildOptions, Geometry, Gpu, order};
use common::scene::{
    Scene, SceneOnGpu, SceneOptions, input_usage, instance_bytes, instance_on_gpu,
};
use glam::Affine3A;

use super::back::Back;
use super::moving::{Motion, moving, way};
use super::scenes::Game;

/// A pixel has 16 bits for its instance, and one number is the sky's.
const MOST: usize = 0xffff;

/// A scene on the device, and a top level that follows its moving instances.
pub struct Levels {
    /// Everything but the top level.
    pub scene: SceneOnGpu,
    /// The top level.
    pub tlas: AccelerationStructure,
    /// The motion of each instance since the last frame.
    pub back: Buffer,
    /// A bound on the error of a distance between two computed points of the scene.
    pub rounding: f32,
    host: Scene,
    /// The instance of each primitive of the build.
    order: Vec<u32>,
    instances: Buffer,
    scratch: Buffer,
    /// The transform of each instance at first, and now.
    homes: Vec<Affine3A>,
    placed: Vec<Affine3A>,
    /// The index of the instance that moves where no game is played, and the length of its way.
    moving: usize,
    way: f64,
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
        let back = Buffer::new(gpu, "back", u64::from(count) * size_of::<Back>() as u64, usage)?;
        let homes: Vec<_> = host.instances.iter().map(|instance| instance.transform).collect();
        let (moving, way, rounding) = (moving(&host), way(&host), rounding(&host));
        Ok(Self {
            scene,
            tlas,
            back,
            rounding,
            host,
            order,
            instances,
            scratch,
            placed: homes.clone(),
            homes,
            moving,
            way,
        })
    }

    /// The transforms of all instances at a frame.
    pub fn places(&self, motion: Motion, game: Option<&Game>, frame: u32) -> Vec<Affine3A> {
        let mut places = self.homes.clone();
        match game {
            Some(game) if motion.moves_pieces() => {
                let first = places.len() - game.legs.pieces.len();
                let pieces = places[first..].iter_mut().zip(game.legs.at(frame));
                pieces.for_each(|(place, piece)| *place = piece.at);
            }
            Some(_) => {}
            None => {
                let place = &mut places[self.moving];
                *place = motion.piece(place, self.way, frame);
            }
        }
        places
    }

    /// Records a move of the instances.
    ///
    /// # Errors
    /// If the update cannot be recorded.
    pub fn place(&mut self, cmd: vk::CommandBuffer, to: &[Affine3A]) -> Result<()> {
        if self.placed == to {
            return Ok(());
        }
        for (instance, to) in self.host.instances.iter_mut().zip(to) {
            instance.transform = *to;
        }
        self.instances.update(cmd, &instances(&self.host, &self.scene, &self.order))?;
        let count = self.order.len() as u32;
        let input = [Geometry::Instances { instances: self.instances.address, count }];
        self.tlas.update(cmd, &input, &self.scratch)?;
        self.placed = to.to_vec();
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
