//! 17 · Ray query and raster: triangles are drawn, and rays add what drawing cannot: shadows and occlusion.
//!
//! New since 16_ray_query: a graphics pipeline that fills a G-buffer, in `gbuffer.rs`; the compute shader begins
//! at what that has seen; ambient occlusion.

mod gbuffer;

use std::process::ExitCode;

use anyhow::Result;
use common::gpu::{
    Address, Band, Binding, ComputePipeline, Descriptor, Gpu, Requirements, TextureTable,
};
use common::scene::{
    Camera, CameraBasis, DirectionalLight, Scene, SceneAddresses, SceneOnGpu, Sun,
};
use common::{Controls, Frame, Sample, Setup, Variant, Variants};
use gbuffer::{GBuffer, Placed};
use glam::Vec3;

fn main() -> ExitCode {
    common::run::<Demo>(env!("CARGO_BIN_NAME"), instruments::all())
}

struct Demo {
    scene: SceneOnGpu,
    gbuffer: GBuffer,
    pipelines: Variants<Constants, ComputePipeline>,
    camera: Camera,
    sun: Sun,
    occlusion_rays: u32,
    constants: Constants,
}

common::shader_enum! {
    /// The quantity shown per pixel.
    enum Show: SHOW {
        Picture, Triangle, Weights, Hit, Direction = "ray direction", Shadow,
        Occlusion = "ambient occlusion",
    }
}

common::shader_enum! {
    /// The method that finds the surface behind a pixel.
    enum Primary: PRIMARY { Raster, Rays }
}

/// Specialization constants of a pipeline's shaders.
#[derive(Clone, Copy, PartialEq)]
struct Constants {
    show: Show,
    primary: Primary,
}

common::shader_struct! {
    /// Push constants of this chapter's compute shader.
    struct Push {
        camera: CameraBasis,
        scene: SceneAddresses,
        placed: Address<Placed>,
        light: DirectionalLight,
        occlusion_rays: u32,
        band: Band,
    }
}

impl Sample for Demo {
    fn requirements() -> Requirements {
        Requirements::ray_tracing().textures().ray_query().raster()
    }

    fn new(gpu: &Gpu, setup: &Setup) -> Result<Self> {
        let scene = setup.scene_or(Scene::chess)?;
        let camera = scene.camera;
        let gbuffer = GBuffer::new(gpu, &scene)?;
        let scene = SceneOnGpu::new(gpu, &scene, setup.options)?;
        let sun = Sun { azimuth: 60.0, elevation: 17.0, radiance: Vec3::new(4.4, 3.5, 2.4) };
        Ok(Self {
            scene,
            gbuffer,
            pipelines: Variants::default(),
            camera,
            sun,
            occlusion_rays: 16,
            constants: Constants { show: Show::Picture, primary: Primary::Raster },
        })
    }

    fn controls(&mut self, c: &mut Controls) {
        c.choice("show", &mut self.constants.show);
        c.choice("primary", &mut self.constants.primary);
        self.gbuffer.controls(c);
        c.integer("occlusion rays", &mut self.occlusion_rays, 0..=256);
        c.sun(&mut self.sun);
        c.camera(&mut self.camera);
    }

    fn render(&mut self, frame: &Frame) -> Result<()> {
        // ANCHOR: trace
        let camera = self.camera.basis(frame.aspect());
        let Variant { pipeline, key, .. } =
            self.pipelines.choose(frame, &self.scene.textures, self.constants, pipeline)?;
        // All bands of a frame share what the first one draws.
        if frame.is_first_band() {
            let draws = key.primary == Primary::Raster;
            self.gbuffer.prepare(frame, draws.then_some(camera), &self.scene)?;
        }
        let push = Push {
            camera,
            scene: self.scene.addresses,
            placed: self.gbuffer.placed(),
            light: self.sun.light(),
            occlusion_rays: self.occlusion_rays,
            band: frame.area.into(),
        };
        let descriptors = [
            Descriptor::AccelerationStructure(&self.scene.tlas),
            Descriptor::StorageImage(frame.image),
            Descriptor::StorageImage(self.gbuffer.seen()?),
        ];
        pipeline.bind(frame.cmd, &descriptors, &push)?;
        pipeline.dispatch(frame.cmd, frame.area);
        // ANCHOR_END: trace
        Ok(())
    }
}

/// One stage: no groups, no recursion, and nothing to put into a table.
fn pipeline(gpu: &Gpu, textures: &TextureTable, constants: Constants) -> Result<ComputePipeline> {
    ComputePipeline::builder(env!("CARGO_BIN_NAME"))
        .compute("trace.comp")
        .workgroup(3, [8, 4])
        .constant(0, constants.show)
        .constant(1, constants.primary)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .binding(Binding::StorageImage)
        .textures(textures)
        .push_constants::<Push>()
        .build_compute(gpu)
}
