//! 08 · Intersection: spheres and boxes, which the device does not know, found by our own shaders.
//!
//! New since 05_shadow_miss: bottom levels of boxes, the intersection shaders `sphere.rint` and
//! `box.rint`, a closest hit shader for both, hit groups per instance, and how exact all that is.

mod placed;
mod shapes;

use std::process::ExitCode;

use anyhow::Result;
use common::gpu::{
    Address, Binding, Descriptor, Gpu, HitGroup, RayTracingPipeline, Requirements, TextureTable,
    Variant, Variants,
};
use common::scene::{
    Camera, CameraBasis, Light, PointLight, Scene, SceneAddresses, SceneOnGpu, Sun,
};
use common::{Controls, Frame, Sample, Setup};
use glam::Vec3;
use placed::{Build, Placed};

fn main() -> ExitCode {
    common::run::<Demo>(env!("CARGO_BIN_NAME"))
}

/// The rung of `sphere.glsl` that takes c from the host.
const HOST_C: u32 = 3;
/// Not to trace shadow rays.
const NO_SHADOWS: u32 = 2;

struct Demo {
    model: Scene,
    scene: SceneOnGpu,
    placed: Placed,
    pipelines: Variants<Constants>,
    camera: Camera,
    sun: Sun,
    lamp: PointLight,
    light: u32,
    light_size: f32,
    light_samples: u32,
    build: Build,
    distance: f32,
    constants: Constants,
}

/// What a pipeline is made for: the specialization constants of its shaders.
#[derive(Clone, Copy, PartialEq)]
struct Constants {
    show: u32,
    shadow_rays: u32,
    smooth_terminator: bool,
    /// Which way spheres and boxes are intersected: a position in `sphere.glsl` and in `box.glsl`.
    sphere_rung: u32,
    box_rung: u32,
}

common::shader_struct! {
    /// What every shader of this chapter can read.
    struct Push {
        camera: CameraBasis,
        scene: SceneAddresses,
        shapes: Address,
        host_c: Address,
        light: Light,
        light_samples: u32,
    }
}

impl Sample for Demo {
    fn requirements() -> Requirements {
        Requirements::ray_tracing().textures()
    }

    fn new(gpu: &Gpu, setup: &Setup) -> Result<Self> {
        let mut model = setup.scene_or(Scene::chess)?;
        model.model.materials.extend(shapes::materials());
        let camera = model.camera;
        let scene = SceneOnGpu::new(gpu, &model, setup.options)?;
        let ordering = setup.options.ordering;
        let build = Build { scene: shapes::CHESS, count: 10_000, ordering, margin: true };
        let placed = Placed::new(gpu, &model, &scene, build, camera.eye.as_vec3())?;
        let constants = Constants {
            show: 0,
            shadow_rays: 0,
            smooth_terminator: true,
            sphere_rung: 2,
            box_rung: 1,
        };
        Ok(Self {
            model,
            scene,
            placed,
            pipelines: Variants::default(),
            camera,
            sun: Sun { azimuth: 60.0, elevation: 17.0, radiance: Vec3::new(4.4, 3.5, 2.4) },
            lamp: PointLight::default(),
            light: 0,
            light_size: 0.0,
            light_samples: 16,
            build,
            distance: 100.0,
            constants,
        })
    }

    // ANCHOR: controls
    fn controls(&mut self, c: &mut Controls) {
        // A scene brings its size, its view, and whether its shadows are worth their time.
        if c.choice("scene", &mut self.build.scene, &shapes::SCENES) {
            self.build.count = shapes::default_count(self.build.scene);
            let shadows = [shapes::CHESS, shapes::GRID].contains(&self.build.scene);
            self.constants.shadow_rays = if shadows { 0 } else { NO_SHADOWS };
            self.camera = self.scene_camera();
        }
        if c.integer("count", &mut self.build.count, 1..=1_000_000) {
            self.camera = self.scene_camera();
        }
        if c.slider("distance", &mut self.distance, 1e-3..=1e6) {
            self.camera = self.scene_camera();
        }
        let rungs = ["textbook", "projection", "stable", "host c", "offered"];
        c.choice("sphere rung", &mut self.constants.sphere_rung, &rungs);
        c.choice("box rung", &mut self.constants.box_rung, &["reciprocal", "division"]);
        c.checkbox("ordering", &mut self.build.ordering);
        c.checkbox("margin", &mut self.build.margin);
        let views = [
            "picture",
            "normal",
            "triangle",
            "hit",
            "ray direction",
            "shadow",
            "shadow origin",
            "hit kind",
        ];
        c.choice("show", &mut self.constants.show, &views);
        c.choice("light", &mut self.light, &["directional", "point"]);
        c.slider("sun azimuth", &mut self.sun.azimuth, 0.0..=360.0);
        c.slider("sun elevation", &mut self.sun.elevation, 0.0..=90.0);
        c.vector("lamp position", &mut self.lamp.position, -10.0..=10.0);
        c.slider("light size", &mut self.light_size, 0.0..=1.0);
        c.integer("light samples", &mut self.light_samples, 1..=64);
        let rays = ["first hit", "nearest hit", "off"];
        c.choice("shadow rays", &mut self.constants.shadow_rays, &rays);
        c.checkbox("smooth terminator", &mut self.constants.smooth_terminator);
        c.camera(&mut self.camera);
    }
    // ANCHOR_END: controls

    fn render(&mut self, frame: &Frame) -> Result<()> {
        // ANCHOR: rebuild
        let Variant { key, pipeline, sbt } =
            self.pipelines.choose(frame.gpu, &self.scene.textures, self.constants, pipeline)?;
        let eye = self.camera.eye.as_vec3();
        if self.placed.is_outdated(self.build, eye) {
            self.placed = Placed::new(frame.gpu, &self.model, &self.scene, self.build, eye)?;
        }
        if key.sphere_rung == HOST_C {
            self.placed.compute_host_c(frame.gpu, eye)?;
        }
        // ANCHOR_END: rebuild
        // ANCHOR: trace
        let push = Push {
            camera: self.camera.basis(frame.aspect()),
            scene: self.scene.addresses,
            shapes: self.placed.addresses.address.into(),
            host_c: self.placed.host_c_address(),
            light: match self.light {
                0 => Light::directional(&self.sun, self.light_size),
                _ => Light::point(&self.lamp, self.light_size),
            },
            light_samples: self.light_samples,
        };
        let descriptors = [
            Descriptor::AccelerationStructure(&self.placed.tlas),
            Descriptor::StorageImage(frame.image),
        ];
        pipeline.bind(frame.cmd, &descriptors, &push)?;
        sbt.trace(frame.cmd, frame.image.extent);
        // ANCHOR_END: trace
        Ok(())
    }
}

impl Demo {
    fn scene_camera(&self) -> Camera {
        shapes::camera(self.build.scene, self.model.camera, self.build.count, self.distance)
    }
}

// ANCHOR: pipeline
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
        .miss("shadow.rmiss")
        .hit(HitGroup::triangles().closest_hit("shade.rchit"))
        .hit(HitGroup::procedural("sphere.rint").closest_hit("shape.rchit"))
        .hit(HitGroup::procedural("box.rint").closest_hit("shape.rchit"))
        .constant(0, constants.show)
        .constant(1, constants.shadow_rays)
        .constant(2, constants.smooth_terminator.into())
        .constant(3, constants.sphere_rung)
        .constant(4, constants.box_rung)
        .recursion(1)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .textures(textures)
        .push_constants::<Push>()
        .build(gpu)
}
// ANCHOR_END: pipeline
