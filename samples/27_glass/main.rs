//! 27 · Glass: a path goes on through a surface, and knows which body it is in.
//!
//! New since 11_path_tracing: rays that glass refracts and reflects; bodies that absorb, and that overlap; and
//! a light that a path meets by chance where no shadow ray can ask for it.

mod bodies;
mod glass;
mod scenes;

use std::process::ExitCode;

use anyhow::Result;
use ash::vk;
use common::gpu::{
    Address, Binding, Buffer, Descriptor, Gpu, HitGroup, RayTracingPipeline, Requirements,
    TextureTable, barrier,
};
use common::scene::{
    Camera, CameraBasis, DiskLight, Light, Look, PointLight, Scene, SceneAddresses, SceneOnGpu,
    input_usage,
};
use common::{Controls, Frame, Sample, Setup, Variant, Variants};
use glam::UVec3;
use glass::{Glass, media_at};
use scenes::{SceneName, Sky, Staged};

fn main() -> ExitCode {
    common::run::<Demo>(env!("CARGO_BIN_NAME"), instruments::all())
}

/// Maximum number of surfaces that a path leaves: clear glass ends none.
const MAX_DEPTH: u32 = 256;

struct Demo {
    source: Scene,
    scene: Scene,
    on_gpu: SceneOnGpu,
    glasses: Buffer,
    pipelines: Variants<Constants>,
    camera: Camera,
    lamp: PointLight,
    light_size: f32,
    name: SceneName,
    /// The scene that was built.
    built: SceneName,
    depth: u32,
    clamp: f32,
    seed: u32,
    constants: Constants,
    sums: Buffer,
    world: Buffer,
}

common::shader_enum! {
    /// The quantity shown per pixel: the last two belong to the last ray, where each surface lets through what it
    /// can.
    enum Show: SHOW { Picture, Origin = "last origin", Direction = "last direction" }
}

/// Specialization constants of a pipeline's shaders.
#[derive(Clone, Copy, PartialEq)]
struct Constants {
    show: Show,
    sky: Sky,
}

common::shader_struct! {
    /// Push constants of all shaders.
    struct Push {
        camera: CameraBasis,
        world: Address<World>,
        depth: u32,
        most: f32,
        seed: u32,
        sample_index: u32,
    }
}

common::shader_struct! {
    /// Data that stays constant while samples are added up.
    struct World {
        scene: SceneAddresses,
        glasses: Address<Glass>,
        sums: Address<PixelSum>,
        light: DiskLight,
        media: [u32; 4],
    }
}

common::shader_struct! {
    /// The samples of a pixel, added up.
    struct PixelSum {
        whole: UVec3,
        part: UVec3,
        count: u32,
    }
}

impl Sample for Demo {
    fn requirements() -> Requirements {
        Requirements::ray_tracing().textures()
    }

    fn new(gpu: &Gpu, setup: &Setup) -> Result<Self> {
        let source = setup.scene_with(&[Look::Mirror, Look::Glass], scenes::chess)?;
        let Staged { scene, lamp, sky } = Staged::new(SceneName::Chess, &source);
        let on_gpu = SceneOnGpu::new(gpu, &scene, setup.options)?;
        let usage = input_usage() | vk::BufferUsageFlags::TRANSFER_DST;
        Ok(Self {
            source,
            camera: scene.camera,
            glasses: glasses(gpu, &scene)?,
            scene,
            on_gpu,
            pipelines: Variants::default(),
            lamp,
            light_size: 1.0,
            name: SceneName::Chess,
            built: SceneName::Chess,
            depth: 32,
            clamp: 0.0,
            seed: 0,
            constants: Constants { show: Show::Picture, sky },
            sums: Buffer::new(gpu, "sums", 0, usage)?,
            world: Buffer::new(gpu, "world", size_of::<World>() as u64, usage)?,
        })
    }

    fn controls(&mut self, c: &mut Controls) {
        if c.choice("scene", &mut self.name) {
            let Staged { scene, lamp, sky } = Staged::new(self.name, &self.source);
            (self.camera, self.lamp, self.constants.sky) = (scene.camera, lamp, sky);
        }
        c.choice("show", &mut self.constants.show);
        c.choice("sky", &mut self.constants.sky);
        c.vector("lamp position", &mut self.lamp.position, -100.0..=100.0);
        c.slider("light size", &mut self.light_size, 0.0..=1.0);
        c.integer("depth", &mut self.depth, 0..=MAX_DEPTH);
        c.slider("clamp", &mut self.clamp, 0.0..=100.0);
        c.integer("seed", &mut self.seed, 0..=1000);
        c.camera(&mut self.camera);
    }

    fn changed(&mut self, gpu: &Gpu) -> Result<()> {
        if self.name != self.built {
            self.scene = Staged::new(self.name, &self.source).scene;
            self.on_gpu.rebuild(gpu, &self.scene, self.on_gpu.options)?;
            self.glasses = glasses(gpu, &self.scene)?;
            self.built = self.name;
        }
        Ok(())
    }

    fn render(&mut self, frame: &Frame) -> Result<()> {
        let extent = frame.image.extent;
        let size =
            u64::from(extent.width) * u64::from(extent.height) * size_of::<PixelSum>() as u64;
        if self.sums.size != size {
            let usage = input_usage() | vk::BufferUsageFlags::TRANSFER_DST;
            self.sums = Buffer::new(frame.gpu, "sums", size, usage)?;
        }
        let is_start = frame.accumulated == 0 && frame.is_first_band();
        if is_start {
            self.sums.clear(frame.cmd);
        }
        // The previous frame may still write its sums when this one begins to read them.
        barrier::trace_to_trace(frame.gpu, frame.cmd);
        if is_start {
            let light = Light::point(&self.lamp);
            let world = World {
                scene: self.on_gpu.addresses,
                glasses: self.glasses.address.into(),
                sums: self.sums.address.into(),
                // Each path asks for the light at one point of the disk.
                light: DiskLight { light, radius: self.light_size, samples: 1 },
                media: media_at(&self.scene, self.camera.eye),
            };
            self.world.update(frame.cmd, &[world])?;
        }
        // ANCHOR: trace
        let push = Push {
            camera: self.camera.basis(frame.aspect()),
            world: self.world.address.into(),
            depth: self.depth,
            most: self.clamp,
            seed: self.seed,
            sample_index: frame.index,
        };
        let descriptors = [
            Descriptor::AccelerationStructure(&self.on_gpu.tlas),
            Descriptor::StorageImage(frame.image),
        ];
        let Variant { pipeline, sbt, .. } =
            self.pipelines.choose(frame, &self.on_gpu.textures, self.constants, pipeline)?;
        pipeline.bind(frame.cmd, &descriptors, &push)?;
        sbt.trace(frame.cmd, frame.area);
        // ANCHOR_END: trace
        Ok(())
    }

    fn accumulates(&self) -> bool {
        true
    }
}

/// The glass of each material.
fn glasses(gpu: &Gpu, scene: &Scene) -> Result<Buffer> {
    let glasses: Vec<Glass> = scene.model.materials.iter().map(Glass::from).collect();
    Buffer::with_data(gpu, "glasses", &glasses, input_usage())
}

/// Raygen traces every ray of a path: however long that is, rays do not nest.
fn pipeline(
    gpu: &Gpu,
    textures: &TextureTable,
    constants: Constants,
) -> Result<RayTracingPipeline> {
    RayTracingPipeline::builder(env!("CARGO_BIN_NAME"))
        .raygen("camera.rgen")
        .miss("sky.rmiss")
        .miss("common/shadow.rmiss")
        .hit(HitGroup::triangles().closest_hit("shade.rchit"))
        .constant(0, constants.show)
        .constant(1, constants.sky)
        .recursion(1)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .textures(textures)
        .push_constants::<Push>()
        .build(gpu)
}
