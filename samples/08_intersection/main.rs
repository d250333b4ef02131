//! 08 · Intersection: spheres and boxes, which the device does not know, found by our own shaders.
//!
//! New since 05_shadow_miss: bottom levels of boxes, the intersection shaders `sphere.rint` and
//! `box.rint`, a closest hit shader for both, hit groups per instance, and how exact all that is.

mod shapes;

use std::process::ExitCode;

use anyhow::Result;
use ash::vk;
use common::gpu::{
    AccelerationStructure, Address, Binding, Buffer, BuildOptions, Descriptor, Geometry, Gpu,
    HitGroup, RayTracingPipeline, Requirements, ShaderBindingTable, order,
};
use common::scene::{
    Camera, CameraBasis, Instance, Light, PointLight, Scene, SceneAddresses, SceneOnGpu, Sun,
    build_top, input_usage, transform,
};
use common::{Controls, Frame, Sample, Setup};
use glam::{Affine3A, Vec3};
use shapes::Shapes;

fn main() -> ExitCode {
    common::run::<Demo>(env!("CARGO_BIN_NAME"))
}

/// The rung of `common/sphere.glsl` that takes c from the host.
const HOST_C: u32 = 3;
/// Not to trace shadow rays.
const NO_SHADOWS: u32 = 2;

struct Demo {
    model: Scene,
    scene: SceneOnGpu,
    shapes: ShapesOnGpu,
    pipelines: Vec<(Rungs, RayTracingPipeline, ShaderBindingTable)>,
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
    distance: f32,
    rungs: Rungs,
}

/// What the shapes are built from; where it changes, they are built again.
#[derive(Clone, Copy, PartialEq)]
struct Build {
    scene: u32,
    count: u32,
    ordering: bool,
    /// Whether the boxes around shapes are larger than the shapes.
    margin: bool,
}

/// Which way spheres and boxes are intersected: positions in `common/sphere.glsl` and `box.glsl`.
#[derive(Clone, Copy, PartialEq)]
struct Rungs {
    sphere: u32,
    aabb: u32,
}

common::shader_struct! {
    /// What every shader of this chapter can read.
    struct Push {
        camera: CameraBasis,
        scene: SceneAddresses,
        shapes: Address,
        host_c: Address,
        light: Light,
        light_samples: u32,
        shadow_rays: u32,
        smooth_terminator: u32,
        show: u32,
    }
}

impl Sample for Demo {
    fn requirements() -> Requirements {
        Requirements::ray_tracing().textures()
    }

    fn new(gpu: &Gpu, setup: &Setup) -> Result<Self> {
        let mut model = setup.scene_or(Scene::chess)?;
        model.model.materials.extend(shapes::materials());
        let camera = model.camera;
        let scene = SceneOnGpu::new(gpu, &model, setup.options)?;
        let ordering = setup.options.ordering;
        let build = Build { scene: shapes::CHESS, count: 10_000, ordering, margin: true };
        let shapes = ShapesOnGpu::new(gpu, &model, &scene, build, camera.eye.as_vec3())?;
        Ok(Self {
            model,
            scene,
            shapes,
            pipelines: Vec::new(),
            camera,
            sun: Sun { azimuth: 60.0, elevation: 17.0, radiance: Vec3::new(4.4, 3.5, 2.4) },
            lamp: PointLight::default(),
            light: 0,
            light_size: 0.0,
            light_samples: 16,
            shadow_rays: 0,
            smooth_terminator: true,
            show: 0,
            build,
            distance: 100.0,
            rungs: Rungs { sphere: 2, aabb: 1 },
        })
    }

    // ANCHOR: controls
    fn controls(&mut self, c: &mut Controls) {
        // A scene brings its size, its view, and whether its shadows are worth their time.
        if c.choice("scene", &mut self.build.scene, &shapes::SCENES) {
            self.build.count = shapes::default_count(self.build.scene);
            let shadows = [shapes::CHESS, shapes::GRID].contains(&self.build.scene);
            self.shadow_rays = if shadows { 0 } else { NO_SHADOWS };
            self.camera = self.scene_camera();
        }
        if c.integer("count", &mut self.build.count, 1..=1_000_000) {
            self.camera = self.scene_camera();
        }
        if c.slider("distance", &mut self.distance, 1e-3..=1e6) {
            self.camera = self.scene_camera();
        }
        let rungs = ["textbook", "projection", "stable", "host c", "offered"];
        c.choice("sphere rung", &mut self.rungs.sphere, &rungs);
        c.choice("box rung", &mut self.rungs.aabb, &["reciprocal", "division"]);
        c.checkbox("ordering", &mut self.build.ordering);
        c.checkbox("margin", &mut self.build.margin);
        let views = [
            "picture",
            "normal",
            "triangle",
            "hit",
            "ray direction",
            "shadow",
            "shadow origin",
            "hit kind",
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
        // ANCHOR: rebuild
        let chosen = self.choose_pipeline(frame.gpu)?;
        let eye = self.camera.eye.as_vec3();
        if self.build != self.shapes.build || self.shapes.reach != self.shapes.reach_from(eye) {
            self.shapes = ShapesOnGpu::new(frame.gpu, &self.model, &self.scene, self.build, eye)?;
        }
        if self.rungs.sphere == HOST_C {
            self.shapes.compute_host_c(frame.gpu, eye)?;
        }
        // ANCHOR_END: rebuild
        // ANCHOR: trace
        let push = Push {
            camera: self.camera.basis(frame.aspect()),
            scene: self.scene.addresses,
            shapes: self.shapes.addresses.address.into(),
            host_c: self.shapes.host_c.as_ref().map_or(0, |(_, buffer)| buffer.address).into(),
            light: match self.light {
                0 => Light::directional(&self.sun, self.light_size),
                _ => Light::point(&self.lamp, self.light_size),
            },
            light_samples: self.light_samples,
            shadow_rays: self.shadow_rays,
            smooth_terminator: self.smooth_terminator.into(),
            show: self.show,
        };
        let descriptors = [
            Descriptor::AccelerationStructure(&self.shapes.tlas),
            Descriptor::StorageImage(frame.image),
        ];
        let (_, pipeline, sbt) = &self.pipelines[chosen];
        pipeline.bind(frame.cmd, &descriptors, &push)?;
        sbt.trace(frame.cmd, frame.image.extent);
        // ANCHOR_END: trace
        Ok(())
    }
}

impl Demo {
    // ANCHOR: variant
    /// Which of the pipelines has the rungs in use; it is made when they are first wanted.
    fn choose_pipeline(&mut self, gpu: &Gpu) -> Result<usize> {
        let known = self.pipelines.iter().position(|(rungs, ..)| *rungs == self.rungs);
        if let Some(known) = known {
            return Ok(known);
        }
        let pipeline = pipeline(gpu, &self.scene, self.rungs)?;
        let sbt = ShaderBindingTable::new(gpu, &pipeline)?;
        self.pipelines.push((self.rungs, pipeline, sbt));
        Ok(self.pipelines.len() - 1)
    }
    // ANCHOR_END: variant

    fn scene_camera(&self) -> Camera {
        shapes::camera(self.build.scene, self.model.camera, self.build.count, self.distance)
    }
}

// ANCHOR: pipeline
/// A hit group for each kind of surface. The rungs are specialization constants: a pipeline holds the
/// code of the one in use, and no shader asks at run time.
fn pipeline(gpu: &Gpu, scene: &SceneOnGpu, rungs: Rungs) -> Result<RayTracingPipeline> {
    RayTracingPipeline::builder(env!("CARGO_BIN_NAME"))
        .raygen("camera.rgen")
        .miss("sky.rmiss")
        .miss("shadow.rmiss")
        .hit(HitGroup::triangles().closest_hit("shade.rchit"))
        .hit(HitGroup::procedural("sphere.rint").closest_hit("shape.rchit"))
        .hit(HitGroup::procedural("box.rint").closest_hit("shape.rchit"))
        .constant(0, rungs.sphere)
        .constant(1, rungs.aabb)
        .recursion(2)
        .binding(Binding::AccelerationStructure)
        .binding(Binding::StorageImage)
        .textures(&scene.textures)
        .push_constants::<Push>()
        .build(gpu)
}
// ANCHOR_END: pipeline

/// The shapes in device memory, and the top level that holds them beside the meshes.
struct ShapesOnGpu {
    tlas: AccelerationStructure,
    /// Where shaders find the shapes: four addresses.
    addresses: Buffer,
    /// |eye - center|² - radius² of each sphere, for this eye.
    host_c: Option<(Vec3, Buffer)>,
    shapes: Shapes,
    /// Corners of the box around everything.
    bounds: order::Bounds,
    /// How far rays may begin from a shape; the margin of the boxes grows with it.
    reach: f32,
    build: Build,
    _levels: Vec<AccelerationStructure>,
    _buffers: Vec<Buffer>,
}

impl ShapesOnGpu {
    fn new(gpu: &Gpu, model: &Scene, scene: &SceneOnGpu, build: Build, eye: Vec3) -> Result<Self> {
        let shapes = Shapes::new(build.scene, build.count, &model.model, &model.instances);
        let spheres: Vec<_> = shapes.spheres.iter().map(shapes::Sphere::bounds).collect();
        let boxes: Vec<_> = shapes.boxes.iter().map(|b| (b.low, b.high)).collect();
        // In the other scenes there are no triangles, and in this one fewer.
        let is_shown = |(_, piece): &(usize, &Instance)| {
            build.scene == shapes::CHESS && !shapes::is_replaced(&model.model, piece)
        };
        let pieces: Vec<_> = model.instances.iter().enumerate().filter(is_shown).collect();
        let mut bounds: Vec<_> =
            pieces.iter().map(|(_, piece)| model.instance_bounds(piece)).collect();
        let everything = around(bounds.iter().chain(&spheres).chain(&boxes));
        let reach = if build.margin { reach(everything, eye) } else { 0.0 };

        // ANCHOR: instances
        let mut instances = Vec::new();
        for (index, piece) in pieces {
            let blas = &scene.blas[piece.mesh];
            instances.push(instance(&piece.transform, index, 0, blas));
        }
        // One more instance for all spheres and one for all boxes. The record offset makes the device
        // run their intersection shaders: hit group 0 is that of triangles, 1 of spheres, 2 of boxes.
        let spheres = Level::new(gpu, "spheres", &spheres, build.ordering, reach)?;
        let boxes = Level::new(gpu, "boxes", &boxes, build.ordering, reach)?;
        for (record, level) in [(1, &spheres), (2, &boxes)] {
            if let Some(blas) = &level.blas {
                let index = model.instances.len() + record as usize - 1;
                instances.push(instance(&Affine3A::IDENTITY, index, record, blas));
                bounds.push(level.bounds);
            }
        }
        // ANCHOR_END: instances
        let ordered = ordered(&bounds, build.ordering);
        let ordered: Vec<_> = ordered.iter().map(|&i| instances[i as usize]).collect();
        let tlas = build_top(gpu, &ordered)?;

        let records = [
            Buffer::with_data(gpu, "spheres", &shapes.spheres, input_usage())?,
            Buffer::with_data(gpu, "boxes", &shapes.boxes, input_usage())?,
            spheres.ids,
            boxes.ids,
        ];
        let addresses = records.each_ref().map(|buffer| buffer.address);
        Ok(Self {
            tlas,
            addresses: Buffer::with_data(gpu, "shapes", &addresses, input_usage())?,
            host_c: None,
            shapes,
            bounds: everything,
            reach,
            build,
            _levels: [spheres.blas, boxes.blas].into_iter().flatten().collect(),
            _buffers: records.into(),
        })
    }

    fn reach_from(&self, eye: Vec3) -> f32 {
        if self.build.margin { reach(self.bounds, eye) } else { 0.0 }
    }

    // ANCHOR: host_c
    /// c of the quadratic for rays from the eye: products and sums of f32 numbers, in f64.
    fn compute_host_c(&mut self, gpu: &Gpu, eye: Vec3) -> Result<()> {
        if self.host_c.as_ref().is_some_and(|(known, _)| *known == eye) {
            return Ok(());
        }
        let c = self.shapes.spheres.iter().map(|sphere| {
            let radius = f64::from(sphere.radius);
            let distance = (eye.as_dvec3() - sphere.center.as_dvec3()).length();
            ((distance - radius) * (distance + radius)) as f32
        });
        let c: Vec<f32> = c.collect();
        self.host_c = Some((eye, Buffer::with_data(gpu, "c of spheres", &c, input_usage())?));
        Ok(())
    }
    // ANCHOR_END: host_c
}

/// All shapes of one kind as a bottom level.
struct Level {
    /// `None` without shapes.
    blas: Option<AccelerationStructure>,
    /// Which shape a primitive of the build is.
    ids: Buffer,
    bounds: order::Bounds,
}

impl Level {
    fn new(
        gpu: &Gpu,
        name: &str,
        bounds: &[order::Bounds],
        ordering: bool,
        reach: f32,
    ) -> Result<Self> {
        // ANCHOR: order
        let order = ordered(bounds, ordering);
        let ids = Buffer::with_data(gpu, name, &order, input_usage())?;
        // ANCHOR_END: order
        // ANCHOR: margin
        // A driver's box test rounds: a wall at distance x along an axis may seem to be 3u·x off, with
        // u = 2^-24 (a subtraction, a reciprocal and a product). A fourth u is for the wall itself.
        let margin = Vec3::splat(4.0 * 0.5f32.powi(24) * reach);
        let grow = |i: &u32| {
            let (low, high) = bounds[*i as usize];
            [low - margin, high + margin]
        };
        let boxes: Vec<[Vec3; 2]> = order.iter().map(grow).collect();
        // ANCHOR_END: margin
        let input = Buffer::with_data(gpu, name, &boxes, input_usage())?;
        let count = boxes.len() as u32;
        let geometry = Geometry::Aabbs { boxes: input.address, count, opaque: true };
        let options = BuildOptions { compact: true, ..BuildOptions::default() };
        let blas = (count > 0)
            .then(|| AccelerationStructure::bottom(gpu, name, &[geometry], options))
            .transpose()?;
        Ok(Self { blas, ids, bounds: around(bounds) })
    }
}

/// The order of the build: near beside near, or as the shapes come.
fn ordered(bounds: &[order::Bounds], ordering: bool) -> Vec<u32> {
    if ordering { order::kd_median(bounds) } else { (0..bounds.len() as u32).collect() }
}

/// The box around boxes.
fn around<'a>(bounds: impl IntoIterator<Item = &'a order::Bounds>) -> order::Bounds {
    let nothing = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    bounds.into_iter().fold(nothing, |(low, high), (l, h)| (low.min(*l), high.max(*h)))
}

// ANCHOR: reach
/// How far a ray may begin from a shape: at the eye or, as shadow rays do, anywhere on the scene.
/// Rounded up to a power of two, so that few steps of a camera change it.
fn reach((low, high): order::Bounds, eye: Vec3) -> f32 {
    let farthest = (eye - low).abs().max((eye - high).abs()).max(high - low);
    farthest.length().log2().ceil().exp2()
}
// ANCHOR_END: reach

fn instance(
    placement: &Affine3A,
    custom_index: usize,
    record: u32,
    blas: &AccelerationStructure,
) -> vk::AccelerationStructureInstanceKHR {
    vk::AccelerationStructureInstanceKHR {
        transform: transform(placement),
        instance_custom_index_and_mask: vk::Packed24_8::new(custom_index as u32, 0xff),
        instance_shader_binding_table_record_offset_and_flags: vk::Packed24_8::new(record, 0),
        acceleration_structure_reference: vk::AccelerationStructureReferenceKHR {
            device_handle: blas.address,
        },
    }
}
