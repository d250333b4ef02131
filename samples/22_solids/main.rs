//! 22 · Solids: half-spaces and balls that have an inside, and all that can be made of them.
//!
//! New since 08_intersection: solids by an intersection shader, union, intersection, difference and
//! inverse, a clip that cuts open, fog that fills what is outside, and seven scenes.

mod fog;
mod modifiers;
mod pieces;
mod program;
mod scenes;
mod shapes;
mod solid;
mod solids;

use std::process::ExitCode;

use anyhow::Result;
use common::gpu::{
    Address, Binding, Descriptor, Gpu, HitGroup, RayTracingPipeline, Requirements, ShaderStruct,
    TextureTable, Variant, Variants,
};
use common::scene::plane::Plane;
use common::scene::{
    Camera, CameraBasis, Light, PointLight, Scene, SceneAddresses, SceneOnGpu, Sun,
};
use common::{Controls, Frame, Sample, Setup};
use fog::Fog;
use program::{Face, Part};
use scenes::Preset;
use solid::Ball;
use solids::{Build, SolidRecord, Solids, SolidsOnGpu};

fn main() -> ExitCode {
    common::run::<Demo>(env!("CARGO_BIN_NAME"))
}

struct Demo {
    model: Scene,
    scene: SceneOnGpu,
    solids: SolidsOnGpu,
    pipelines: Variants<Constants>,
    camera: Camera,
    sun: Sun,
    lamp: PointLight,
    light: u32,
    light_size: f32,
    light_samples: u32,
    build: Build,
    fog: Fog,
    section_distance: f32,
    constants: Constants,
}

/// What a pipeline is made for: the specialization constants of its shaders.
#[derive(Clone, Copy, PartialEq)]
struct Constants {
    show: u32,
    shadow_rays: u32,
    smooth_terminator: bool,
    /// Which way half-spaces are met: a position in `push.glsl`.
    rung: u32,
    /// Where fog is: [`fog::NONE`], [`fog::EVERYWHERE`] or [`fog::OUTSIDE`].
    fog: u32,
}

common::shader_struct! {
    /// What every shader of this chapter can read.
    struct Push {
        camera: CameraBasis,
        scene: SceneAddresses,
        solids: Address,
        light: Light,
        light_samples: u32,
        fog: Fog,
        section_distance: f32,
    }
}

impl Sample for Demo {
    fn requirements() -> Requirements {
        Requirements::ray_tracing().textures()
    }

    fn new(gpu: &Gpu, setup: &Setup) -> Result<Self> {
        let mut model = setup.scene_or(scenes::chess)?;
        scenes::extend(&mut model.model);
        let build = Build::default();
        let Preset { scene, solids, sun, fog } = Preset::new(0, &model, &build.modifiers);
        let camera = scene.camera;
        let on_gpu = SceneOnGpu::new(gpu, &scene, setup.options)?;
        let solids = SolidsOnGpu::new(gpu, &scene, &on_gpu, &solids, build)?;
        gpu.share_structs(&[Ball::LAYOUT, Face::LAYOUT, Part::LAYOUT, Plane::LAYOUT]);
        gpu.share_structs(&[SolidRecord::LAYOUT, Solids::LAYOUT]);
        let constants =
            Constants { show: 0, shadow_rays: 0, smooth_terminator: true, rung: 2, fog: fog::NONE };
        Ok(Self {
            model,
            scene: on_gpu,
            solids,
            pipelines: Variants::default(),
            camera,
            sun,
            lamp: PointLight::default(),
            light: 0,
            light_size: 0.0,
            light_samples: 16,
            build,
            fog,
            section_distance: 5.0,
            constants,
        })
    }

    // ANCHOR: controls
    fn controls(&mut self, c: &mut Controls) {
        // A preset brings its view, its sun and its fog.
        if c.choice("preset", &mut self.build.preset, &scenes::PRESETS) {
            let Build { preset, modifiers, .. } = &self.build;
            let Preset { scene, sun, fog, .. } = Preset::new(*preset, &self.model, modifiers);
            (self.camera, self.sun, self.fog) = (scene.camera, sun, fog);
        }
        self.build.modifiers.controls(c);
        c.choice("size", &mut self.build.size, &["0.001", "1", "1000"]);
        c.choice("moved", &mut self.build.moved, &["0", "10000"]);
        c.choice("rung", &mut self.constants.rung, &["pov", "point", "compensated"]);
        self.fog.controls(c);
        c.slider("section distance", &mut self.section_distance, 0.0..=1e4);
        let views = [
            "picture",
            "normal",
            "triangle",
            "hit",
            "ray direction",
            "shadow",
            "shadow origin",
            "hit kind",
            "section",
            "fog",
        ];
        c.choice("show", &mut self.constants.show, &views);
        c.choice("light", &mut self.light, &["directional", "point"]);
        c.slider("sun azimuth", &mut self.sun.azimuth, 0.0..=360.0);
        c.slider("sun elevation", &mut self.sun.elevation, 0.0..=90.0);
        c.vector("lamp position", &mut self.lamp.position, -10.0..=10.0);
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
        if self.solids.build != self.build {
            let preset = Preset::new(self.build.preset, &self.model, &self.build.modifiers);
            let placed = self.build.placement().scene(&preset.scene);
            if self.solids.build.places_otherwise(&self.build) {
                self.scene.rebuild(frame.gpu, &placed, self.scene.options)?;
            }
            self.solids =
                SolidsOnGpu::new(frame.gpu, &placed, &self.scene, &preset.solids, self.build)?;
        }
        let placement = self.build.placement();
        let camera = placement.camera(&self.camera).basis(frame.aspect());
        let enclosed = self.solids.enclose(camera.origin.as_dvec3());
        self.constants.fog = self.fog.extent(self.build.modifiers.hollow, enclosed);
        // ANCHOR_END: rebuild
        // ANCHOR: trace
        let size = self.light_size * placement.size as f32;
        let push = Push {
            camera,
            scene: self.scene.addresses,
            solids: self.solids.addresses.address.into(),
            light: match self.light {
                0 => Light::directional(&self.sun, self.light_size),
                _ => Light::point(&placement.lamp(&self.lamp), size),
            },
            light_samples: self.light_samples,
            fog: self.fog.placed(placement.size),
            section_distance: self.section_distance * placement.size as f32,
        };
        let descriptors = [
            Descriptor::AccelerationStructure(&self.solids.tlas),
            Descriptor::StorageImage(frame.image),
        ];
        let Variant { pipeline, sbt, .. } =
            self.pipelines.choose(frame.gpu, &self.scene.textures, self.constants, pipeline)?;
        pipeline.bind(frame.cmd, &descriptors, &push)?;
        sbt.trace(frame.cmd, frame.image.extent);
        // ANCHOR_END: trace
        Ok(())
    }
}

// ANCHOR: pipeline
/// A hit group for each kind of surface: triangles, and solids.
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
        .hit(HitGroup::procedural("solid.rint").closest_hit("solid.rchit"))
        .constant(0, constants.show)
        .constant(1, constants.shadow_rays)
        .constant(2, constants.smooth_terminator.into())
        .constant(3, constants.rung)
        .constant(4, constants.fog)
        .recursion(1)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .textures(textures)
        .push_constants::<Push>()
        .build(gpu)
}
// ANCHOR_END: pipeline
