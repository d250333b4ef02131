//! 12 · Infinite plane: a surface that fits in no acceleration structure, hit before the ray is traced.
//!
//! New since 06_reflection: a plane that bounds each ray and reports itself where the ray reaches it, its
//! inside and outside, two lights at once, and three scenes.

mod plane;
mod scenes;

use std::process::ExitCode;

use anyhow::Result;
use ash::vk;
use common::gpu::{
    Address, Binding, Buffer, Descriptor, Gpu, HitGroup, RayTracingPipeline, Requirements,
    TextureTable,
};
use common::scene::board::Board;
use common::scene::plane::Plane;
use common::scene::{
    Camera, CameraBasis, Light, Look, Scene, SceneAddresses, SceneOnGpu, input_usage,
};
use common::{Controls, Frame, Lighting, Sample, Setup, Variant, Variants};
use glam::Vec3;
use plane::{InfinitePlane, Inside};
use scenes::{Lights, Preset, PresetName};

fn main() -> ExitCode {
    common::run::<Demo>(env!("CARGO_BIN_NAME"), instruments::all())
}

struct Demo {
    source: Scene,
    scene: SceneOnGpu,
    pipelines: Variants<Constants>,
    camera: Camera,
    lights: Lights,
    lighting: Lighting,
    depth: u32,
    minimum_contribution: f32,
    constants: Constants,
    preset: PresetName,
    /// The preset that was built.
    built: PresetName,
    plane: InfinitePlane,
    reflections: Buffer,
    world: Buffer,
}

common::shader_enum! {
    /// The quantity shown per pixel.
    enum Show: SHOW {
        Picture, Normal, Triangle, Hit, Direction = "ray direction", Shadow, Origin = "shadow origin",
    }
    /// The moment to test the plane: before the scene is traced, or after.
    enum PlaneTest: TEST { Before, After }
}

/// Specialization constants of a pipeline's shaders.
#[derive(Clone, Copy, PartialEq)]
struct Constants {
    show: Show,
    plane_test: PlaneTest,
    plane: bool,
    inside: Inside,
}

common::shader_struct! {
    /// Push constants of all shaders.
    struct Push {
        camera: CameraBasis,
        scene: SceneAddresses,
        world: Address<World>,
        depth: u32,
        minimum_contribution: f32,
    }
}

common::shader_struct! {
    /// The world beside the scene.
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
        let mut source = setup.scene_with(&[Look::Mirror], scenes::chess)?;
        scenes::extend(&mut source.model);
        let Preset { scene, sun, lamp, lights, plane, board } =
            Preset::new(PresetName::Board, &source);
        let camera = scene.camera;
        let scene = SceneOnGpu::new(gpu, &scene, setup.options)?;
        let reflections: Vec<Vec3> =
            source.model.materials.iter().map(scenes::reflection).collect();
        let reflections = Buffer::with_data(gpu, "reflections", &reflections, input_usage())?;
        let usage = input_usage() | vk::BufferUsageFlags::TRANSFER_DST;
        let world = Buffer::new(gpu, "world", size_of::<World>() as u64, usage)?;
        Ok(Self {
            source,
            scene,
            pipelines: Variants::default(),
            camera,
            lights,
            lighting: Lighting { lamp, ..Lighting::new(sun) },
            depth: 4,
            minimum_contribution: 1.0 / 512.0,
            constants: Constants {
                show: Show::Picture,
                plane_test: PlaneTest::Before,
                plane: true,
                inside: Inside::Surface,
            },
            preset: PresetName::Board,
            built: PresetName::Board,
            plane: InfinitePlane::new(plane, board),
            reflections,
            world,
        })
    }

    fn controls(&mut self, c: &mut Controls) {
        if c.choice("preset", &mut self.preset) {
            self.take_preset();
        }
        c.choice("show", &mut self.constants.show);
        c.choice("light", &mut self.lights);
        self.lighting.controls_of_both(c);
        c.integer("depth", &mut self.depth, 0..=8);
        c.slider("minimum contribution", &mut self.minimum_contribution, 0.0..=1.0);
        self.plane.controls(c);
        c.choice("plane test", &mut self.constants.plane_test);
        c.camera(&mut self.camera);
    }

    fn changed(&mut self, gpu: &Gpu) -> Result<()> {
        if self.preset != self.built {
            let Preset { scene, .. } = Preset::new(self.preset, &self.source);
            self.scene.rebuild(gpu, &scene, self.scene.options)?;
            self.built = self.preset;
        }
        Ok(())
    }

    fn render(&mut self, frame: &Frame) -> Result<()> {
        let camera = self.camera.basis(frame.aspect());
        let (plane, board) = self.plane.for_shaders(camera.origin);
        let [sun, lamp] = self.lighting.both();
        let world = World {
            reflections: self.reflections.address.into(),
            plane,
            board,
            light_count: if self.lights == Lights::Both { 2 } else { 1 },
            lights: if self.lights == Lights::Point { [lamp, sun] } else { [sun, lamp] },
        };
        self.world.update(frame.cmd, &[world])?;
        // ANCHOR: trace
        let push = Push {
            camera,
            scene: self.scene.addresses,
            world: self.world.address.into(),
            depth: self.depth,
            minimum_contribution: self.minimum_contribution,
        };
        let descriptors = [
            Descriptor::AccelerationStructure(&self.scene.tlas),
            Descriptor::StorageImage(frame.image),
        ];
        let (plane, inside) = (self.plane.is_there(), self.plane.inside);
        let constants = Constants { plane, inside, ..self.constants };
        let Variant { pipeline, sbt, .. } =
            self.pipelines.choose(frame, &self.scene.textures, constants, pipeline)?;
        pipeline.bind(frame.cmd, &descriptors, &push)?;
        sbt.trace(frame.cmd, frame.area);
        // ANCHOR_END: trace
        Ok(())
    }
}

impl Demo {
    /// Takes over what a preset brings: view, lights and plane.
    fn take_preset(&mut self) {
        let Preset { scene, sun, lamp, lights, plane, board } =
            Preset::new(self.preset, &self.source);
        self.camera = scene.camera;
        (self.lighting.sun, self.lighting.lamp, self.lights) = (sun, lamp, lights);
        (self.plane.half_space, self.plane.board) = (plane, board);
    }
}

/// The plane adds no shader: raygen knows where it is.
fn pipeline(
    gpu: &Gpu,
    textures: &TextureTable,
    constants: Constants,
) -> Result<RayTracingPipeline> {
    RayTracingPipeline::builder(env!("CARGO_BIN_NAME"))
        .raygen("camera.rgen")
        .miss("common/sky.rmiss")
        .miss("common/shadow.rmiss")
        .hit(HitGroup::triangles().closest_hit("shade.rchit"))
        .constant(0, constants.show)
        .constant(1, constants.plane_test)
        .constant(2, constants.plane)
        .constant(3, constants.inside)
        .rounding_to_nearest_even(gpu)
        .recursion(1)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .textures(textures)
        .push_constants::<Push>()
        .build(gpu)
}
