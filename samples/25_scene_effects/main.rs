//! 25 · Scene effects: a pipeline that holds what the scene calls for, and nothing else.
//!
//! New since 12_infinite_plane: effects found from the scene, shaders in pieces, stages and groups that
//! come and go, and one more pipeline that has everything, to be compared with.

mod costs;
mod geometry;
mod ground;
mod panel;
mod recipe;
mod tracer;
mod world;

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, Result};
use ash::vk;
use common::app::output;
use common::gpu::{Address, Buffer, Descriptor, Gpu, Requirements, ShaderStruct};
use common::scene::plane::Plane;
use common::scene::{
    Camera, CameraBasis, Composition, Effect, Face, Finding, Light, SceneAddresses, SceneOnGpu,
    SceneOptions, Solid, Sphere, assets, findings, input_usage, needed,
};
use common::{Controls, Frame, Sample, Setup};
use costs::Cost;
use geometry::SceneGeometry;
use glam::Vec3;
use ground::{Ground, HeightfieldShape};
use recipe::Recipe;
use serde_json::{Value, json};
use tracer::{Tracer, Workshop};
use world::{Board, World};

fn main() -> ExitCode {
    common::run::<Demo>(env!("CARGO_BIN_NAME"))
}

/// The scenes in `samples/assets/scenes`, from the least to everything. The last is a file of the reader's.
const SCENES: [&str; 14] = [
    "one sphere",
    "two kings",
    "empty board",
    "opening",
    "lamp at night",
    "soft evening",
    "fretwork",
    "knight",
    "bauhaus",
    "mirror balls",
    "solids",
    "lake",
    "everything",
    "file",
];
const EVERYTHING: u32 = 12;
const FILE: u32 = 13;

const PIPELINE_EVERYTHING: u32 = 1;

struct Demo {
    scene: Composition,
    /// `None` where the scene is not on the device yet.
    geometry: Option<SceneGeometry>,
    /// The materials have changed; meshes and textures have not.
    repainted: bool,
    world: Buffer,
    tracers: Vec<Tracer>,
    /// The one in use.
    current: usize,
    workshop: Workshop,
    /// The pipeline that could not be made, and why; until another is called for.
    failed: Option<(Recipe, String)>,
    costs: Vec<Cost>,
    camera: Camera,
    file: Option<PathBuf>,
    number: u32,
    pipeline: u32,
    without: u32,
    measure: bool,
    light: u32,
    material: u32,
    /// Why the scene that was chosen cannot be opened.
    trouble: Option<anyhow::Error>,
    interactive: bool,
    options: SceneOptions,
}

common::shader_struct! {
    /// What every shader of this chapter can read.
    struct Push {
        camera: CameraBasis,
        scene: SceneAddresses,
        world: Address,
    }
}

impl Sample for Demo {
    fn requirements() -> Requirements {
        Requirements::ray_tracing().textures().primitive_culling_where_offered()
    }

    fn new(gpu: &Gpu, setup: &Setup) -> Result<Self> {
        let file = setup.scene().map(PathBuf::from);
        let number = if file.is_some() { FILE } else { EVERYTHING };
        let path = file.clone().unwrap_or_else(|| path(EVERYTHING));
        let scene = Composition::open(&path)?;
        output::warn(&scene.scene.model.warnings);
        gpu.share_structs(&[
            World::LAYOUT,
            Plane::LAYOUT,
            Board::LAYOUT,
            Ground::LAYOUT,
            HeightfieldShape::LAYOUT,
            Light::LAYOUT,
            Sphere::LAYOUT,
            common::scene::Box::LAYOUT,
            Solid::LAYOUT,
            Face::LAYOUT,
        ]);
        let usage = input_usage() | vk::BufferUsageFlags::TRANSFER_DST;
        let camera = scene.scene.camera;
        Ok(Self {
            scene,
            geometry: None,
            repainted: false,
            world: Buffer::new(gpu, "world", size_of::<World>() as u64, usage)?,
            tracers: Vec::new(),
            current: 0,
            workshop: Workshop::default(),
            failed: None,
            costs: Vec::new(),
            camera,
            file,
            number,
            pipeline: 0,
            without: 0,
            measure: false,
            light: 1,
            material: 0,
            trouble: None,
            interactive: setup.interactive,
            options: setup.options,
        })
    }

    // ANCHOR: controls
    fn controls(&mut self, c: &mut Controls) {
        let known = if self.file.is_some() { SCENES.len() } else { FILE as usize };
        if c.choice("scene", &mut self.number, &SCENES[..known]) {
            self.open();
        }
        c.choice("pipeline", &mut self.pipeline, &["specialised", "everything"]);
        let names: Vec<&str> =
            ["nothing"].into_iter().chain(Effect::ALL.map(Effect::name)).collect();
        c.choice("without", &mut self.without, &names);
        c.checkbox("measure costs", &mut self.measure);
        c.integer("samples", &mut self.scene.samples, 1..=64);
        c.integer("depth", &mut self.scene.depth, 0..=8);
        let lights = self.scene.lights.len() as u32;
        c.integer("light", &mut self.light, 1..=lights.max(1));
        if let Some(light) = self.scene.lights.get_mut(self.light as usize - 1) {
            c.slider("light size", &mut light.light.size, 0.0..=1.0);
            c.checkbox("light shadows", &mut light.shadows);
        }
        self.polish(c);
        self.tell(c);
        c.camera(&mut self.camera);
    }
    // ANCHOR_END: controls

    fn render(&mut self, frame: &Frame) -> Result<()> {
        // A window goes on with the scene that it has, and tells.
        if let Some(error) = self.trouble.take_if(|_| !self.interactive) {
            return Err(error);
        }
        let camera = self.camera.basis(frame.aspect());
        self.upload(frame.gpu, camera.origin)?;
        self.choose(frame.gpu)?;
        let effects = self.recipe().effects;
        if self.measure && self.costs.is_empty() {
            self.costs = costs::measure(frame.gpu, effects, |cmd, effects| {
                let recipe = Recipe { effects, ..self.recipe() };
                let at = self.tracer(frame.gpu, recipe)?;
                self.record(cmd, frame, at, camera)
            })?;
            self.current = self.tracer(frame.gpu, self.recipe())?;
        }
        self.record(frame.cmd, frame, self.current, camera)
    }

    fn is_busy(&self) -> bool {
        self.workshop.is_busy()
    }

    fn report(&self) -> Result<Value> {
        let found = self.findings();
        let effects = found.iter().map(|Finding { effect, needed, why }| {
            let cost = self.costs.iter().find(|cost| cost.effect == *effect);
            json!({
                "name": effect.name(),
                "in": needed,
                "why": why,
                "cost_milliseconds": cost.map(|cost| cost.milliseconds),
                "time_without": cost.map(|cost| cost.ratio),
            })
        });
        Ok(json!({
            "scene": SCENES[self.number as usize],
            "effects": effects.collect::<Vec<_>>(),
            "pipeline": self.tracers.get(self.current).map(Tracer::report).transpose()?,
        }))
    }
}

/// The file of one of the chapter's own scenes.
fn path(number: u32) -> PathBuf {
    let name = SCENES[number as usize].replace(' ', "_");
    assets().join("scenes").join(name).with_extension("toml")
}

impl Demo {
    /// Opens the scene that was chosen.
    fn open(&mut self) {
        let own = path(self.number.min(EVERYTHING));
        let path = self.file.as_ref().filter(|_| self.number == FILE).unwrap_or(&own);
        match Composition::open(path) {
            Ok(scene) => {
                output::warn(&scene.scene.model.warnings);
                self.camera = scene.scene.camera;
                (self.scene, self.geometry) = (scene, None);
                (self.light, self.material) = (1, 0);
                self.trouble = None;
            }
            Err(error) => self.trouble = Some(error),
        }
    }

    fn findings(&self) -> Vec<Finding> {
        findings(&self.scene)
    }

    // ANCHOR: recipe
    /// What the pipeline shall be made for.
    fn recipe(&self) -> Recipe {
        let mut recipe = match self.pipeline {
            PIPELINE_EVERYTHING => Recipe::everything(),
            _ => Recipe::specialised(&self.scene, needed(&self.findings())),
        };
        if let Some(&left_out) = Effect::ALL.get((self.without as usize).wrapping_sub(1)) {
            recipe.effects = recipe.effects.without(left_out);
        }
        recipe
    }
    // ANCHOR_END: recipe

    /// Brings the scene to the device, if it is not there.
    fn upload(&mut self, gpu: &Gpu, eye: Vec3) -> Result<()> {
        let fits = self.geometry.as_ref().is_some_and(|g| g.reaches(&self.scene, eye));
        if fits && !self.repainted {
            return Ok(());
        }
        // Pipelines know the texture table; top levels know everything else.
        let textures = self.geometry.take().map(|geometry| geometry.scene.textures);
        let scene =
            SceneOnGpu::with_textures(gpu, &self.scene.scene, self.options, textures.clone())?;
        let geometry = SceneGeometry::new(gpu, &self.scene, scene, eye)?;
        if textures.is_none() {
            self.tracers.clear();
            self.workshop = Workshop::default();
        }
        for tracer in &mut self.tracers {
            tracer.tlas = geometry.top_level(gpu, &tracer.recipe)?;
        }
        (self.geometry, self.repainted) = (Some(geometry), false);
        self.costs.clear();
        Ok(())
    }

    // ANCHOR: choose
    /// Takes the pipeline for the scene as it is now. While it is being made, the last one goes on.
    fn choose(&mut self, gpu: &Gpu) -> Result<()> {
        let geometry = self.geometry.as_ref().context("no scene")?;
        match self.workshop.done() {
            Some((recipe, Ok(made))) => {
                self.tracers.push(Tracer::new(gpu, geometry, recipe, made)?);
            }
            Some((recipe, Err(error))) => self.failed = Some((recipe, format!("{error:#}"))),
            None => {}
        }
        let recipe = self.recipe();
        let known = self.tracers.iter().position(|tracer| tracer.recipe == recipe);
        let old = self.tracers.get(self.current).map(|tracer| tracer.recipe);
        if old != Some(recipe) {
            self.costs.clear();
        }
        if known.is_some() || !self.interactive || old.is_none() {
            self.current = self.tracer(gpu, recipe)?;
        } else if self.failed.as_ref().is_none_or(|(known, _)| *known != recipe) {
            self.failed = None;
            self.workshop.begin(gpu, &geometry.scene.textures, recipe);
        }
        Ok(())
    }
    // ANCHOR_END: choose

    /// The tracer of a recipe, made now if there is none.
    fn tracer(&mut self, gpu: &Gpu, recipe: Recipe) -> Result<usize> {
        let known = self.tracers.iter().position(|tracer| tracer.recipe == recipe);
        if let Some(known) = known {
            return Ok(known);
        }
        let geometry = self.geometry.as_ref().context("no scene")?;
        let pipeline = recipe.build(gpu, &geometry.scene.textures)?;
        self.tracers.push(Tracer::new(gpu, geometry, recipe, pipeline)?);
        Ok(self.tracers.len() - 1)
    }

    /// Records the trace.
    fn record(
        &self,
        cmd: vk::CommandBuffer,
        frame: &Frame,
        tracer: usize,
        camera: CameraBasis,
    ) -> Result<()> {
        let geometry = self.geometry.as_ref().context("no scene")?;
        let Tracer { pipeline, sbt, tlas, .. } = &self.tracers[tracer];
        self.world.write(0, &[World::new(&self.scene, geometry.shapes, camera.origin)])?;
        // ANCHOR: trace
        let push =
            Push { camera, scene: geometry.scene.addresses, world: self.world.address.into() };
        let descriptors =
            [Descriptor::AccelerationStructure(tlas), Descriptor::StorageImage(frame.image)];
        pipeline.bind(cmd, &descriptors, &push)?;
        sbt.trace(cmd, frame.image.extent);
        // ANCHOR_END: trace
        Ok(())
    }
}
