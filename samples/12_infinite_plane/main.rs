//! 12 · Infinite plane: a surface that no acceleration structure can hold, met before the ray is traced.
//!
//! New since 06_reflection: a plane that bounds each ray and reports itself where the ray reaches it, four
//! ways to intersect it, a checker board without aliasing, two lights at once, and three scenes.

mod plane;
mod scenes;

use std::process::ExitCode;

use anyhow::Result;
use ash::vk;
use common::gpu::{
    Address, Binding, Buffer, Descriptor, Gpu, HitGroup, RayTracingPipeline, Requirements,
    ShaderStruct, TextureTable, Variant, Variants,
};
use common::scene::board::Board;
use common::scene::plane::Plane;
use common::scene::{
    Camera, CameraBasis, Light, PointLight, Scene, SceneAddresses, SceneOnGpu, Sun, input_usage,
};
use common::{Controls, Frame, Sample, Setup};
use glam::Vec3;
use plane::InfinitePlane;
use scenes::Preset;

fn main() -> ExitCode {
    common::run::<Demo>(env!("CARGO_BIN_NAME"))
}

const LIGHT_POINT: u32 = 1;
const LIGHT_BOTH: u32 = 2;

struct Demo {
    model: Scene,
    scene: SceneOnGpu,
    pipelines: Variants<Constants>,
    camera: Camera,
    sun: Sun,
    lamp: PointLight,
    light: u32,
    light_size: f32,
    light_samples: u32,
    depth: u32,
    minimum_contribution: f32,
    constants: Constants,
    preset: u32,
    /// The preset that was built.
    built: u32,
    plane: InfinitePlane,
    reflections: Buffer,
    world: Buffer,
}

/// What a pipeline is made for: the specialization constants of its shaders.
#[derive(Clone, Copy, PartialEq)]
struct Constants {
    show: u32,
    shadow_rays: u32,
    smooth_terminator: bool,
    rung: u32,
    plane_test: u32,
    inside: u32,
}

common::shader_struct! {
    /// What every shader of this chapter can read.
    struct Push {
        camera: CameraBasis,
        scene: SceneAddresses,
        world: Address,
        light_samples: u32,
        depth: u32,
        minimum_contribution: f32,
    }
}

common::shader_struct! {
    /// What is in the world beside the scene.
    struct World {
        reflections: Address,
        plane: Plane,
        board: Board,
        light_count: u32,
        lights: [Light; 2],
    }
}

impl Sample for Demo {
    fn requirements() -> Requirements {
        Requirements::ray_tracing().textures()
    }

    fn new(gpu: &Gpu, setup: &Setup) -> Result<Self> {
        let mut model = setup.scene_or(scenes::chess)?;
        scenes::extend(&mut model.model);
        let Preset { scene, sun, lamp, light, plane, board } = Preset::new(0, &model);
        let camera = scene.camera;
        let scene = SceneOnGpu::new(gpu, &scene, setup.options)?;
        gpu.share_structs(&[World::LAYOUT, Plane::LAYOUT, Board::LAYOUT, Light::LAYOUT]);
        let reflections: Vec<Vec3> = model.model.materials.iter().map(scenes::reflection).collect();
        let reflections = Buffer::with_data(gpu, "reflections", &reflections, input_usage())?;
        let usage = input_usage() | vk::BufferUsageFlags::TRANSFER_DST;
        let world = Buffer::new(gpu, "world", size_of::<World>() as u64, usage)?;
        Ok(Self {
            model,
            scene,
            pipelines: Variants::default(),
            camera,
            sun,
            lamp,
            light,
            light_size: 0.0,
            light_samples: 16,
            depth: 4,
            minimum_contribution: 1.0 / 512.0,
            constants: Constants {
                show: 0,
                shadow_rays: 0,
                smooth_terminator: true,
                rung: 3,
                plane_test: 0,
                inside: 1,
            },
            preset: 0,
            built: 0,
            plane: InfinitePlane::new(plane, board),
            reflections,
            world,
        })
    }

    // ANCHOR: controls
    fn controls(&mut self, c: &mut Controls) {
        if c.choice("preset", &mut self.preset, &scenes::PRESETS) {
            self.take_preset();
        }
        let views = [
            "picture",
            "normal",
            "triangle",
            "hit",
            "ray direction",
            "shadow",
            "shadow origin",
            "rungs",
        ];
        c.choice("show", &mut self.constants.show, &views);
        c.choice("light", &mut self.light, &["directional", "point", "both"]);
        c.slider("sun azimuth", &mut self.sun.azimuth, 0.0..=360.0);
        c.slider("sun elevation", &mut self.sun.elevation, 0.0..=90.0);
        c.vector("lamp position", &mut self.lamp.position, -100.0..=100.0);
        c.slider("light size", &mut self.light_size, 0.0..=1.0);
        c.integer("light samples", &mut self.light_samples, 1..=64);
        let rays = ["first hit", "nearest hit", "off"];
        c.choice("shadow rays", &mut self.constants.shadow_rays, &rays);
        c.checkbox("smooth terminator", &mut self.constants.smooth_terminator);
        c.integer("depth", &mut self.depth, 0..=8);
        c.slider("minimum contribution", &mut self.minimum_contribution, 0.0..=1.0);
        self.plane.controls(c);
        let rungs = ["pov", "point", "cut-off", "compensated"];
        c.choice("rung", &mut self.constants.rung, &rungs);
        c.choice("plane test", &mut self.constants.plane_test, &["before", "after"]);
        c.camera(&mut self.camera);
    }
    // ANCHOR_END: controls

    fn render(&mut self, frame: &Frame) -> Result<()> {
        if self.preset != self.built {
            let Preset { scene, .. } = Preset::new(self.preset, &self.model);
            self.scene.rebuild(frame.gpu, &scene, self.scene.options)?;
            self.built = self.preset;
        }
        // ANCHOR: world
        let camera = self.camera.basis(frame.aspect());
        let (plane, board) = self.plane.for_shaders(camera.origin);
        let sun = Light::directional(&self.sun, self.light_size);
        let lamp = Light::point(&self.lamp, self.light_size);
        let world = World {
            reflections: self.reflections.address.into(),
            plane,
            board,
            light_count: if self.light == LIGHT_BOTH { 2 } else { 1 },
            lights: if self.light == LIGHT_POINT { [lamp, sun] } else { [sun, lamp] },
        };
        self.world.update(frame.cmd, &[world])?;
        // ANCHOR_END: world
        // ANCHOR: trace
        let push = Push {
            camera,
            scene: self.scene.addresses,
            world: self.world.address.into(),
            light_samples: self.light_samples,
            depth: self.depth,
            minimum_contribution: self.minimum_contribution,
        };
        let descriptors = [
            Descriptor::AccelerationStructure(&self.scene.tlas),
            Descriptor::StorageImage(frame.image),
        ];
        let constants = Constants { inside: self.plane.rule(), ..self.constants };
        let Variant { pipeline, sbt, .. } =
            self.pipelines.choose(frame.gpu, &self.scene.textures, constants, pipeline)?;
        pipeline.bind(frame.cmd, &descriptors, &push)?;
        sbt.trace(frame.cmd, frame.image.extent);
        // ANCHOR_END: trace
        Ok(())
    }
}

impl Demo {
    /// Takes over what a preset brings: view, lights and plane.
    fn take_preset(&mut self) {
        let Preset { scene, sun, lamp, light, plane, board } =
            Preset::new(self.preset, &self.model);
        self.camera = scene.camera;
        (self.sun, self.lamp, self.light) = (sun, lamp, light);
        (self.plane.half_space, self.plane.board) = (plane, board);
    }
}

// ANCHOR: pipeline
/// The plane adds no shader: raygen knows where it is.
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
        .constant(3, constants.rung)
        .constant(4, constants.plane_test)
        .constant(5, constants.inside)
        .recursion(1)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .textures(textures)
        .push_constants::<Push>()
        .build(gpu)
}
// ANCHOR_END: pipeline
