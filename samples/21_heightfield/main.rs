//! 21 · Heightfield: a landscape without triangles, marched by an intersection shader inside one box.
//!
//! New since 08_intersection: a height for every (x, z), five ways to march a ray to it, pieces that
//! stand on the ground, views of steps and errors, and five views of the land.

#[path = "../08_intersection/boxes.rs"]
mod boxes;
mod ground;
mod land;
mod scenes;
mod shape;

use std::process::ExitCode;

use anyhow::Result;
use ash::vk;
use common::gpu::{
    Address, Binding, Buffer, Descriptor, Gpu, HitGroup, RayTracingPipeline, Requirements,
    TextureTable,
};
use common::scene::{
    Camera, CameraBasis, DirectionalLight, Scene, SceneAddresses, SceneOnGpu, Sun, input_usage,
};
use common::{Controls, Frame, Sample, Setup, Variant, Variants};
use ground::{Ground, Landscape};
use land::Land;
use scenes::{Preset, PresetName};

fn main() -> ExitCode {
    common::run::<Demo>(env!("CARGO_BIN_NAME"), instruments::all())
}

struct Demo {
    source: Scene,
    scene: SceneOnGpu,
    land: Land,
    ground: Buffer,
    pipelines: Variants<Constants>,
    camera: Camera,
    sun: Sun,
    preset: PresetName,
    landscape: Landscape,
    constants: Constants,
}

common::shader_enum! {
    /// The quantity shown per pixel.
    enum Show: SHOW {
        Picture, Normal, Triangle, Hit, Direction = "ray direction", Shadow, Origin = "shadow origin",
        Steps, Error, March,
    }
    /// The way to march rays.
    enum Rung: HEIGHTFIELD { Relaxed, Lipschitz, OverRelaxed = "over-relaxed", Bisected, Secant }
}

/// Specialization constants of a pipeline's shaders.
#[derive(Clone, Copy, PartialEq)]
struct Constants {
    show: Show,
    rung: Rung,
}

common::shader_struct! {
    /// Push constants of all shaders.
    struct Push {
        camera: CameraBasis,
        scene: SceneAddresses,
        ground: Address<Ground>,
        light: DirectionalLight,
    }
}

impl Sample for Demo {
    fn requirements() -> Requirements {
        Requirements::ray_tracing().textures()
    }

    fn new(gpu: &Gpu, setup: &Setup) -> Result<Self> {
        let own = setup.scene_or(scenes::chess)?;
        // The chess set is on the hill already.
        let mut source = if setup.scene().is_some() { scenes::framed(own) } else { own };
        source.model.materials.push(scenes::earth());
        let Preset { landscape, camera, sun } = Preset::new(PresetName::Hills);
        let scene = SceneOnGpu::new(gpu, &source, setup.options)?;
        let land = Land::new(gpu, &source, &scene, landscape, camera.eye.as_vec3())?;
        let usage = input_usage() | vk::BufferUsageFlags::TRANSFER_DST;
        let ground = Buffer::new(gpu, "ground", size_of::<Ground>() as u64, usage)?;
        let constants = Constants { show: Show::Picture, rung: Rung::Bisected };
        Ok(Self {
            source,
            scene,
            land,
            ground,
            pipelines: Variants::default(),
            camera,
            sun,
            preset: PresetName::Hills,
            landscape,
            constants,
        })
    }

    fn controls(&mut self, c: &mut Controls) {
        // A preset brings its landscape, its view and its sun.
        if c.choice("preset", &mut self.preset) {
            let Preset { landscape, camera, sun } = Preset::new(self.preset);
            (self.landscape, self.camera, self.sun) = (landscape, camera, sun);
        }
        c.slider("steepness", &mut self.landscape.k, 0.0..=16.0);
        c.integer("rings", &mut self.landscape.rings, 0..=100);
        c.choice("rung", &mut self.constants.rung);
        c.choice("show", &mut self.constants.show);
        c.sun(&mut self.sun);
        c.camera(&mut self.camera);
    }

    fn changed(&mut self, gpu: &Gpu) -> Result<()> {
        let eye = self.camera.eye.as_vec3();
        if self.land.is_outdated(self.landscape, eye) {
            self.land = Land::new(gpu, &self.source, &self.scene, self.landscape, eye)?;
        }
        Ok(())
    }

    fn render(&mut self, frame: &Frame) -> Result<()> {
        // The last material is the ground's.
        let material = self.source.model.materials.len() as u32 - 1;
        self.ground.update(frame.cmd, &[self.land.ground(material)])?;
        // ANCHOR: trace
        let push = Push {
            camera: self.camera.basis(frame.aspect()),
            scene: self.scene.addresses,
            ground: self.ground.address.into(),
            light: self.sun.light(),
        };
        let descriptors = [
            Descriptor::AccelerationStructure(&self.land.tlas),
            Descriptor::StorageImage(frame.image),
        ];
        let Variant { pipeline, sbt, .. } =
            self.pipelines.choose(frame, &self.scene.textures, self.constants, pipeline)?;
        pipeline.bind(frame.cmd, &descriptors, &push)?;
        sbt.trace(frame.cmd, frame.area);
        // ANCHOR_END: trace
        Ok(())
    }
}

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
        .miss("common/sky.rmiss")
        .miss("common/shadow.rmiss")
        .hit(HitGroup::triangles().closest_hit("shade.rchit"))
        .hit(HitGroup::procedural("terrain.rint").closest_hit("terrain.rchit"))
        .constant(0, constants.show)
        .constant(1, constants.rung)
        .recursion(1)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .textures(textures)
        .push_constants::<Push>()
        .build(gpu)
}
