//! 06 · Reflection: a hit sends the next ray on its way, from a loop or by recursion.
//!
//! New since 05_shadow_miss: a payload that carries a path from ray to ray, traced by a loop in the
//! raygen shader or by the closest hit shader itself; six rules for where such a ray starts.

use std::process::ExitCode;

use anyhow::Result;
use common::gpu::{
    Binding, Descriptor, Gpu, HitGroup, RayTracingPipeline, Requirements, ShaderBindingTable,
};
use common::scene::{
    Camera, CameraBasis, Light, Placement, PointLight, Scene, SceneAddresses, SceneOnGpu, Sun,
};
use common::{Controls, Frame, Sample, Setup};
use glam::{DVec3, Vec3};

fn main() -> ExitCode {
    common::run::<Demo>(env!("CARGO_BIN_NAME"))
}

const METHOD_ITERATIVE: u32 = 0;
const METHOD_RECURSIVE: u32 = 1;
const MAX_DEPTH: u32 = 8;

/// A place 10000 units from the origin, and no axis spared.
const FAR: DVec3 = DVec3::new(6000.0, 4800.0, 6400.0);

struct Demo {
    model: Scene,
    scene: SceneOnGpu,
    placement: Placement,
    pipelines: Vec<(Variant, RayTracingPipeline, ShaderBindingTable)>,
    camera: Camera,
    sun: Sun,
    lamp: PointLight,
    light: u32,
    light_size: f32,
    light_samples: u32,
    shadow_rays: u32,
    smooth_terminator: bool,
    method: u32,
    depth: u32,
    deepest: u32,
    minimum_contribution: f32,
    origin: u32,
    size: u32,
    moved: u32,
    bounce: u32,
    show: u32,
}

/// What a pipeline is made for: the method, and how deep its rays nest.
#[derive(Clone, Copy, PartialEq)]
struct Variant {
    method: u32,
    recursion: u32,
}

common::shader_struct! {
    /// What every shader of this chapter can read.
    struct Push {
        camera: CameraBasis,
        scene: SceneAddresses,
        light: Light,
        light_samples: u32,
        shadow_rays: u32,
        smooth_terminator: u32,
        depth: u32,
        minimum_contribution: f32,
        origin: u32,
        bounce: u32,
        show: u32,
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
            pipelines: Vec::new(),
            camera,
            sun: Sun { azimuth: 340.0, elevation: 20.0, radiance: Vec3::new(4.4, 3.5, 2.4) },
            lamp: PointLight::default(),
            light: 0,
            light_size: 0.0,
            light_samples: 16,
            shadow_rays: 0,
            smooth_terminator: true,
            method: METHOD_ITERATIVE,
            depth: 4,
            deepest: MAX_DEPTH.min(gpu.limits.max_ray_recursion_depth.saturating_sub(2)),
            minimum_contribution: 1.0 / 512.0,
            origin: 5,
            size: 1,
            moved: 0,
            bounce: 0,
            show: 0,
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
        c.choice("show", &mut self.show, &views);
        c.choice("light", &mut self.light, &["directional", "point"]);
        c.slider("sun azimuth", &mut self.sun.azimuth, 0.0..=360.0);
        c.slider("sun elevation", &mut self.sun.elevation, 0.0..=90.0);
        c.vector("lamp position", &mut self.lamp.position, -10.0..=10.0);
        c.slider("light size", &mut self.light_size, 0.0..=1.0);
        c.integer("light samples", &mut self.light_samples, 1..=64);
        c.choice("shadow rays", &mut self.shadow_rays, &["first hit", "nearest hit", "off"]);
        c.checkbox("smooth terminator", &mut self.smooth_terminator);
        c.choice("method", &mut self.method, &["iterative", "recursive"]);
        let deepest = if self.method == METHOD_RECURSIVE { self.deepest } else { MAX_DEPTH };
        // What a loop may do can be too deep for this device's recursion.
        self.depth = self.depth.min(deepest);
        c.integer("depth", &mut self.depth, 0..=deepest);
        c.slider("minimum contribution", &mut self.minimum_contribution, 0.0..=1.0);
        let rules = ["nothing", "tmin", "normal", "integers", "reprojected", "bound"];
        c.choice("origin", &mut self.origin, &rules);
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
        let chosen = self.choose_pipeline(frame.gpu)?;
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
            shadow_rays: self.shadow_rays,
            smooth_terminator: self.smooth_terminator.into(),
            depth: self.depth,
            minimum_contribution: self.minimum_contribution,
            origin: self.origin,
            bounce: self.bounce,
            show: self.show,
        };
        let descriptors = [
            Descriptor::AccelerationStructure(&self.scene.tlas),
            Descriptor::StorageImage(frame.image),
        ];
        let (_, pipeline, sbt) = &self.pipelines[chosen];
        pipeline.bind(frame.cmd, &descriptors, &push)?;
        sbt.trace(frame.cmd, frame.image.extent);
        // ANCHOR_END: trace
        Ok(())
    }
}

impl Demo {
    // ANCHOR: variant
    /// Which of the pipelines is for the method and the depth in use; it is made when first wanted.
    fn choose_pipeline(&mut self, gpu: &Gpu) -> Result<usize> {
        // A loop's rays all come from the raygen shader, and at a hit there is the shadow ray. By
        // recursion the camera's ray and every reflection are a level each.
        let recursion = if self.method == METHOD_RECURSIVE { 1 + self.depth + 1 } else { 1 + 1 };
        let variant = Variant { method: self.method, recursion };
        let known = self.pipelines.iter().position(|(known, ..)| *known == variant);
        if let Some(known) = known {
            return Ok(known);
        }
        let pipeline = pipeline(gpu, &self.scene, variant)?;
        let sbt = ShaderBindingTable::new(gpu, &pipeline)?;
        self.pipelines.push((variant, pipeline, sbt));
        Ok(self.pipelines.len() - 1)
    }
    // ANCHOR_END: variant
}

// ANCHOR: pipeline
/// The method is a specialization constant: in the loop's pipeline no shader calls itself.
fn pipeline(gpu: &Gpu, scene: &SceneOnGpu, variant: Variant) -> Result<RayTracingPipeline> {
    RayTracingPipeline::builder(env!("CARGO_BIN_NAME"))
        .raygen("camera.rgen")
        .miss("sky.rmiss")
        .miss("shadow.rmiss")
        .hit(HitGroup::triangles().closest_hit("shade.rchit"))
        .constant(0, variant.method)
        .recursion(variant.recursion)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .textures(&scene.textures)
        .push_constants::<Push>()
        .build(gpu)
}
// ANCHOR_END: pipeline
