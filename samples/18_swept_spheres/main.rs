//! 18 · Swept spheres: spheres swept along segments, their radius changing, and chains of them.
//!
//! New since 08_intersection: `swept.rint` with three rungs, chains whose segments share their ends, the
//! normal of a cone, and the same strands as triangles.

#[path = "../08_intersection/boxes.rs"]
mod boxes;
#[path = "../08_intersection/random.rs"]
mod random;
mod scenes;
mod strands;
mod strands_on_gpu;
mod tubes;

use std::process::ExitCode;

use anyhow::Result;
use common::gpu::{
    Address, Binding, Descriptor, Gpu, HitGroup, RayTracingPipeline, Requirements, TextureTable,
};
use common::scene::{
    Camera, CameraBasis, DirectionalLight, Scene, SceneAddresses, SceneOptions, Sun,
};
use common::{Controls, Frame, Sample, Setup, Variant, Variants};
use glam::Vec3;
use scenes::SceneKind;
use strands::StrandAddresses;
use strands_on_gpu::{Build, Shape, StrandsOnGpu};

fn main() -> ExitCode {
    common::run::<Demo>(env!("CARGO_BIN_NAME"), instruments::all())
}

struct Demo {
    source: Scene,
    options: SceneOptions,
    strands: StrandsOnGpu,
    pipelines: Variants<Constants>,
    camera: Camera,
    sun: Sun,
    build: Build,
    distance: f32,
    constants: Constants,
}

common::shader_enum! {
    /// The quantity shown per pixel.
    enum Show: SHOW { Picture, Normal, Segment, Hit, Direction = "ray direction", Along }
    /// The normal that shades strands: that of their surface, or that of a cylinder around their axis.
    enum Normal: NORMAL { Surface, Axis }
    /// The formula that intersects swept spheres.
    enum Rung: SWEPT { Textbook, Stable, TwoFloat = "two-float" }
}

/// Specialization constants of a pipeline's shaders.
#[derive(Clone, Copy, PartialEq)]
struct Constants {
    show: Show,
    normal: Normal,
    rung: Rung,
}

common::shader_struct! {
    /// Push constants of all shaders.
    struct Push {
        camera: CameraBasis,
        scene: SceneAddresses,
        strands: Address<StrandAddresses>,
        light: DirectionalLight,
    }
}

impl Sample for Demo {
    fn requirements() -> Requirements {
        Requirements::ray_tracing().textures()
    }

    fn new(gpu: &Gpu, setup: &Setup) -> Result<Self> {
        let mut source = setup.scene_or(Scene::chess)?;
        source.model.materials.extend(scenes::materials());
        let (options, camera) = (setup.options, scenes::camera(SceneKind::Board, 1.0));
        let build = Build { scene: SceneKind::Board, hairs: 10_000, shape: Shape::Swept, sides: 8 };
        let strands = StrandsOnGpu::new(gpu, &source, build, options, camera.eye.as_vec3(), None)?;
        let constants =
            Constants { show: Show::Picture, normal: Normal::Surface, rung: Rung::Stable };
        let sun = Sun { azimuth: 62.0, elevation: 33.0, radiance: Vec3::new(4.4, 3.7, 2.8) };
        Ok(Self {
            source,
            options,
            strands,
            pipelines: Variants::default(),
            camera,
            sun,
            build,
            distance: 4.0,
            constants,
        })
    }

    fn controls(&mut self, c: &mut Controls) {
        // A scene brings its view.
        if c.choice("scene", &mut self.build.scene) {
            self.camera = scenes::camera(self.build.scene, self.distance);
        }
        let is_farther = c.slider("distance", &mut self.distance, 1.0..=1e5);
        if is_farther && self.build.scene == SceneKind::One {
            self.camera = scenes::camera(self.build.scene, self.distance);
        }
        c.integer("hairs", &mut self.build.hairs, 0..=100_000);
        c.choice("rung", &mut self.constants.rung);
        c.choice("normal", &mut self.constants.normal);
        c.choice("shape", &mut self.build.shape);
        c.integer("sides", &mut self.build.sides, 3..=64);
        c.choice("show", &mut self.constants.show);
        c.sun(&mut self.sun);
        c.camera(&mut self.camera);
    }

    fn changed(&mut self, gpu: &Gpu) -> Result<()> {
        let (eye, old) = (self.camera.eye.as_vec3(), &self.strands);
        if old.is_outdated(self.build, eye) {
            self.strands =
                StrandsOnGpu::new(gpu, &self.source, self.build, self.options, eye, Some(old))?;
        }
        Ok(())
    }

    fn render(&mut self, frame: &Frame) -> Result<()> {
        let scene = &self.strands.scene;
        let Variant { pipeline, sbt, .. } =
            self.pipelines.choose(frame, &scene.textures, self.constants, pipeline)?;
        // ANCHOR: trace
        let push = Push {
            camera: self.camera.basis(frame.aspect()),
            scene: scene.addresses,
            strands: self.strands.addresses.address.into(),
            light: self.sun.light(),
        };
        let descriptors = [
            Descriptor::AccelerationStructure(&self.strands.tlas),
            Descriptor::StorageImage(frame.image),
        ];
        pipeline.bind(frame.cmd, &descriptors, &push)?;
        sbt.trace(frame.cmd, frame.area);
        // ANCHOR_END: trace
        Ok(())
    }
}

/// A hit group for each kind of surface: triangles, and swept spheres.
///
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
        .hit(HitGroup::procedural("swept.rint").closest_hit("strand.rchit"))
        .constant(0, constants.show)
        .constant(1, constants.normal)
        .constant(2, constants.rung)
        .rounding_to_nearest_even(gpu)
        .recursion(1)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .textures(textures)
        .push_constants::<Push>()
        .build(gpu)
}
