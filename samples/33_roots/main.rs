//! 33 · Roots: a torus is a polynomial of degree four, and four ways to find its roots.
//!
//! New since 42_distant_spheres: tori instead of spheres and boxes, Ferrari's formula, Newton's method in brackets,
//! Sturm's theorem, brackets in two-floats, and the same polynomial seen from near the shape.

#[path = "../08_intersection/boxes.rs"]
mod boxes;
#[path = "../08_intersection/level.rs"]
mod level;
mod scenes;
mod shapes_on_gpu;
mod tori;

use std::process::ExitCode;

use anyhow::Result;
use common::gpu::{
    Address, Binding, Descriptor, Gpu, HitGroup, RayTracingPipeline, Requirements, TextureTable,
};
use common::scene::{
    Camera, CameraBasis, DirectionalLight, Scene, SceneAddresses, SceneOnGpu, Sun,
};
use common::{Controls, Frame, Sample, Setup, Variant, Variants};
use glam::Vec3;
use scenes::SceneKind;
use shapes_on_gpu::{Build, ShapeAddresses, ShapesOnGpu};

fn main() -> ExitCode {
    common::run::<Demo>(env!("CARGO_BIN_NAME"), instruments::all())
}

struct Demo {
    source: Scene,
    scene: SceneOnGpu,
    shapes: ShapesOnGpu,
    pipelines: Variants<Constants>,
    camera: Camera,
    sun: Sun,
    build: Build,
    distance: f32,
    constants: Constants,
}

common::shader_enum! {
    /// The quantity shown per pixel.
    enum Show: SHOW {
        Picture, Normal, Triangle, Hit, Direction = "ray direction", Shadow, Origin = "shadow origin",
    }
    /// The method that finds the roots.
    enum Method: METHOD { Ferrari, Brackets, Sturm, TwoFloat = "two-float" }
}

/// Specialization constants of a pipeline's shaders.
#[derive(Clone, Copy, PartialEq)]
struct Constants {
    show: Show,
    method: Method,
    conditioned: bool,
}

common::shader_struct! {
    /// Push constants of all shaders.
    struct Push {
        camera: CameraBasis,
        scene: SceneAddresses,
        shapes: Address<ShapeAddresses>,
        light: DirectionalLight,
    }
}

impl Sample for Demo {
    fn requirements() -> Requirements {
        Requirements::ray_tracing().textures()
    }

    fn new(gpu: &Gpu, setup: &Setup) -> Result<Self> {
        let mut source = Scene::chess()?;
        source.model.materials.extend(tori::materials());
        let build = Build { scene: SceneKind::Chain, tube: 0.25 };
        let distance = 30.0;
        let camera = scenes::camera(build.scene, distance);
        let scene = SceneOnGpu::new(gpu, &source, setup.options)?;
        let shapes = ShapesOnGpu::new(gpu, &source, &scene, build, camera.eye.as_vec3())?;
        let constants =
            Constants { show: Show::Picture, method: Method::Brackets, conditioned: true };
        let sun = Sun { azimuth: 60.0, elevation: 38.0, radiance: Vec3::new(4.0, 3.5, 2.8) };
        Ok(Self {
            source,
            scene,
            shapes,
            pipelines: Variants::default(),
            camera,
            sun,
            build,
            distance,
            constants,
        })
    }

    fn controls(&mut self, c: &mut Controls) {
        // A scene brings its view.
        if c.choice("scene", &mut self.build.scene) {
            self.camera = scenes::camera(self.build.scene, self.distance);
        }
        if c.slider("distance", &mut self.distance, 2.0..=1e6) {
            self.camera = scenes::camera(self.build.scene, self.distance);
        }
        c.slider("tube", &mut self.build.tube, 1e-6..=1.0);
        let is_ring = self.build.scene == SceneKind::Ring;
        c.needs("distance", "scene=ring", is_ring);
        c.needs("tube", "scene=ring", is_ring);
        c.choice("method", &mut self.constants.method);
        c.checkbox("conditioned", &mut self.constants.conditioned);
        let is_single = self.constants.method != Method::TwoFloat;
        c.needs("conditioned", "another method than two-float", is_single);
        c.choice("show", &mut self.constants.show);
        c.sun(&mut self.sun);
        c.camera(&mut self.camera);
    }

    fn changed(&mut self, gpu: &Gpu) -> Result<()> {
        let eye = self.camera.eye.as_vec3();
        if self.shapes.is_outdated(self.build, eye) {
            self.shapes = ShapesOnGpu::new(gpu, &self.source, &self.scene, self.build, eye)?;
        }
        Ok(())
    }

    fn render(&mut self, frame: &Frame) -> Result<()> {
        let Variant { pipeline, sbt, .. } =
            self.pipelines.choose(frame, &self.scene.textures, self.constants, pipeline)?;
        let push = Push {
            camera: self.camera.basis(frame.aspect()),
            scene: self.scene.addresses,
            shapes: self.shapes.addresses.address.into(),
            light: self.sun.light(),
        };
        let descriptors = [
            Descriptor::AccelerationStructure(&self.shapes.tlas),
            Descriptor::StorageImage(frame.image),
        ];
        pipeline.bind(frame.cmd, &descriptors, &push)?;
        sbt.trace(frame.cmd, frame.area);
        Ok(())
    }
}

// ANCHOR: pipeline
/// A hit group for each kind of surface: triangles and tori.
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
        .hit(HitGroup::procedural("torus.rint").closest_hit("shape.rchit"))
        .constant(0, constants.show)
        .constant(1, constants.method)
        .constant(2, constants.conditioned)
        .recursion(1)
        .rounding_to_nearest_even(gpu)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .textures(textures)
        .push_constants::<Push>()
        .build(gpu)
}
// ANCHOR_END: pipeline
