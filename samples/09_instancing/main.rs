//! 09 · Instancing: thousands of pieces from a handful of meshes, each with a matrix and a mind of its own.
//!
//! New since 41_ray_offset: the instances are made here, with masks, custom indices and flags; a record
//! a piece; and normals under any matrix.

mod formation;
mod instances;
mod pieces;
mod top_level;

use std::process::ExitCode;

use anyhow::Result;
use common::gpu::{
    Address, Binding, Descriptor, Gpu, HitGroup, RayTracingPipeline, Requirements, TextureTable,
};
use common::scene::{Camera, CameraBasis, DirectionalLight, SceneAddresses, SceneOnGpu, Sun};
use common::{Controls, Frame, Sample, Setup, Variant, Variants};
use formation::{Build, Geometry, SceneKind};
use glam::Vec3;
use instances::{FLAGS, SEEN};
use pieces::Pieces;
use top_level::PieceRecord;

fn main() -> ExitCode {
    common::run::<Demo>(env!("CARGO_BIN_NAME"), instruments::all())
}

struct Demo {
    scene: SceneOnGpu,
    pieces: Pieces,
    pipelines: Variants<Constants>,
    camera: Camera,
    sun: Sun,
    build: Build,
    white_flags: u32,
    camera_sees: u32,
    shadows_of: u32,
    constants: Constants,
}

common::shader_enum! {
    /// The quantity shown per pixel.
    enum Show: SHOW {
        Picture, Normal, Triangle, Hit, Direction = "ray direction", Shadow, Origin = "shadow origin",
        InstanceId, ObjectNormal,
    }
    /// The triangles a ray passes through.
    enum Culling: CULL { Off, Back = "back faces", Front = "front faces" }
    /// The matrix that takes a normal to the world.
    enum Normals: NORMALS { Matrix, DeviceInverse, HostInverse }
}

/// Specialization constants of a pipeline's shaders.
#[derive(Clone, Copy, PartialEq)]
struct Constants {
    show: Show,
    culling: Culling,
    normals: Normals,
}

common::shader_struct! {
    /// Push constants of all shaders.
    struct Push {
        camera: CameraBasis,
        scene: SceneAddresses,
        pieces: Address<PieceRecord>,
        light: DirectionalLight,
        camera_mask: u32,
        shadow_mask: u32,
    }
}

impl Sample for Demo {
    fn requirements() -> Requirements {
        Requirements::ray_tracing().textures()
    }

    fn new(gpu: &Gpu, setup: &Setup) -> Result<Self> {
        let build =
            Build { scene: SceneKind::Ripples, squares: 10_000, geometry: Geometry::Instances };
        let pieces = Pieces::new(build)?;
        let scene = SceneOnGpu::new(gpu, &pieces.meshes, setup.options)?;
        let constants =
            Constants { show: Show::Picture, culling: Culling::Off, normals: Normals::HostInverse };
        let sun = Sun { azimuth: 300.0, elevation: 22.0, radiance: Vec3::new(4.4, 3.5, 2.4) };
        Ok(Self {
            scene,
            pieces,
            pipelines: Variants::default(),
            camera: formation::camera(build.scene),
            sun,
            build,
            white_flags: 0,
            camera_sees: 0,
            shadows_of: 0,
            constants,
        })
    }

    fn controls(&mut self, c: &mut Controls) {
        if c.choice("scene", &mut self.build.scene) {
            self.camera = formation::camera(self.build.scene);
        }
        if c.choice("geometry", &mut self.build.geometry) {
            self.build.squares = self.build.squares.min(1_000);
        }
        // A million squares take 400 MB as instances, a thousand take 250 MB as copies.
        let most = if self.build.geometry == Geometry::Instances { 1_000_000 } else { 1_000 };
        c.integer("squares", &mut self.build.squares, 1..=most);
        c.one_of("camera sees", &mut self.camera_sees, &SEEN.map(|(name, _)| name));
        c.one_of("shadows of", &mut self.shadows_of, &SEEN.map(|(name, _)| name));
        c.choice("culling", &mut self.constants.culling);
        c.one_of("flags of white", &mut self.white_flags, &FLAGS.map(|(name, _)| name));
        c.choice("normals", &mut self.constants.normals);
        c.choice("show", &mut self.constants.show);
        c.sun(&mut self.sun);
        c.camera(&mut self.camera);
    }

    fn changed(&mut self, gpu: &Gpu) -> Result<()> {
        self.pieces.rebuild(gpu, &mut self.scene, self.build)
    }

    fn render(&mut self, frame: &Frame) -> Result<()> {
        let flags = FLAGS[self.white_flags as usize].1;
        let top_level = self.pieces.top_level(frame.gpu, &self.scene, flags)?;
        // ANCHOR: trace
        let push = Push {
            camera: self.camera.basis(frame.aspect()),
            scene: self.scene.addresses,
            pieces: top_level.records.address.into(),
            light: self.sun.light(),
            camera_mask: SEEN[self.camera_sees as usize].1.into(),
            shadow_mask: SEEN[self.shadows_of as usize].1.into(),
        };
        let descriptors = [
            Descriptor::AccelerationStructure(&top_level.tlas),
            Descriptor::StorageImage(frame.image),
        ];
        let Variant { pipeline, sbt, .. } =
            self.pipelines.choose(frame, &self.scene.textures, self.constants, pipeline)?;
        pipeline.bind(frame.cmd, &descriptors, &push)?;
        sbt.trace(frame.cmd, frame.area);
        // ANCHOR_END: trace
        Ok(())
    }

    fn report(&self) -> Result<serde_json::Value> {
        Ok(self.pieces.memory(&self.scene))
    }
}

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
        .hit(HitGroup::triangles().any_hit("slice.rahit").closest_hit("shade.rchit"))
        .constant(0, constants.show)
        .constant(1, constants.culling)
        .constant(2, constants.normals)
        .recursion(1)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .textures(textures)
        .push_constants::<Push>()
        .build(gpu)
}
