//! 10 · Position fetch: the acceleration structure hands out the corners of the triangle that was hit.
//!
//! New since 02_basic: bottom levels built with `ALLOW_DATA_ACCESS`, `gl_HitTriangleVertexPositionsEXT` in the
//! closest hit shader, and vertices that have no position in a buffer of ours.

mod attributes;

use std::process::ExitCode;

use anyhow::Result;
use attributes::{AttributesOnGpu, MeshRecord};
use common::gpu::{
    Address, Binding, Descriptor, Gpu, HitGroup, RayTracingPipeline, Requirements, TextureTable,
};
use common::scene::{
    Camera, CameraBasis, DirectionalLight, Scene, SceneAddresses, SceneOnGpu, SceneOptions, Sun,
};
use common::{Controls, Frame, Sample, Setup, Variant, Variants};

fn main() -> ExitCode {
    common::run::<Demo>(env!("CARGO_BIN_NAME"), instruments::all())
}

struct Demo {
    source: Scene,
    scene: SceneOnGpu,
    attributes: AttributesOnGpu,
    pipelines: Variants<Constants>,
    camera: Camera,
    sun: Sun,
    constants: Constants,
}

common::shader_enum! {
    /// The quantity shown per pixel.
    enum Show: SHOW {
        Picture, Normal, Geometric = "geometric normal", Triangle, Hit, Direction = "ray direction",
        HitPoint = "hit point", RayPoint = "ray point",
    }
    /// The source of a triangle's corners in the hit shader.
    enum Positions: POSITIONS { Structure = "acceleration structure", Buffer }
}

/// Specialization constants of a pipeline's shaders.
#[derive(Clone, Copy, PartialEq)]
struct Constants {
    show: Show,
    positions: Positions,
}

common::shader_struct! {
    /// Push constants of all shaders.
    struct Push {
        camera: CameraBasis,
        scene: SceneAddresses,
        light: DirectionalLight,
        meshes: Address<MeshRecord>,
    }
}

impl Sample for Demo {
    fn requirements() -> Requirements {
        Requirements::ray_tracing().textures().position_fetch()
    }

    fn new(gpu: &Gpu, setup: &Setup) -> Result<Self> {
        let source = setup.scene_or(Scene::chess)?;
        let camera = source.camera;
        let options = SceneOptions { position_fetch: true, ..setup.options };
        Ok(Self {
            scene: SceneOnGpu::new(gpu, &source, options)?,
            attributes: AttributesOnGpu::new(gpu, &source.model.meshes)?,
            source,
            pipelines: Variants::default(),
            camera,
            sun: Sun::default(),
            constants: Constants { show: Show::Picture, positions: Positions::Structure },
        })
    }

    fn controls(&mut self, c: &mut Controls) {
        c.choice("show", &mut self.constants.show);
        c.choice("positions", &mut self.constants.positions);
        c.slider("sun azimuth", &mut self.sun.azimuth, 0.0..=360.0);
        c.slider("sun elevation", &mut self.sun.elevation, 0.0..=90.0);
        c.camera(&mut self.camera);
    }

    fn changed(&mut self, gpu: &Gpu) -> Result<()> {
        let position_fetch = self.constants.positions == Positions::Structure;
        if position_fetch != self.scene.options.position_fetch {
            let options = SceneOptions { position_fetch, ..self.scene.options };
            self.scene.rebuild(gpu, &self.source, options)?;
            let meshes = if position_fetch { &self.source.model.meshes[..] } else { &[] };
            self.attributes = AttributesOnGpu::new(gpu, meshes)?;
        }
        Ok(())
    }

    fn render(&mut self, frame: &Frame) -> Result<()> {
        // ANCHOR: trace
        let push = Push {
            camera: self.camera.basis(frame.aspect()),
            scene: self.scene.addresses,
            light: self.sun.light(),
            meshes: self.attributes.table.address.into(),
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
        .hit(HitGroup::triangles().closest_hit("shade.rchit"))
        .constant(0, constants.show)
        .constant(1, constants.positions)
        .recursion(1)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .textures(textures)
        .push_constants::<Push>()
        .build(gpu)
}
