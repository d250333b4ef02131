//! 11 · Path tracing: the loop goes on where light is scattered, and the mean of many paths is the picture.
//!
//! New since 06_reflection: a surface sends a path on in a direction by chance; sequences that place those
//! chances; roulette, which ends a path without a bias; a sum of samples that nothing is lost from; and
//! scenes whose light is known in closed form.

mod closed_forms;
mod scenes;

use std::process::ExitCode;

use anyhow::Result;
use ash::vk;
use common::gpu::{
    Address, Binding, Buffer, Descriptor, Gpu, HitGroup, RayTracingPipeline, Requirements,
    TextureTable, barrier,
};
use common::scene::{Camera, CameraBasis, Light, Scene, SceneAddresses, SceneOnGpu, input_usage};
use common::{Controls, Frame, Lighting, Sample, Setup, Variant, Variants};
use glam::UVec3;
use scenes::{SceneName, Sky, Staged};

fn main() -> ExitCode {
    instruments::run::<Demo>(env!("CARGO_BIN_NAME"))
}

/// How often a path may be reflected at most. If each surface takes 5 % of
/// its light, less than 2·10^-6 of it is left by then.
const MAX_DEPTH: u32 = 256;

struct Demo {
    source: Scene,
    scene: SceneOnGpu,
    pipelines: Variants<Constants>,
    camera: Camera,
    lighting: Lighting,
    name: SceneName,
    /// The scene that was built.
    built: SceneName,
    depth: u32,
    minimum_contribution: f32,
    clamp: f32,
    seed: u32,
    constants: Constants,
    sums: Buffer,
    can_reorder: bool,
}

common::shader_enum! {
    /// What a pixel shows.
    enum Show: SHOW { Picture, Direct, Bounced, Rays }
    /// What random numbers are made of.
    enum Sequence: SEQUENCE { Random, Unshuffled = "Sobol unshuffled", Shuffled = "Sobol" }
    /// How samples are added up.
    enum Sum: SUM { Integers, Floats }
}

/// What a pipeline is made for: the specialization constants of its shaders.
#[derive(Clone, Copy, PartialEq)]
struct Constants {
    show: Show,
    sky: Sky,
    sequence: Sequence,
    roulette: bool,
    sum: Sum,
    /// Whether threads may change places; only where the device lets them.
    reorder: bool,
}

common::shader_struct! {
    /// What every shader of this chapter can read.
    struct Push {
        camera: CameraBasis,
        scene: SceneAddresses,
        sums: Address<PixelSum>,
        light: Light,
        depth: u32,
        minimum_contribution: f32,
        most: f32,
        seed: u32,
        sample_index: u32,
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
        Requirements::ray_tracing().textures().invocation_reorder_where_offered()
    }

    fn new(gpu: &Gpu, setup: &Setup) -> Result<Self> {
        let source = setup.scene_or(scenes::chess)?;
        let Staged { scene, sun, lamp, sky } = Staged::new(SceneName::Chess, &source);
        let camera = scene.camera;
        let scene = SceneOnGpu::new(gpu, &scene, setup.options)?;
        // Each path asks for the light at one point of it.
        let lighting = Lighting { lamp, size: 0.03, samples: 1, ..Lighting::new(sun) };
        Ok(Self {
            source,
            scene,
            pipelines: Variants::default(),
            camera,
            lighting,
            name: SceneName::Chess,
            built: SceneName::Chess,
            depth: 16,
            minimum_contribution: 0.0,
            clamp: 0.0,
            seed: 0,
            constants: Constants {
                show: Show::Picture,
                sky,
                sequence: Sequence::Shuffled,
                roulette: true,
                sum: Sum::Integers,
                reorder: false,
            },
            can_reorder: gpu.invocation_reorder,
            sums: Buffer::new(gpu, "sums", 0, input_usage())?,
        })
    }

    // ANCHOR: controls
    fn controls(&mut self, c: &mut Controls) {
        if c.choice("scene", &mut self.name) {
            self.take_scene();
        }
        c.choice("show", &mut self.constants.show);
        c.choice("sky", &mut self.constants.sky);
        self.lighting.controls(c);
        c.integer("depth", &mut self.depth, 0..=MAX_DEPTH);
        c.slider("minimum contribution", &mut self.minimum_contribution, 0.0..=1.0);
        c.checkbox("roulette", &mut self.constants.roulette);
        c.slider("clamp", &mut self.clamp, 0.0..=100.0);
        c.choice("sequence", &mut self.constants.sequence);
        c.integer("seed", &mut self.seed, 0..=1000);
        c.choice("sum", &mut self.constants.sum);
        if self.can_reorder {
            c.checkbox("reorder", &mut self.constants.reorder);
        }
        c.camera(&mut self.camera);
    }
    // ANCHOR_END: controls

    fn changed(&mut self, gpu: &Gpu) -> Result<()> {
        if self.name != self.built {
            let Staged { scene, .. } = Staged::new(self.name, &self.source);
            self.scene.rebuild(gpu, &scene, self.scene.options)?;
            self.built = self.name;
        }
        Ok(())
    }

    fn render(&mut self, frame: &Frame) -> Result<()> {
        // ANCHOR: sums
        let extent = frame.image.extent;
        let size =
            u64::from(extent.width) * u64::from(extent.height) * size_of::<PixelSum>() as u64;
        if self.sums.size != size {
            let usage = input_usage() | vk::BufferUsageFlags::TRANSFER_DST;
            self.sums = Buffer::new(frame.gpu, "sums", size, usage)?;
        }
        if frame.accumulated == 0 && frame.is_first_band() {
            self.sums.clear(frame.cmd);
        }
        // The frame before may still write its sums when this one begins to read them.
        barrier::trace_to_trace(frame.gpu, frame.cmd);
        // ANCHOR_END: sums
        // ANCHOR: trace
        let push = Push {
            camera: self.camera.basis(frame.aspect()),
            scene: self.scene.addresses,
            sums: self.sums.address.into(),
            light: self.lighting.shader(),
            depth: self.depth,
            minimum_contribution: self.minimum_contribution,
            most: self.clamp,
            seed: self.seed,
            sample_index: frame.index,
        };
        let descriptors = [
            Descriptor::AccelerationStructure(&self.scene.tlas),
            Descriptor::StorageImage(frame.image),
        ];
        let Variant { pipeline, sbt, .. } =
            self.pipelines.choose(frame, &self.scene.textures, self.constants, pipeline)?;
        pipeline.bind(frame.cmd, &descriptors, &push)?;
        sbt.trace(frame.cmd, frame.area);
        // ANCHOR_END: trace
        Ok(())
    }

    fn accumulates(&self) -> bool {
        true
    }
}

impl Demo {
    /// Takes over what a scene brings: view, lights and sky.
    fn take_scene(&mut self) {
        let Staged { scene, sun, lamp, sky } = Staged::new(self.name, &self.source);
        self.camera = scene.camera;
        (self.lighting.sun, self.lighting.lamp, self.constants.sky) = (sun, lamp, sky);
    }
}

// ANCHOR: pipeline
/// Raygen traces every ray of a path: however long that is, rays do not nest.
fn pipeline(
    gpu: &Gpu,
    textures: &TextureTable,
    constants: Constants,
) -> Result<RayTracingPipeline> {
    let builder = RayTracingPipeline::builder(env!("CARGO_BIN_NAME"));
    // A shader that has the words of an extension can be loaded only where that is.
    let builder = if constants.reorder { builder.define("REORDER", 1) } else { builder };
    builder
        .raygen("camera.rgen")
        .miss("sky.rmiss")
        .miss("shadow.rmiss")
        .hit(HitGroup::triangles().closest_hit("shade.rchit"))
        .constant(0, constants.show)
        .constant(1, constants.sky)
        .constant(2, constants.sequence)
        .constant(3, constants.roulette)
        .constant(4, constants.sum)
        .recursion(1)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .textures(textures)
        .push_constants::<Push>()
        .build(gpu)
}
// ANCHOR_END: pipeline
