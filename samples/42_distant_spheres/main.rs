//! 42 · Distant spheres: the textbook's sphere fails from afar, and forms that do not.
//!
//! New since 08_intersection: four ways to intersect a sphere and two for a box, a number computed on the host
//! for each sphere, boxes without padding, and scenes that are far away, large or small.

#[path = "../08_intersection/boxes.rs"]
mod boxes;
mod host_c;
#[path = "../08_intersection/level.rs"]
mod level;
#[path = "../08_intersection/random.rs"]
mod random;
mod scenes;
#[path = "../08_intersection/shapes.rs"]
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
        Kind = "hit kind",
    }
    /// The formula that intersects spheres.
    enum SphereRung: SPHERE { Textbook, Projection, Stable, HostC, Offered }
    /// The formula that intersects boxes.
    enum BoxRung: BOX { Reciprocal, Division }
}

/// Specialization constants of a pipeline's shaders.
#[derive(Clone, Copy, PartialEq)]
struct Constants {
    show: Show,
    shadows: bool,
    sphere_rung: SphereRung,
    box_rung: BoxRung,
}

common::shader_struct! {
    /// Push constants of all shaders.
    struct Push {
        camera: CameraBasis,
        scene: SceneAddresses,
        shapes: Address<ShapeAddresses>,
        host_c: Address,
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
        let build = Build { scene: SceneKind::OneSphere, count: 10_000, margin: true };
        let distance = 1e4;
        let camera = scenes::camera(build.scene, source.camera, build.count, distance);
        let scene = SceneOnGpu::new(gpu, &source, setup.options)?;
        let shapes = ShapesOnGpu::new(gpu, &source, &scene, build, camera.eye.as_vec3())?;
        let constants = Constants {
            show: Show::Picture,
            shadows: false,
            sphere_rung: SphereRung::Stable,
            box_rung: BoxRung::Division,
        };
        let sun = Sun { azimuth: 60.0, elevation: 17.0, radiance: Vec3::new(4.4, 3.5, 2.4) };
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
        // A scene brings its size, its view, and whether its shadows are worth their time.
        if c.choice("scene", &mut self.build.scene) {
            self.build.count = scenes::default_count(self.build.scene);
            self.constants.shadows =
                [SceneKind::Chess, SceneKind::Grid].contains(&self.build.scene);
            self.camera = self.scene_camera();
        }
        if c.integer("count", &mut self.build.count, 1..=1_000_000) {
            self.camera = self.scene_camera();
        }
        if c.slider("distance", &mut self.distance, 1e-3..=1e6) {
            self.camera = self.scene_camera();
        }
        let scene = self.build.scene;
        c.needs("count", "scene=grid, random ball or dust", scenes::has_count(scene));
        c.needs("distance", "scene=one sphere", scene == SceneKind::OneSphere);
        c.choice("sphere rung", &mut self.constants.sphere_rung);
        c.choice("box rung", &mut self.constants.box_rung);
        c.checkbox("margin", &mut self.build.margin);
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
        let Variant { key, pipeline, sbt } =
            self.pipelines.choose(frame, &self.scene.textures, self.constants, pipeline)?;
        if key.sphere_rung == SphereRung::HostC {
            self.shapes.host_c.compute(frame, self.camera.eye.as_vec3())?;
        }
        // ANCHOR: trace
        let push = Push {
            camera: self.camera.basis(frame.aspect()),
            scene: self.scene.addresses,
            shapes: self.shapes.addresses.address.into(),
            host_c: self.shapes.host_c.address(),
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

impl Demo {
    fn scene_camera(&self) -> Camera {
        scenes::camera(self.build.scene, self.source.camera, self.build.count, self.distance)
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
        .constant(2, constants.sphere_rung)
        .constant(3, constants.box_rung)
        .recursion(1)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .textures(textures)
        .push_constants::<Push>()
        .build(gpu)
}
