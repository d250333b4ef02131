//! 03 · Any-hit: a shader that may say "not here", and why order must not matter to it.
//!
//! New since 02_basic: the any-hit shader `decide.rahit`, cut-outs, transparency at random, and a
//! buffer that lists every surface that a ray crosses.

use std::process::ExitCode;

use anyhow::Result;
use ash::vk;
use common::gpu::{
    Address, Binding, Buffer, Descriptor, Gpu, HitGroup, RayTracingPipeline, Requirements,
    TextureTable, Variant, Variants, barrier,
};
use common::scene::{
    Camera, CameraBasis, DirectionalLight, Scene, SceneAddresses, SceneOnGpu, Sun,
};
use common::{Controls, Frame, Sample, Setup};

fn main() -> ExitCode {
    common::run::<Demo>(env!("CARGO_BIN_NAME"))
}

/// How many hits of a ray the list has room for; the same number is in `push.glsl`.
const MAX_HITS: u64 = 32;
/// Bytes of a hit in the list: instance, triangle, distance.
const HIT_SIZE: u64 = 12;
/// The mode that lists hits.
const ALL_HITS: u32 = 4;

struct Demo {
    model: Scene,
    scene: SceneOnGpu,
    pipelines: Variants<Constants>,
    camera: Camera,
    sun: Sun,
    constants: Constants,
    opacity: f32,
    samples: u32,
    invocations: u32,
    layer: u32,
    no_duplicates: bool,
    hits: Buffer,
}

/// What a pipeline is made for: the specialization constants of its shaders.
#[derive(Clone, Copy, PartialEq)]
struct Constants {
    show: u32,
    mode: u32,
}

common::shader_struct! {
    /// What every shader of this chapter can read.
    struct Push {
        camera: CameraBasis,
        scene: SceneAddresses,
        light: DirectionalLight,
        opacity: f32,
        samples: u32,
        invocations: u32,
        layer: u32,
        hits: Address,
    }
}

impl Sample for Demo {
    fn requirements() -> Requirements {
        Requirements::ray_tracing().textures()
    }

    fn new(gpu: &Gpu, setup: &Setup) -> Result<Self> {
        let mut model = setup.scene_or(Scene::chess)?;
        // ANCHOR: pieces
        // Less than opaque, so that the build leaves the pieces to the any-hit shader.
        for material in &mut model.model.materials {
            if ["white", "black"].contains(&material.name.as_str()) {
                material.opacity = 0.5;
            }
        }
        // ANCHOR_END: pieces
        let camera = model.camera;
        let scene = SceneOnGpu::new(gpu, &model, setup.options)?;
        Ok(Self {
            model,
            scene,
            pipelines: Variants::default(),
            camera,
            sun: Sun::default(),
            constants: Constants { show: 0, mode: 1 },
            opacity: 0.4,
            samples: 16,
            invocations: 1,
            layer: 0,
            no_duplicates: false,
            hits: hit_list(gpu, 0)?,
        })
    }

    // ANCHOR: controls
    fn controls(&mut self, c: &mut Controls) {
        let views = ["picture", "normal", "triangle", "hit", "ray direction"];
        c.choice("show", &mut self.constants.show, &views);
        let modes = ["opaque", "cut-out", "random", "naive random", "all hits"];
        c.choice("mode", &mut self.constants.mode, &modes);
        c.slider("opacity", &mut self.opacity, 0.0..=1.0);
        c.integer("samples", &mut self.samples, 1..=256);
        c.integer("invocations", &mut self.invocations, 1..=4);
        c.integer("layer", &mut self.layer, 0..=MAX_HITS as u32 - 1);
        c.checkbox("no duplicates", &mut self.no_duplicates);
        c.slider("sun azimuth", &mut self.sun.azimuth, 0.0..=360.0);
        c.slider("sun elevation", &mut self.sun.elevation, 0.0..=90.0);
        c.camera(&mut self.camera);
    }
    // ANCHOR_END: controls

    fn render(&mut self, frame: &Frame) -> Result<()> {
        // ANCHOR: rebuild
        let mut options = self.scene.options;
        options.no_duplicate_any_hit = self.no_duplicates;
        if options != self.scene.options {
            self.scene.rebuild(frame.gpu, &self.model, options)?;
        }
        // ANCHOR_END: rebuild
        // ANCHOR: hits
        let vk::Extent2D { width, height } = frame.image.extent;
        let rays =
            if self.constants.mode == ALL_HITS { u64::from(width) * u64::from(height) } else { 0 };
        if self.hits.size < rays * MAX_HITS * HIT_SIZE {
            self.hits = hit_list(frame.gpu, rays)?;
        }
        // The frame before may still write the list when this one begins.
        barrier::trace_to_trace(frame.gpu, frame.cmd);
        // ANCHOR_END: hits
        // ANCHOR: trace
        let push = Push {
            camera: self.camera.basis(frame.aspect()),
            scene: self.scene.addresses,
            light: self.sun.light(),
            opacity: self.opacity,
            samples: self.samples,
            invocations: self.invocations,
            layer: self.layer,
            hits: self.hits.address.into(),
        };
        let descriptors = [
            Descriptor::AccelerationStructure(&self.scene.tlas),
            Descriptor::StorageImage(frame.image),
        ];
        let Variant { pipeline, sbt, .. } =
            self.pipelines.choose(frame.gpu, &self.scene.textures, self.constants, pipeline)?;
        pipeline.bind(frame.cmd, &descriptors, &push)?;
        sbt.trace(frame.cmd, frame.image.extent);
        // ANCHOR_END: trace
        Ok(())
    }
}

// ANCHOR: pipeline
/// The pipeline for the shaders' constants.
fn pipeline(
    gpu: &Gpu,
    textures: &TextureTable,
    constants: Constants,
) -> Result<RayTracingPipeline> {
    RayTracingPipeline::builder(env!("CARGO_BIN_NAME"))
        .raygen("camera.rgen")
        .miss("sky.rmiss")
        .hit(HitGroup::triangles().closest_hit("shade.rchit").any_hit("decide.rahit"))
        .constant(0, constants.show)
        .constant(1, constants.mode)
        .recursion(1)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .textures(textures)
        .push_constants::<Push>()
        .build(gpu)
}
// ANCHOR_END: pipeline

/// A list of hits for so many rays.
fn hit_list(gpu: &Gpu, rays: u64) -> Result<Buffer> {
    let usage = vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS;
    Buffer::new(gpu, "hits", rays * MAX_HITS * HIT_SIZE, usage)
}
