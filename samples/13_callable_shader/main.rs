//! 13 · Callable shader: functions that a shader calls by a number, found in the shader binding table.
//!
//! New since 34_lights: marble, wood, a checker and both kinds of light as callable shaders, chosen by
//! data; the same by a `switch` and by hit groups, to the bit; patterns of an integer lattice.

mod finish;

use std::process::ExitCode;

use anyhow::Result;
use common::gpu::{
    Address, Binding, Buffer, Descriptor, Gpu, HitGroup, RayTracingPipeline, Requirements,
    TextureTable,
};
use common::scene::{
    Camera, CameraBasis, Light, Scene, SceneAddresses, SceneOnGpu, Sun, input_usage,
};
use common::{Controls, Frame, Lighting, Sample, Setup, Variant, Variants};
use finish::{Finish, finishes};
use glam::Vec3;

fn main() -> ExitCode {
    common::run::<Demo>(env!("CARGO_BIN_NAME"), instruments::all())
}

struct Demo {
    scene: SceneOnGpu,
    finishes: Buffer,
    pipelines: Variants<Constants>,
    camera: Camera,
    lighting: Lighting,
    constants: Constants,
    far: u32,
}

common::shader_enum! {
    /// The quantity shown per pixel.
    enum Show: SHOW {
        Picture, Normal, Triangle, Hit, Direction = "ray direction", Shadow, Origin = "shadow origin",
        Weight = "pattern", Object = "object position",
    }
    /// The mechanism that selects code for a surface's pattern and for a kind of light.
    enum Choose: CHOOSE { Callable, Switch, HitGroup }
    /// The shader that evaluates the pattern.
    enum Stage: STAGE { Raygen, Hit = "closest hit" }
}

/// Specialization constants of a pipeline's shaders.
#[derive(Clone, Copy, PartialEq)]
struct Constants {
    show: Show,
    choose: Choose,
    stage: Stage,
}

common::shader_struct! {
    /// Push constants of all shaders.
    struct Push {
        camera: CameraBasis,
        scene: SceneAddresses,
        finishes: Address<Finish>,
        light: Light,
        far: u32,
    }
}

impl Sample for Demo {
    fn requirements() -> Requirements {
        Requirements::ray_tracing().textures()
    }

    fn new(gpu: &Gpu, setup: &Setup) -> Result<Self> {
        let mut scene = setup.scene_or(Scene::chess)?;
        let camera = scene.camera;
        let finishes = finishes(&scene.model);
        for instance in &mut scene.instances {
            instance.record_offset = finishes[instance.material].pattern;
        }
        let finishes = Buffer::with_data(gpu, "finishes", &finishes, input_usage())?;
        let scene = SceneOnGpu::new(gpu, &scene, setup.options)?;
        let sun = Sun { azimuth: 60.0, elevation: 17.0, radiance: Vec3::new(4.4, 3.5, 2.4) };
        Ok(Self {
            scene,
            finishes,
            pipelines: Variants::default(),
            camera,
            lighting: Lighting::new(sun),
            constants: Constants {
                show: Show::Picture,
                choose: Choose::Callable,
                stage: Stage::Raygen,
            },
            far: 0,
        })
    }

    fn controls(&mut self, c: &mut Controls) {
        c.choice("show", &mut self.constants.show);
        self.lighting.controls(c);
        c.choice("choose by", &mut self.constants.choose);
        c.choice("called from", &mut self.constants.stage);
        c.integer("far", &mut self.far, 0..=1 << 24);
        c.camera(&mut self.camera);
    }

    fn render(&mut self, frame: &Frame) -> Result<()> {
        // ANCHOR: trace
        let push = Push {
            camera: self.camera.basis(frame.aspect()),
            scene: self.scene.addresses,
            finishes: self.finishes.address.into(),
            light: self.lighting.shader(),
            far: self.far,
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
    // Callables that no instance uses are left out: a device may compile a pipeline without them differently.
    let callables: &[&str] = match constants.choose {
        Choose::Callable => {
            &["marble.rcall", "wood.rcall", "checker.rcall", "sun.rcall", "lamp.rcall"]
        }
        Choose::Switch | Choose::HitGroup => &[],
    };
    let hit = |shader| match constants.choose {
        Choose::HitGroup => HitGroup::triangles().closest_hit(shader),
        Choose::Callable | Choose::Switch => HitGroup::triangles().closest_hit("shade.rchit"),
    };
    let builder = RayTracingPipeline::builder(env!("CARGO_BIN_NAME"))
        .raygen("camera.rgen")
        .miss("sky.rmiss")
        .miss("common/shadow.rmiss")
        .hit(hit("shade.rchit"))
        .hit(hit("marble.rchit"))
        .hit(hit("wood.rchit"))
        .hit(hit("checker.rchit"))
        .as_written()
        .constant(0, constants.show)
        .constant(1, constants.choose)
        .constant(2, constants.stage)
        .recursion(1)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .textures(textures)
        .push_constants::<Push>();
    callables.iter().fold(builder, |builder, shader| builder.callable(shader)).build(gpu)
}
