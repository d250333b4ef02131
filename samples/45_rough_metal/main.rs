//! 45 · Rough metal: GGX microfacets, and how to sample them.
//!
//! New since 11_path_tracing: metal and insulators of any roughness; directions that follow the facets an eye sees;
//! and the light that facets pass on to each other, from a table of what they reflect in all.

mod albedo;
mod microfacets;
mod rough_scene;
mod scenes;

use std::process::ExitCode;

use anyhow::Result;
use ash::vk;
use common::gpu::{
    Address, Binding, Buffer, Descriptor, Gpu, HitGroup, RayTracingPipeline, Requirements,
    TextureTable, barrier,
};
use common::scene::{Camera, CameraBasis, Light, Look, Scene, SceneAddresses, Sun, input_usage};
use common::{Controls, Frame, Sample, Setup, Variant, Variants};
use glam::UVec3;
use microfacets::RoughAddresses;
use rough_scene::RoughScene;
use scenes::{SceneName, Sky, Staged};

fn main() -> ExitCode {
    common::run::<Demo>(env!("CARGO_BIN_NAME"), instruments::all())
}

/// Maximum number of reflections of a path. If each surface takes 5 % of its light, less than
/// 2·10^-6 of it is left by then.
const MAX_DEPTH: u32 = 256;

/// The value of the control `roughness` for which each material has its own.
const OWN: f32 = -1.0;

struct Demo {
    source: Scene,
    rough: RoughScene,
    pipelines: Variants<Constants>,
    camera: Camera,
    sun: Sun,
    light_size: f32,
    name: SceneName,
    /// The roughness of all surfaces; negative for each material's own.
    roughness: f32,
    /// The scene and the roughness that were built.
    built: (SceneName, f32),
    depth: u32,
    clamp: f32,
    seed: u32,
    constants: Constants,
    sums: Buffer,
}

common::shader_enum! {
    /// The quantity shown per pixel.
    enum Show: SHOW { Picture, Direct, Bounced, Rays, Facets }
    /// The way to choose a facet.
    enum Sampling: SAMPLING { Distribution, Visible, Bounded }
    /// The formula for the density of facets.
    enum Form: FORM { Textbook, Stable }
}

/// Specialization constants of a pipeline's shaders.
#[derive(Clone, Copy, PartialEq)]
struct Constants {
    show: Show,
    sky: Sky,
    roulette: bool,
    sampling: Sampling,
    form: Form,
    compensation: bool,
}

common::shader_struct! {
    /// Push constants of all shaders.
    struct Push {
        camera: CameraBasis,
        scene: SceneAddresses,
        rough: Address<RoughAddresses>,
        sums: Address<PixelSum>,
        light: Light,
        light_size: f32,
        depth: u32,
        most: f32,
        seed: u32,
        sample_index: u32,
    }
}

common::shader_struct! {
    /// The samples of a pixel, added up.
    struct PixelSum {
        whole: UVec3,
        part: UVec3,
        count: u32,
    }
}

impl Sample for Demo {
    fn requirements() -> Requirements {
        Requirements::ray_tracing().textures()
    }

    fn new(gpu: &Gpu, setup: &Setup) -> Result<Self> {
        let source = setup.scene_with(&[Look::Mirror, Look::Microfacet], scenes::chess)?;
        let Staged { scene, sun, sky } = Staged::new(SceneName::Chess, &source);
        let camera = scene.camera;
        let rough = RoughScene::new(gpu, &scene, setup.options, OWN)?;
        Ok(Self {
            source,
            rough,
            pipelines: Variants::default(),
            camera,
            sun,
            light_size: 0.03,
            name: SceneName::Chess,
            roughness: OWN,
            built: (SceneName::Chess, OWN),
            depth: 16,
            clamp: 0.0,
            seed: 0,
            constants: Constants {
                show: Show::Picture,
                sky,
                roulette: true,
                sampling: Sampling::Bounded,
                form: Form::Stable,
                compensation: true,
            },
            sums: Buffer::new(gpu, "sums", 0, input_usage())?,
        })
    }

    fn controls(&mut self, c: &mut Controls) {
        if c.choice("scene", &mut self.name) {
            self.take_scene();
        }
        c.choice("show", &mut self.constants.show);
        c.slider("roughness", &mut self.roughness, OWN..=1.0);
        c.choice("sampling", &mut self.constants.sampling);
        c.choice("form", &mut self.constants.form);
        c.checkbox("compensation", &mut self.constants.compensation);
        c.choice("sky", &mut self.constants.sky);
        c.sun(&mut self.sun);
        c.slider("light size", &mut self.light_size, 0.0..=1.0);
        c.integer("depth", &mut self.depth, 0..=MAX_DEPTH);
        c.checkbox("roulette", &mut self.constants.roulette);
        c.slider("clamp", &mut self.clamp, 0.0..=100.0);
        c.integer("seed", &mut self.seed, 0..=1000);
        c.camera(&mut self.camera);
    }

    fn changed(&mut self, gpu: &Gpu) -> Result<()> {
        let wanted = (self.name, self.roughness);
        if wanted != self.built {
            let Staged { scene, .. } = Staged::new(self.name, &self.source);
            self.rough.rebuild(gpu, &scene, self.roughness)?;
            self.built = wanted;
        }
        Ok(())
    }

    fn render(&mut self, frame: &Frame) -> Result<()> {
        let extent = frame.image.extent;
        let size =
            u64::from(extent.width) * u64::from(extent.height) * size_of::<PixelSum>() as u64;
        if self.sums.size != size {
            let usage = input_usage() | vk::BufferUsageFlags::TRANSFER_DST;
            self.sums = Buffer::new(frame.gpu, "sums", size, usage)?;
        }
        if frame.accumulated == 0 && frame.is_first_band() {
            self.sums.clear(frame.cmd);
        }
        // The previous frame may still write its sums when this one begins to read them.
        barrier::trace_to_trace(frame.gpu, frame.cmd);
        // ANCHOR: trace
        let push = Push {
            camera: self.camera.basis(frame.aspect()),
            scene: self.rough.on_gpu.addresses,
            rough: self.rough.microfacets.rough.address.into(),
            sums: self.sums.address.into(),
            light: Light::directional(&self.sun),
            light_size: self.light_size,
            depth: self.depth,
            most: self.clamp,
            seed: self.seed,
            sample_index: frame.index,
        };
        let descriptors = [
            Descriptor::AccelerationStructure(&self.rough.on_gpu.tlas),
            Descriptor::StorageImage(frame.image),
        ];
        let Variant { pipeline, sbt, .. } =
            self.pipelines.choose(frame, &self.rough.on_gpu.textures, self.constants, pipeline)?;
        pipeline.bind(frame.cmd, &descriptors, &push)?;
        sbt.trace(frame.cmd, frame.area);
        // ANCHOR_END: trace
        Ok(())
    }

    fn accumulates(&self) -> bool {
        true
    }
}

impl Demo {
    /// Takes over what a scene brings: view, sun and sky.
    fn take_scene(&mut self) {
        let Staged { scene, sun, sky } = Staged::new(self.name, &self.source);
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
        .constant(0, constants.show)
        .constant(1, constants.sky)
        .constant(2, constants.roulette)
        .constant(3, constants.sampling)
        .constant(4, constants.form)
        .constant(5, constants.compensation)
        .recursion(1)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .textures(textures)
        .push_constants::<Push>()
        .build(gpu)
}
