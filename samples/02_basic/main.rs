//! 02 · Basic: the first scene, traced through the framework.
//!
//! New since 01_foundation: a model from an OBJ file, one bottom level a mesh and many instances,
//! a camera, a closest hit shader that reads vertices and materials by address, and controls.

use std::process::ExitCode;

use anyhow::Result;
use common::gpu::{
    Binding, Descriptor, Gpu, HitGroup, RayTracingPipeline, Requirements, TextureTable,
};
use common::scene::{
    Camera, CameraBasis, DirectionalLight, Scene, SceneAddresses, SceneOnGpu, Sun,
};
use common::{Controls, Frame, Sample, Setup, Variant, Variants};

// ANCHOR: main
fn main() -> ExitCode {
    common::run::<Demo>(env!("CARGO_BIN_NAME"), instruments::all())
}

struct Demo {
    scene: SceneOnGpu,
    pipelines: Variants<Show>,
    camera: Camera,
    sun: Sun,
    show: Show,
}
// ANCHOR_END: main

// ANCHOR: show
common::shader_enum! {
    /// The quantity shown per pixel.
    enum Show: SHOW { Picture, Normal, Triangle, Hit, Direction = "ray direction" }
}
// ANCHOR_END: show

// ANCHOR: push
common::shader_struct! {
    /// Push constants of all shaders.
    struct Push {
        camera: CameraBasis,
        scene: SceneAddresses,
        light: DirectionalLight,
    }
}
// ANCHOR_END: push

impl Sample for Demo {
    // ANCHOR: new
    fn requirements() -> Requirements {
        Requirements::ray_tracing().textures()
    }

    fn new(gpu: &Gpu, setup: &Setup) -> Result<Self> {
        let scene = setup.scene_or(Scene::chess)?;
        let camera = scene.camera;
        let scene = SceneOnGpu::new(gpu, &scene, setup.options)?;
        Ok(Self {
            scene,
            pipelines: Variants::default(),
            camera,
            sun: Sun::default(),
            show: Show::Picture,
        })
    }
    // ANCHOR_END: new

    fn controls(&mut self, c: &mut Controls) {
        c.choice("show", &mut self.show);
        c.slider("sun azimuth", &mut self.sun.azimuth, 0.0..=360.0);
        c.slider("sun elevation", &mut self.sun.elevation, 0.0..=90.0);
        c.camera(&mut self.camera);
    }

    fn render(&mut self, frame: &Frame) -> Result<()> {
        // ANCHOR: trace
        let push = Push {
            camera: self.camera.basis(frame.aspect()),
            scene: self.scene.addresses,
            light: self.sun.light(),
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

/// The pipeline for what is shown: a specialization constant of the shaders.
fn pipeline(gpu: &Gpu, textures: &TextureTable, show: Show) -> Result<RayTracingPipeline> {
    RayTracingPipeline::builder(env!("CARGO_BIN_NAME"))
        .raygen("camera.rgen")
        .miss("sky.rmiss")
        .hit(HitGroup::triangles().closest_hit("shade.rchit"))
        .constant(0, show)
        .recursion(1)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .textures(textures)
        .push_constants::<Push>()
        .build(gpu)
}
