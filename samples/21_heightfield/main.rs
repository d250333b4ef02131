//! 21 · Heightfield: a landscape without triangles, marched by an intersection shader inside one box.
//!
//! New since 12_infinite_plane: a height for every (x, z), four ways to march a ray to it, a box in the
//! top level with pieces that stand on the ground, views of steps and errors, and four scenes.

mod ground;
mod land;
mod scenes;

use std::process::ExitCode;

use anyhow::Result;
use ash::vk;
use common::gpu::{
    Address, Binding, Buffer, Descriptor, Gpu, HitGroup, RayTracingPipeline, Requirements,
    ShaderBindingTable, ShaderStruct,
};
use common::scene::board::Board;
use common::scene::plane::{HalfSpace, Plane};
use common::scene::{
    Camera, CameraBasis, Light, Placement, PointLight, Scene, SceneAddresses, SceneOnGpu, Sun,
    input_usage,
};
use common::{Controls, Frame, Sample, Setup};
use glam::{DVec3, Vec3};
use ground::{Ground, HeightfieldShape, Landscape};
use land::Land;
use scenes::Preset;

fn main() -> ExitCode {
    common::run::<Demo>(env!("CARGO_BIN_NAME"))
}

const LIGHT_POINT: u32 = 1;
const LIGHT_BOTH: u32 = 2;

const METHOD_ITERATIVE: u32 = 0;
const METHOD_RECURSIVE: u32 = 1;
const MAX_DEPTH: u32 = 8;

struct Demo {
    model: Scene,
    scene: SceneOnGpu,
    land: Land,
    world: Buffer,
    reflections: Buffer,
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
    bounce: u32,
    show: u32,
    preset: u32,
    plane: HalfSpace,
    plane_on: bool,
    inside: u32,
    board: Board,
    plane_rung: u32,
    plane_test: u32,
    landscape: Landscape,
    ground: Ground,
    rung: u32,
}

/// What a pipeline is made for: the method, how deep its rays nest, how and when the plane is tested,
/// how the ground is marched.
#[derive(Clone, Copy, PartialEq)]
struct Variant {
    method: u32,
    recursion: u32,
    plane_rung: u32,
    plane_test: u32,
    rung: u32,
}

common::shader_struct! {
    /// What every shader of this chapter can read.
    struct Push {
        camera: CameraBasis,
        scene: SceneAddresses,
        world: Address,
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

common::shader_struct! {
    /// What is in the world beside the scene.
    struct World {
        reflections: Address,
        plane: Plane,
        board: Board,
        inside: u32,
        light_count: u32,
        lights: [Light; 2],
        ground: Ground,
    }
}

impl Sample for Demo {
    fn requirements() -> Requirements {
        Requirements::ray_tracing().textures()
    }

    fn new(gpu: &Gpu, setup: &Setup) -> Result<Self> {
        let model = setup.scene_or(scenes::chess)?;
        let Preset { landscape, camera, sun, lamp, light, plane, board } = Preset::new(0);
        let scene = SceneOnGpu::new(gpu, &model, setup.options)?;
        let land = Land::new(gpu, &model, &scene, landscape, camera.eye.as_vec3())?;
        gpu.share_structs(&[World::LAYOUT, Plane::LAYOUT, Board::LAYOUT, Light::LAYOUT]);
        gpu.share_structs(&[Ground::LAYOUT, HeightfieldShape::LAYOUT]);
        let usage = input_usage() | vk::BufferUsageFlags::TRANSFER_DST;
        let world = Buffer::new(gpu, "world", size_of::<World>() as u64, usage)?;
        let reflections: Vec<Vec3> = model.model.materials.iter().map(scenes::reflection).collect();
        let reflections = Buffer::with_data(gpu, "reflections", &reflections, input_usage())?;
        Ok(Self {
            model,
            scene,
            land,
            world,
            reflections,
            pipelines: Vec::new(),
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
            deepest: MAX_DEPTH.min(gpu.limits.max_ray_recursion_depth.saturating_sub(2)),
            minimum_contribution: 1.0 / 512.0,
            origin: 5,
            bounce: 0,
            show: 0,
            preset: 0,
            plane,
            plane_on: true,
            inside: 0,
            board,
            plane_rung: 3,
            plane_test: 0,
            landscape,
            ground: Ground::default(),
            rung: 3,
        })
    }

    // ANCHOR: controls
    fn controls(&mut self, c: &mut Controls) {
        if c.choice("preset", &mut self.preset, &scenes::PRESETS) {
            self.take_preset();
        }
        c.choice("rung", &mut self.rung, &["relaxed", "lipschitz", "over-relaxed", "bisected"]);
        c.slider("steepness", &mut self.landscape.k, 0.0..=16.0);
        c.integer("rings", &mut self.landscape.rings, 0..=100);
        c.choice("fields", &mut self.ground.checker, &["filtered", "point", "off"]);
        c.color("light fields", &mut self.ground.light);
        c.color("dark fields", &mut self.ground.dark);
        c.color("rock", &mut self.ground.rock);
        c.slider("ground reflection", &mut self.ground.reflection, 0.0..=1.0);
        c.checkbox("plane", &mut self.plane_on);
        let forms = ["normal and distance", "point and normal"];
        c.choice("plane form", &mut self.plane.form, &forms);
        c.vector("plane normal", &mut self.plane.normal, -1e3..=1e3);
        c.slider("plane distance", &mut self.plane.distance, -1e6..=1e6);
        c.vector("plane point", &mut self.plane.point, -1e6..=1e6);
        c.checkbox("inverse", &mut self.plane.inverse);
        c.choice("inside", &mut self.inside, &["surface", "color", "through"]);
        c.color("inside color", &mut self.board.inner);
        c.choice("checker", &mut self.board.checker, &["filtered", "point", "off"]);
        c.color("light squares", &mut self.board.light);
        c.color("dark squares", &mut self.board.dark);
        c.slider("square", &mut self.board.square, 0.01..=100.0);
        c.slider("plane reflection", &mut self.board.reflection, 0.0..=1.0);
        c.slider("plane specular", &mut self.board.specular, 0.0..=1.0);
        c.slider("plane roughness", &mut self.board.roughness, 0.05..=1.0);
        let rungs = ["pov", "point", "cut-off", "compensated"];
        c.choice("plane rung", &mut self.plane_rung, &rungs);
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
            "steps",
            "error",
            "march",
        ];
        c.choice("show", &mut self.show, &views);
        c.choice("light", &mut self.light, &["directional", "point", "both"]);
        c.slider("sun azimuth", &mut self.sun.azimuth, 0.0..=360.0);
        c.slider("sun elevation", &mut self.sun.elevation, 0.0..=90.0);
        c.vector("lamp position", &mut self.lamp.position, -100.0..=100.0);
        c.slider("light size", &mut self.light_size, 0.0..=1.0);
        c.integer("light samples", &mut self.light_samples, 1..=64);
        c.choice("shadow rays", &mut self.shadow_rays, &["first hit", "nearest hit", "off"]);
        c.checkbox("smooth terminator", &mut self.smooth_terminator);
        c.choice("method", &mut self.method, &["iterative", "recursive"]);
        let deepest = if self.method == METHOD_RECURSIVE { self.deepest } else { MAX_DEPTH };
        c.integer("depth", &mut self.depth, 0..=deepest);
        c.slider("minimum contribution", &mut self.minimum_contribution, 0.0..=1.0);
        let rules = ["nothing", "tmin", "normal", "integers", "reprojected", "bound"];
        c.choice("origin", &mut self.origin, &rules);
        c.integer("bounce", &mut self.bounce, 0..=MAX_DEPTH);
        c.camera(&mut self.camera);
    }
    // ANCHOR_END: controls

    fn render(&mut self, frame: &Frame) -> Result<()> {
        // ANCHOR: place
        let eye = self.camera.eye.as_vec3();
        if !self.land.is_of(self.landscape, eye) {
            self.land = Land::new(frame.gpu, &self.model, &self.scene, self.landscape, eye)?;
        }
        // ANCHOR_END: place
        let chosen = self.choose_pipeline(frame.gpu)?;
        // ANCHOR: world
        let camera = self.camera.basis(frame.aspect());
        let placement = Placement::default();
        // Without a plane, any will do that no ray is tested against.
        let placed = self.plane.placed(&placement).filter(|_| self.plane_on);
        let plane = Plane::new(placed.unwrap_or((DVec3::Y, 0.0)), camera.origin);
        let sun = Light::directional(&self.sun, self.light_size);
        let lamp = Light::point(&self.lamp, self.light_size);
        let world = World {
            reflections: self.reflections.address.into(),
            plane,
            board: self.board.placed(&placement, &self.plane, &plane),
            inside: placed.map_or(0, |_| self.inside + 1),
            light_count: if self.light == LIGHT_BOTH { 2 } else { 1 },
            lights: if self.light == LIGHT_POINT { [lamp, sun] } else { [sun, lamp] },
            ground: self.land.ground(self.ground),
        };
        self.world.write(0, &[world])?;
        // ANCHOR_END: world
        // ANCHOR: trace
        let push = Push {
            camera,
            scene: self.scene.addresses,
            world: self.world.address.into(),
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
            Descriptor::AccelerationStructure(&self.land.tlas),
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
    /// Takes over what a preset brings: ground, view, lights and plane.
    fn take_preset(&mut self) {
        let Preset { landscape, camera, sun, lamp, light, plane, board } = Preset::new(self.preset);
        (self.landscape, self.camera) = (landscape, camera);
        (self.sun, self.lamp, self.light) = (sun, lamp, light);
        (self.plane, self.board) = (plane, board);
    }

    // ANCHOR: variant
    /// Which of the pipelines is for the method, the depth and the tests in use; it is made when first
    /// wanted.
    fn choose_pipeline(&mut self, gpu: &Gpu) -> Result<usize> {
        // A loop's rays all come from the raygen shader, and at a hit there is the shadow ray. By
        // recursion the camera's ray and every reflection are a level each.
        let recursion = if self.method == METHOD_RECURSIVE { 1 + self.depth + 1 } else { 1 + 1 };
        let Self { method, plane_rung, plane_test, rung, .. } = *self;
        let variant = Variant { method, recursion, plane_rung, plane_test, rung };
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
/// The method is a specialization constant: in the loop's pipeline no shader calls itself. So are the
/// plane's rung, when it is tested, and the ground's rung.
fn pipeline(gpu: &Gpu, scene: &SceneOnGpu, variant: Variant) -> Result<RayTracingPipeline> {
    RayTracingPipeline::builder(env!("CARGO_BIN_NAME"))
        .raygen("camera.rgen")
        .miss("sky.rmiss")
        .miss("shadow.rmiss")
        .miss("plane.rmiss")
        .hit(HitGroup::triangles().closest_hit("shade.rchit"))
        .hit(HitGroup::procedural("terrain.rint").closest_hit("terrain.rchit"))
        .constant(0, variant.method)
        .constant(1, variant.plane_rung)
        .constant(2, variant.plane_test)
        .constant(3, variant.rung)
        .recursion(variant.recursion)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .textures(&scene.textures)
        .push_constants::<Push>()
        .build(gpu)
}
// ANCHOR_END: pipeline
