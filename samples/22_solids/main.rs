//! 22 · Solids: half-spaces and balls that have an inside, and all that can be made of them.
//!
//! New since 08_intersection: solids by an intersection shader, union, intersection, difference and
//! inverse, a clip that cuts open, fog that fills what is outside, and seven scenes.

#[path = "../08_intersection/boxes.rs"]
mod boxes;
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
    Address, Binding, Descriptor, Gpu, HitGroup, RayTracingPipeline, Requirements, TextureTable,
};
use common::scene::{
    Camera, CameraBasis, DirectionalLight, Scene, SceneAddresses, SceneOnGpu, Sun,
};
use common::{Controls, Frame, Sample, Setup, Variant, Variants};
use fog::{Extent, Fog};
use scenes::{Preset, PresetName};
use solids::{Build, Solids, SolidsOnGpu};

fn main() -> ExitCode {
    common::run::<Demo>(env!("CARGO_BIN_NAME"), instruments::all())
}

struct Demo {
    source: Scene,
    scene: SceneOnGpu,
    solids: SolidsOnGpu,
    pipelines: Variants<Constants>,
    camera: Camera,
    sun: Sun,
    build: Build,
    fog: Fog,
    section_distance: f32,
    constants: Constants,
}

common::shader_enum! {
    /// The quantity shown per pixel.
    enum Show: SHOW {
        Picture, Normal, Triangle, Hit, Direction = "ray direction", Shadow, Origin = "shadow origin",
        Kind = "hit kind", Section, Fog,
    }
    /// The formula that intersects half-spaces.
    enum Rung: RUNG { Pov, Point, Compensated }
}

/// Specialization constants of a pipeline's shaders.
#[derive(Clone, Copy, PartialEq)]
struct Constants {
    show: Show,
    rung: Rung,
    fog: Extent,
}

common::shader_struct! {
    /// Push constants of all shaders.
    struct Push {
        camera: CameraBasis,
        scene: SceneAddresses,
        solids: Address<Solids>,
        light: DirectionalLight,
        fog: Fog,
        section_distance: f32,
    }
}

impl Sample for Demo {
    fn requirements() -> Requirements {
        Requirements::ray_tracing().textures()
    }

    fn new(gpu: &Gpu, setup: &Setup) -> Result<Self> {
        let mut source = scenes::chess()?;
        scenes::extend(&mut source.model);
        let build = Build::default();
        let Preset { scene, solids, sun, fog } =
            Preset::new(PresetName::Board, &source, &build.modifiers);
        let camera = scene.camera;
        let on_gpu = SceneOnGpu::new(gpu, &scene, setup.options)?;
        let solids = SolidsOnGpu::new(gpu, &scene, &on_gpu, &solids, build)?;
        let constants =
            Constants { show: Show::Picture, rung: Rung::Compensated, fog: Extent::None };
        Ok(Self {
            source,
            scene: on_gpu,
            solids,
            pipelines: Variants::default(),
            camera,
            sun,
            build,
            fog,
            section_distance: 5.0,
            constants,
        })
    }

    fn controls(&mut self, c: &mut Controls) {
        // A preset brings its view, its sun and its fog.
        if c.choice("preset", &mut self.build.preset) {
            let Build { preset, modifiers, .. } = &self.build;
            let Preset { scene, sun, fog, .. } = Preset::new(*preset, &self.source, modifiers);
            (self.camera, self.sun, self.fog) = (scene.camera, sun, fog);
        }
        self.build.modifiers.controls(c);
        c.choice("size", &mut self.build.size);
        c.choice("moved", &mut self.build.moved);
        c.choice("rung", &mut self.constants.rung);
        self.fog.controls(c);
        c.slider("section distance", &mut self.section_distance, 0.0..=1e4);
        c.choice("show", &mut self.constants.show);
        c.sun(&mut self.sun);
        c.camera(&mut self.camera);
    }

    fn changed(&mut self, gpu: &Gpu) -> Result<()> {
        if self.solids.build != self.build {
            let preset = Preset::new(self.build.preset, &self.source, &self.build.modifiers);
            let placed = self.build.placement().scene(&preset.scene);
            if self.solids.build.places_otherwise(&self.build) {
                self.scene.rebuild(gpu, &placed, self.scene.options)?;
            }
            self.solids = SolidsOnGpu::new(gpu, &placed, &self.scene, &preset.solids, self.build)?;
        }
        Ok(())
    }

    fn render(&mut self, frame: &Frame) -> Result<()> {
        let placement = self.build.placement();
        let camera = placement.camera(&self.camera).basis(frame.aspect());
        let enclosed = self.solids.enclose(camera.origin.as_dvec3());
        self.constants.fog = self.fog.extent(self.build.modifiers.hollow, enclosed);
        // ANCHOR: trace
        let push = Push {
            camera,
            scene: self.scene.addresses,
            solids: self.solids.addresses.address.into(),
            light: self.sun.light(),
            fog: self.fog.placed(placement.size),
            section_distance: self.section_distance * placement.size as f32,
        };
        let descriptors = [
            Descriptor::AccelerationStructure(&self.solids.tlas),
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
        .miss("common/shadow.rmiss")
        .hit(HitGroup::triangles().closest_hit("shade.rchit"))
        .hit(HitGroup::procedural("solid.rint").closest_hit("solid.rchit"))
        .constant(0, constants.show)
        .constant(1, constants.rung)
        .constant(2, constants.fog)
        .rounding_to_nearest_even(gpu)
        .recursion(1)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .textures(textures)
        .push_constants::<Push>()
        .build(gpu)
}
