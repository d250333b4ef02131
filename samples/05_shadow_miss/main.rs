//! 05 · Shadow miss: a second ray checks whether the sun is visible; its miss shader sets one bool.
//!
//! New since 02_basic: the miss shader `shadow.rmiss`, the ray flags of a shadow ray, and an offset that lifts its
//! origin off the surface. The hit shader reports the hit, and the raygen shader traces every ray.

use std::process::ExitCode;

use anyhow::Result;
use common::gpu::{
    Binding, Descriptor, Gpu, HitGroup, RayTracingPipeline, Requirements, TextureTable,
};
use common::scene::{
    Camera, CameraBasis, DirectionalLight, Scene, SceneAddresses, SceneOnGpu, Sun,
};
use common::{Controls, Frame, Sample, Setup, Variant, Variants};
use glam::Vec3;

fn main() -> ExitCode {
    common::run::<Demo>(env!("CARGO_BIN_NAME"), instruments::all())
}

struct Demo {
    scene: SceneOnGpu,
    pipelines: Variants<Show>,
    camera: Camera,
    sun: Sun,
    offset: f32,
    show: Show,
}

common::shader_enum! {
    /// The quantity shown per pixel.
    enum Show: SHOW {
        Picture, Normal, Triangle, Hit, Direction = "ray direction", Shadow, Origin = "shadow origin",
    }
}

common::shader_struct! {
    /// Push constants of all shaders.
    struct Push {
        camera: CameraBasis,
        scene: SceneAddresses,
        light: DirectionalLight,
        offset: f32,
    }
}

impl Sample for Demo {
    fn requirements() -> Requirements {
        Requirements::ray_tracing().textures()
    }

    fn new(gpu: &Gpu, setup: &Setup) -> Result<Self> {
        let scene = setup.scene_or(Scene::chess)?;
        let camera = scene.camera;
        let scene = SceneOnGpu::new(gpu, &scene, setup.options)?;
        let sun = Sun { azimuth: 60.0, elevation: 17.0, radiance: Vec3::new(4.4, 3.5, 2.4) };
        Ok(Self {
            scene,
            pipelines: Variants::default(),
            camera,
            sun,
            offset: 1e-3,
            show: Show::Picture,
        })
    }

    fn controls(&mut self, c: &mut Controls) {
        c.choice("show", &mut self.show);
        c.sun(&mut self.sun);
        c.slider("offset", &mut self.offset, 0.0..=0.1);
        c.camera(&mut self.camera);
    }

    fn render(&mut self, frame: &Frame) -> Result<()> {
        // ANCHOR: trace
        let push = Push {
            camera: self.camera.basis(frame.aspect()),
            scene: self.scene.addresses,
            light: self.sun.light(),
            offset: self.offset,
        };
        let descriptors = [
            Descriptor::AccelerationStructure(&self.scene.tlas),
            Descriptor::StorageImage(frame.image),
        ];
        let Variant { pipeline, sbt, .. } =
            self.pipelines.choose(frame, &self.scene.textures, self.show, pipeline)?;
        pipeline.bind(frame.cmd, &descriptors, &push)?;
        sbt.trace(frame.cmd, frame.area);
        // ANCHOR_END: trace
        Ok(())
    }
}

/// Only the raygen shader traces rays: they do not nest, and a recursion depth of 1 is enough.
fn pipeline(gpu: &Gpu, textures: &TextureTable, show: Show) -> Result<RayTracingPipeline> {
    RayTracingPipeline::builder(env!("CARGO_BIN_NAME"))
        .raygen("camera.rgen")
        .miss("common/sky.rmiss")
        .miss("common/shadow.rmiss")
        .hit(HitGroup::triangles().closest_hit("shade.rchit"))
        .constant(0, show)
        .recursion(1)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .textures(textures)
        .push_constants::<Push>()
        .build(gpu)
}
