//! 08 · Intersection: spheres and boxes, which the device does not know, found by our own shaders.
//!
//! New since 41_ray_offset: bottom levels of boxes, the intersection shaders `sphere.rint` and
//! `box.rint`, a closest hit shader for both, and hit groups per instance.

mod boxes;
mod level;
mod random;
mod scenes;
mod shapes;
mod shapes_on_gpu;

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
    pipelines: Variants<Show>,
    camera: Camera,
    sun: Sun,
    build: Build,
    show: Show,
}

common::shader_enum! {
    /// The quantity shown per pixel.
    enum Show: SHOW {
        Picture, Normal, Triangle, Hit, Direction = "ray direction", Shadow, Origin = "shadow origin",
        Kind = "hit kind",
    }
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
        let mut source = setup.scene_or(Scene::chess)?;
        source.model.materials.extend(shapes::materials());
        let camera = source.camera;
        let scene = SceneOnGpu::new(gpu, &source, setup.options)?;
        let build = Build { scene: SceneKind::Chess, count: 10_000 };
        let shapes = ShapesOnGpu::new(gpu, &source, &scene, build, camera.eye.as_vec3())?;
        let sun = Sun { azimuth: 60.0, elevation: 17.0, radiance: Vec3::new(4.4, 3.5, 2.4) };
        Ok(Self {
            source,
            scene,
            shapes,
            pipelines: Variants::default(),
            camera,
            sun,
            build,
            show: Show::Picture,
        })
    }

    fn controls(&mut self, c: &mut Controls) {
        let scene = c.choice("scene", &mut self.build.scene);
        if scene {
            self.build.count = scenes::default_count(self.build.scene);
        }
        let count = c.integer("count", &mut self.build.count, 1..=1_000_000);
        if scene || count {
            let Build { scene, count } = self.build;
            self.camera = scenes::camera(scene, self.source.camera, count);
        }
        c.choice("show", &mut self.show);
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
            self.pipelines.choose(frame, &self.scene.textures, self.show, pipeline)?;
        // ANCHOR: trace
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
        // ANCHOR_END: trace
        Ok(())
    }
}

/// A hit group for each kind of surface: triangles, spheres, boxes.
///
/// Only the raygen shader traces rays: they do not nest, and a recursion depth of 1 is enough.
fn pipeline(gpu: &Gpu, textures: &TextureTable, show: Show) -> Result<RayTracingPipeline> {
    RayTracingPipeline::builder(env!("CARGO_BIN_NAME"))
        .raygen("camera.rgen")
        .miss("sky.rmiss")
        .miss("common/shadow.rmiss")
        .hit(HitGroup::triangles().closest_hit("shade.rchit"))
        .hit(HitGroup::procedural("sphere.rint").closest_hit("shape.rchit"))
        .hit(HitGroup::procedural("box.rint").closest_hit("shape.rchit"))
        .constant(0, show)
        .recursion(1)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .textures(textures)
        .push_constants::<Push>()
        .build(gpu)
}
