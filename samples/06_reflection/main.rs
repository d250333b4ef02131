//! 06 · Reflection: a hit sends the next ray on its way, from a loop or by recursion.
//!
//! New since 41_ray_offset: a path of rays, which mirrors turn. A loop in the raygen shader traces it; or
//! the closest hit shader lights what it reports, and traces the next ray itself (`recursion.rs`).

mod recursion;

use std::process::ExitCode;

use anyhow::Result;
use common::gpu::{
    Binding, Descriptor, Gpu, HitGroup, RayTracingPipeline, Requirements, TextureTable,
};
use common::scene::{
    Camera, CameraBasis, DirectionalLight, Look, Scene, SceneAddresses, SceneOnGpu, Sun,
};
use common::{Controls, Frame, Sample, Setup, Variant, Variants};
use glam::Vec3;
use recursion::Recursion;

fn main() -> ExitCode {
    common::run::<Demo>(env!("CARGO_BIN_NAME"), instruments::all())
}

/// Maximum number of reflections of a path.
const MAX_DEPTH: u32 = 8;

struct Demo {
    scene: SceneOnGpu,
    pipelines: Variants<Constants>,
    camera: Camera,
    sun: Sun,
    recursion: Recursion,
    depth: u32,
    minimum_contribution: f32,
    bounce: u32,
    show: Show,
}

common::shader_enum! {
    /// The quantity shown per pixel.
    enum Show: SHOW {
        Picture, Normal, Triangle, Hit, Direction = "ray direction", Shadow, Origin = "shadow origin",
    }
}

/// The specialization constant of a pipeline's shaders, and the method.
#[derive(Clone, Copy, PartialEq)]
struct Constants {
    show: Show,
    /// Maximum number of reflections of a path if hits trace the rays; `None` if a loop does.
    recursive: Option<u32>,
}

common::shader_struct! {
    /// Push constants of all shaders.
    struct Push {
        camera: CameraBasis,
        scene: SceneAddresses,
        light: DirectionalLight,
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
        let scene = setup.scene_with(&[Look::Mirror], Scene::chess_of_metal)?;
        let camera = scene.camera;
        let scene = SceneOnGpu::new(gpu, &scene, setup.options)?;
        let sun = Sun { azimuth: 340.0, elevation: 20.0, radiance: Vec3::new(4.4, 3.5, 2.4) };
        Ok(Self {
            scene,
            pipelines: Variants::default(),
            camera,
            sun,
            recursion: Recursion::new(gpu),
            depth: 4,
            minimum_contribution: 1.0 / 512.0,
            bounce: 0,
            show: Show::Picture,
        })
    }

    fn controls(&mut self, c: &mut Controls) {
        c.choice("show", &mut self.show);
        c.sun(&mut self.sun);
        let deepest = self.recursion.controls(c);
        // A depth that the loop allows can be too deep for this device's recursion.
        self.depth = self.depth.min(deepest);
        c.integer("depth", &mut self.depth, 0..=deepest);
        c.slider("minimum contribution", &mut self.minimum_contribution, 0.0..=1.0);
        c.integer("bounce", &mut self.bounce, 0..=MAX_DEPTH);
        c.camera(&mut self.camera);
    }

    fn render(&mut self, frame: &Frame) -> Result<()> {
        // ANCHOR: variant
        let recursive = self.recursion.nested(self.depth);
        let wanted = Constants { show: self.show, recursive };
        let Variant { key, pipeline, sbt } =
            self.pipelines.choose(frame, &self.scene.textures, wanted, recursion::pipeline)?;
        // While a pipeline is made, the last one goes on, and no ray may nest deeper than it declares.
        let depth = key.recursive.unwrap_or(self.depth);
        // ANCHOR_END: variant
        // ANCHOR: trace
        let push = Push {
            camera: self.camera.basis(frame.aspect()),
            scene: self.scene.addresses,
            light: self.sun.light(),
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

/// Only the raygen shader traces rays: however long a path is, its rays do not nest.
fn pipeline(
    gpu: &Gpu,
    textures: &TextureTable,
    constants: Constants,
) -> Result<RayTracingPipeline> {
    RayTracingPipeline::builder(env!("CARGO_BIN_NAME"))
        .raygen("camera.rgen")
        .miss("common/sky.rmiss")
        .miss("common/shadow.rmiss")
        .hit(HitGroup::triangles().closest_hit("shade.rchit"))
        .constant(0, constants.show)
        .recursion(1)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .textures(textures)
        .push_constants::<Push>()
        .build(gpu)
}
