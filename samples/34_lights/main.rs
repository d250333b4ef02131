//! 34 · Lights: a light gives a direction, a strength and the ray's end.
//!
//! New since 41_ray_offset: `Light`, which is the sun or a lamp at a place; its strength falls with the distance, and
//! the shadow ray ends at it.

use std::process::ExitCode;

use anyhow::Result;
use common::gpu::{
    Binding, Descriptor, Gpu, HitGroup, RayTracingPipeline, Requirements, TextureTable,
};
use common::scene::{
    Camera, CameraBasis, Light, LightKind, Scene, SceneAddresses, SceneOnGpu, Sun,
};
use common::{Controls, Frame, Lighting, Sample, Setup, Variant, Variants};
use glam::Vec3;

fn main() -> ExitCode {
    common::run::<Demo>(env!("CARGO_BIN_NAME"), instruments::all())
}

struct Demo {
    scene: SceneOnGpu,
    pipelines: Variants<Show>,
    camera: Camera,
    lighting: Lighting,
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
        light: Light,
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
            lighting: Lighting { kind: LightKind::Point, ..Lighting::new(sun) },
            show: Show::Picture,
        })
    }

    fn controls(&mut self, c: &mut Controls) {
        c.choice("show", &mut self.show);
        self.lighting.controls(c);
        c.camera(&mut self.camera);
    }

    fn render(&mut self, frame: &Frame) -> Result<()> {
        // ANCHOR: trace
        let push = Push {
            camera: self.camera.basis(frame.aspect()),
            scene: self.scene.addresses,
            light: self.lighting.shader(),
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
