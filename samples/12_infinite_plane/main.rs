//! 12 · Infinite plane: a surface that no acceleration structure can hold, met before the ray is traced.
//!
//! New since 06_reflection: a plane that bounds each ray, the miss shader of rays that reach it, four
//! ways to intersect it, a checker board without aliasing, two lights at once, and three scenes.

mod plane;
mod scenes;

use std::collections::HashMap;
use std::process::ExitCode;

use anyhow::Result;
use common::gpu::{
    Address, Binding, Buffer, Descriptor, Gpu, HitGroup, RayTracingPipeline, Requirements,
    ShaderBindingTable, TextureTable,
};
use common::scene::{
    Camera, CameraBasis, Light, Material, Model, Placement, PointLight, Scene, SceneAddresses,
    SceneOnGpu, Sun, input_usage,
};
use common::{Controls, Frame, Sample, Setup};
use glam::{DVec3, Vec2, Vec3};
use plane::{Plane, PlaneLook, PlaneRecord};
use scenes::Preset;

fn main() -> ExitCode {
    common::run::<Demo>(env!("CARGO_BIN_NAME"))
}

/// What a trace needs, made for one method and one depth of recursion, one rung and one order of tests.
type Program = (RayTracingPipeline, ShaderBindingTable);
type MadeFor = (u32, u32, u32, u32);

const LIGHT_POINT: u32 = 1;
const LIGHT_BOTH: u32 = 2;

const METHOD_ITERATIVE: u32 = 0;
const METHOD_RECURSIVE: u32 = 1;

/// A place 10000 units from the origin, and no axis spared.
const FAR: DVec3 = DVec3::new(6000.0, 4800.0, 6400.0);

struct Demo {
    own: Scene,
    model: Scene,
    scene: SceneOnGpu,
    placement: Placement,
    preset: u32,
    placed_preset: u32,
    reflections: Buffer,
    plane: Plane,
    plane_on: bool,
    look: PlaneLook,
    roughness: f32,
    look_on_gpu: (PlaneLook, Buffer),
    inside: u32,
    plane_test: u32,
    rung: u32,
    programs: HashMap<MadeFor, Program>,
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
        reflections: Address,
        look: Address,
        plane: PlaneRecord,
        anchor_square: Vec2,
        inside: u32,
        lights: [Light; 2],
        light_count: u32,
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
        let mut own = setup.scene_or(royal_metal)?;
        scenes::extend(&mut own.model);
        let preset = Preset::new(0, &own);
        let Preset { camera, sun, lamp, light, plane, look, .. } = preset;
        let model = Scene { model: own.model.clone(), instances: preset.instances, camera };
        let scene = SceneOnGpu::new(gpu, &model, setup.options)?;
        let reflections: Vec<Vec3> = model.model.materials.iter().map(scenes::reflection).collect();
        Ok(Self {
            own,
            model,
            scene,
            placement: Placement::default(),
            preset: 0,
            placed_preset: 0,
            reflections: Buffer::with_data(gpu, "reflections", &reflections, input_usage())?,
            plane,
            plane_on: true,
            look,
            roughness: roughness(look.shininess),
            look_on_gpu: (look, Buffer::with_data(gpu, "look", &[look], input_usage())?),
            inside: 0,
            plane_test: 0,
            rung: 3,
            programs: HashMap::new(),
            camera,
            sun,
            lamp,
            light,
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
        if c.choice("preset", &mut self.preset, &scenes::PRESETS) {
            self.take_preset();
        }
        c.checkbox("plane", &mut self.plane_on);
        let forms = ["normal and distance", "point and normal"];
        c.choice("plane form", &mut self.plane.form, &forms);
        c.vector("plane normal", &mut self.plane.normal, -1e3..=1e3);
        c.slider("plane distance", &mut self.plane.distance, -1e6..=1e6);
        c.vector("plane point", &mut self.plane.point, -1e6..=1e6);
        c.checkbox("inverse", &mut self.plane.inverse);
        c.choice("inside", &mut self.inside, &["surface", "color", "through"]);
        c.color("inside color", &mut self.look.inner);
        c.choice("checker", &mut self.look.checker, &["filtered", "point", "off"]);
        c.color("light squares", &mut self.look.light);
        c.color("dark squares", &mut self.look.dark);
        c.slider("square", &mut self.look.square, 0.01..=100.0);
        c.slider("plane reflection", &mut self.look.reflection, 0.0..=1.0);
        c.slider("plane specular", &mut self.look.specular, 0.0..=1.0);
        c.slider("plane roughness", &mut self.roughness, 0.05..=1.0);
        c.choice("rung", &mut self.rung, &["pov", "point", "cut-off", "compensated"]);
        c.choice("plane test", &mut self.plane_test, &["before", "after"]);
        let views = [
            "picture",
            "normal",
            "triangle",
            "hit",
            "ray direction",
            "shadow",
            "shadow origin",
            "ray origin",
            "rungs",
        ];
        c.choice("show", &mut self.show, &views);
        c.choice("light", &mut self.light, &scenes::LIGHTS);
        c.slider("sun azimuth", &mut self.sun.azimuth, 0.0..=360.0);
        c.slider("sun elevation", &mut self.sun.elevation, 0.0..=90.0);
        c.vector("lamp position", &mut self.lamp.position, -100.0..=100.0);
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
        if placement != self.placement || self.preset != self.placed_preset {
            let placed = placement.scene(&self.model);
            self.scene.rebuild(frame.gpu, &placed, self.scene.options)?;
            self.placement = placement;
            self.placed_preset = self.preset;
        }
        // ANCHOR_END: place
        // ANCHOR: plane
        let look = PlaneLook {
            square: self.look.square * placement.size as f32,
            shininess: shininess(self.roughness),
            ..self.look
        };
        if look != self.look_on_gpu.0 {
            let buffer = Buffer::with_data(frame.gpu, "look", &[look], input_usage())?;
            self.look_on_gpu = (look, buffer);
        }
        let camera = placement.camera(&self.camera).basis(frame.aspect());
        let placed = self.plane.placed(&placement).filter(|_| self.plane_on);
        // Without a plane, any will do that no ray is tested against.
        let plane = Plane::record(placed.unwrap_or((DVec3::Y, 0.0)), camera.origin);
        // ANCHOR_END: plane
        // ANCHOR: recursion
        // A loop's rays all come from the raygen shader, and at a hit there is the shadow ray. By
        // recursion the camera's ray and each reflection are a level of their own.
        let recursion = if self.method == METHOD_RECURSIVE { self.depth + 2 } else { 2 };
        let made_for = (self.method, recursion, self.rung, self.plane_test);
        if !self.programs.contains_key(&made_for) {
            let made = program(frame.gpu, &self.scene.textures, made_for)?;
            self.programs.insert(made_for, made);
        }
        let (pipeline, sbt) = &self.programs[&made_for];
        // ANCHOR_END: recursion
        // ANCHOR: lights
        let sun = Light::directional(&self.sun, self.light_size);
        let size = self.light_size * placement.size as f32;
        let lamp = Light::point(&placement.lamp(&self.lamp), size);
        let [first, second] = if self.light == LIGHT_POINT { [lamp, sun] } else { [sun, lamp] };
        // ANCHOR_END: lights
        // ANCHOR: trace
        let push = Push {
            camera,
            scene: self.scene.addresses,
            reflections: self.reflections.address.into(),
            look: self.look_on_gpu.1.address.into(),
            plane,
            anchor_square: plane::anchor_square(&plane, &placement, self.look.square),
            inside: placed.map_or(0, |_| self.inside + 1),
            lights: [first, second],
            light_count: if self.light == LIGHT_BOTH { 2 } else { 1 },
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

impl Demo {
    /// Takes over what a preset brings: things, lights, view and plane.
    fn take_preset(&mut self) {
        let preset = Preset::new(self.preset, &self.own);
        let Preset { instances, camera, sun, lamp, light, plane, look } = preset;
        self.model.instances = instances;
        (self.camera, self.sun, self.lamp, self.light) = (camera, sun, lamp, light);
        (self.plane, self.look, self.roughness) = (plane, look, roughness(look.shininess));
    }
}

// ANCHOR: roughness
/// The exponent of a highlight that is as wide as that of a surface of this roughness, and back
/// (Walter et al., "Microfacet Models for Refraction", 2007, with their width as roughness squared).
fn shininess(roughness: f32) -> f32 {
    2.0 / roughness.powi(4) - 2.0
}

fn roughness(shininess: f32) -> f32 {
    (2.0 / (shininess + 2.0)).powf(0.25)
}
// ANCHOR_END: roughness

/// The pipeline of a method, declared to nest `recursion` rays, and its table; the plane tested by a
/// rung, before or after the scene.
fn program(gpu: &Gpu, textures: &TextureTable, made_for: MadeFor) -> Result<Program> {
    let (method, recursion, rung, plane_test) = made_for;
    // ANCHOR: pipeline
    let pipeline = RayTracingPipeline::builder(env!("CARGO_BIN_NAME"))
        .raygen("camera.rgen")
        .miss("sky.rmiss")
        .miss("shadow.rmiss")
        .miss("plane.rmiss")
        .hit(HitGroup::triangles().closest_hit("shade.rchit"))
        .recursion(recursion)
        .constant(0, method)
        .constant(1, rung)
        .constant(2, plane_test)
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
    scene.camera = Camera::new(DVec3::new(-3.4, 1.6, 7.2), DVec3::new(0.6, 0.62, 0.0), 37.0);
    Ok(scene)
}
// ANCHOR_END: metal
