//! 43 · Filtered checker: a board to the horizon without aliasing.
//!
//! New since 12_infinite_plane: each ray knows how wide its pixel's cone is, and the board shows the mean of the
//! squares in the cone's footprint. The plane is level and below everything, so shadow rays never meet it.

use std::process::ExitCode;

use anyhow::Result;
use ash::vk;
use common::gpu::{
    Address, Binding, Buffer, Descriptor, Gpu, HitGroup, RayTracingPipeline, Requirements,
    TextureTable,
};
use common::scene::board::Board;
use common::scene::plane::{HalfSpace, Plane};
use common::scene::{
    Camera, CameraBasis, DirectionalLight, Look, Placement, Scene, SceneAddresses, SceneOnGpu, Sun,
    input_usage,
};
use common::{Controls, Frame, Sample, Setup, Variant, Variants};
use glam::{DVec3, Vec3};

fn main() -> ExitCode {
    common::run::<Demo>(env!("CARGO_BIN_NAME"), instruments::all())
}

struct Demo {
    scene: SceneOnGpu,
    pipelines: Variants<Constants>,
    camera: Camera,
    sun: Sun,
    depth: u32,
    minimum_contribution: f32,
    constants: Constants,
    board: Board,
    world: Buffer,
}

common::shader_enum! {
    /// The quantity shown per pixel.
    enum Show: SHOW {
        Picture, Normal, Triangle, Hit, Direction = "ray direction", Shadow, Origin = "shadow origin",
    }
    /// The filtering of the squares: averaged over the pixel, or sampled at its centre.
    enum Checker: CHECKER { Filtered, Point }
}

/// Specialization constants of a pipeline's shaders.
#[derive(Clone, Copy, PartialEq)]
struct Constants {
    show: Show,
    checker: Checker,
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
        plane: Plane,
        board: Board,
        light: DirectionalLight,
    }
}

impl Sample for Demo {
    fn requirements() -> Requirements {
        Requirements::ray_tracing().textures()
    }

    fn new(gpu: &Gpu, setup: &Setup) -> Result<Self> {
        let mut scene = setup.scene_with(&[Look::Mirror], chess)?;
        scene.remove_board();
        let camera = scene.camera;
        let scene = SceneOnGpu::new(gpu, &scene, setup.options)?;
        let usage = input_usage() | vk::BufferUsageFlags::TRANSFER_DST;
        let world = Buffer::new(gpu, "world", size_of::<World>() as u64, usage)?;
        Ok(Self {
            scene,
            pipelines: Variants::default(),
            camera,
            sun: Sun { azimuth: 285.0, elevation: 17.0, radiance: Vec3::new(5.2, 4.0, 2.7) },
            depth: 4,
            minimum_contribution: 1.0 / 512.0,
            constants: Constants { show: Show::Picture, checker: Checker::Filtered },
            board: Board {
                light: Vec3::new(0.62, 0.46, 0.26),
                dark: Vec3::new(0.115, 0.048, 0.022),
                specular: 0.03,
                roughness: 0.38,
                reflection: 0.03,
                ..Board::default()
            },
            world,
        })
    }

    fn controls(&mut self, c: &mut Controls) {
        c.choice("show", &mut self.constants.show);
        c.sun(&mut self.sun);
        c.integer("depth", &mut self.depth, 0..=8);
        c.slider("minimum contribution", &mut self.minimum_contribution, 0.0..=1.0);
        c.choice("checker", &mut self.constants.checker);
        c.color("light squares", &mut self.board.light);
        c.color("dark squares", &mut self.board.dark);
        c.slider("square", &mut self.board.square, 0.01..=100.0);
        c.slider("plane reflection", &mut self.board.reflection, 0.0..=1.0);
        c.camera(&mut self.camera);
    }

    fn render(&mut self, frame: &Frame) -> Result<()> {
        let camera = self.camera.basis(frame.aspect());
        let level = HalfSpace::new(Vec3::Y, 0.0);
        let plane = Plane::new((DVec3::Y, 0.0), camera.origin);
        let board = self.board.placed(&Placement::default(), &level, &plane);
        self.world.update(frame.cmd, &[World { plane, board, light: self.sun.light() }])?;
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
        let Variant { pipeline, sbt, .. } =
            self.pipelines.choose(frame, &self.scene.textures, self.constants, pipeline)?;
        pipeline.bind(frame.cmd, &descriptors, &push)?;
        sbt.trace(frame.cmd, frame.area);
        // ANCHOR_END: trace
        Ok(())
    }
}

/// The chess set of metal, from so low down that the horizon is seen.
fn chess() -> Result<Scene> {
    let camera = Camera::new(DVec3::new(-3.4, 1.6, 7.2), DVec3::new(0.6, 0.62, 0.0), 37.0);
    Ok(Scene { camera, ..Scene::chess_of_metal()? })
}

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
        .constant(1, constants.checker)
        .rounding_to_nearest_even(gpu)
        .recursion(1)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .textures(textures)
        .push_constants::<Push>()
        .build(gpu)
}
