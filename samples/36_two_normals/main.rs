//! 36 · Two normals: shade by one normal, leave by the other.
//!
//! New since 41_ray_offset: the terminator offset, from the flat triangle to the round surface that its
//! normals pretend, and a switch that leaves it out.

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
    pipelines: Variants<Constants>,
    camera: Camera,
    sun: Sun,
    constants: Constants,
}

common::shader_enum! {
    /// The quantity shown per pixel.
    enum Show: SHOW {
        Picture, Normal, Triangle, Hit, Direction = "ray direction", Shadow, Origin = "shadow origin",
    }
}

/// Specialization constants of a pipeline's shaders.
#[derive(Clone, Copy, PartialEq)]
struct Constants {
    show: Show,
    smooth_terminator: bool,
}

common::shader_struct! {
    /// Push constants of all shaders.
    struct Push {
        camera: CameraBasis,
        scene: SceneAddresses,
        light: DirectionalLight,
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
            constants: Constants { show: Show::Picture, smooth_terminator: true },
        })
    }

    fn controls(&mut self, c: &mut Controls) {
        c.choice("show", &mut self.constants.show);
        c.sun(&mut self.sun);
        c.checkbox("smooth terminator", &mut self.constants.smooth_terminator);
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
            self.pipelines.choose(frame, &self.scene.textures, self.constants, pipeline)?;
        pipeline.bind(frame.cmd, &descriptors, &push)?;
        sbt.trace(frame.cmd, frame.area);
        // ANCHOR_END: trace
        Ok(())
    }
}

/// Only the raygen shader traces rays: they do not nest, and a recursion depth of 1 is enough.
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
        .constant(1, constants.smooth_terminator)
        .recursion(1)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .textures(textures)
        .push_constants::<Push>()
        .build(gpu)
}
