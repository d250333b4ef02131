//! 20 · Wireframe: the edges of every triangle as lines of one width in pixels, near and far.
//!
//! New since 10_position_fetch: the distance in pixels from a pixel to an edge, in closed form and without
//! derivatives; an any-hit shader that finds hidden lines; and no vertex buffer at all.

use std::process::ExitCode;

use anyhow::Result;
use common::gpu::{
    Binding, Descriptor, Gpu, HitGroup, RayTracingPipeline, Requirements, TextureTable,
};
use common::scene::{
    Camera, CameraBasis, DirectionalLight, Scene, SceneAddresses, SceneOnGpu, SceneOptions, Sun,
};
use common::{Controls, Frame, Sample, Setup, Variant, Variants};
use glam::Vec2;

fn main() -> ExitCode {
    common::run::<Demo>(env!("CARGO_BIN_NAME"), instruments::all())
}

struct Demo {
    scene: SceneOnGpu,
    pipelines: Variants<Constants>,
    camera: Camera,
    sun: Sun,
    constants: Constants,
    width: f32,
}

common::shader_enum! {
    /// The quantity shown per pixel.
    enum Show: SHOW { Picture, Lines, Normal = "geometric normal" }
    /// The quantity that is constant along a line: its width in pixels, or its part of the triangle.
    enum Constant: CONSTANT { Width, Weight = "barycentric" }
}

/// Specialization constants of a pipeline's shaders.
#[derive(Clone, Copy, PartialEq)]
struct Constants {
    show: Show,
    constant: Constant,
    hidden: bool,
}

common::shader_struct! {
    /// Push constants of all shaders.
    struct Push {
        camera: CameraBasis,
        scene: SceneAddresses,
        light: DirectionalLight,
        size: Vec2,
        width: f32,
    }
}

impl Sample for Demo {
    fn requirements() -> Requirements {
        Requirements::ray_tracing().textures().position_fetch()
    }

    fn new(gpu: &Gpu, setup: &Setup) -> Result<Self> {
        let scene = setup.scene_or(Scene::chess)?;
        let camera = scene.camera;
        let options = SceneOptions { position_fetch: true, ..setup.options };
        Ok(Self {
            scene: SceneOnGpu::new(gpu, &scene, options)?,
            pipelines: Variants::default(),
            camera,
            sun: Sun::default(),
            constants: Constants { show: Show::Picture, constant: Constant::Width, hidden: false },
            width: 1.0,
        })
    }

    fn controls(&mut self, c: &mut Controls) {
        c.choice("show", &mut self.constants.show);
        c.slider("line width", &mut self.width, 0.0..=20.0);
        c.choice("constant", &mut self.constants.constant);
        c.checkbox("hidden lines", &mut self.constants.hidden);
        c.sun(&mut self.sun);
        c.camera(&mut self.camera);
    }

    fn render(&mut self, frame: &Frame) -> Result<()> {
        // ANCHOR: trace
        let extent = frame.image.extent;
        let push = Push {
            camera: self.camera.basis(frame.aspect()),
            scene: self.scene.addresses,
            light: self.sun.light(),
            size: Vec2::new(extent.width as f32, extent.height as f32),
            width: self.width,
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
        .miss("end.rmiss")
        .hit(HitGroup::triangles().closest_hit("shade.rchit"))
        .hit(HitGroup::triangles().any_hit("line.rahit"))
        .constant(0, constants.show)
        .constant(1, constants.constant)
        .constant(2, constants.hidden)
        .recursion(1)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .textures(textures)
        .push_constants::<Push>()
        .build(gpu)
}
