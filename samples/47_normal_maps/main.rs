//! 47 · Normal maps: relief from a texture, and rays that stay above the surface.
//!
//! New since 45_rough_metal: normals from a texture, in a frame that follows from the texture coordinates; and five
//! rules for eyes and rays that a mapped normal puts below the surface.

#[path = "../45_rough_metal/albedo.rs"]
mod albedo;
mod mapped_scene;
#[path = "../45_rough_metal/microfacets.rs"]
mod microfacets;
mod normal_map;
#[path = "../45_rough_metal/scenes.rs"]
mod rough_scenes;
mod scenes;

use std::process::ExitCode;

use anyhow::Result;
use ash::vk;
use common::gpu::{
    Address, Binding, Buffer, Descriptor, Gpu, HitGroup, RayTracingPipeline, Requirements,
    TextureTable, barrier,
};
use common::scene::{Camera, CameraBasis, Light, Scene, SceneAddresses, Sun, input_usage};
use common::{Controls, Frame, Sample, Setup, Variant, Variants};
use glam::UVec3;
use mapped_scene::{MappedAddresses, MappedScene, Settings};
use rough_scenes::{Sky, Staged};
use scenes::SceneName;

fn main() -> ExitCode {
    common::run::<Demo>(env!("CARGO_BIN_NAME"), instruments::all())
}

/// Maximum number of reflections of a path. If each surface takes 5 % of its light, less than
/// 2·10^-6 of it is left by then.
const MAX_DEPTH: u32 = 256;

struct Demo {
    source: Scene,
    rough: MappedScene,
    pipelines: Variants<Constants>,
    camera: Camera,
    sun: Sun,
    light_size: f32,
    name: SceneName,
    settings: Settings,
    /// The scene and the settings that were built.
    built: (SceneName, Settings),
    depth: u32,
    clamp: f32,
    seed: u32,
    constants: Constants,
    sums: Buffer,
}

common::shader_enum! {
    /// The quantity shown per pixel.
    enum Show: SHOW { Picture, Normals, Below, Lost }
    /// The rule for eyes and rays that a mapped normal puts below the surface.
    enum Rule: RULE {
        /// The map's normal as it is.
        None,
        /// Rays below the surface are dropped.
        Cut,
        /// They are mirrored at the surface, and so is an eye below the mapped normal's horizon.
        Flipped,
        /// The normal is bent until a mirror's ray is above the surface.
        Bent,
        /// A wall beside each mapped facet makes the surface flat on the whole.
        TwoFacets,
    }
}

/// Specialization constants of a pipeline's shaders.
#[derive(Clone, Copy, PartialEq)]
struct Constants {
    show: Show,
    sky: Sky,
    roulette: bool,
    rule: Rule,
}

common::shader_struct! {
    /// Push constants of all shaders.
    struct Push {
        camera: CameraBasis,
        scene: SceneAddresses,
        mapped: Address<MappedAddresses>,
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
        let source = scenes::open(setup)?;
        let Staged { scene, sun, sky } = scenes::staged(SceneName::Chess, &source);
        let camera = scene.camera;
        let settings = Settings { roughness: mapped_scene::OWN, strength: 1.0 };
        let rough = MappedScene::new(gpu, &scene, setup.options, settings)?;
        Ok(Self {
            source,
            rough,
            pipelines: Variants::default(),
            camera,
            sun,
            light_size: 0.03,
            name: SceneName::Chess,
            settings,
            built: (SceneName::Chess, settings),
            depth: 16,
            clamp: 0.0,
            seed: 0,
            constants: Constants {
                show: Show::Picture,
                sky,
                roulette: true,
                rule: Rule::TwoFacets,
            },
            sums: Buffer::new(gpu, "sums", 0, input_usage())?,
        })
    }

    fn controls(&mut self, c: &mut Controls) {
        if c.choice("scene", &mut self.name) {
            self.take_scene();
        }
        c.choice("show", &mut self.constants.show);
        c.choice("rule", &mut self.constants.rule);
        c.slider("strength", &mut self.settings.strength, 0.0..=4.0);
        c.slider("roughness", &mut self.settings.roughness, mapped_scene::OWN..=1.0);
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
        let wanted = (self.name, self.settings);
        if wanted != self.built {
            let Staged { scene, .. } = scenes::staged(self.name, &self.source);
            self.rough.rebuild(gpu, &scene, self.settings)?;
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
            mapped: self.rough.mapped.address.into(),
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
        let Staged { scene, sun, sky } = scenes::staged(self.name, &self.source);
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
        .constant(3, constants.rule)
        .recursion(1)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .textures(textures)
        .push_constants::<Push>()
        .build(gpu)
}
