//! 06 · Reflection: a hit sends the next ray on its way, from a loop or by recursion.
//!
//! New since 05_shadow_miss: a payload that carries a path from ray to ray, traced by a loop in the
//! raygen shader or by the closest hit shader itself; six rules for where such a ray starts.

use std::collections::HashMap;
use std::process::ExitCode;

use anyhow::Result;
use common::gpu::{
    Binding, Descriptor, Gpu, HitGroup, RayTracingPipeline, Requirements, ShaderBindingTable,
    TextureTable,
};
use common::scene::{
    Camera, CameraBasis, Light, Material, Model, Placement, PointLight, Scene, SceneAddresses,
    SceneOnGpu, Sun,
};
use common::{Controls, Frame, Sample, Setup};
use glam::{DVec3, Vec3};

fn main() -> ExitCode {
    common::run::<Demo>(env!("CARGO_BIN_NAME"))
}

/// What a trace needs, made for one method and one depth of recursion.
type Program = (RayTracingPipeline, ShaderBindingTable);

const METHOD_ITERATIVE: u32 = 0;
const METHOD_RECURSIVE: u32 = 1;

/// A place 10000 units from the origin, and no axis spared.
const FAR: DVec3 = DVec3::new(6000.0, 4800.0, 6400.0);

struct Demo {
    model: Scene,
    scene: SceneOnGpu,
    placement: Placement,
    programs: HashMap<(u32, u32), Program>,
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
    minimum_contribution: f32,
    origin: u32,
    size: u32,
    moved: u32,
    bounce: u32,
    show: u32,
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
        let model = setup.scene_or(royal_metal)?;
        let camera = model.camera;
        let scene = SceneOnGpu::new(gpu, &model, setup.options)?;
        Ok(Self {
            model,
            scene,
            placement: Placement::default(),
            programs: HashMap::new(),
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
        c.integer("depth", &mut self.depth, 0..=8);
        c.slider("minimum contribution", &mut self.minimum_contribution, 0.0..=1.0);
        let rules = ["nothing", "tmin", "normal", "integers", "reprojected", "bound"];
        c.choice("origin", &mut self.origin, &rules);
        c.choice("size", &mut self.size, &["0.001", "1", "1000"]);
        c.choice("moved", &mut self.moved, &["0", "10000"]);
        c.integer("bounce", &mut self.bounce, 0..=8);
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
        // ANCHOR: recursion
        // A loop's rays all come from the raygen shader, and at a hit there is the shadow ray. By
        // recursion the camera's ray and each reflection are a level of their own.
        let recursion = if self.method == METHOD_RECURSIVE { self.depth + 2 } else { 2 };
        let made_for = (self.method, recursion);
        if !self.programs.contains_key(&made_for) {
            let made = program(frame.gpu, &self.scene.textures, self.method, recursion)?;
            self.programs.insert(made_for, made);
        }
        let (pipeline, sbt) = &self.programs[&made_for];
        // ANCHOR_END: recursion
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
        pipeline.bind(frame.cmd, &descriptors, &push)?;
        sbt.trace(frame.cmd, frame.image.extent);
        // ANCHOR_END: trace
        Ok(())
    }
}

/// The pipeline of a method, declared to nest `recursion` rays, and its table.
fn program(gpu: &Gpu, textures: &TextureTable, method: u32, recursion: u32) -> Result<Program> {
    // ANCHOR: pipeline
    let pipeline = RayTracingPipeline::builder(env!("CARGO_BIN_NAME"))
        .raygen("camera.rgen")
        .miss("sky.rmiss")
        .miss("shadow.rmiss")
        .hit(HitGroup::triangles().closest_hit("shade.rchit"))
        .recursion(recursion)
        .constant(0, method)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .textures(textures)
        .push_constants::<Push>()
        .build(gpu)?;
    let sbt = ShaderBindingTable::new(gpu, &pipeline)?;
    // ANCHOR_END: pipeline
    Ok((pipeline, sbt))
}

// ANCHOR: metal
/// The chess set, its kings and queens of metal: silver and gold, by their reflectance in linear RGB
/// (Akenine-Moeller et al., Real-Time Rendering, 4th ed., table 9.2; gold's red is cut to 1).
fn royal_metal() -> Result<Scene> {
    let mut scene = Scene::chess()?;
    let Model { meshes, materials, .. } = &mut scene.model;
    for (wood, metal, specular) in [
        ("white", "gold", Vec3::new(1.0, 0.782, 0.344)),
        ("black", "silver", Vec3::new(0.972, 0.96, 0.915)),
    ] {
        // Light that enters a metal is lost: it has no colour but that of its reflections.
        let like = materials.iter().find(|material| material.name == wood).cloned();
        let name = metal.to_owned();
        let metal = Material { name, base_color: Vec3::ZERO, specular, ..like.unwrap_or_default() };
        for instance in &mut scene.instances {
            let royal = ["king", "queen"].contains(&meshes[instance.mesh].name.as_str());
            if royal && materials[instance.material].name == wood {
                instance.material = materials.len();
            }
        }
        materials.push(metal);
    }
    scene.camera = Camera::new(DVec3::new(-8.2, 2.9, 5.2), DVec3::new(-0.2, 0.35, 0.8), 32.0);
    Ok(scene)
}
// ANCHOR_END: metal
