//! 41 · Ray offset: a shadow ray's origin, from a bound on all rounding errors.
//!
//! New since 05_shadow_miss: the offset is computed for each hit; the constant stays as a choice, to compare. The
//! scene can be made larger or smaller and moved away, where a constant fails.

use std::process::ExitCode;

use anyhow::Result;
use common::gpu::{
    Binding, Descriptor, Gpu, HitGroup, RayTracingPipeline, Requirements, TextureTable,
};
use common::scene::{
    Camera, CameraBasis, DirectionalLight, Moved, Placement, Scene, SceneAddresses, SceneOnGpu,
    Size, Sun,
};
use common::{Controls, Frame, Sample, Setup, Variant, Variants};
use glam::Vec3;

fn main() -> ExitCode {
    common::run::<Demo>(env!("CARGO_BIN_NAME"), instruments::all())
}

struct Demo {
    source: Scene,
    scene: SceneOnGpu,
    placement: Placement,
    pipelines: Variants<Constants>,
    camera: Camera,
    sun: Sun,
    size: Size,
    moved: Moved,
    constants: Constants,
}

common::shader_enum! {
    /// The quantity shown per pixel.
    enum Show: SHOW {
        Picture, Normal, Triangle, Hit, Direction = "ray direction", Shadow, Origin = "shadow origin",
    }
    /// The distance of a shadow ray's origin from its surface.
    enum Offset: OFFSET { Bound, Constant }
}

/// Specialization constants of a pipeline's shaders.
#[derive(Clone, Copy, PartialEq)]
struct Constants {
    show: Show,
    offset: Offset,
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
        let source = setup.scene_or(Scene::chess)?;
        let camera = source.camera;
        let scene = SceneOnGpu::new(gpu, &source, setup.options)?;
        let sun = Sun { azimuth: 60.0, elevation: 17.0, radiance: Vec3::new(4.4, 3.5, 2.4) };
        Ok(Self {
            source,
            scene,
            placement: Placement::default(),
            pipelines: Variants::default(),
            camera,
            sun,
            size: Size::Usual,
            moved: Moved::Not,
            constants: Constants { show: Show::Picture, offset: Offset::Bound },
        })
    }

    fn controls(&mut self, c: &mut Controls) {
        c.choice("show", &mut self.constants.show);
        c.sun(&mut self.sun);
        c.choice("offset", &mut self.constants.offset);
        c.choice("size", &mut self.size);
        c.choice("moved", &mut self.moved);
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
        .miss("common/sky.rmiss")
        .miss("common/shadow.rmiss")
        .hit(HitGroup::triangles().closest_hit("shade.rchit"))
        .constant(0, constants.show)
        .constant(1, constants.offset)
        .recursion(1)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .textures(textures)
        .push_constants::<Push>()
        .build(gpu)
}
