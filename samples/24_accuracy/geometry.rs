//! Costs of geometry: the sphere of an intersection shader beside meshes that are nearly spheres.

use std::collections::HashMap;
use std::time::Instant;

use anyhow::Result;
use ash::vk;
use common::gpu::{
    AccelerationStructure, Address, Binding, Buffer, BuildOptions, Descriptor, Geometry, Gpu,
    HitGroup, RayTracingPipeline, ShaderBindingTable, Timer, barrier,
};
use common::scene::{Camera, CameraBasis, boxes_on_gpu, build_top, input_usage};
use glam::{DVec3, Vec3};
use instruments::compare::{self, Ratio};
use reference::Ray;
use reference::sphere::Sphere;
use serde::Serialize;

use crate::batch::{IDENTITY, instance};

/// Pixels of the picture's side; the sphere's diameter is a little less.
const SIDE: u32 = 512;
/// Number of times each triangle of an octahedron is cut into four.
const CUTS: [u32; 3] = [2, 4, 6];

/// A sphere of radius 1, in one of its forms.
#[derive(Serialize)]
pub struct Form {
    pub name: String,
    /// Triangles; 0 for the sphere itself.
    pub triangles: usize,
    /// The number of pixels that do not show this, per million that show the sphere.
    pub lost: f64,
    /// Distance of the deepest of them inside the sphere's outline, in pixels of a picture 512 high.
    pub depth: f64,
    /// Error of the distance where both are seen, in radii: 99 of 100 pixels are at least as good.
    pub p99: f64,
    /// Bytes of vertices, indices and the bottom level.
    pub bytes: u64,
    pub build_milliseconds: f64,
    /// Time of the picture over that of the sphere itself.
    pub ratio: Option<Ratio>,
}

common::shader_struct! {
    struct Push {
        camera: CameraBasis,
        found: Address,
    }
}

/// Renders the sphere in every form; over `rounds` rounds, if any, for the time.
///
/// # Errors
/// If the device fails.
pub fn measure(gpu: &Gpu, rounds: u32) -> Result<Vec<Form>> {
    let usage = input_usage() | vk::BufferUsageFlags::TRANSFER_SRC;
    let found = Buffer::new(gpu, "found", u64::from(4 * SIDE * SIDE), usage)?;
    let push = Push { camera: camera().basis(1.0), found: found.address.into() };
    let truth = truth();
    let timer = Timer::new(gpu)?;
    let mut bodies = vec![Body::sphere(gpu)?];
    for cuts in CUTS {
        bodies.push(Body::mesh(gpu, cuts)?);
    }
    let render = |body: &Body| -> Result<f64> {
        gpu.submit(|cmd| {
            timer.start(cmd);
            let level = Descriptor::AccelerationStructure(&body.tlas);
            body.pipeline.bind(cmd, &[level], &push)?;
            body.sbt.trace(cmd, vk::Extent2D { width: SIDE, height: SIDE }.into());
            timer.stop(cmd);
            barrier::trace_to_trace(gpu, cmd);
            Ok(())
        })?;
        timer.milliseconds()
    };
    for body in &mut bodies {
        render(body)?;
        body.form.compare_with(&truth, &found.read()?);
    }
    if rounds > 0 {
        let labels: Vec<String> = bodies.iter().map(|body| body.form.name.clone()).collect();
        let comparison = compare::compare("form", &labels, rounds, |label| {
            let body = bodies.iter().find(|body| body.form.name == label);
            render(body.expect("the labels are those of the bodies"))
        })?;
        for (body, value) in bodies.iter_mut().zip(&comparison.values) {
            body.form.ratio = Some(value.ratio);
        }
    }
    Ok(bodies.into_iter().map(|body| body.form).collect())
}

/// From 4 radii away; the sphere all but fills the picture.
fn camera() -> Camera {
    Camera::new(4.0 * DVec3::new(0.36, 0.48, 0.8), DVec3::ZERO, 30.0)
}

/// The exact hit of a pixel's ray with the sphere.
struct ExactHit {
    t: f64,
    /// Pixels from the outline.
    depth: f64,
}

fn truth() -> Vec<Option<ExactHit>> {
    let camera = camera();
    let sphere = Sphere { center: DVec3::ZERO, radius: 1.0 };
    let [right, up, forward] = camera.axes();
    // Pixels from the middle of the picture, for a slope of 1.
    let scale = 0.5 * f64::from(SIDE) / (camera.fov_y.to_radians() / 2.0).tan();
    let outline = scale * (1.0 / camera.eye.length()).asin().tan();
    let pixel = |i: u32| {
        let at = |i: u32| f64::from(i) + 0.5 - 0.5 * f64::from(SIDE);
        let (x, y) = (at(i % SIDE), at(i / SIDE));
        let direction = (scale * forward + x * right - y * up).normalize();
        let ray = Ray { origin: camera.eye, direction, tmin: 0.0, tmax: f64::INFINITY };
        sphere.intersect(&ray).map(|hit| ExactHit { t: hit.t, depth: outline - x.hypot(y) })
    };
    (0..SIDE * SIDE).map(pixel).collect()
}

impl Form {
    fn compare_with(&mut self, truth: &[Option<ExactHit>], found: &[f32]) {
        let seen = truth.iter().zip(found).filter_map(|(truth, &t)| Some((truth.as_ref()?, t)));
        let (met, lost): (Vec<_>, Vec<_>) = seen.partition(|&(_, t)| t > 0.0);
        self.lost = 1e6 * lost.len() as f64 / (met.len() + lost.len()) as f64;
        self.depth = lost.iter().map(|(truth, _)| truth.depth).fold(0.0, f64::max);
        let mut errors: Vec<f64> =
            met.iter().map(|&(truth, t)| (f64::from(t) - truth.t).abs()).collect();
        errors.sort_by(f64::total_cmp);
        self.p99 = errors.get(errors.len() * 99 / 100).copied().unwrap_or_default();
    }
}

/// A form made ready to be traced.
struct Body {
    form: Form,
    tlas: AccelerationStructure,
    _blas: AccelerationStructure,
    _inputs: Vec<Buffer>,
    pipeline: RayTracingPipeline,
    sbt: ShaderBindingTable,
}

impl Body {
    fn sphere(gpu: &Gpu) -> Result<Self> {
        let boxes = boxes_on_gpu(gpu, "box", &[[Vec3::splat(-1.00001), Vec3::splat(1.00001)]])?;
        let geometry = Geometry::Aabbs { boxes: boxes.address, count: 1, opaque: true };
        let hit = HitGroup::procedural("geometry.rint").closest_hit("geometry.rchit");
        Self::new(gpu, "the sphere itself", 0, geometry, vec![boxes], hit)
    }

    fn mesh(gpu: &Gpu, cuts: u32) -> Result<Self> {
        let (corners, triangles) = mesh(cuts);
        let vertices = Buffer::with_data(gpu, "corners", &corners, input_usage())?;
        let indices = Buffer::with_data(gpu, "triangles", &triangles, input_usage())?;
        let geometry = Geometry::Triangles {
            vertices: vertices.address,
            vertex_stride: 12,
            vertex_count: corners.len() as u32,
            indices: indices.address,
            count: triangles.len() as u32,
            opaque: true,
            no_duplicate_any_hit: false,
        };
        let name = format!("{} triangles", triangles.len());
        let hit = HitGroup::triangles().closest_hit("geometry.rchit");
        Self::new(gpu, &name, triangles.len(), geometry, vec![vertices, indices], hit)
    }

    fn new(
        gpu: &Gpu,
        name: &str,
        triangles: usize,
        geometry: Geometry,
        inputs: Vec<Buffer>,
        hit: HitGroup<'static>,
    ) -> Result<Self> {
        let begun = Instant::now();
        let options = BuildOptions { compact: true, ..BuildOptions::default() };
        let blas = AccelerationStructure::bottom(gpu, name, &[geometry], options)?;
        let build_milliseconds = begun.elapsed().as_secs_f64() * 1e3;
        let tlas = build_top(gpu, &[instance(&IDENTITY, 0, blas.address)])?;
        let pipeline = RayTracingPipeline::builder(env!("CARGO_BIN_NAME"))
            .raygen("geometry.rgen")
            .miss("geometry.rmiss")
            .hit(hit)
            .binding(Binding::AccelerationStructure)
            .push_constants::<Push>()
            .build(gpu)?;
        let sbt = ShaderBindingTable::new(gpu, &pipeline)?;
        let bytes = blas.size + inputs.iter().map(|input| input.size).sum::<u64>();
        let form = Form {
            name: name.to_owned(),
            triangles,
            lost: 0.0,
            depth: 0.0,
            p99: 0.0,
            bytes,
            build_milliseconds,
            ratio: None,
        };
        Ok(Self { form, tlas, _blas: blas, _inputs: inputs, pipeline, sbt })
    }
}

/// An octahedron whose triangles are cut into four again and again, each new corner on the unit sphere.
pub fn mesh(cuts: u32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let mut corners = vec![Vec3::X, Vec3::Y, Vec3::Z, Vec3::NEG_X, Vec3::NEG_Y, Vec3::NEG_Z];
    let mut triangles = vec![
        [0, 1, 2],
        [1, 3, 2],
        [3, 4, 2],
        [4, 0, 2],
        [1, 0, 5],
        [3, 1, 5],
        [4, 3, 5],
        [0, 4, 5],
    ];
    for _ in 0..cuts {
        let mut middles = HashMap::new();
        let mut middle = |a: u32, b: u32| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                let sum = corners[a as usize].as_dvec3() + corners[b as usize].as_dvec3();
                corners.push(sum.normalize().as_vec3());
                corners.len() as u32 - 1
            })
        };
        let cut = |[a, b, c]: [u32; 3]| {
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        };
        triangles = triangles.into_iter().flat_map(cut).collect();
    }
    (corners, triangles)
}
