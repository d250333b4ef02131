//! 39 · Far from the origin: coordinates are subtracted in f64, before they are rounded to f32.
//!
//! New since 09_instancing: the set and the camera are moved as far away as you like, and all places are
//! taken from an origin near the camera; and three ways to a ray's origin in the mesh's space.

#[path = "../09_instancing/formation.rs"]
mod formation;
#[path = "../09_instancing/instances.rs"]
mod instances;
mod pieces;
mod top_level;

use std::ops::Range;
use std::process::ExitCode;

use anyhow::Result;
use common::gpu::{
    Address, Binding, Descriptor, Gpu, HitGroup, RayTracingPipeline, Requirements, TextureTable,
    barrier,
};
use common::scene::{Camera, CameraBasis, DirectionalLight, SceneAddresses, SceneOnGpu, Sun};
use common::{Controls, Frame, Sample, Setup, Variant, Variants};
use formation::{Build, Geometry, SceneKind};
use glam::{DVec3, Vec3};
use instances::{FLAGS, SEEN};
use pieces::Pieces;
use top_level::{PieceRecord, TopLevelBuild};

fn main() -> ExitCode {
    common::run::<Demo>(env!("CARGO_BIN_NAME"), instruments::all())
}

/// Distance the camera moves before the set is placed again.
const STEP: f64 = 16.0;

struct Demo {
    scene: SceneOnGpu,
    pieces: Pieces,
    pipelines: Variants<Constants>,
    camera: Camera,
    sun: Sun,
    build: Build,
    far: f32,
    coordinates: Coordinates,
    white_flags: u32,
    camera_sees: u32,
    shadows_of: u32,
    constants: Constants,
}

common::shader_enum! {
    /// The quantity shown per pixel.
    enum Show: SHOW {
        Picture, Normal, Triangle, Hit, Direction = "ray direction", Shadow, Origin = "shadow origin",
        InstanceId, ObjectNormal, ObjectOrigin,
    }
    /// The triangles a ray passes through.
    enum Culling: CULL { Off, Back = "back faces", Front = "front faces" }
    /// The matrix that takes a normal to the world.
    enum Normals: NORMALS { Matrix, DeviceInverse, HostInverse }
    /// The transform that takes a ray to the mesh's space.
    enum ObjectRay: OBJECT_RAY { Device, Matrix, Inverse }
    /// About which origin everything is placed.
    enum Coordinates { World, CameraRelative = "camera-relative", Both }
}

/// Specialization constants of a pipeline's shaders.
#[derive(Clone, Copy, PartialEq)]
struct Constants {
    show: Show,
    culling: Culling,
    normals: Normals,
    object_ray: ObjectRay,
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
        let constants = Constants {
            show: Show::Picture,
            culling: Culling::Off,
            normals: Normals::HostInverse,
            object_ray: ObjectRay::Device,
        };
        let sun = Sun { azimuth: 300.0, elevation: 22.0, radiance: Vec3::new(4.4, 3.5, 2.4) };
        Ok(Self {
            scene,
            pieces,
            pipelines: Variants::default(),
            camera: formation::camera(build.scene),
            sun,
            build,
            far: 1e6,
            coordinates: Coordinates::CameraRelative,
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
        c.slider("far", &mut self.far, 0.0..=1e7);
        c.choice("coordinates", &mut self.coordinates);
        c.one_of("camera sees", &mut self.camera_sees, &SEEN.map(|(name, _)| name));
        c.one_of("shadows of", &mut self.shadows_of, &SEEN.map(|(name, _)| name));
        c.choice("culling", &mut self.constants.culling);
        c.one_of("flags of white", &mut self.white_flags, &FLAGS.map(|(name, _)| name));
        c.choice("normals", &mut self.constants.normals);
        c.choice("object ray", &mut self.constants.object_ray);
        c.choice("show", &mut self.constants.show);
        c.sun(&mut self.sun);
        c.camera(&mut self.camera);
    }

    fn changed(&mut self, gpu: &Gpu) -> Result<()> {
        self.pieces.rebuild(gpu, &mut self.scene, self.build)
    }

    fn render(&mut self, frame: &Frame) -> Result<()> {
        let width = frame.image.extent.width;
        // World coordinates to the left of it, camera-relative ones to the right.
        let middle = match self.coordinates {
            Coordinates::World => width,
            Coordinates::CameraRelative => 0,
            Coordinates::Both => width / 2,
        };
        self.trace(frame, 0, 0..middle)?;
        barrier::trace_to_trace(frame.gpu, frame.cmd);
        self.trace(frame, 1, middle..width)
    }

    fn report(&self) -> Result<serde_json::Value> {
        Ok(self.pieces.memory(&self.scene))
    }
}

impl Demo {
    /// Traces some columns of the picture, in coordinates about one of the two origins.
    fn trace(&mut self, frame: &Frame, which: usize, columns: Range<u32>) -> Result<()> {
        if columns.is_empty() {
            return Ok(());
        }
        // ANCHOR: origin
        // The set and what looks at it are moved together, in f64.
        let moved = DVec3::new(self.far.into(), 0.0, self.far.into());
        let origin = match which {
            0 => DVec3::ZERO,
            // Near the camera, in steps, so that few of its movements place everything again.
            _ => ((self.camera.eye + moved) / STEP).round() * STEP,
        };
        let shift = moved - origin;
        let mut camera = self.camera;
        camera.eye += shift;
        camera.target += shift;
        // ANCHOR_END: origin
        let build = TopLevelBuild { shift, white: FLAGS[self.white_flags as usize].1 };
        let top_level = self.pieces.top_level(frame.gpu, &self.scene, which, build)?;
        // ANCHOR: trace
        let push = Push {
            camera: camera.basis(frame.aspect()),
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
        let mut area = frame.area;
        area.offset.x = columns.start as i32;
        area.extent.width = columns.len() as u32;
        sbt.trace(frame.cmd, area);
        // ANCHOR_END: trace
        Ok(())
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
        .constant(3, constants.object_ray)
        .recursion(1)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .textures(textures)
        .push_constants::<Push>()
        .build(gpu)
}
