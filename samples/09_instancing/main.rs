//! 09 · Instancing: thousands of pieces from a handful of meshes, each with a matrix and a mind of its own.
//!
//! New since 05_shadow_miss: the instances are made here, with masks, custom indices and flags; a record
//! a piece; normals under any matrix; and a set that may be moved as far away as you like.

mod formation;
mod placed;

use std::ops::Range;
use std::process::ExitCode;

use anyhow::Result;
use ash::vk;
use common::gpu::{
    Address, Binding, Descriptor, Gpu, HitGroup, RayTracingPipeline, Requirements,
    ShaderBindingTable, barrier,
};
use common::scene::{
    Camera, CameraBasis, Light, Mesh, PointLight, Scene, SceneAddresses, SceneOnGpu, Sun,
};
use common::{Controls, Frame, Sample, Setup};
use formation::{BLACK, BOARD, Formation, WHITE};
use glam::{DVec3, Vec3};
use placed::{FLAGS, PieceRecord, Placed, Placement};

fn main() -> ExitCode {
    common::run::<Demo>(env!("CARGO_BIN_NAME"))
}

// What `coordinates` may be; the third is both, side by side.
const WORLD: u32 = 0;
const CAMERA_RELATIVE: u32 = 1;

/// What `normals` is to begin with.
const HOST_INVERSE: u32 = 2;

/// How far the camera goes before the set is placed anew.
const STEP: f64 = 16.0;

// ANCHOR: masks
/// Which bits a ray asks for: it sees an instance if they share one.
const SEEN: [(&str, u8); 4] = [
    ("everything", 0xff),
    ("all but white", BOARD | BLACK),
    ("all but black", BOARD | WHITE),
    ("the board", BOARD),
];
// ANCHOR_END: masks

struct Demo {
    meshes: Scene,
    scene: SceneOnGpu,
    formation: Formation,
    /// The instances about each of the two origins, where they were last needed.
    placed: [Option<Placed>; 2],
    pipeline: RayTracingPipeline,
    sbt: ShaderBindingTable,
    camera: Camera,
    sun: Sun,
    lamp: PointLight,
    light: u32,
    light_size: f32,
    light_samples: u32,
    shadow_rays: u32,
    smooth_terminator: bool,
    show: u32,
    build: Build,
    built: Build,
    far: f32,
    coordinates: u32,
    white_flags: u32,
    camera_sees: u32,
    shadows_of: u32,
    culling: u32,
    normals: u32,
    object_ray: u32,
}

/// What meshes and pieces are made from; where it changes, they are made again.
#[derive(Clone, Copy, PartialEq)]
struct Build {
    scene: u32,
    squares: u32,
    /// 0 instances of a mesh, 1 a mesh for each piece.
    geometry: u32,
}

common::shader_struct! {
    /// What every shader of this chapter can read.
    struct Push {
        camera: CameraBasis,
        scene: SceneAddresses,
        pieces: Address,
        light: Light,
        light_samples: u32,
        shadow_rays: u32,
        smooth_terminator: u32,
        show: u32,
        camera_mask: u32,
        shadow_mask: u32,
        culling: u32,
        normals: u32,
        object_ray: u32,
        first_column: u32,
    }
}

impl Sample for Demo {
    fn requirements() -> Requirements {
        Requirements::ray_tracing().textures()
    }

    fn new(gpu: &Gpu, setup: &Setup) -> Result<Self> {
        let meshes = formation::meshes()?;
        let scene = SceneOnGpu::new(gpu, &meshes, setup.options)?;
        let build = Build { scene: 0, squares: 10_000, geometry: 0 };
        let formation = Formation::new(build.scene, build.squares, &meshes.model)?;
        let camera = formation::camera(build.scene);
        // ANCHOR: pipeline
        let pipeline = RayTracingPipeline::builder(env!("CARGO_BIN_NAME"))
            .raygen("camera.rgen")
            .miss("sky.rmiss")
            .miss("shadow.rmiss")
            .hit(HitGroup::triangles().any_hit("slice.rahit").closest_hit("shade.rchit"))
            .recursion(2)
            .binding(Binding::AccelerationStructure)
            .binding(Binding::StorageImage)
            .textures(&scene.textures)
            .push_constants::<Push>()
            .build(gpu)?;
        let sbt = ShaderBindingTable::new(gpu, &pipeline)?;
        // ANCHOR_END: pipeline
        Ok(Self {
            meshes,
            scene,
            formation,
            placed: [None, None],
            pipeline,
            sbt,
            camera,
            sun: Sun { azimuth: 300.0, elevation: 22.0, radiance: Vec3::new(4.4, 3.5, 2.4) },
            lamp: PointLight::default(),
            light: 0,
            light_size: 0.0,
            light_samples: 16,
            shadow_rays: 0,
            smooth_terminator: true,
            show: 0,
            build,
            built: build,
            far: 0.0,
            coordinates: CAMERA_RELATIVE,
            white_flags: 0,
            camera_sees: 0,
            shadows_of: 0,
            culling: 0,
            normals: HOST_INVERSE,
            object_ray: 0,
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
        c.choice("culling", &mut self.culling, &["off", "back faces", "front faces"]);
        c.choice("flags of white", &mut self.white_flags, &FLAGS.map(|(name, _)| name));
        c.choice("normals", &mut self.normals, &["matrix", "device inverse", "host inverse"]);
        c.choice("object ray", &mut self.object_ray, &["device", "matrix", "inverse"]);
        let views = [
            "picture",
            "normal",
            "triangle",
            "hit",
            "ray direction",
            "shadow",
            "shadow origin",
            "object normal",
            "object origin",
        ];
        c.choice("show", &mut self.show, &views);
        c.choice("light", &mut self.light, &["directional", "point"]);
        c.slider("sun azimuth", &mut self.sun.azimuth, 0.0..=360.0);
        c.slider("sun elevation", &mut self.sun.elevation, 0.0..=90.0);
        c.vector("lamp position", &mut self.lamp.position, -10.0..=10.0);
        c.slider("light size", &mut self.light_size, 0.0..=1.0);
        c.integer("light samples", &mut self.light_samples, 1..=64);
        c.choice("shadow rays", &mut self.shadow_rays, &["first hit", "nearest hit", "off"]);
        c.checkbox("smooth terminator", &mut self.smooth_terminator);
        c.camera(&mut self.camera);
    }
    // ANCHOR_END: controls

    fn render(&mut self, frame: &Frame) -> Result<()> {
        self.rebuild(frame.gpu)?;
        let (world, relative) = (0, 1);
        let width = frame.image.extent.width;
        match self.coordinates {
            WORLD => self.trace(frame, world, 0..width),
            CAMERA_RELATIVE => self.trace(frame, relative, 0..width),
            _ => {
                self.trace(frame, world, 0..width / 2)?;
                barrier::trace_to_trace(frame.gpu, frame.cmd);
                self.trace(frame, relative, width / 2..width)
            }
        }
    }

    fn report(&self) -> Result<serde_json::Value> {
        Ok(self.memory())
    }
}

impl Demo {
    /// Traces some columns of the picture, in coordinates about one of the two origins.
    fn trace(&mut self, frame: &Frame, which: usize, columns: Range<u32>) -> Result<()> {
        // ANCHOR: origin
        // The set and all that looks at it and lights it are moved together, in f64.
        let moved = DVec3::new(self.far.into(), 0.0, self.far.into());
        let mut camera = self.camera;
        camera.eye += moved;
        camera.target += moved;
        let origin = match which {
            0 => DVec3::ZERO,
            // Near the camera, in steps, so that few of its movements place everything again.
            _ => (camera.eye / STEP).round() * STEP,
        };
        camera.eye -= origin;
        camera.target -= origin;
        // ANCHOR_END: origin
        let placement =
            Placement { shift: moved - origin, flags: FLAGS[self.white_flags as usize].1 };
        let known = self.placed[which].take().filter(|placed| placed.placement == placement);
        let placed = match known {
            Some(placed) => placed,
            None => Placed::new(frame.gpu, &self.meshes, &self.scene, &self.formation, placement)?,
        };
        let placed = self.placed[which].insert(placed);
        // ANCHOR: trace
        let position = (self.lamp.position.as_dvec3() + moved - origin).as_vec3();
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
            shadow_rays: self.shadow_rays,
            smooth_terminator: self.smooth_terminator.into(),
            show: self.show,
            camera_mask: SEEN[self.camera_sees as usize].1.into(),
            shadow_mask: SEEN[self.shadows_of as usize].1.into(),
            culling: self.culling,
            normals: self.normals,
            object_ray: self.object_ray,
            first_column: columns.start,
        };
        let descriptors = [
            Descriptor::AccelerationStructure(&placed.tlas),
            Descriptor::StorageImage(frame.image),
        ];
        self.pipeline.bind(frame.cmd, &descriptors, &push)?;
        let width = columns.end - columns.start;
        self.sbt.trace(frame.cmd, vk::Extent2D { width, ..frame.image.extent });
        // ANCHOR_END: trace
        Ok(())
    }

    /// Makes meshes and pieces again if a control has changed what they are made from.
    fn rebuild(&mut self, gpu: &Gpu) -> Result<()> {
        if self.build == self.built {
            return Ok(());
        }
        let Build { scene, squares, geometry } = self.build;
        let meshes = formation::meshes()?;
        let formation = Formation::new(scene, squares, &meshes.model)?;
        let copied = geometry != 0 || self.built.geometry != 0;
        (self.meshes, self.formation) = match geometry {
            0 => (meshes, formation),
            _ => formation.copies(&meshes),
        };
        self.placed = [None, None];
        if copied {
            self.scene.rebuild(gpu, &self.meshes, self.scene.options)?;
        }
        self.built = self.build;
        Ok(())
    }

    // ANCHOR: memory
    /// Bytes of everything that grows with the pieces.
    fn memory(&self) -> serde_json::Value {
        let meshes = &self.meshes.model.meshes;
        let bytes = |mesh: &Mesh| size_of_val(&*mesh.vertices) + size_of_val(&*mesh.triangles);
        let placed = self.placed.iter().flatten();
        let pieces = self.formation.pieces.len();
        serde_json::json!({
            "pieces": pieces,
            "meshes": meshes.len(),
            "triangles": self.formation.triangles(&self.meshes.model),
            "mesh_bytes": meshes.iter().map(bytes).sum::<usize>(),
            "bottom_level_bytes": self.scene.blas.iter().map(|blas| blas.size).sum::<u64>(),
            "top_level_bytes": placed.clone().map(|placed| placed.tlas.size).sum::<u64>(),
            "record_bytes": placed.map(|_| pieces * size_of::<PieceRecord>()).sum::<usize>(),
            "instance_bytes": pieces * size_of::<vk::AccelerationStructureInstanceKHR>(),
        })
    }
    // ANCHOR_END: memory
}
