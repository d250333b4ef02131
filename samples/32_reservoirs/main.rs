//! 32 · Reservoirs: of many candidates for a shadow ray one is kept, and passed on in time and in space.
//!
//! New since 29_emitters: a reservoir per pixel, in `candidates.glsl`; its merge with the last frame's and with those
//! of neighbours, in `merge.glsl`, by three kinds of weights. There is one bounce, and no mirrors.

#[allow(dead_code, reason = "29 also reads shares from its tables")]
#[path = "../29_emitters/alias.rs"]
mod alias;
#[path = "../11_path_tracing/closed_forms.rs"]
mod closed_forms;
#[path = "../29_emitters/emitters.rs"]
mod emitters;
mod history;
#[path = "../29_emitters/lit_scene.rs"]
mod lit_scene;
mod passes;
mod pixels;
#[path = "../29_emitters/scenes.rs"]
mod scenes;

use std::process::ExitCode;

use anyhow::Result;
use common::gpu::{
    Address, Binding, Descriptor, Gpu, HitGroup, RayTracingPipeline, Requirements, TextureTable,
    barrier,
};
use common::output;
use common::scene::{Camera, CameraBasis, SceneAddresses};
use common::{Controls, Frame, Sample, Setup, Variant, Variants};
use emitters::EmitterAddresses;
use glam::{DMat3, UVec2, Vec3};
use history::{Done, Valid};
use lit_scene::LitScene;
use passes::{Passes, Reuse, Show, Weights};
use pixels::{PixelAddresses, Pixels};
use scenes::{SceneName, Sky, Staged};

fn main() -> ExitCode {
    common::run::<Demo>(env!("CARGO_BIN_NAME"), instruments::all())
}

struct Demo {
    source: Staged,
    staged: Staged,
    lit: LitScene,
    pixels: Pixels,
    pipelines: Variants<Constants>,
    passes: Passes,
    /// The last complete frame, and the one in progress.
    done: Option<Done>,
    next: Option<Done>,
    camera: Camera,
    turn: f32,
    name: SceneName,
    /// The scene that was built.
    built: SceneName,
    reuse: Reuse,
    candidates: u32,
    cap: u32,
    neighbours: u32,
    radius: u32,
    tolerance: f32,
    seed: u32,
    constants: Constants,
}

/// Specialization constants of all pipelines' shaders.
#[derive(Clone, Copy, PartialEq)]
struct Constants {
    show: Show,
    sky: Sky,
    weights: Weights,
    visibility: bool,
    jitter: bool,
}

common::shader_struct! {
    /// Push constants of all shaders.
    struct Push {
        camera: CameraBasis,
        scene: SceneAddresses,
        emitters: Address<EmitterAddresses>,
        pixels: Address<PixelAddresses>,
        candidates: u32,
        most: u32,
        neighbours: u32,
        radius: u32,
        seed: u32,
        sample_index: u32,
        frames: u32,
        tolerance: f32,
    }
}

impl Sample for Demo {
    fn requirements() -> Requirements {
        Requirements::ray_tracing().textures()
    }

    fn new(gpu: &Gpu, setup: &Setup) -> Result<Self> {
        let (source, name) = match setup.scene() {
            Some(_) => {
                let scene = setup.scene_or(|| unreachable!("there is a file"))?;
                if scene.model.materials.iter().all(|material| material.emission == Vec3::ZERO) {
                    let line = "the scene has no lamp, so nothing lights it here: a lamp is a material with Ke";
                    output::warn(&[line.to_owned()]);
                }
                (Staged::from_file(scene), SceneName::Chess)
            }
            None => (scenes::chess()?, SceneName::ManyLamps),
        };
        let staged = Staged::new(name, &source);
        let camera = staged.scene.camera;
        Ok(Self {
            lit: LitScene::new(gpu, &staged, setup.options, camera.eye.as_vec3())?,
            constants: Constants {
                show: Show::Picture,
                sky: staged.sky,
                weights: Weights::Balance,
                visibility: true,
                jitter: true,
            },
            source,
            staged,
            pixels: Pixels::new(gpu, UVec2::ZERO)?,
            pipelines: Variants::default(),
            passes: Passes::default(),
            done: None,
            next: None,
            camera,
            turn: 0.0,
            name,
            built: name,
            reuse: Reuse::Both,
            candidates: 16,
            cap: 20,
            neighbours: 3,
            radius: 16,
            tolerance: 0.05,
            seed: 0,
        })
    }

    fn controls(&mut self, c: &mut Controls) {
        if c.choice("scene", &mut self.name) {
            let Staged { scene, sky, .. } = Staged::new(self.name, &self.source);
            (self.camera, self.constants.sky) = (scene.camera, sky);
        }
        c.choice("show", &mut self.constants.show);
        c.choice("sky", &mut self.constants.sky);
        c.choice("reuse", &mut self.reuse);
        c.choice("weights", &mut self.constants.weights);
        c.checkbox("visibility", &mut self.constants.visibility);
        c.integer("candidates", &mut self.candidates, 1..=256);
        c.integer("cap", &mut self.cap, 1..=1000);
        c.integer("neighbours", &mut self.neighbours, 1..=8);
        c.integer("radius", &mut self.radius, 1..=100);
        c.slider("plane tolerance", &mut self.tolerance, 0.0..=1.0);
        c.checkbox("jitter", &mut self.constants.jitter);
        c.slider("turn", &mut self.turn, -10.0..=10.0);
        c.integer("seed", &mut self.seed, 0..=1000);
        c.camera(&mut self.camera);
    }

    fn changed(&mut self, gpu: &Gpu) -> Result<()> {
        let eye = self.camera.eye.as_vec3();
        if self.name != self.built {
            self.staged = Staged::new(self.name, &self.source);
            self.built = self.name;
            self.lit.rebuild(gpu, &self.staged, eye)?;
        } else if self.lit.is_outdated(&self.staged, eye) {
            self.lit.rebuild(gpu, &self.staged, eye)?;
        }
        Ok(())
    }

    fn render(&mut self, frame: &Frame) -> Result<()> {
        let size = UVec2::new(frame.image.extent.width, frame.image.extent.height);
        if self.pixels.size != size {
            // A frame of another size may have been abandoned since the last complete one.
            (self.pixels, self.done) = (Pixels::new(frame.gpu, size)?, None);
        }
        // The passes of the last frame have read what this one writes.
        barrier::trace_to_trace(frame.gpu, frame.cmd);
        let camera = self.turned(frame.accumulated);
        let valid = Valid::of(self);
        let last = self.done.as_ref().filter(|done| done.goes_on_to(&valid, &camera));
        let age = last.map_or(0, |done| done.age + 1);
        let in_time = self.reuse.is_in_time();
        let has_history = in_time && last.is_some();
        // ANCHOR: trace
        let push = Push {
            camera: camera.basis(frame.aspect()),
            scene: self.lit.on_gpu.addresses,
            emitters: self.lit.emitters.address.into(),
            pixels: self.pixels.addresses(),
            candidates: self.candidates,
            most: if has_history { self.cap * self.candidates } else { 0 },
            neighbours: if self.reuse.is_in_space() { self.neighbours } else { 0 },
            radius: self.radius,
            seed: self.seed,
            sample_index: if in_time { age } else { frame.index },
            frames: frame.accumulated,
            tolerance: self.tolerance,
        };
        let descriptors = [
            Descriptor::AccelerationStructure(&self.lit.tlas),
            Descriptor::StorageImage(frame.image),
        ];
        let textures = &self.lit.on_gpu.textures;
        let Variant { pipeline, sbt, key } =
            self.pipelines.choose(frame, textures, self.constants, pipeline)?;
        pipeline.bind(frame.cmd, &descriptors, &push)?;
        sbt.trace(frame.cmd, frame.area);
        // ANCHOR_END: trace
        let is_whole = *key == self.constants;
        self.next = Some(Done { valid, camera, push, age, is_whole });
        Ok(())
    }

    fn passes(&self) -> Vec<&'static str> {
        Passes::NAMES.to_vec()
    }

    fn pass(&mut self, frame: &Frame, number: u32) -> Result<()> {
        let Some(now) = &mut self.next else { return Ok(()) };
        let last = self.done.as_ref().filter(|done| done.goes_on_to(&now.valid, &now.camera));
        let push = match (number, last) {
            (0, Some(last)) => Push { camera: last.push.camera, ..now.push },
            _ => now.push,
        };
        let used = self.passes.record(frame, number, (&self.lit, &push, self.constants))?;
        now.is_whole &= used == self.constants;
        if number as usize + 1 == Passes::NAMES.len() {
            self.pixels.swap();
            self.done = self.next.take().filter(|done| done.is_whole);
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
        // The camera turns from frame to frame of one picture.
        !self.reuse.is_in_time() && self.turn == 0.0
    }
}

impl Demo {
    /// The camera after so many frames: it turns around its target by some degrees per frame.
    fn turned(&self, frames: u32) -> Camera {
        let angle = f64::from(self.turn) * f64::from(frames);
        let arm =
            DMat3::from_rotation_y(angle.to_radians()) * (self.camera.eye - self.camera.target);
        let eye = if self.turn == 0.0 { self.camera.eye } else { self.camera.target + arm };
        Camera { eye, ..self.camera }
    }
}

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
        .hit(HitGroup::procedural("sphere.rint").closest_hit("sphere.rchit"))
        .constant(1, constants.sky)
        .constant(3, constants.visibility)
        .constant(4, constants.jitter)
        .recursion(1)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .textures(textures)
        .push_constants::<Push>()
        .build(gpu)
}
