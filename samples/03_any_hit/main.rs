//! 03 · Any-hit: a shader that may say "not here", and why order must not matter to it.
//!
//! New since 02_basic: the any-hit shader `decide.rahit`, cut-outs, transparency at random, and a
//! buffer that lists every surface that a ray crosses.

mod hits;

use std::process::ExitCode;

use anyhow::Result;
use ash::vk;
use common::gpu::{
    Address, Binding, Buffer, Descriptor, Gpu, HitGroup, RayTracingPipeline, Requirements,
    TextureTable, barrier,
};
use common::scene::{
    Camera, CameraBasis, DirectionalLight, Look, Scene, SceneAddresses, SceneOnGpu, SceneOptions,
    Sun,
};
use common::{Controls, Frame, Sample, Setup, Variant, Variants};

fn main() -> ExitCode {
    common::run::<Demo>(env!("CARGO_BIN_NAME"), instruments::all())
}

struct Demo {
    source: Scene,
    scene: SceneOnGpu,
    pipelines: Variants<Constants>,
    camera: Camera,
    sun: Sun,
    constants: Constants,
    opacity: f32,
    samples: u32,
    invocations: u32,
    layer: u32,
    options: SceneOptions,
    hits: Buffer,
}

common::shader_enum! {
    /// The quantity shown per pixel.
    enum Show: SHOW { Picture, Normal, Triangle, Hit, Direction = "ray direction" }
    /// The rule by which the any-hit shader decides.
    enum Mode: MODE { Opaque, Cutout = "cut-out", Random, Naive = "naive random", AllHits }
}

/// Specialization constants of a pipeline's shaders.
#[derive(Clone, Copy, PartialEq)]
struct Constants {
    show: Show,
    mode: Mode,
}

common::shader_struct! {
    /// Push constants of all shaders.
    struct Push {
        camera: CameraBasis,
        scene: SceneAddresses,
        light: DirectionalLight,
        opacity: f32,
        samples: u32,
        invocations: u32,
        layer: u32,
        hits: Address<hits::ListedHit>,
    }
}

impl Sample for Demo {
    fn requirements() -> Requirements {
        Requirements::ray_tracing().textures()
    }

    fn new(gpu: &Gpu, setup: &Setup) -> Result<Self> {
        let mut source = setup.scene_with(&[Look::Holes], Scene::chess)?;
        // Less than opaque, so that the build leaves the pieces to the any-hit shader.
        for material in &mut source.model.materials {
            if ["white", "black"].contains(&material.name.as_str()) {
                material.opacity = 0.5;
            }
        }
        let camera = source.camera;
        let scene = SceneOnGpu::new(gpu, &source, setup.options)?;
        Ok(Self {
            source,
            scene,
            pipelines: Variants::default(),
            camera,
            sun: Sun::default(),
            constants: Constants { show: Show::Picture, mode: Mode::Cutout },
            opacity: 0.4,
            samples: 16,
            invocations: 1,
            layer: 0,
            options: setup.options,
            hits: hits::list(gpu, 0)?,
        })
    }

    fn controls(&mut self, c: &mut Controls) {
        c.choice("show", &mut self.constants.show);
        c.choice("mode", &mut self.constants.mode);
        c.slider("opacity", &mut self.opacity, 0.0..=1.0);
        c.integer("samples", &mut self.samples, 1..=256);
        c.integer("invocations", &mut self.invocations, 1..=4);
        c.integer("layer", &mut self.layer, 0..=hits::MAX_HITS - 1);
        c.checkbox("no duplicates", &mut self.options.no_duplicate_any_hit);
        c.sun(&mut self.sun);
        c.camera(&mut self.camera);
    }

    fn changed(&mut self, gpu: &Gpu) -> Result<()> {
        if self.options != self.scene.options {
            self.scene.rebuild(gpu, &self.source, self.options)?;
        }
        Ok(())
    }

    fn render(&mut self, frame: &Frame) -> Result<()> {
        // ANCHOR: hits
        let vk::Extent2D { width, height } = frame.image.extent;
        let is_listed = self.constants.mode == Mode::AllHits;
        let rays = if is_listed { u64::from(width) * u64::from(height) } else { 0 };
        if self.hits.size < hits::size(rays) {
            self.hits = hits::list(frame.gpu, rays)?;
        }
        // The previous frame may still write the list when this one begins.
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
            self.pipelines.choose(frame, &self.scene.textures, self.constants, pipeline)?;
        pipeline.bind(frame.cmd, &descriptors, &push)?;
        sbt.trace(frame.cmd, frame.area);
        // ANCHOR_END: trace
        Ok(())
    }
}

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
