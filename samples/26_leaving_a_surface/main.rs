//! 26 · Leaving a surface: where a shadow ray or a mirrored ray starts, by eight rules.
//!
//! New since 06_reflection: a start for each direction, in three sizes of the scene and far from the
//! origin. The hit shader reports what the strictest rule needs: the barycentrics and the matrix.

use std::process::ExitCode;

use anyhow::Result;
use common::gpu::{
    Binding, Descriptor, Gpu, HitGroup, RayTracingPipeline, Requirements, TextureTable,
};
use common::scene::{
    Camera, CameraBasis, DirectionalLight, Look, Moved, Placement, Scene, SceneAddresses,
    SceneOnGpu, Size, Sun,
};
use common::{Controls, Frame, Sample, Setup, Variant, Variants};
use glam::Vec3;

fn main() -> ExitCode {
    common::run::<Demo>(env!("CARGO_BIN_NAME"), instruments::all())
}

const MAX_DEPTH: u32 = 8;

struct Demo {
    source: Scene,
    scene: SceneOnGpu,
    placement: Placement,
    pipelines: Variants<Constants>,
    camera: Camera,
    sun: Sun,
    depth: u32,
    minimum_contribution: f32,
    size: Size,
    moved: Moved,
    bounce: u32,
    constants: Constants,
}

common::shader_enum! {
    /// The quantity shown per pixel.
    enum Show: SHOW {
        Picture, Normal, Triangle, Hit, Direction = "ray direction", Shadow, Origin = "shadow origin",
        RayOrigin,
    }
    /// The rule for a ray's start.
    enum Origin: ORIGIN { Nothing, Tmin, Normal, Integers, Reprojected, Bound, Offset, Magnitudes }
}

/// Specialization constants of a pipeline's shaders.
#[derive(Clone, Copy, PartialEq)]
struct Constants {
    show: Show,
    origin: Origin,
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
        let source = setup.scene_with(&[Look::Mirror], Scene::chess_of_metal)?;
        let camera = source.camera;
        let scene = SceneOnGpu::new(gpu, &source, setup.options)?;
        let sun = Sun { azimuth: 340.0, elevation: 20.0, radiance: Vec3::new(4.4, 3.5, 2.4) };
        Ok(Self {
            source,
            scene,
            placement: Placement::default(),
            pipelines: Variants::default(),
            camera,
            sun,
            depth: 4,
            minimum_contribution: 1.0 / 512.0,
            size: Size::Usual,
            moved: Moved::Not,
            bounce: 0,
            constants: Constants { show: Show::Picture, origin: Origin::Bound },
        })
    }

    fn controls(&mut self, c: &mut Controls) {
        c.choice("show", &mut self.constants.show);
        c.sun(&mut self.sun);
        c.integer("depth", &mut self.depth, 0..=MAX_DEPTH);
        c.slider("minimum contribution", &mut self.minimum_contribution, 0.0..=1.0);
        c.choice("origin", &mut self.constants.origin);
        c.choice("size", &mut self.size);
        c.choice("moved", &mut self.moved);
        c.integer("bounce", &mut self.bounce, 0..=MAX_DEPTH);
        c.camera(&mut self.camera);
    }

    fn changed(&mut self, gpu: &Gpu) -> Result<()> {
        let placement = Placement::new(self.size, self.moved);
        if placement != self.placement {
            self.scene.rebuild(gpu, &placement.scene(&self.source), self.scene.options)?;
            self.placement = placement;
        }
        Ok(())
    }

    fn render(&mut self, frame: &Frame) -> Result<()> {
        // ANCHOR: trace
        let push = Push {
            camera: self.placement.camera(&self.camera).basis(frame.aspect()),
            scene: self.scene.addresses,
            light: self.sun.light(),
            depth: self.depth,
            minimum_contribution: self.minimum_contribution,
            bounce: self.bounce,
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

/// The rule for a ray's start is a constant of the pipeline, like the view.
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
        .constant(1, constants.origin)
        .recursion(1)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .textures(textures)
        .push_constants::<Push>()
        .build(gpu)
}
