//! 09 · Instancing: thousands of pieces from a handful of meshes, each with a matrix and a mind of its own.
//!
//! New since 05_shadow_miss: the instances are made here, with masks, custom indices and flags; a record
//! a piece; normals under any matrix; and a set that may be moved as far away as you like.

mod formation;
mod pieces;
mod placed;

use std::ops::Range;
use std::process::ExitCode;

use anyhow::Result;
use ash::vk;
use common::gpu::{
    Address, Binding, Descriptor, Gpu, HitGroup, RayTracingPipeline, Requirements, TextureTable,
    Variant, Variants, barrier,
};
use common::scene::{Camera, CameraBasis, Light, PointLight, SceneAddresses, SceneOnGpu, Sun};
use common::{Controls, Frame, Sample, Setup};
use formation::Build;
use glam::{DVec3, Vec3};
use pieces::Pieces;
use placed::{FLAGS, Placement, SEEN};

fn main() -> ExitCode {
    common::run::<Demo>(env!("CARGO_BIN_NAME"))
}

/// How far the camera goes before the set is placed anew.
const STEP: f64 = 16.0;

struct Demo {
    scene: SceneOnGpu,
    pieces: Pieces,
    pipelines: Variants<Constants>,
    camera: Camera,
    sun: Sun,
    lamp: PointLight,
    light: u32,
    light_size: f32,
    light_samples: u32,
    build: Build,
    far: f32,
    coordinates: u32,
    white_flags: u32,
    camera_sees: u32,
    shadows_of: u32,
    constants: Constants,
}

/// What a pipeline is made for: the specialization constants of its shaders.
#[derive(Clone, Copy, PartialEq)]
struct Constants {
    show: u32,
    shadow_rays: u32,
    smooth_terminator: bool,
    culling: u32,
    normals: u32,
    object_ray: u32,
}

common::shader_struct! {
    /// What every shader of this chapter can read.
    struct Push {
        camera: CameraBasis,
        scene: SceneAddresses,
        pieces: Address,
        light: Light,
        light_samples: u32,
        camera_mask: u32,
        shadow_mask: u32,
        first_column: u32,
    }
}

impl Sample for Demo {
    fn requirements() -> Requirements {
        Requirements::ray_tracing().textures()
    }

    fn new(gpu: &Gpu, setup: &Setup) -> Result<Self> {
        let build = Build { scene: 0, squares: 10_000, geometry: 0 };
        let pieces = Pieces::new(build)?;
        let scene = SceneOnGpu::new(gpu, &pieces.meshes, setup.options)?;
        let constants = Constants {
            show: 0,
            shadow_rays: 0,
            smooth_terminator: true,
            culling: 0,
            normals: 2,
            object_ray: 0,
        };
        Ok(Self {
            scene,
            pieces,
            pipelines: Variants::default(),
            camera: formation::camera(build.scene),
            sun: Sun { azimuth: 300.0, elevation: 22.0, radiance: Vec3::new(4.4, 3.5, 2.4) },
            lamp: PointLight::default(),
            light: 0,
            light_size: 0.0,
            light_samples: 16,
            build,
            far: 0.0,
            coordinates: 1,
            white_flags: 0,
            camera_sees: 0,
            shadows_of: 0,
            constants,
        })
    }

    // ANCHOR: controls
    fn controls(&mut self, c: &mut Controls) {
        if c.choice("scene", &mut self.build.scene, &formation::SCENES) {
            self.camera = formation::camera(self.build.scene);
        }
        if c.choice("geometry", &mut self.build.geometry, &["instances", "copies"]) {
            self.build.squares = self.build.squares.min(1_000);
        }
        // A million squares take 400 MB as instances, a thousand take 250 MB as copies.
        let most = if self.build.geometry == 0 { 1_000_000 } else { 1_000 };
        c.integer("squares", &mut self.build.squares, 1..=most);
        c.slider("far", &mut self.far, 0.0..=1e7);
        c.choice("coordinates", &mut self.coordinates, &["world", "camera-relative", "both"]);
        c.choice("camera sees", &mut self.camera_sees, &SEEN.map(|(name, _)| name));
        c.choice("shadows of", &mut self.shadows_of, &SEEN.map(|(name, _)| name));
        c.choice("culling", &mut self.constants.culling, &["off", "back faces", "front faces"]);
        c.choice("flags of white", &mut self.white_flags, &FLAGS.map(|(name, _)| name));
        let normals = ["matrix", "device inverse", "host inverse"];
        c.choice("normals", &mut self.constants.normals, &normals);
        c.choice("object ray", &mut self.constants.object_ray, &["device", "matrix", "inverse"]);
        let views = [
            "picture",
            "normal",
            "triangle",
            "hit",
            "ray direction",
            "shadow",
            "shadow origin",
            "instance id",
            "object normal",
            "object origin",
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
        self.pieces.rebuild(frame.gpu, &mut self.scene, self.build)?;
        let width = frame.image.extent.width;
        // World coordinates to the left of it, camera-relative ones to the right.
        let middle = [width, 0, width / 2][self.coordinates as usize];
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
        // The set and all that looks at it and lights it are moved together, in f64.
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
        let placement = Placement { shift, flags: FLAGS[self.white_flags as usize].1 };
        let placed = self.pieces.place(frame.gpu, &self.scene, which, placement)?;
        // ANCHOR: trace
        let position = (self.lamp.position.as_dvec3() + shift).as_vec3();
        let lamp = PointLight { position, ..self.lamp };
        let push = Push {
            camera: camera.basis(frame.aspect()),
            scene: self.scene.addresses,
            pieces: placed.records.address.into(),
            light: match self.light {
                0 => Light::directional(&self.sun, self.light_size),
                _ => Light::point(&lamp, self.light_size),
            },
            light_samples: self.light_samples,
            camera_mask: SEEN[self.camera_sees as usize].1.into(),
            shadow_mask: SEEN[self.shadows_of as usize].1.into(),
            first_column: columns.start,
        };
        let descriptors = [
            Descriptor::AccelerationStructure(&placed.tlas),
            Descriptor::StorageImage(frame.image),
        ];
        let Variant { pipeline, sbt, .. } =
            self.pipelines.choose(frame.gpu, &self.scene.textures, self.constants, pipeline)?;
        pipeline.bind(frame.cmd, &descriptors, &push)?;
        sbt.trace(frame.cmd, vk::Extent2D { width: columns.len() as u32, ..frame.image.extent });
        // ANCHOR_END: trace
        Ok(())
    }
}

// ANCHOR: pipeline
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
        .hit(HitGroup::triangles().any_hit("slice.rahit").closest_hit("shade.rchit"))
        .constant(0, constants.show)
        .constant(1, constants.shadow_rays)
        .constant(2, constants.smooth_terminator.into())
        .constant(3, constants.culling)
        .constant(4, constants.normals)
        .constant(5, constants.object_ray)
        .recursion(1)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .textures(textures)
        .push_constants::<Push>()
        .build(gpu)
}
// ANCHOR_END: pipeline
