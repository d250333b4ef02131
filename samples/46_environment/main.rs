//! 46 · Environment: light from a picture of the sky, and how to find a small sun in it.
//!
//! New since 45_rough_metal: a sky from an EXR file, shadow rays to texels chosen by their light, and the balance of
//! these with bounces. The sun is a texel.

#[path = "../45_rough_metal/albedo.rs"]
mod albedo;
#[allow(dead_code, reason = "29 also makes tables of checked weights")]
#[path = "../29_emitters/alias.rs"]
mod alias;
#[path = "../45_rough_metal/microfacets.rs"]
mod microfacets;
#[path = "../45_rough_metal/rough_scene.rs"]
mod rough_scene;
#[path = "../45_rough_metal/scenes.rs"]
mod rough_scenes;
mod scenes;
mod sky;

use std::process::ExitCode;

use anyhow::Result;
use ash::vk;
use common::gpu::{
    Address, Binding, Buffer, Descriptor, Gpu, HitGroup, RayTracingPipeline, Requirements,
    TextureTable, barrier,
};
use common::scene::{Camera, CameraBasis, Look, Scene, SceneAddresses, input_usage};
use common::{Controls, Frame, Sample, Setup, Variant, Variants};
use glam::UVec3;
use microfacets::RoughAddresses;
use rough_scene::RoughScene;
use rough_scenes::SceneName;
use scenes::{Skies, SkyName};
use sky::{SkyAddresses, SkyOnGpu, SkyTable, Sum, divided};

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
    skies: Skies,
    sky: SkyOnGpu,
    pipelines: Variants<Constants>,
    camera: Camera,
    name: SceneName,
    /// The roughness of all surfaces; negative for each material's own.
    roughness: f32,
    /// The scene and the roughness that were built.
    built: (SceneName, f32),
    look: SkyLook,
    /// The sky that was built.
    built_look: SkyLook,
    /// Degrees by which the sky is turned around the vertical.
    rotation: f32,
    depth: u32,
    clamp: f32,
    seed: u32,
    constants: Constants,
    sums: Buffer,
}

/// The settings that the table of the sky depends on.
#[derive(Clone, Copy, PartialEq)]
struct SkyLook {
    name: SkyName,
    sum: Sum,
    /// Into how many rows and columns each texel is divided.
    cut: u32,
}

common::shader_enum! {
    /// The quantity shown per pixel.
    enum Show: SHOW { Picture, Rays }
    /// The rays that find the light of the sky.
    enum Sampler: SAMPLER { Bounces, Uniform, Map, Both }
}

/// Specialization constants of a pipeline's shaders.
#[derive(Clone, Copy, PartialEq)]
struct Constants {
    show: Show,
    sampler: Sampler,
}

common::shader_struct! {
    /// Push constants of all shaders.
    struct Push {
        camera: CameraBasis,
        scene: SceneAddresses,
        rough: Address<RoughAddresses>,
        sky: Address<SkyAddresses>,
        sums: Address<PixelSum>,
        rotation: f32,
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
        let skies = Skies::open(setup)?;
        let (scene, sky_name) = scenes::staged(SceneName::Chess, &source, skies.first());
        let look = SkyLook { name: sky_name, sum: Sum::Exact, cut: 1 };
        let table = SkyTable::new(&skies.picture(look.name)?, look.sum);
        Ok(Self {
            rough: RoughScene::new(gpu, &scene, setup.options, OWN)?,
            sky: SkyOnGpu::new(gpu, &table)?,
            camera: scene.camera,
            source,
            skies,
            pipelines: Variants::default(),
            name: SceneName::Chess,
            roughness: OWN,
            built: (SceneName::Chess, OWN),
            look,
            built_look: look,
            rotation: 0.0,
            depth: 16,
            clamp: 0.0,
            seed: 0,
            constants: Constants { show: Show::Picture, sampler: Sampler::Both },
            sums: Buffer::new(gpu, "sums", 0, input_usage())?,
        })
    }

    fn controls(&mut self, c: &mut Controls) {
        if c.choice("scene", &mut self.name) {
            let (scene, sky) = scenes::staged(self.name, &self.source, self.skies.first());
            (self.camera, self.look.name) = (scene.camera, sky);
        }
        c.choice("show", &mut self.constants.show);
        c.choice("sky", &mut self.look.name);
        c.slider("rotation", &mut self.rotation, -360.0..=360.0);
        c.choice("sampling", &mut self.constants.sampler);
        c.choice("sum", &mut self.look.sum);
        c.integer("cut", &mut self.look.cut, 1..=64);
        c.slider("roughness", &mut self.roughness, OWN..=1.0);
        c.integer("depth", &mut self.depth, 0..=MAX_DEPTH);
        c.slider("clamp", &mut self.clamp, 0.0..=100.0);
        c.integer("seed", &mut self.seed, 0..=1000);
        c.camera(&mut self.camera);
    }

    fn changed(&mut self, gpu: &Gpu) -> Result<()> {
        let wanted = (self.name, self.roughness);
        if wanted != self.built {
            let (scene, _) = scenes::staged(self.name, &self.source, self.look.name);
            self.rough.rebuild(gpu, &scene, self.roughness)?;
            self.built = wanted;
        }
        if self.look != self.built_look {
            let SkyLook { name, sum, cut } = self.look;
            let table = SkyTable::new(&divided(&self.skies.picture(name)?, cut)?, sum);
            self.sky = SkyOnGpu::new(gpu, &table)?;
            self.built_look = self.look;
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
            sky: self.sky.sky.address.into(),
            sums: self.sums.address.into(),
            rotation: (self.rotation / 360.0).rem_euclid(1.0),
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
        .constant(1, constants.sampler)
        .recursion(1)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .textures(textures)
        .push_constants::<Push>()
        .build(gpu)
}
