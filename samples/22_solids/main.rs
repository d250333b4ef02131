//! 22 · Solids: half-spaces and balls that have an inside, and all that can be made of them.
//!
//! New since 12_infinite_plane: solids by an intersection shader, union, intersection, difference and
//! inverse, a clip that cuts open, fog that fills what is outside, and seven scenes.

mod fog;
mod modifiers;
mod pieces;
mod program;
mod scenes;
mod shapes;
mod solid;
mod solids;

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
use fog::Fog;
use glam::{DVec3, Vec3};
use modifiers::Modifiers;
use program::{Face, Part};
use scenes::Preset;
use solid::Ball;
use solids::{SolidRecord, SolidsOnGpu};

fn main() -> ExitCode {
    common::run::<Demo>(env!("CARGO_BIN_NAME"))
}

const LIGHT_POINT: u32 = 1;
const LIGHT_BOTH: u32 = 2;

const METHOD_ITERATIVE: u32 = 0;
const METHOD_RECURSIVE: u32 = 1;
const MAX_DEPTH: u32 = 8;

/// A place 10000 units from the origin, and no axis spared.
const FAR: DVec3 = DVec3::new(6000.0, 4800.0, 6400.0);

struct Demo {
    model: Scene,
    scene: SceneOnGpu,
    solids: SolidsOnGpu,
    /// The preset, the placement and the solids that were built.
    placed: (u32, Placement, Modifiers),
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
    size: u32,
    moved: u32,
    bounce: u32,
    show: u32,
    preset: u32,
    plane: HalfSpace,
    plane_on: bool,
    inside: u32,
    board: Board,
    rung: u32,
    plane_test: u32,
    modifiers: Modifiers,
    fog: Fog,
    section_distance: f32,
}

/// What a pipeline is made for: the method, how deep its rays nest, how and when the plane is tested, and
/// where fog is.
#[derive(Clone, Copy, PartialEq)]
struct Variant {
    method: u32,
    recursion: u32,
    rung: u32,
    plane_test: u32,
    fog: u32,
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
        solids: Address,
        plane: Plane,
        board: Board,
        inside: u32,
        light_count: u32,
        lights: [Light; 2],
        fog: Fog,
        first_solid: u32,
        solid_count: u32,
        section_distance: f32,
    }
}

impl Sample for Demo {
    fn requirements() -> Requirements {
        Requirements::ray_tracing().textures()
    }

    fn new(gpu: &Gpu, setup: &Setup) -> Result<Self> {
        let mut model = setup.scene_or(scenes::chess)?;
        scenes::extend(&mut model.model);
        let modifiers = Modifiers::default();
        let Preset { scene, solids, sun, lamp, light, plane, board, fog } =
            Preset::new(0, &model, &modifiers);
        let camera = scene.camera;
        let placed = (0, Placement::default(), modifiers);
        let on_gpu = SceneOnGpu::new(gpu, &scene, setup.options)?;
        let solids = SolidsOnGpu::new(gpu, &scene, &on_gpu, &solids, &placed.1, &modifiers)?;
        gpu.share_structs(&[World::LAYOUT, Plane::LAYOUT, Board::LAYOUT, Light::LAYOUT]);
        gpu.share_structs(&[Ball::LAYOUT, Face::LAYOUT, Part::LAYOUT, SolidRecord::LAYOUT]);
        gpu.share_structs(&[Fog::LAYOUT]);
        let usage = input_usage() | vk::BufferUsageFlags::TRANSFER_DST;
        let world = Buffer::new(gpu, "world", size_of::<World>() as u64, usage)?;
        let reflections: Vec<Vec3> = model.model.materials.iter().map(scenes::reflection).collect();
        let reflections = Buffer::with_data(gpu, "reflections", &reflections, input_usage())?;
        Ok(Self {
            model,
            scene: on_gpu,
            solids,
            placed,
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
            size: 1,
            moved: 0,
            bounce: 0,
            show: 0,
            preset: 0,
            plane,
            plane_on: true,
            inside: 0,
            board,
            rung: 3,
            plane_test: 0,
            modifiers,
            fog,
            section_distance: 5.0,
        })
    }

    // ANCHOR: controls
    fn controls(&mut self, c: &mut Controls) {
        if c.choice("preset", &mut self.preset, &scenes::PRESETS) {
            self.take_preset();
        }
        // The one solid stands on the plane, whichever it is.
        if self.modifiers.controls(c) && self.preset == scenes::ONE_SOLID {
            self.plane = Preset::new(self.preset, &self.model, &self.modifiers).plane;
        }
        self.fog.controls(c);
        c.slider("section distance", &mut self.section_distance, 0.0..=1e4);
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
            "section",
            "fog",
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
        let wanted = (self.preset, placement, self.modifiers);
        if wanted != self.placed {
            let preset = Preset::new(self.preset, &self.model, &self.modifiers);
            let placed = placement.scene(&preset.scene);
            if (wanted.0, wanted.1) != (self.placed.0, self.placed.1) {
                self.scene.rebuild(frame.gpu, &placed, self.scene.options)?;
            }
            let Self { scene, modifiers, .. } = self;
            self.solids =
                SolidsOnGpu::new(frame.gpu, &placed, scene, &preset.solids, &placement, modifiers)?;
            self.placed = wanted;
        }
        // ANCHOR_END: place
        let camera = placement.camera(&self.camera).basis(frame.aspect());
        let enclosed = self.solids.enclose(camera.origin.as_dvec3());
        let fog = self.fog.extent(self.modifiers.hollow, enclosed);
        let chosen = self.choose_pipeline(frame.gpu, fog)?;
        // ANCHOR: world
        // Without a plane, any will do that no ray is tested against.
        let placed = self.plane.placed(&placement).filter(|_| self.plane_on);
        let plane = Plane::new(placed.unwrap_or((DVec3::Y, 0.0)), camera.origin);
        let sun = Light::directional(&self.sun, self.light_size);
        let size = self.light_size * placement.size as f32;
        let lamp = Light::point(&placement.lamp(&self.lamp), size);
        let world = World {
            reflections: self.reflections.address.into(),
            solids: self.solids.addresses.address.into(),
            plane,
            board: self.board.placed(&placement, &self.plane, &plane),
            inside: placed.map_or(0, |_| self.inside + 1),
            light_count: if self.light == LIGHT_BOTH { 2 } else { 1 },
            lights: if self.light == LIGHT_POINT { [lamp, sun] } else { [sun, lamp] },
            fog: self.fog.placed(placement.size),
            first_solid: self.solids.first,
            solid_count: self.solids.count,
            section_distance: self.section_distance * placement.size as f32,
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
            Descriptor::AccelerationStructure(&self.solids.tlas),
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
    /// Takes over what a preset brings: view, lights, plane and fog.
    fn take_preset(&mut self) {
        let Preset { scene, sun, lamp, light, plane, board, fog, .. } =
            Preset::new(self.preset, &self.model, &self.modifiers);
        self.camera = scene.camera;
        (self.sun, self.lamp, self.light) = (sun, lamp, light);
        (self.plane, self.board, self.fog) = (plane, board, fog);
    }

    // ANCHOR: variant
    /// Which of the pipelines is for the method, the depth and the tests in use; it is made when first
    /// wanted.
    fn choose_pipeline(&mut self, gpu: &Gpu, fog: u32) -> Result<usize> {
        // A loop's rays all come from the raygen shader, and at a hit there is the shadow ray. By
        // recursion the camera's ray and every reflection are a level each.
        let recursion = if self.method == METHOD_RECURSIVE { 1 + self.depth + 1 } else { 1 + 1 };
        let Self { method, rung, plane_test, .. } = *self;
        let variant = Variant { method, recursion, rung, plane_test, fog };
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
/// plane's rung and when it is tested, and where fog is.
fn pipeline(gpu: &Gpu, scene: &SceneOnGpu, variant: Variant) -> Result<RayTracingPipeline> {
    RayTracingPipeline::builder(env!("CARGO_BIN_NAME"))
        .raygen("camera.rgen")
        .miss("sky.rmiss")
        .miss("shadow.rmiss")
        .miss("plane.rmiss")
        .hit(HitGroup::triangles().closest_hit("shade.rchit"))
        .hit(HitGroup::procedural("solid.rint").closest_hit("solid.rchit"))
        .constant(0, variant.method)
        .constant(1, variant.rung)
        .constant(2, variant.plane_test)
        .constant(3, variant.fog)
        .recursion(variant.recursion)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .textures(&scene.textures)
        .push_constants::<Push>()
        .build(gpu)
}
// ANCHOR_END: pipeline
