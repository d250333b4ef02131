//! 25 · Scene effects: a pipeline with exactly the effects that the scene triggers.
//!
//! New since 12_infinite_plane: effects found from the scene, shaders in pieces, stages and groups that
//! come and go, and one more pipeline that has everything, to be compared with.

#[path = "../45_rough_metal/albedo.rs"]
mod albedo;
#[allow(dead_code, reason = "29 also makes tables of checked weights")]
#[path = "../29_emitters/alias.rs"]
mod alias;
#[path = "../31_history_and_filter/back.rs"]
mod back;
mod clock;
mod contents;
mod costs;
mod geometry;
mod ground;
mod history;
#[allow(dead_code, reason = "45 takes other materials")]
#[path = "../45_rough_metal/microfacets.rs"]
mod microfacets;
#[path = "../47_normal_maps/normal_map.rs"]
mod normal_map;
mod panel;
#[allow(dead_code, reason = "31 also filters")]
#[path = "../31_history_and_filter/pixels.rs"]
mod pixels;
mod recipe;
mod report;
mod scenes;
#[path = "../21_heightfield/shape.rs"]
mod shape;
#[allow(dead_code, reason = "46 compares sums, and divides texels")]
#[path = "../46_environment/sky.rs"]
mod sky;
mod why;
mod world;

use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, Result, anyhow};
use ash::vk;
use common::gpu::{Address, Buffer, Descriptor, Gpu, Requirements, ShaderEnum};
use common::output;
use common::scene::{Camera, CameraBasis, SceneAddresses, SceneOnGpu, SceneOptions, input_usage};
use common::{Controls, Frame, Playback, Sample, Setup, Variant, Variants};
use costs::Costs;
use effects::{Composition, Effect, Environment, Finding, findings, needed};
use geometry::SceneGeometry;
use history::History;
use microfacets::RoughAddresses;
use recipe::{Recipe, pipeline};
use scenes::{EVERYTHING, FILE, SCENES};
use serde_json::Value;
use sky::SkyAddresses;
use why::Why;
use world::World;

fn main() -> ExitCode {
    common::exit::finish(|| {
        let name = env!("CARGO_BIN_NAME");
        let (args, options, why) = instruments::parse_with::<Why>(name)?;
        clock::check(&args)?;
        why.start(name, args, options)
    })
}

const PIPELINE_EVERYTHING: u32 = 1;
/// The last frame of what moves: a minute.
const LAST: u32 = 3600;

struct Demo {
    scene: Composition,
    /// `None` where the scene is not on the device yet.
    geometry: Option<SceneGeometry>,
    /// The materials have changed; meshes and textures have not.
    repainted: bool,
    world: Buffer,
    pipelines: Variants<Recipe>,
    costs: Option<Costs>,
    history: History,
    playback: Playback,
    camera: Camera,
    file: Option<PathBuf>,
    number: u32,
    pipeline: u32,
    without: u32,
    also: u32,
    measure: bool,
    show: u32,
    /// The ticks that the view of time shows in white.
    hottest: f32,
    /// The ticks of each pixel, while they are shown.
    ticks: Option<Buffer>,
    light: u32,
    material: u32,
    /// The choice among the scene's own sky and [`effects::SKIES`].
    sky: u32,
    /// The scene's own.
    own_sky: Option<Environment>,
    /// The reason why the chosen scene cannot be opened.
    trouble: Option<anyhow::Error>,
    /// The device lets threads change places.
    can_reorder: bool,
    options: SceneOptions,
}

common::shader_struct! {
    /// Push constants of all shaders.
    struct Push {
        camera: CameraBasis,
        scene: SceneAddresses,
        world: Address,
        rough: Address<RoughAddresses>,
        sky: Address<SkyAddresses>,
        ticks: Address<u32>,
        hottest: f32,
    }
}

impl Sample for Demo {
    fn requirements() -> Requirements {
        Requirements::ray_tracing()
            .textures()
            .mipmaps()
            .primitive_culling_where_offered()
            .shader_clock_where_offered()
            .invocation_reorder_where_offered()
    }

    fn new(gpu: &Gpu, setup: &Setup) -> Result<Self> {
        let file = setup.scene().map(PathBuf::from);
        let number = if file.is_some() { FILE } else { EVERYTHING };
        let path = file.clone().unwrap_or_else(|| scenes::path(EVERYTHING));
        let scene = effects::open(&path)?;
        output::warn(&scene.scene.model.warnings);
        let usage = input_usage() | vk::BufferUsageFlags::TRANSFER_DST;
        let camera = scene.scene.camera;
        let own_sky = scene.environment.clone();
        Ok(Self {
            scene,
            geometry: None,
            repainted: false,
            world: Buffer::new(gpu, "world", size_of::<World>() as u64, usage)?,
            pipelines: Variants::default(),
            costs: None,
            history: History::new(gpu)?,
            playback: Playback::new(LAST),
            camera,
            file,
            number,
            pipeline: 0,
            without: 0,
            also: 0,
            measure: false,
            show: 0,
            hottest: 500_000.0,
            ticks: None,
            light: 1,
            material: 0,
            sky: 0,
            own_sky,
            trouble: None,
            can_reorder: recipe::can_reorder(gpu),
            options: setup.options,
        })
    }

    fn controls(&mut self, c: &mut Controls) {
        let known = if self.file.is_some() { SCENES.len() } else { FILE as usize };
        if c.one_of("scene", &mut self.number, &SCENES[..known]) {
            self.open();
        }
        if self.scene.motion.is_some() {
            c.playback(&mut self.playback);
        }
        c.one_of("pipeline", &mut self.pipeline, &["specialised", "everything"]);
        let names = [&["nothing"], Effect::LAYOUT.words].concat();
        c.one_of("without", &mut self.without, &names);
        c.one_of("also", &mut self.also, &names);
        c.checkbox("measure costs", &mut self.measure);
        c.integer("samples", &mut self.scene.samples, 1..=64);
        c.integer("depth", &mut self.scene.depth, 0..=32);
        c.integer("bounces", &mut self.scene.bounces, 0..=8);
        let lights = self.scene.lights.len() as u32;
        c.integer("light", &mut self.light, 1..=lights.max(1));
        if let Some(light) = self.scene.lights.get_mut(self.light as usize - 1) {
            c.slider("light size", &mut light.disk.radius, 0.0..=1.0);
            c.checkbox("light shadows", &mut light.shadows);
        }
        self.choose_sky(c);
        self.polish(c);
        self.tell(c);
        c.camera(&mut self.camera);
        c.slider("lens diameter", &mut self.scene.lens.diameter, 0.0..=1.0);
        c.slider("focus", &mut self.scene.lens.focus, effects::FOCUS);
        c.one_of("show", &mut self.show, &["picture", "time"]);
        c.slider("hottest", &mut self.hottest, 1e3..=1e8);
    }

    fn changed(&mut self, gpu: &Gpu) -> Result<()> {
        if self.measure && !gpu.limits.has_timestamps() {
            self.measure = false;
            let queue = format!("{}, whose queue has no timestamps", gpu.name);
            self.trouble = Some(anyhow!("costs cannot be measured on {queue}"));
        }
        if self.show == clock::TIME && !clock::has_clock(gpu) {
            self.show = 0;
            let what = format!("{}, whose shaders have no clock (VK_KHR_shader_clock)", gpu.name);
            self.trouble = Some(anyhow!("times cannot be shown on {what}"));
        }
        if let Some(error) = self.trouble.take() {
            return Err(error);
        }
        self.upload(gpu)
    }

    fn render(&mut self, frame: &Frame) -> Result<()> {
        let recipe = self.recipe();
        let geometry = self.geometry.as_mut().context("no scene")?;
        let mut view = self.camera;
        if let Some(motion) = &self.scene.motion {
            motion.place(&mut self.scene.scene.instances, self.playback.frame);
            view = motion.camera(&self.camera, self.playback.frame);
            geometry.place(&self.scene);
        }
        let camera = view.basis(frame.aspect());
        let world = World::new(&self.scene, geometry.shapes, view.eye, 0);
        // With --samples, each frame has rays of its own.
        let is_alone = frame.accumulated == 0 && frame.index > 0;
        let number = if !recipe.effects.has(Effect::History) {
            frame.first()
        } else if self.scene.motion.is_none() || is_alone {
            self.history.none(frame)?;
            frame.first()
        } else {
            let now = (world, self.playback.frame, geometry.rounding);
            self.history.begin(frame, &self.scene, recipe, &view, now)?
        };
        let rays = self.scene.samples;
        let next = number.checked_add(1).and_then(|next| next.checked_mul(rays));
        let first = next.context("rays are numbered up to 2^32: ask for fewer samples")? - rays;
        self.world.update(frame.cmd, &[World { first_sample: first, ..world }])?;
        let pixels = u64::from(frame.image.extent.width) * u64::from(frame.image.extent.height);
        if self.show != clock::TIME {
            self.ticks = None;
        } else if self.ticks.as_ref().is_none_or(|ticks| ticks.size != 4 * pixels) {
            self.ticks = Some(clock::ticks(frame.gpu, frame.image.extent)?);
        }
        let mut is_own = true;
        if !self.measure {
            self.costs = None;
            is_own = self.trace(frame, recipe, camera)?;
        } else {
            let mut costs = Costs::for_recipe(frame.gpu, self.costs.take(), recipe)?;
            costs.record(frame, |recipe| {
                is_own = self.trace(frame, recipe, camera)?;
                Ok(is_own)
            })?;
            self.costs = Some(costs);
        }
        self.history.end(frame, is_own);
        Ok(())
    }

    fn accumulates(&self) -> bool {
        let follows = self.scene.motion.is_some() && self.recipe().effects.has(Effect::History);
        self.costs.as_ref().is_some_and(Costs::wants_more) || follows && !self.history.is_full()
    }

    fn forget(&mut self) -> bool {
        self.history.forget()
    }

    fn playback(&mut self) -> Option<&mut Playback> {
        self.scene.motion.is_some().then_some(&mut self.playback)
    }

    fn gathers(&self) -> bool {
        !self.measure && (self.scene.motion.is_none() || !self.playback.playing)
    }

    fn report(&self) -> Result<Value> {
        report::report(self)
    }
}

impl Demo {
    /// Opens the scene that was chosen.
    fn open(&mut self) {
        let own = scenes::path(self.number.min(EVERYTHING));
        let path = self.file.as_ref().filter(|_| self.number == FILE).unwrap_or(&own);
        match effects::open(path) {
            Ok(scene) => {
                output::warn(&scene.scene.model.warnings);
                self.camera = scene.scene.camera;
                self.playback = Playback::new(LAST);
                (self.scene, self.geometry) = (scene, None);
                (self.light, self.material, self.sky) = (1, 0, 0);
                self.own_sky = self.scene.environment.clone();
                self.trouble = None;
            }
            Err(error) => self.trouble = Some(error),
        }
    }

    fn findings(&self) -> Vec<Finding> {
        findings(&self.scene)
    }

    // ANCHOR: recipe
    /// The recipe of the wanted pipeline.
    fn recipe(&self) -> Recipe {
        let mut recipe = match self.pipeline {
            PIPELINE_EVERYTHING => Recipe::everything(),
            _ => Recipe::specialised(&self.scene, needed(&self.findings())),
        };
        let chosen = |number: u32| Effect::ALL.get((number as usize).wrapping_sub(1)).copied();
        if let Some(left_out) = chosen(self.without) {
            recipe.effects = recipe.effects.without(left_out);
        }
        if let Some(put_in) = chosen(self.also) {
            recipe.effects = recipe.effects.with(put_in);
        }
        recipe.timed = self.show == clock::TIME;
        recipe
    }
    // ANCHOR_END: recipe

    /// Uploads the scene, unless it is on the device already, and returns the addresses of its shapes.
    fn upload(&mut self, gpu: &Gpu) -> Result<()> {
        if let Some(geometry) = &self.geometry
            && geometry.reaches(&self.scene, &self.camera)
            && !self.repainted
        {
            return Ok(());
        }
        self.history.forget();
        // Pipelines know the texture table; top levels know everything else.
        let textures = self.geometry.take().map(|geometry| geometry.scene.textures);
        if textures.is_none() {
            self.pipelines = Variants::default();
        }
        let options = SceneOptions { mipmaps: self.scene.filtered, ..self.options };
        let scene = SceneOnGpu::with_textures(gpu, &self.scene.scene, options, textures)?;
        let geometry = SceneGeometry::new(gpu, &self.scene, scene, &self.camera)?;
        (self.geometry, self.repainted, self.costs) = (Some(geometry), false, None);
        Ok(())
    }

    /// Records a trace by the pipeline of a recipe; in a window, by the last one for as long as that is
    /// being made. Returns whether it was the recipe's own.
    fn trace(&mut self, frame: &Frame, recipe: Recipe, camera: CameraBasis) -> Result<bool> {
        let geometry = self.geometry.as_mut().context("no scene")?;
        // ANCHOR: trace
        let Variant { key, pipeline, sbt } =
            self.pipelines.choose(frame, &geometry.scene.textures, recipe, pipeline)?;
        let push = Push {
            camera,
            scene: geometry.scene.addresses,
            world: self.world.address.into(),
            rough: geometry.shapes.rough.into(),
            sky: geometry.shapes.sky.into(),
            ticks: self.ticks.as_ref().map_or(0, |ticks| ticks.address).into(),
            hottest: self.hottest,
        };
        let mut descriptors = vec![
            Descriptor::AccelerationStructure(geometry.top_level(frame, *key)?),
            Descriptor::StorageImage(frame.image),
        ];
        if key.effects.has(Effect::History) {
            descriptors.push(Descriptor::StorageBuffer(&self.history.past));
        }
        pipeline.bind(frame.cmd, &descriptors, &push)?;
        sbt.trace(frame.cmd, frame.area);
        // ANCHOR_END: trace
        Ok(*key == recipe)
    }
}
