//! 14 · Animation: a game of chess is played, and a flag waves beside it.
//!
//! New since 41_ray_offset: a frame's number says where everything is; a compute shader moves vertices; bottom
//! and top levels are updated or built again, each behind its barriers.

mod costs;
mod flag;
mod leg;
mod legs;
mod levels;
mod motion;
mod pole;
mod turned;
mod world;

use std::process::ExitCode;

use anyhow::Result;
use ash::vk;
use common::UsageError;
use common::gpu::{
    Binding, Descriptor, Gpu, HitGroup, RayTracingPipeline, Requirements, TextureTable,
};
use common::model::text;
use common::scene::{
    Camera, CameraBasis, DirectionalLight, SceneAddresses, SceneOptions, Sun, assets,
};
use common::{Controls, Frame, Playback, Sample, Setup, Variant, Variants};
use flag::Flag;
use glam::{DVec3, Vec3};
use leg::Motion;
use levels::{Levels, Plan, Policy};
use world::World;

fn main() -> ExitCode {
    common::run::<Demo>(env!("CARGO_BIN_NAME"), instruments::all())
}

struct Demo {
    world: World,
    flag: Flag,
    levels: Levels,
    playback: Playback,
    plan: Plan,
    /// Wanted number of cells across the flag.
    cells: u32,
    options: SceneOptions,
    pipelines: Variants<Show>,
    camera: Camera,
    sun: Sun,
    show: Show,
}

common::shader_enum! {
    /// The quantity shown per pixel.
    enum Show: SHOW {
        Picture, Normal, Triangle, Hit, Direction = "ray direction", Shadow, Origin = "shadow origin",
    }
}

common::shader_struct! {
    /// Push constants of all shaders.
    struct Push {
        camera: CameraBasis,
        scene: SceneAddresses,
        light: DirectionalLight,
    }
}

impl Sample for Demo {
    fn requirements() -> Requirements {
        Requirements::ray_tracing().textures()
    }

    fn new(gpu: &Gpu, setup: &Setup) -> Result<Self> {
        let motion = motion(setup)?;
        let (cells, plan) = (48, Plan { flag: Policy::Updated, top: Policy::Updated, every: 240 });
        let flag = Flag::new(gpu, cells, setup.options)?;
        let playback = Playback::new(motion.last);
        let world = World::new(gpu, motion, &flag, setup.options)?;
        let levels = Levels::new(gpu, &world, &flag)?;
        let camera = Camera::new(DVec3::new(-6.3, 4.6, 10.9), DVec3::new(0.6, 1.35, -0.6), 38.5);
        let sun = Sun { azimuth: 60.0, elevation: 17.0, radiance: Vec3::new(4.4, 3.5, 2.4) };
        Ok(Self {
            world,
            flag,
            levels,
            playback,
            plan,
            cells,
            options: setup.options,
            pipelines: Variants::default(),
            camera,
            sun,
            show: Show::Picture,
        })
    }

    fn controls(&mut self, c: &mut Controls) {
        c.playback(&mut self.playback);
        c.choice("flag", &mut self.plan.flag);
        c.choice("top level", &mut self.plan.top);
        c.integer("build every", &mut self.plan.every, 1..=3600);
        c.integer("flag cells", &mut self.cells, 1..=512);
        c.choice("show", &mut self.show);
        c.sun(&mut self.sun);
        c.camera(&mut self.camera);
    }

    /// Applies changed controls before the next frame, whose time is then that of tracing alone.
    fn changed(&mut self, gpu: &Gpu) -> Result<()> {
        if self.flag.across != self.cells {
            self.flag = Flag::new(gpu, self.cells, self.options)?;
            self.world.take(&self.flag)?;
            self.levels = Levels::new(gpu, &self.world, &self.flag)?;
        }
        if self.levels.are_at(self.playback.frame, self.plan) {
            return Ok(());
        }
        gpu.submit(|cmd| self.reach(cmd))
    }

    fn render(&mut self, frame: &Frame) -> Result<()> {
        // Bands share a picture: all of them show what the first has recorded.
        if frame.is_first_band() {
            self.reach(frame.cmd)?;
        }
        // ANCHOR: trace
        let push = Push {
            camera: self.camera.basis(frame.aspect()),
            scene: self.world.addresses,
            light: self.sun.light(),
        };
        let descriptors = [
            Descriptor::AccelerationStructure(&self.levels.tlas),
            Descriptor::StorageImage(frame.image),
        ];
        let Variant { pipeline, sbt, .. } =
            self.pipelines.choose(frame, &self.world.scene.textures, self.show, pipeline)?;
        pipeline.bind(frame.cmd, &descriptors, &push)?;
        sbt.trace(frame.cmd, frame.area);
        // ANCHOR_END: trace
        Ok(())
    }

    fn playback(&mut self) -> Option<&mut Playback> {
        Some(&mut self.playback)
    }

    fn report(&self) -> Result<serde_json::Value> {
        self.levels.report()
    }
}

impl Demo {
    /// Records what takes everything that moves to the frame that is shown.
    fn reach(&mut self, cmd: vk::CommandBuffer) -> Result<()> {
        self.levels.reach(cmd, (&self.world, &self.flag), (self.playback.frame, self.plan))
    }
}

/// The legs that `--scene` names, else those of Morphy's game at the opera.
fn motion(setup: &Setup) -> Result<Motion> {
    let own = assets().join("games/opera.legs");
    let path = setup.scene().unwrap_or(&own);
    if path.extension().is_none_or(|extension| !extension.eq_ignore_ascii_case("legs")) {
        let what = "this chapter takes legs of pieces (.legs), which chess_game makes of moves";
        return Err(UsageError(format!("{}: {what}", text::shown(path))).into());
    }
    legs::open(path)
}

/// Only the raygen shader traces rays: they do not nest, and a recursion depth of 1 is enough.
fn pipeline(gpu: &Gpu, textures: &TextureTable, show: Show) -> Result<RayTracingPipeline> {
    RayTracingPipeline::builder(env!("CARGO_BIN_NAME"))
        .raygen("camera.rgen")
        .miss("common/sky.rmiss")
        .miss("common/shadow.rmiss")
        .hit(HitGroup::triangles().closest_hit("shade.rchit"))
        .constant(0, show)
        .recursion(1)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .textures(textures)
        .push_constants::<Push>()
        .build(gpu)
}
