//! 21 · Heightfield: a landscape without triangles, marched by an intersection shader inside one box.
//!
//! New since 08_intersection: a height for every (x, z), four ways to march a ray to it, pieces that
//! stand on the ground, views of steps and errors, and five views of the land.

mod ground;
mod land;
mod scenes;

use std::process::ExitCode;

use anyhow::Result;
use ash::vk;
use common::gpu::{
    Address, Binding, Buffer, Descriptor, Gpu, HitGroup, RayTracingPipeline, Requirements,
    ShaderStruct, TextureTable, Variant, Variants,
};
use common::scene::{
    Camera, CameraBasis, Light, PointLight, Scene, SceneAddresses, SceneOnGpu, Sun, input_usage,
};
use common::{Controls, Frame, Sample, Setup};
use ground::{Ground, HeightfieldShape, Landscape};
use land::Land;
use scenes::Preset;

fn main() -> ExitCode {
    common::run::<Demo>(env!("CARGO_BIN_NAME"))
}

struct Demo {
    model: Scene,
    scene: SceneOnGpu,
    land: Land,
    ground: Buffer,
    pipelines: Variants<Constants>,
    camera: Camera,
    sun: Sun,
    lamp: PointLight,
    light: u32,
    light_size: f32,
    light_samples: u32,
    preset: u32,
    landscape: Landscape,
    constants: Constants,
}

/// What a pipeline is made for: the specialization constants of its shaders.
#[derive(Clone, Copy, PartialEq)]
struct Constants {
    show: u32,
    shadow_rays: u32,
    smooth_terminator: bool,
    /// How rays are marched: a position in `heightfield.glsl`.
    rung: u32,
}

common::shader_struct! {
    /// What every shader of this chapter can read.
    struct Push {
        camera: CameraBasis,
        scene: SceneAddresses,
        ground: Address,
        light: Light,
        light_samples: u32,
    }
}

impl Sample for Demo {
    fn requirements() -> Requirements {
        Requirements::ray_tracing().textures()
    }

    fn new(gpu: &Gpu, setup: &Setup) -> Result<Self> {
        let mut model = setup.scene_or(scenes::chess)?;
        model.model.materials.push(scenes::earth());
        let Preset { landscape, camera, sun, lamp } = Preset::new(0);
        let scene = SceneOnGpu::new(gpu, &model, setup.options)?;
        let land = Land::new(gpu, &model, &scene, landscape, camera.eye.as_vec3())?;
        gpu.share_structs(&[Ground::LAYOUT, HeightfieldShape::LAYOUT]);
        let usage = input_usage() | vk::BufferUsageFlags::TRANSFER_DST;
        let ground = Buffer::new(gpu, "ground", size_of::<Ground>() as u64, usage)?;
        let constants = Constants { show: 0, shadow_rays: 0, smooth_terminator: true, rung: 3 };
        Ok(Self {
            model,
            scene,
            land,
            ground,
            pipelines: Variants::default(),
            camera,
            sun,
            lamp,
            light: 0,
            light_size: 0.0,
            light_samples: 16,
            preset: 0,
            landscape,
            constants,
        })
    }

    // ANCHOR: controls
    fn controls(&mut self, c: &mut Controls) {
        // A preset brings its landscape, its view and its lights.
        if c.choice("preset", &mut self.preset, &scenes::PRESETS) {
            let Preset { landscape, camera, sun, lamp } = Preset::new(self.preset);
            (self.landscape, self.camera, self.sun, self.lamp) = (landscape, camera, sun, lamp);
        }
        c.slider("steepness", &mut self.landscape.k, 0.0..=16.0);
        c.integer("rings", &mut self.landscape.rings, 0..=100);
        let rungs = ["relaxed", "lipschitz", "over-relaxed", "bisected"];
        c.choice("rung", &mut self.constants.rung, &rungs);
        let views = [
            "picture",
            "normal",
            "triangle",
            "hit",
            "ray direction",
            "shadow",
            "shadow origin",
            "steps",
            "error",
            "march",
        ];
        c.choice("show", &mut self.constants.show, &views);
        c.choice("light", &mut self.light, &["directional", "point"]);
        c.slider("sun azimuth", &mut self.sun.azimuth, 0.0..=360.0);
        c.slider("sun elevation", &mut self.sun.elevation, 0.0..=90.0);
        c.vector("lamp position", &mut self.lamp.position, -100.0..=100.0);
        c.slider("light size", &mut self.light_size, 0.0..=1.0);
        c.integer("light samples", &mut self.light_samples, 1..=64);
        let rays = ["first hit", "nearest hit", "off"];
        c.choice("shadow rays", &mut self.constants.shadow_rays, &rays);
        c.checkbox("smooth terminator", &mut self.constants.smooth_terminator);
        c.camera(&mut self.camera);
    }
    // ANCHOR_END: controls

    fn render(&mut self, frame: &Frame) -> Result<()> {
        // ANCHOR: rebuild
        let Variant { pipeline, sbt, .. } =
            self.pipelines.choose(frame.gpu, &self.scene.textures, self.constants, pipeline)?;
        let eye = self.camera.eye.as_vec3();
        if self.land.is_outdated(self.landscape, eye) {
            self.land = Land::new(frame.gpu, &self.model, &self.scene, self.landscape, eye)?;
        }
        // The last material is the ground's.
        let material = self.model.model.materials.len() as u32 - 1;
        self.ground.write(0, &[self.land.ground(material)])?;
        // ANCHOR_END: rebuild
        // ANCHOR: trace
        let push = Push {
            camera: self.camera.basis(frame.aspect()),
            scene: self.scene.addresses,
            ground: self.ground.address.into(),
            light: match self.light {
                0 => Light::directional(&self.sun, self.light_size),
                _ => Light::point(&self.lamp, self.light_size),
            },
            light_samples: self.light_samples,
        };
        let descriptors = [
            Descriptor::AccelerationStructure(&self.land.tlas),
            Descriptor::StorageImage(frame.image),
        ];
        pipeline.bind(frame.cmd, &descriptors, &push)?;
        sbt.trace(frame.cmd, frame.image.extent);
        // ANCHOR_END: trace
        Ok(())
    }
}

// ANCHOR: pipeline
/// A hit group for each kind of surface: triangles, and the ground.
///
/// Only the raygen shader traces rays: they do not nest, and a recursion depth of 1 is enough.
fn pipeline(
    gpu: &Gpu,
    textures: &TextureTable,
    constants: Constants,
) -> Result<RayTracingPipeline> {
    RayTracingPipeline::builder(env!("CARGO_BIN_NAME"))
        .raygen("camera.rgen")
        .miss("sky.rmiss")
        .miss("shadow.rmiss")
        .hit(HitGroup::triangles().closest_hit("shade.rchit"))
        .hit(HitGroup::procedural("terrain.rint").closest_hit("terrain.rchit"))
        .constant(0, constants.show)
        .constant(1, constants.shadow_rays)
        .constant(2, constants.smooth_terminator.into())
        .constant(3, constants.rung)
        .recursion(1)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .textures(textures)
        .push_constants::<Push>()
        .build(gpu)
}
// ANCHOR_END: pipeline
