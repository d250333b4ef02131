//! 38 · Primitive order: the order of a list decides the tree that is built from it.
//!
//! New since 08_intersection: six orders of the same boxes, the tree that halves a list, a view of how many
//! boxes each ray is tested against, and shapes copied into the order of the build.

#[path = "../08_intersection/boxes.rs"]
mod boxes;
#[path = "../08_intersection/level.rs"]
mod level;
mod order;
#[path = "../08_intersection/random.rs"]
mod random;
#[path = "../08_intersection/scenes.rs"]
mod scenes;
#[path = "../08_intersection/shapes.rs"]
mod shapes;
mod shapes_on_gpu;
mod tree;

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
use order::Order;
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
    constants: Constants,
}

common::shader_enum! {
    /// The quantity shown per pixel.
    enum Show: SHOW {
        Picture, Normal, Triangle, Hit, Direction = "ray direction", Shadow, Origin = "shadow origin",
        Kind = "hit kind", Place = "place in order", Tests = "box tests",
    }
}

/// Specialization constants of a pipeline's shaders.
#[derive(Clone, Copy, PartialEq)]
struct Constants {
    show: Show,
    shadows: bool,
    copies: bool,
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
        source.model.materials.extend(shapes::materials());
        let order = if setup.options.ordering { Order::Halves } else { Order::Given };
        let (scene, count) = (SceneKind::RandomBall, 10_000);
        let build = Build { scene, count, order };
        let camera = scenes::camera(scene, source.camera, count);
        let scene = SceneOnGpu::new(gpu, &source, setup.options)?;
        let shapes = ShapesOnGpu::new(gpu, &source, &scene, build, camera.eye.as_vec3())?;
        let constants = Constants { show: Show::Picture, shadows: false, copies: false };
        let sun = Sun { azimuth: 60.0, elevation: 17.0, radiance: Vec3::new(4.4, 3.5, 2.4) };
        Ok(Self {
            source,
            scene,
            shapes,
            pipelines: Variants::default(),
            camera,
            sun,
            build,
            constants,
        })
    }

    fn controls(&mut self, c: &mut Controls) {
        // A scene brings its size, its view, and whether its shadows are worth their time.
        let scene = c.choice("scene", &mut self.build.scene);
        if scene {
            self.build.count = scenes::default_count(self.build.scene);
            self.constants.shadows = self.build.scene != SceneKind::RandomBall;
        }
        let count = c.integer("count", &mut self.build.count, 1..=1_000_000);
        if scene || count {
            let Build { scene, count, .. } = self.build;
            self.camera = scenes::camera(scene, self.source.camera, count);
        }
        c.choice("order", &mut self.build.order);
        c.checkbox("copies in order", &mut self.constants.copies);
        let [spheres, boxes] = self.shapes.expected_tests;
        c.note("expected tests", &format!("{spheres:.0} of spheres, {boxes:.0} of boxes"));
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
        .hit(HitGroup::procedural("sphere.rint").closest_hit("shape.rchit"))
        .hit(HitGroup::procedural("box.rint").closest_hit("shape.rchit"))
        .constant(0, constants.show)
        .constant(1, constants.shadows)
        .constant(2, constants.copies)
        .recursion(1)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .textures(textures)
        .push_constants::<Push>()
        .build(gpu)
}
