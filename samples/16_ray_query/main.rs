//! 16 · Ray query: the picture of 41 from a compute shader, which runs the traversal itself.
//!
//! New since 41_ray_offset: a compute pipeline with one shader and no table; a query for each ray, in place
//! of hit groups, miss shaders and payloads; workgroups, whose shape is a choice.

use std::process::ExitCode;

use anyhow::Result;
use common::gpu::{Band, Binding, ComputePipeline, Descriptor, Gpu, Requirements, TextureTable};
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
    pipelines: Variants<Constants, ComputePipeline>,
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
    /// Index into [`WORKGROUPS`].
    workgroup: u32,
}

// ANCHOR: workgroups
/// Width and height of a workgroup: 32 invocations, or a few times as many.
const WORKGROUPS: [(&str, [u32; 2]); 5] =
    [("8x4", [8, 4]), ("8x8", [8, 8]), ("16x4", [16, 4]), ("32x1", [32, 1]), ("16x16", [16, 16])];
// ANCHOR_END: workgroups

common::shader_struct! {
    /// Push constants of all shaders.
    struct Push {
        camera: CameraBasis,
        scene: SceneAddresses,
        light: DirectionalLight,
        band: Band,
    }
}

impl Sample for Demo {
    fn requirements() -> Requirements {
        Requirements::ray_tracing().textures().ray_query()
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
            constants: Constants { show: Show::Picture, workgroup: 0 },
        })
    }

    fn controls(&mut self, c: &mut Controls) {
        c.choice("show", &mut self.constants.show);
        c.sun(&mut self.sun);
        c.one_of("workgroup", &mut self.constants.workgroup, &WORKGROUPS.map(|(shape, _)| shape));
        c.camera(&mut self.camera);
    }

    fn render(&mut self, frame: &Frame) -> Result<()> {
        // ANCHOR: trace
        let push = Push {
            camera: self.camera.basis(frame.aspect()),
            scene: self.scene.addresses,
            light: self.sun.light(),
            band: frame.area.into(),
        };
        let descriptors = [
            Descriptor::AccelerationStructure(&self.scene.tlas),
            Descriptor::StorageImage(frame.image),
        ];
        let Variant { pipeline, .. } =
            self.pipelines.choose(frame, &self.scene.textures, self.constants, pipeline)?;
        pipeline.bind(frame.cmd, &descriptors, &push)?;
        pipeline.dispatch(frame.cmd, frame.area);
        // ANCHOR_END: trace
        Ok(())
    }
}

/// One stage: no groups, no recursion, and nothing to put into a table.
fn pipeline(gpu: &Gpu, textures: &TextureTable, constants: Constants) -> Result<ComputePipeline> {
    let (_, workgroup) = WORKGROUPS[constants.workgroup as usize];
    ComputePipeline::builder(env!("CARGO_BIN_NAME"))
        .compute("trace.comp")
        .workgroup(3, workgroup)
        .constant(0, constants.show)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .textures(textures)
        .push_constants::<Push>()
        .build_compute(gpu)
}
