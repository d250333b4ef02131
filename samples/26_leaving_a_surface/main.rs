//! 26 · Leaving a surface: where a shadow ray or a mirrored ray starts, by seven rules.
//!
//! New since 06_reflection: a start for each direction, in three sizes of the scene and far from the
//! origin. The hit shader reports what the strictest rule needs: the weights and the matrix.

use std::process::ExitCode;

use anyhow::Result;
use common::gpu::{
    Binding, Descriptor, Gpu, HitGroup, RayTracingPipeline, Requirements, TextureTable, Variant,
    Variants,
};
use common::scene::{
    Camera, CameraBasis, Light, Placement, PointLight, Scene, SceneAddresses, SceneOnGpu, Sun,
};
use common::{Controls, Frame, Sample, Setup};
use glam::{DVec3, Vec3};

fn main() -> ExitCode {
    common::run::<Demo>(env!("CARGO_BIN_NAME"))
}

const MAX_DEPTH: u32 = 8;

/// A place 10000 units from the origin, and no axis spared.
const FAR: DVec3 = DVec3::new(6000.0, 4800.0, 6400.0);

struct Demo {
    model: Scene,
    scene: SceneOnGpu,
    placement: Placement,
    pipelines: Variants<Constants>,
    camera: Camera,
    sun: Sun,
    lamp: PointLight,
    light: u32,
    light_size: f32,
    light_samples: u32,
    depth: u32,
    minimum_contribution: f32,
    size: u32,
    moved: u32,
    bounce: u32,
    constants: Constants,
}

/// What a pipeline is made for: the specialization constants of its shaders.
#[derive(Clone, Copy, PartialEq)]
struct Constants {
    show: u32,
    shadow_rays: u32,
    smooth_terminator: bool,
    origin: u32,
}

common::shader_struct! {
    /// What every shader of this chapter can read.
    struct Push {
        camera: CameraBasis,
        scene: SceneAddresses,
        light: Light,
        light_samples: u32,
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
        let model = setup.scene_or(Scene::chess_of_metal)?;
        let camera = model.camera;
        let scene = SceneOnGpu::new(gpu, &model, setup.options)?;
        Ok(Self {
            model,
            scene,
            placement: Placement::default(),
            pipelines: Variants::default(),
            camera,
            sun: Sun { azimuth: 340.0, elevation: 20.0, radiance: Vec3::new(4.4, 3.5, 2.4) },
            lamp: PointLight::default(),
            light: 0,
            light_size: 0.0,
            light_samples: 16,
            depth: 4,
            minimum_contribution: 1.0 / 512.0,
            size: 1,
            moved: 0,
            bounce: 0,
            constants: Constants { show: 0, shadow_rays: 0, smooth_terminator: true, origin: 5 },
        })
    }

    // ANCHOR: controls
    fn controls(&mut self, c: &mut Controls) {
        let views = [
            "picture",
            "normal",
            "triangle",
            "hit",
            "ray direction",
            "shadow",
            "shadow origin",
            "ray origin",
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
        c.integer("depth", &mut self.depth, 0..=MAX_DEPTH);
        c.slider("minimum contribution", &mut self.minimum_contribution, 0.0..=1.0);
        let rules = ["nothing", "tmin", "normal", "integers", "reprojected", "bound", "height"];
        c.choice("origin", &mut self.constants.origin, &rules);
        c.choice("size", &mut self.size, &["0.001", "1", "1000"]);
        c.choice("moved", &mut self.moved, &["0", "10000"]);
        c.integer("bounce", &mut self.bounce, 0..=MAX_DEPTH);
        c.camera(&mut self.camera);
    }
    // ANCHOR_END: controls

    fn render(&mut self, frame: &Frame) -> Result<()> {
        // ANCHOR: place
        let placement = Placement {
            size: [1e-3, 1.0, 1e3][self.size as usize],
            moved: [DVec3::ZERO, FAR][self.moved as usize],
        };
        if placement != self.placement {
            let placed = placement.scene(&self.model);
            self.scene.rebuild(frame.gpu, &placed, self.scene.options)?;
            self.placement = placement;
        }
        // ANCHOR_END: place
        // ANCHOR: trace
        let push = Push {
            camera: placement.camera(&self.camera).basis(frame.aspect()),
            scene: self.scene.addresses,
            light: match self.light {
                0 => Light::directional(&self.sun, self.light_size),
                _ => {
                    let size = self.light_size * placement.size as f32;
                    Light::point(&placement.lamp(&self.lamp), size)
                }
            },
            light_samples: self.light_samples,
            depth: self.depth,
            minimum_contribution: self.minimum_contribution,
            bounce: self.bounce,
        };
        let descriptors = [
            Descriptor::AccelerationStructure(&self.scene.tlas),
            Descriptor::StorageImage(frame.image),
        ];
        let Variant { pipeline, sbt, .. } =
            self.pipelines.choose(frame.gpu, &self.scene.textures, self.constants, pipeline)?;
        pipeline.bind(frame.cmd, &descriptors, &push)?;
        sbt.trace(frame.cmd, frame.image.extent);
        // ANCHOR_END: trace
        Ok(())
    }
}

// ANCHOR: pipeline
/// The rule for a ray's start is a constant of the pipeline, like the view.
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
        .constant(0, constants.show)
        .constant(1, constants.shadow_rays)
        .constant(2, constants.smooth_terminator.into())
        .constant(3, constants.origin)
        .recursion(1)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .textures(textures)
        .push_constants::<Push>()
        .build(gpu)
}
// ANCHOR_END: pipeline
