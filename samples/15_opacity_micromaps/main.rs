//! 15 · Opacity micromaps: opacity known for parts of a triangle, so that few any-hit calls read a texture.
//!
//! New since 03_any_hit: each triangle is cut into micro-triangles, whose states the any-hit shader reads before
//! any texture. Of 03 only the cut-outs stay.

mod alpha;
mod classify;
mod curve;
mod micromaps;
mod on_device;

use std::process::ExitCode;

use anyhow::Result;
use classify::Rule;
use common::gpu::{
    Address, Binding, Descriptor, Gpu, HitGroup, RayTracingPipeline, Requirements, TextureTable,
};
use common::scene::{
    Camera, CameraBasis, DirectionalLight, Look, Scene, SceneAddresses, SceneOnGpu, Sun,
};
use common::{Controls, Frame, Sample, Setup, Variant, Variants};
use glam::DVec3;
use micromaps::{Build, Micromap, Micromaps};

fn main() -> ExitCode {
    common::run::<Demo>(env!("CARGO_BIN_NAME"), instruments::all())
}

struct Demo {
    source: Scene,
    scene: SceneOnGpu,
    micromaps: Micromaps,
    pipelines: Variants<Constants>,
    camera: Camera,
    sun: Sun,
    show: Show,
    build: Build,
}

common::shader_enum! {
    /// The quantity shown per pixel.
    enum Show: SHOW {
        Picture, Normal, Triangle, Hit, Direction = "ray direction", States, Calls, Reads,
    }
    /// The subdivision of triangles.
    enum Level {
        None, Zero = "0", One = "1", Two = "2", Three = "3", Four = "4", Five = "5", Six = "6",
    }
    /// The reader of the states.
    enum Way {
        /// The any-hit shader.
        Shader,
        /// Traversal, where it knows `VK_KHR_opacity_micromap`.
        Device,
    }
}

impl Level {
    fn number(self) -> Option<u32> {
        u32::from(self).checked_sub(1)
    }
}

/// Specialization constants of a pipeline's shaders.
#[derive(Clone, Copy, PartialEq)]
struct Constants {
    show: Show,
    /// True if shaders read states at all.
    known: bool,
    /// True if traversal reads states.
    by_device: bool,
}

common::shader_struct! {
    /// Push constants of all shaders.
    struct Push {
        camera: CameraBasis,
        scene: SceneAddresses,
        light: DirectionalLight,
        micromaps: Address<Micromap>,
    }
}

impl Sample for Demo {
    fn requirements() -> Requirements {
        Requirements::ray_tracing().textures().opacity_micromaps_where_offered()
    }

    fn new(gpu: &Gpu, setup: &Setup) -> Result<Self> {
        let source = setup.scene_with(&[Look::Holes], behind_the_screen)?;
        let camera = source.camera;
        let scene = SceneOnGpu::new(gpu, &source, setup.options)?;
        let (rule, way) = (Rule::Conservative, Way::Shader);
        let none = Build { level: Level::None, rule, way };
        Ok(Self {
            micromaps: Micromaps::new(gpu, &source, &scene, none)?,
            source,
            scene,
            pipelines: Variants::default(),
            camera,
            sun: Sun::default(),
            show: Show::Picture,
            build: Build { level: Level::Five, ..none },
        })
    }

    fn controls(&mut self, c: &mut Controls) {
        c.choice("show", &mut self.show);
        c.choice("level", &mut self.build.level);
        c.choice("rule", &mut self.build.rule);
        c.choice("way", &mut self.build.way);
        let unknown = 100.0 * self.micromaps.unknown();
        c.note("states", &format!("{} bytes, {unknown:.1} % unknown", self.micromaps.bytes));
        c.sun(&mut self.sun);
        c.camera(&mut self.camera);
    }

    fn changed(&mut self, gpu: &Gpu) -> Result<()> {
        if self.build != self.micromaps.build {
            self.micromaps = Micromaps::new(gpu, &self.source, &self.scene, self.build)?;
        }
        Ok(())
    }

    fn render(&mut self, frame: &Frame) -> Result<()> {
        // ANCHOR: trace
        let push = Push {
            camera: self.camera.basis(frame.aspect()),
            scene: self.scene.addresses,
            light: self.sun.light(),
            micromaps: self.micromaps.records.address.into(),
        };
        // To show the states, holes have to be hit, which a device passes through.
        let on_device = self.micromaps.on_device.as_ref().filter(|_| self.show != Show::States);
        let by_device = on_device.is_some();
        let known = self.build.level != Level::None && !by_device;
        let constants = Constants { show: self.show, known, by_device };
        let Variant { key, pipeline, sbt } =
            self.pipelines.choose(frame, &self.scene.textures, constants, pipeline)?;
        // While a pipeline is made, the last one goes on, which may not have been made for micromaps.
        let on_device = on_device.filter(|_| key.by_device);
        let descriptors = [
            Descriptor::AccelerationStructure(on_device.map_or(&self.scene.tlas, |it| &it.tlas)),
            Descriptor::StorageImage(frame.image),
        ];
        pipeline.bind(frame.cmd, &descriptors, &push)?;
        sbt.trace(frame.cmd, frame.area);
        // ANCHOR_END: trace
        Ok(())
    }

    fn report(&self) -> Result<serde_json::Value> {
        Ok(self.micromaps.report())
    }
}

/// The chess set, seen through the screen behind Black: every ray hits the screen.
fn behind_the_screen() -> Result<Scene> {
    let mut scene = Scene::chess()?;
    let (eye, target) = (DVec3::new(2.4, 2.1, -7.4), DVec3::new(0.3, 1.2, -2.0));
    scene.camera = Camera::new(eye, target, 40.0);
    Ok(scene)
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
        .hit(HitGroup::triangles().closest_hit("shade.rchit").any_hit("decide.rahit"))
        .constant(0, constants.show)
        .constant(1, constants.known)
        .opacity_micromaps(constants.by_device)
        .recursion(1)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .textures(textures)
        .push_constants::<Push>()
        .build(gpu)
}
