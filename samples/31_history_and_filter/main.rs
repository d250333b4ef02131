//! 31 · History and filter: one path per pixel and frame, while everything moves.
//!
//! New since 11_path_tracing: light is followed from frame to frame on the surface it lies on, in `history.comp`;
//! a filter that makes and loses none of it, in `filter.comp`; and motion, a function of the frame's number.

mod back;
mod done;
#[path = "../14_animation/leg.rs"]
mod leg;
#[path = "../14_animation/legs.rs"]
mod legs;
mod levels;
#[path = "../14_animation/motion.rs"]
mod motion;
mod moving;
mod passes;
mod pixels;
mod scenes;
#[path = "../14_animation/turned.rs"]
mod turned;

use std::process::ExitCode;

use anyhow::Result;
use back::Back;
use common::gpu::{
    Address, Binding, Descriptor, Gpu, HitGroup, RayTracingPipeline, Requirements, TextureTable,
    barrier,
};
use common::scene::{Camera, CameraBasis, DiskLight, Light, Look, Scene, SceneAddresses, Sun};
use common::{Controls, Frame, Playback, Sample, Setup, Variant, Variants};
use done::{Done, Valid};
use glam::UVec2;
use levels::Levels;
use moving::Motion;
use passes::{Given, Passes, Show, Tests};
use pixels::{PixelAddresses, Pixels};
use scenes::{Game, SceneName, Sky, Staged};

fn main() -> ExitCode {
    common::run::<Demo>(env!("CARGO_BIN_NAME"), instruments::all())
}

/// Maximum number of reflections of a path. If each surface absorbs 5 % of its light, less than
/// 2·10^-6 of it is left by then.
const MAX_DEPTH: u32 = 256;
/// A pixel has 8 bits for the length of its history.
const MAX_MEMORY: u32 = 255;
/// The last frame of the motion, and of the game.
const LAST: u32 = 1824;

struct Demo {
    source: Scene,
    /// None if a file replaces the chess set.
    game: Option<Game>,
    levels: Levels,
    pixels: Pixels,
    pipelines: Variants<Constants>,
    passes: Passes,
    /// The last complete frame, and the one whose rays are traced.
    done: Option<Done>,
    next: Option<Done>,
    playback: Playback,
    motion: Motion,
    camera: Camera,
    sun: Sun,
    light_size: f32,
    name: SceneName,
    /// The scene that was built.
    built: SceneName,
    depth: u32,
    seed: u32,
    history: bool,
    memory: u32,
    filters: u32,
    tests: Tests,
    constants: Constants,
}

/// Specialization constants of the shaders that trace.
#[derive(Clone, Copy, PartialEq)]
struct Constants {
    sky: Sky,
    roulette: bool,
    divide: bool,
}

common::shader_struct! {
    /// Push constants of the shaders that trace.
    struct Push {
        camera: CameraBasis,
        scene: SceneAddresses,
        pixels: Address<PixelAddresses>,
        light: DiskLight,
        depth: u32,
        seed: u32,
        sample_index: u32,
    }
}

impl Sample for Demo {
    fn requirements() -> Requirements {
        Requirements::ray_tracing().textures()
    }

    fn new(gpu: &Gpu, setup: &Setup) -> Result<Self> {
        let source = setup.scene_with(&[Look::Mirror], scenes::chess)?;
        let game = setup.scene().is_none().then(|| Game::new(&source)).transpose()?;
        let Staged { scene, sun, sky } = Staged::new(SceneName::Chess, &source, None);
        let camera = scene.camera;
        let tests =
            Tests { show: Show::Picture, follow: true, instance: true, plane: true, normal: true };
        Ok(Self {
            levels: Levels::new(gpu, scene, setup.options)?,
            source,
            game,
            pixels: Pixels::new(gpu, UVec2::ZERO)?,
            pipelines: Variants::default(),
            passes: Passes::default(),
            done: None,
            next: None,
            playback: Playback::new(LAST),
            motion: Motion::All,
            camera,
            sun,
            light_size: 0.03,
            name: SceneName::Chess,
            built: SceneName::Chess,
            depth: 16,
            seed: 0,
            history: true,
            memory: 32,
            filters: 5,
            tests,
            constants: Constants { sky, roulette: true, divide: true },
        })
    }

    fn controls(&mut self, c: &mut Controls) {
        if c.choice("scene", &mut self.name) {
            self.take_scene();
        }
        c.playback(&mut self.playback);
        c.choice("motion", &mut self.motion);
        c.choice("show", &mut self.tests.show);
        c.checkbox("history", &mut self.history);
        c.integer("memory", &mut self.memory, 2..=MAX_MEMORY);
        c.integer("filter passes", &mut self.filters, 0..=5);
        c.checkbox("follow", &mut self.tests.follow);
        c.checkbox("instance test", &mut self.tests.instance);
        c.checkbox("plane test", &mut self.tests.plane);
        c.checkbox("normal test", &mut self.tests.normal);
        c.checkbox("divide colour", &mut self.constants.divide);
        c.choice("sky", &mut self.constants.sky);
        c.sun(&mut self.sun);
        c.slider("light size", &mut self.light_size, 0.0..=1.0);
        c.integer("depth", &mut self.depth, 0..=MAX_DEPTH);
        c.checkbox("roulette", &mut self.constants.roulette);
        c.integer("seed", &mut self.seed, 0..=1000);
        c.camera(&mut self.camera);
    }

    fn changed(&mut self, gpu: &Gpu) -> Result<()> {
        if self.name != self.built {
            let staged = Staged::new(self.name, &self.source, self.game.as_ref());
            self.levels.rebuild(gpu, staged.scene)?;
            self.built = self.name;
        }
        Ok(())
    }

    fn render(&mut self, frame: &Frame) -> Result<()> {
        let extent = frame.image.extent;
        let size = UVec2::new(extent.width, extent.height);
        if self.pixels.size != size {
            // A frame of another size may have been abandoned since the last complete one.
            (self.pixels, self.done) = (Pixels::new(frame.gpu, size)?, None);
        }
        let number = self.playback.frame;
        let camera = self.motion.camera(&self.camera, number);
        let game = self.game.as_ref().filter(|_| self.built == SceneName::Game);
        let places = self.levels.places(self.motion, game, number);
        if frame.is_first_band() {
            self.levels.place(frame.cmd, &places)?;
        }
        // The passes of the last frame have read what this one writes.
        barrier::trace_to_trace(frame.gpu, frame.cmd);
        let wanted = self.valid();
        let Variant { pipeline, sbt, key } =
            self.pipelines.choose(frame, &self.levels.scene.textures, self.constants, pipeline)?;
        // In a window, the pipeline may still be that of the old controls.
        let valid = Valid { constants: *key, ..wanted };
        let last = self.done.as_ref().filter(|done| done.goes_on_to(&valid, &camera, number));
        let age = last.map_or(0, |done| done.age + 1);
        // ANCHOR: trace
        let light = Light::directional(&self.motion.sun(&self.sun, number));
        let push = Push {
            camera: camera.basis(frame.aspect()),
            scene: self.levels.scene.addresses,
            pixels: self.pixels.addresses(),
            light: DiskLight { light, radius: self.light_size, samples: 1 },
            depth: self.depth,
            seed: self.seed,
            sample_index: if self.history { age } else { frame.index },
        };
        let descriptors = [Descriptor::AccelerationStructure(&self.levels.tlas)];
        pipeline.bind(frame.cmd, &descriptors, &push)?;
        sbt.trace(frame.cmd, frame.area);
        // ANCHOR_END: trace
        self.next = Some(Done { valid, camera, places, frame: number, age });
        Ok(())
    }

    fn passes(&self) -> Vec<&'static str> {
        passes::names(self.filters)
    }

    fn pass(&mut self, frame: &Frame, number: u32) -> Result<()> {
        let Some(now) = &self.next else { return Ok(()) };
        let last =
            self.done.as_ref().filter(|done| done.goes_on_to(&now.valid, &now.camera, now.frame));
        if let (0, Some(last)) = (number, last) {
            let places = now.places.iter().zip(&last.places);
            let back: Vec<_> = places.map(|(now, last)| Back::new(now, last)).collect();
            self.levels.back.update(frame.cmd, &back)?;
        }
        let given = Given {
            levels: &self.levels,
            pixels: &self.pixels,
            camera: now.camera.basis(frame.aspect()),
            before: last.map_or(now.camera, |last| last.camera).basis(frame.aspect()),
            tests: self.tests,
            memory: if last.is_some() && self.history { self.memory } else { 1 },
            white: self.memory,
            filters: self.filters,
        };
        let used = self.passes.record(frame, number, &given)?;
        if let (0, Some(now)) = (number, &mut self.next) {
            now.valid.tests = used;
        }
        if number + 1 == passes::count(self.filters) {
            self.pixels.swap();
            self.done = self.next.take();
        }
        Ok(())
    }

    fn accumulates(&self) -> bool {
        true
    }

    fn forget(&mut self) -> bool {
        (self.done, self.next) = (None, None);
        true
    }

    fn gathers(&self) -> bool {
        let stands = !self.playback.playing || self.motion == Motion::Still;
        stands && !self.history && self.filters == 0
    }

    fn playback(&mut self) -> Option<&mut Playback> {
        Some(&mut self.playback)
    }
}

impl Demo {
    fn valid(&self) -> Valid {
        Valid {
            constants: self.constants,
            name: self.name,
            motion: self.motion,
            sun: self.sun,
            light_size: self.light_size,
            depth: self.depth,
            seed: self.seed,
            history: self.history,
            tests: self.tests,
            size: self.pixels.size,
        }
    }

    /// Takes over what a scene brings: view, sun and sky.
    fn take_scene(&mut self) {
        let Staged { scene, sun, sky } = Staged::new(self.name, &self.source, self.game.as_ref());
        (self.camera, self.sun, self.constants.sky) = (scene.camera, sun, sky);
    }
}

/// Only the raygen shader traces rays: however long a path is, its rays do not nest.
fn pipeline(
    gpu: &Gpu,
    textures: &TextureTable,
    constants: Constants,
) -> Result<RayTracingPipeline> {
    RayTracingPipeline::builder(env!("CARGO_BIN_NAME"))
        .raygen("camera.rgen")
        .miss("sky.rmiss")
        .miss("common/shadow.rmiss")
        .hit(HitGroup::triangles().closest_hit("shade.rchit"))
        .constant(0, constants.sky)
        .constant(1, constants.roulette)
        .constant(2, constants.divide)
        .recursion(1)
        .binding(Binding::AccelerationStructure)
        .textures(textures)
        .push_constants::<Push>()
        .build(gpu)
}
