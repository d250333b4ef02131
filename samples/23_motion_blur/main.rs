//! 23 · Motion blur: each sample has a time within the shutter, and sees the pieces as they are at that time.
//!
//! New since 14_animation: a shutter; a time for each sample, in strata; what is under way in the top level once for
//! each moment, or swept, with its triangles moved by an intersection shader; rotations between two poses.

mod ball;
#[path = "../14_animation/leg.rs"]
mod leg;
#[path = "../14_animation/legs.rs"]
mod legs;
mod levels;
mod motion;
mod shutter;
mod sweep;
#[path = "../14_animation/turned.rs"]
mod turned;
mod world;

use std::process::ExitCode;

use anyhow::Result;
use common::UsageError;
use common::gpu::{
    Address, Binding, Descriptor, Gpu, HitGroup, RayTracingPipeline, Requirements, TextureTable,
};
use common::model::text;
use common::scene::{Camera, CameraBasis, DirectionalLight, SceneAddresses, Sun, assets};
use common::{Controls, Frame, Playback, Sample, Setup, Variant, Variants};
use glam::{DVec3, Vec3};
use leg::Motion;
use levels::{Calls, Levels, Method, Mover, Plan};
use shutter::Between;
use world::World;

fn main() -> ExitCode {
    common::run::<Demo>(env!("CARGO_BIN_NAME"), instruments::all())
}

struct Demo {
    world: World,
    levels: Levels,
    playback: Playback,
    plan: Plan,
    /// The number of samples of a pixel in each frame.
    samples: u32,
    constants: Constants,
    count_calls: bool,
    pipelines: Variants<Constants>,
    camera: Camera,
    sun: Sun,
}

common::shader_enum! {
    /// The quantity shown per pixel.
    enum Show: SHOW {
        Picture, Normal, Triangle, Hit, Direction = "ray direction", Shadow, Origin = "shadow origin", Smear,
    }
    /// The distribution of the samples' times.
    enum Times: TIMES { Middle, Random, Strata }
    /// The counting of calls of the intersection shader.
    enum Counting: COUNTING { Off, On }
}

/// Specialization constants of a pipeline's shaders.
#[derive(Clone, Copy, PartialEq)]
struct Constants {
    show: Show,
    times: Times,
    method: Method,
    between: Between,
    counting: Counting,
}

common::shader_struct! {
    /// Push constants of all shaders.
    struct Push {
        camera: CameraBasis,
        scene: SceneAddresses,
        movers: Address<Mover>,
        calls: Address<Calls>,
        light: DirectionalLight,
        samples: u32,
        moments: u32,
        frame: u32,
    }
}

impl Sample for Demo {
    fn requirements() -> Requirements {
        Requirements::ray_tracing().textures()
    }

    fn new(gpu: &Gpu, setup: &Setup) -> Result<Self> {
        let motion = motion(setup)?;
        let (method, between) = (Method::Swept, Between::Rotation);
        let plan = Plan { method, moments: 8, between, shutter: 1.0, turns: 1 };
        let playback = Playback::new(motion.last);
        let world = World::new(gpu, motion, setup.options)?;
        let levels = Levels::new(gpu, &world, plan)?;
        let constants = Constants {
            show: Show::Picture,
            times: Times::Strata,
            method,
            between,
            counting: Counting::Off,
        };
        let camera = Camera::new(DVec3::new(-6.3, 4.6, 10.9), DVec3::new(0.6, 1.35, -0.6), 38.5);
        let sun = Sun { azimuth: 60.0, elevation: 17.0, radiance: Vec3::new(4.4, 3.5, 2.4) };
        Ok(Self {
            world,
            levels,
            playback,
            plan,
            samples: 16,
            constants,
            count_calls: false,
            pipelines: Variants::default(),
            camera,
            sun,
        })
    }

    fn controls(&mut self, c: &mut Controls) {
        c.playback(&mut self.playback);
        c.slider("shutter", &mut self.plan.shutter, 0.0..=2.0);
        c.integer("turns", &mut self.plan.turns, 0..=3);
        c.integer("samples", &mut self.samples, 1..=4096);
        c.choice("times", &mut self.constants.times);
        c.choice("method", &mut self.plan.method);
        c.integer("moments", &mut self.plan.moments, 1..=8);
        c.choice("between", &mut self.plan.between);
        c.checkbox("count calls", &mut self.count_calls);
        c.choice("show", &mut self.constants.show);
        c.sun(&mut self.sun);
        c.camera(&mut self.camera);
    }

    fn changed(&mut self, gpu: &Gpu) -> Result<()> {
        if !self.levels.fit(self.plan) {
            self.levels = Levels::new(gpu, &self.world, self.plan)?;
        }
        let counting = if self.count_calls { Counting::On } else { Counting::Off };
        let Plan { method, between, .. } = self.plan;
        self.constants = Constants { method, between, counting, ..self.constants };
        Ok(())
    }

    fn render(&mut self, frame: &Frame) -> Result<()> {
        // Bands share a picture: all of them show what the first has recorded.
        if frame.is_first_band() {
            self.levels.reach(frame.cmd, &self.world, (self.playback.frame, self.plan))?;
            self.levels.calls.clear(frame.cmd);
        }
        let push = Push {
            camera: self.camera.basis(frame.aspect()),
            scene: self.world.addresses,
            movers: self.levels.movers.address.into(),
            calls: self.levels.calls.address.into(),
            light: self.sun.light(),
            samples: self.samples_needed(),
            moments: self.plan.moments,
            frame: self.playback.frame,
        };
        let descriptors = [
            Descriptor::AccelerationStructure(&self.levels.tlas),
            Descriptor::StorageImage(frame.image),
        ];
        let Variant { pipeline, sbt, .. } =
            self.pipelines.choose(frame, &self.world.scene.textures, self.constants, pipeline)?;
        pipeline.bind(frame.cmd, &descriptors, &push)?;
        sbt.trace(frame.cmd, frame.area);
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
    /// One sample says it all where nothing is under way. Data has no mean: then it is that of the first sample.
    fn samples_needed(&self) -> u32 {
        let is_data = [Show::Hit, Show::Direction, Show::Origin].contains(&self.constants.show);
        if is_data || !self.levels.moves { 1 } else { self.samples }
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

/// A hit group for fixed triangles, and one for those that an intersection shader moves.
///
/// Only the raygen shader traces rays: they do not nest, and a recursion depth of 1 is enough.
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
        .hit(HitGroup::procedural("moved.rint").closest_hit("shade.rchit"))
        .constant(0, constants.show)
        .constant(1, constants.times)
        .constant(2, constants.method)
        .constant(3, constants.between)
        .constant(4, constants.counting)
        .rounding_to_nearest_even(gpu)
        .recursion(1)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .textures(textures)
        .push_constants::<Push>()
        .build(gpu)
}
