//! 06 · Reflection: a hit sends the next ray on its way, from a loop or by recursion.
//!
//! New since 05_shadow_miss: a path of rays, which mirrors turn. A loop in the raygen shader traces it; or
//! the closest hit shader lights what it reports, and traces the next ray itself.

use std::process::ExitCode;

use anyhow::Result;
use common::gpu::{
    Binding, Descriptor, Gpu, HitGroup, RayTracingPipeline, Requirements, TextureTable,
};
use common::scene::{
    Camera, CameraBasis, Light, Scene, SceneAddresses, SceneOnGpu, ShadowRays, Sun,
};
use common::{Controls, Frame, Lighting, Sample, Setup, Variant, Variants};
use glam::Vec3;

fn main() -> ExitCode {
    instruments::run::<Demo>(env!("CARGO_BIN_NAME"))
}

const MAX_DEPTH: u32 = 8;

struct Demo {
    scene: SceneOnGpu,
    pipelines: Variants<Constants>,
    camera: Camera,
    lighting: Lighting,
    method: Method,
    depth: u32,
    deepest: u32,
    minimum_contribution: f32,
    bounce: u32,
    constants: Constants,
}

common::shader_enum! {
    /// What a pixel shows.
    enum Show: SHOW {
        Picture, Normal, Triangle, Hit, Direction = "ray direction", Shadow, Origin = "shadow origin",
    }
    /// What traces a path: a loop, or hits by recursion.
    enum Method { Iterative, Recursive }
}

/// What a pipeline is made for: the specialization constants of its shaders, and the method.
#[derive(Clone, Copy, PartialEq)]
struct Constants {
    show: Show,
    shadow_rays: ShadowRays,
    smooth_terminator: bool,
    /// How often a path may be reflected if hits trace the rays; `None` if a loop does.
    recursive: Option<u32>,
}

common::shader_struct! {
    /// What every shader of this chapter can read.
    struct Push {
        camera: CameraBasis,
        scene: SceneAddresses,
        light: Light,
        depth: u32,
        minimum_contribution: f32,
        bounce: u32,
    }
}

impl Sample for Demo {
    fn requirements() -> Requirements {
        Requirements::ray_tracing().textures()
    }

    fn new(gpu: &Gpu, setup: &Setup) -> Result<Self> {
        let scene = setup.scene_or(Scene::chess_of_metal)?;
        let camera = scene.camera;
        let scene = SceneOnGpu::new(gpu, &scene, setup.options)?;
        let sun = Sun { azimuth: 340.0, elevation: 20.0, radiance: Vec3::new(4.4, 3.5, 2.4) };
        Ok(Self {
            scene,
            pipelines: Variants::default(),
            camera,
            lighting: Lighting::new(sun),
            method: Method::Iterative,
            depth: 4,
            deepest: MAX_DEPTH.min(gpu.limits.max_ray_recursion_depth.saturating_sub(2)),
            minimum_contribution: 1.0 / 512.0,
            bounce: 0,
            constants: Constants {
                show: Show::Picture,
                shadow_rays: ShadowRays::FirstHit,
                smooth_terminator: true,
                recursive: None,
            },
        })
    }

    // ANCHOR: controls
    fn controls(&mut self, c: &mut Controls) {
        c.choice("show", &mut self.constants.show);
        self.lighting.controls(c);
        c.choice("shadow rays", &mut self.constants.shadow_rays);
        c.checkbox("smooth terminator", &mut self.constants.smooth_terminator);
        c.choice("method", &mut self.method);
        let deepest = if self.method == Method::Recursive { self.deepest } else { MAX_DEPTH };
        // What a loop may do can be too deep for this device's recursion.
        self.depth = self.depth.min(deepest);
        c.integer("depth", &mut self.depth, 0..=deepest);
        c.slider("minimum contribution", &mut self.minimum_contribution, 0.0..=1.0);
        c.integer("bounce", &mut self.bounce, 0..=MAX_DEPTH);
        c.camera(&mut self.camera);
    }
    // ANCHOR_END: controls

    fn render(&mut self, frame: &Frame) -> Result<()> {
        // ANCHOR: variant
        let recursive = (self.method == Method::Recursive).then_some(self.depth);
        let constants = Constants { recursive, ..self.constants };
        let Variant { key, pipeline, sbt } =
            self.pipelines.choose(frame, &self.scene.textures, constants, pipeline)?;
        // While a pipeline is made, the last one goes on, and no ray may nest deeper than it declares.
        let depth = key.recursive.unwrap_or(self.depth);
        // ANCHOR_END: variant
        // ANCHOR: trace
        let push = Push {
            camera: self.camera.basis(frame.aspect()),
            scene: self.scene.addresses,
            light: self.lighting.shader(),
            depth,
            minimum_contribution: self.minimum_contribution,
            bounce: self.bounce,
        };
        let descriptors = [
            Descriptor::AccelerationStructure(&self.scene.tlas),
            Descriptor::StorageImage(frame.image),
        ];
        pipeline.bind(frame.cmd, &descriptors, &push)?;
        sbt.trace(frame.cmd, frame.area);
        // ANCHOR_END: trace
        Ok(())
    }
}

// ANCHOR: pipeline
/// The method decides which shaders there are, and how deep their rays nest.
fn pipeline(
    gpu: &Gpu,
    textures: &TextureTable,
    constants: Constants,
) -> Result<RayTracingPipeline> {
    let (raygen, sky, hit, recursion) = match constants.recursive {
        None => ("camera.rgen", "sky.rmiss", "shade.rchit", 1),
        // The camera's ray and every reflection are a level each, and so is the last hit's shadow ray.
        Some(depth) => ("recursive.rgen", "recursive.rmiss", "recursive.rchit", 1 + depth + 1),
    };
    RayTracingPipeline::builder(env!("CARGO_BIN_NAME"))
        .raygen(raygen)
        .miss(sky)
        .miss("shadow.rmiss")
        .hit(HitGroup::triangles().closest_hit(hit))
        .constant(0, constants.show)
        .constant(1, constants.shadow_rays)
        .constant(2, constants.smooth_terminator)
        .recursion(recursion)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .textures(textures)
        .push_constants::<Push>()
        .build(gpu)
}
// ANCHOR_END: pipeline
