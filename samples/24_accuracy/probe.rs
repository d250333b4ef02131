//! Asks the device: queries go to its shaders, answers come back.

use anyhow::{Result, ensure};
use ash::vk;
use common::gpu::{
    AccelerationStructure, Address, Binding, Blueprint, Buffer, BuildOptions, Descriptor, Geometry,
    Gpu, HitGroup, RayTracingPipeline, ShaderBindingTable, Timer, barrier,
};
use common::scene::{boxes_on_gpu, build_top, input_usage};
use glam::{DVec3, Vec3};

use crate::ladder::{Code, Primitive, Rung};
use crate::shape::{Shape, parts};

common::shader_struct! {
    /// What is asked: a ray, and where the numbers of its shape are.
    pub struct Query {
        pub origin: Vec3,
        pub tmin: f32,
        pub direction: Vec3,
        pub tmax: f32,
        pub first: u32,
        pub count: u32,
        pub shape: u32,
    }
}

common::shader_struct! {
    /// What the device said.
    pub struct Answer {
        pub offered: u32,
        pub hit: u32,
        pub t: f32,
        pub normal: Vec3,
        pub point: Vec3,
        pub steps: u32,
    }
}

common::shader_struct! {
    struct Push {
        queries: Address<Query>,
        answers: Address<Answer>,
        numbers: Address,
        count: u32,
        repeat: u32,
        from: u32,
        until: u32,
    }
}

/// How many samples one dispatch adds to a sum: a shader that runs for longer may be taken for a hang.
const SAMPLES_AT_ONCE: u32 = 1 << 22;

/// A ray `origin + t·direction`, `tmin < t <= tmax`, in f32 as the device gets it.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    pub origin: Vec3,
    pub direction: Vec3,
    pub tmin: f32,
    pub tmax: f32,
}

impl Ray {
    /// The same ray for the reference.
    pub fn exact(&self) -> reference::Ray {
        let Self { origin, direction, tmin, tmax } = *self;
        reference::Ray::from_f32(origin.to_array(), direction.to_array(), tmin, tmax)
    }
}

/// By which way a rung is asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// The raygen shader calls the intersection.
    Direct,
    /// The device's box test decides first whether it is called.
    Traced,
}

/// Queries in device memory, all of one primitive, and their shapes in a top level.
pub struct Batch {
    primitive: Primitive,
    count: u32,
    /// Of the longest sum; 1 where there is none.
    samples: u32,
    queries: Buffer,
    numbers: Buffer,
    answers: Buffer,
    /// The shapes as boxes, and as the device's own triangles.
    boxes: Option<Level>,
    triangles: Option<Level>,
}

struct Level {
    tlas: AccelerationStructure,
    _levels: Vec<AccelerationStructure>,
    _inputs: Vec<Buffer>,
}

impl Batch {
    /// `asked` says which shape each ray is for; `is_traced`, whether they shall stand in a top level.
    ///
    /// # Errors
    /// If memory is short.
    pub fn new(
        gpu: &Gpu,
        shapes: &[Shape],
        asked: &[(usize, Ray)],
        is_traced: bool,
    ) -> Result<Self> {
        ensure!(!shapes.is_empty() && !asked.is_empty(), "nothing is asked");
        let primitive = shapes[0].primitive();
        let (mut queries, mut numbers) = (Vec::new(), Vec::new());
        let mut known: Vec<Option<(u32, Vec<f32>)>> = vec![None; shapes.len()];
        for &(shape, Ray { origin, direction, tmin, tmax }) in asked {
            let own = shapes[shape].numbers(origin);
            let count = own.len() as u32;
            // A mesh is the same for every ray; what the host prepares for a ray is not.
            let first = match &known[shape] {
                Some((first, known)) if *known == own => *first,
                _ => {
                    let first = numbers.len() as u32;
                    numbers.extend_from_slice(&own);
                    known[shape] = Some((first, own));
                    first
                }
            };
            let shape = shape as u32;
            queries.push(Query { origin, tmin, direction, tmax, first, count, shape });
        }
        let samples =
            shapes.iter().map(|shape| if let Shape::Sum(sum) = shape { sum.n } else { 1 });
        let usage = input_usage() | vk::BufferUsageFlags::TRANSFER_SRC;
        let size = (queries.len() * size_of::<Answer>()) as u64;
        Ok(Self {
            primitive,
            count: queries.len() as u32,
            samples: samples.max().unwrap_or(1),
            queries: Buffer::with_data(gpu, "queries", &queries, input_usage())?,
            numbers: Buffer::with_data(gpu, "numbers", &numbers, input_usage())?,
            answers: Buffer::new(gpu, "answers", size, usage)?,
            boxes: is_traced.then(|| boxes(gpu, shapes, asked)).transpose()?,
            triangles: (is_traced && primitive == Primitive::Triangle)
                .then(|| triangles(gpu, shapes))
                .transpose()?,
        })
    }

    /// How many queries there are.
    pub fn count(&self) -> u32 {
        self.count
    }
}

// ANCHOR: margin
/// Each shape in a bottom level of its own, as one box. The box has a margin that grows with the
/// distance of its rays' origins: the device's box test rounds.
fn boxes(gpu: &Gpu, shapes: &[Shape], asked: &[(usize, Ray)]) -> Result<Level> {
    let mut reach = vec![0.0f64; shapes.len()];
    for &(index, ray) in asked {
        let (low, high) = shapes[index].bounds();
        let mut origin = ray.origin.as_dvec3();
        if let Shape::Instance(rows) = &shapes[index] {
            let (linear, translation) = parts(rows);
            // In the shape's space; and the way there rounds relative to the matrix's entries.
            let inverse = linear.inverse();
            let stray = |v: DVec3| {
                DVec3::from_array([0, 1, 2].map(|row| inverse.row(row).abs().dot(v.abs())))
            };
            origin = inverse * (origin - translation);
            origin = origin.abs() + stray(ray.origin.as_dvec3()) + stray(translation);
        }
        let near = origin.clamp(low, high);
        let size = (high - low).max_element().min(1e9);
        reach[index] = reach[index].max((origin - near).abs().max_element() + size);
    }
    // ANCHOR_END: margin
    let bottom = |(shape, reach): (&Shape, &f64)| -> Result<_> {
        let (low, high) = shape.bounds();
        // As in `common::gpu::padded`; an instance's matrix takes three products and their sum.
        let roundings = if matches!(shape, Shape::Instance(_)) { 18.0 } else { 10.0 };
        let margin = DVec3::splat(roundings * 2f64.powi(-24) * reach);
        let corners = [down(low - margin), up(high + margin)];
        let input = boxes_on_gpu(gpu, "box", &[corners])?;
        let geometry = Geometry::Aabbs { boxes: input.address, count: 1, opaque: true };
        Ok((
            AccelerationStructure::bottom(gpu, "shape", &[geometry], BuildOptions::default())?,
            input,
        ))
    };
    let levels = shapes.iter().zip(&reach).map(bottom).collect::<Result<Vec<_>>>()?;
    level(gpu, shapes, levels)
}

fn triangles(gpu: &Gpu, shapes: &[Shape]) -> Result<Level> {
    let bottom = |shape: &Shape| -> Result<_> {
        let Shape::Triangles(mesh) = shape else { unreachable!("a batch has one primitive") };
        let count = mesh.len() as u32;
        let indices: Vec<u32> = (0..3 * count).collect();
        let size = 36 * mesh.len() as u64;
        let corners: Vec<u32> = mesh
            .as_flattened()
            .iter()
            .flat_map(|corner| corner.to_array().map(f32::to_bits))
            .chain(indices)
            .collect();
        let input = Buffer::with_data(gpu, "triangles", &corners, input_usage())?;
        let geometry = Geometry::Triangles {
            vertices: input.address,
            vertex_stride: 12,
            vertex_count: 3 * count,
            indices: input.address + size,
            count,
            opaque: false,
            no_duplicate_any_hit: false,
        };
        Ok((
            AccelerationStructure::bottom(gpu, "mesh", &[geometry], BuildOptions::default())?,
            input,
        ))
    };
    let levels = shapes.iter().map(bottom).collect::<Result<Vec<_>>>()?;
    level(gpu, shapes, levels)
}

/// A top level in which an instance's custom index is the number of its shape.
fn level(
    gpu: &Gpu,
    shapes: &[Shape],
    levels: Vec<(AccelerationStructure, Buffer)>,
) -> Result<Level> {
    let instance = |(index, (shape, (blas, _))): (usize, (&Shape, &(AccelerationStructure, _)))| {
        let rows = if let Shape::Instance(rows) = shape { rows } else { &IDENTITY };
        instance(rows, index as u32, blas.address)
    };
    let instances: Vec<_> = shapes.iter().zip(&levels).enumerate().map(instance).collect();
    let tlas = build_top(gpu, &instances)?;
    let (levels, inputs) = levels.into_iter().unzip();
    Ok(Level { tlas, _levels: levels, _inputs: inputs })
}

/// Three rows of four that leave everything where it is.
pub const IDENTITY: [[f32; 4]; 3] =
    [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];

/// A bottom level in its place, of the only hit group.
pub fn instance(
    rows: &[[f32; 4]; 3],
    index: u32,
    blas: vk::DeviceAddress,
) -> vk::AccelerationStructureInstanceKHR {
    let mut matrix = [0.0; 12];
    matrix.copy_from_slice(rows.as_flattened());
    vk::AccelerationStructureInstanceKHR {
        transform: vk::TransformMatrixKHR { matrix },
        instance_custom_index_and_mask: vk::Packed24_8::new(index, 0xff),
        instance_shader_binding_table_record_offset_and_flags: vk::Packed24_8::new(0, 0),
        acceleration_structure_reference: vk::AccelerationStructureReferenceKHR {
            device_handle: blas,
        },
    }
}

/// Rounded to f32, but never up.
fn down(v: DVec3) -> Vec3 {
    v.to_array()
        .map(|x| if f64::from(x as f32) > x { (x as f32).next_down() } else { x as f32 })
        .into()
}

fn up(v: DVec3) -> Vec3 {
    -down(-v)
}

/// The specialization constant that says whether `fma()` rounds once.
const FUSED: u32 = 1;

/// A rung made ready to be asked one way.
pub struct Instrument {
    pub way: Way,
    device: bool,
    pipeline: RayTracingPipeline,
    sbt: ShaderBindingTable,
}

impl Instrument {
    /// What the pipeline is made from, for a GPU whose `fma()` rounds once, as AMD's does: it is what the
    /// laboratory would make on that GPU, where it would have asked.
    pub fn blueprint(&self) -> Blueprint {
        let mut blueprint = (*self.pipeline.blueprint).clone();
        for (constant, value) in &mut blueprint.constants {
            if *constant == FUSED {
                *value = 1;
            }
        }
        blueprint
    }
}

/// The laboratory on one device.
pub struct Probe {
    gpu: Gpu,
    timer: Timer,
    /// Whether `fma()` rounds once.
    pub fused: bool,
}

impl Probe {
    /// Finds out what the device's `fma()` does.
    ///
    /// # Errors
    /// If a shader or a buffer cannot be made.
    pub fn new(gpu: &Gpu) -> Result<Self> {
        let mut probe = Self { gpu: gpu.clone(), timer: Timer::new(gpu)?, fused: false };
        let pipeline = probe.pipeline("fma.rgen", Primitive::Sphere, 0).build(gpu)?;
        let sbt = ShaderBindingTable::new(gpu, &pipeline)?;
        let instrument = Instrument { way: Way::Direct, device: false, pipeline, sbt };
        // a·a = 1 + 2^-11 + 2^-24, and rounded 1 + 2^-11: only what is rounded once keeps the rest.
        let a = 1.0 + 2f32.powi(-12);
        let numbers = [Vec3::new(a, a, -(1.0 + 2f32.powi(-11)))];
        let ray = Ray { origin: Vec3::ZERO, direction: Vec3::X, tmin: 0.0, tmax: 1.0 };
        let shape = Shape::Triangles(vec![[numbers[0]; 3]]);
        let batch = Batch::new(gpu, &[shape], &[(0, ray)], false)?;
        let (answers, _) = probe.ask(&instrument, &batch, 1)?;
        probe.fused = answers[0].t == 2f32.powi(-24);
        Ok(probe)
    }

    fn pipeline(
        &self,
        raygen: &'static str,
        primitive: Primitive,
        rung: u32,
    ) -> common::gpu::PipelineBuilder<'static> {
        RayTracingPipeline::builder(env!("CARGO_BIN_NAME"))
            .raygen(raygen)
            .define("PRIMITIVE", primitive as u32)
            .constant(0, rung)
            .constant(FUSED, self.fused)
            .push_constants::<Push>()
    }

    /// Makes a rung's pipeline.
    ///
    /// # Errors
    /// If the device does not offer what it needs; ask [`Rung::unavailable`] first.
    pub fn instrument(&self, primitive: Primitive, rung: &Rung, way: Way) -> Result<Instrument> {
        let file = |plain, exact, float64| match rung.code {
            Code::Plain | Code::Device => plain,
            Code::Exact => exact,
            Code::Float64 => float64,
        };
        let device = rung.code == Code::Device;
        let builder = match way {
            Way::Direct => {
                let raygen = file("direct.rgen", "direct_exact.rgen", "direct_f64.rgen");
                self.pipeline(raygen, primitive, rung.constant)
            }
            Way::Traced => {
                let raygen = file("traced.rgen", "traced_exact.rgen", "traced_f64.rgen");
                let shape = file("shape.rint", "shape_exact.rint", "shape_f64.rint");
                let group = if device {
                    HitGroup::triangles().any_hit("triangle.rahit").closest_hit("triangle.rchit")
                } else {
                    HitGroup::procedural(shape).closest_hit("shape.rchit")
                };
                self.pipeline(raygen, primitive, rung.constant)
                    .miss("nothing.rmiss")
                    .hit(group)
                    .binding(Binding::AccelerationStructure)
            }
        };
        let pipeline = builder.build(&self.gpu)?;
        let sbt = ShaderBindingTable::new(&self.gpu, &pipeline)?;
        Ok(Instrument { way, device, pipeline, sbt })
    }

    /// Asks every query of the batch `repeat` times; the answers, and the device's milliseconds.
    ///
    /// # Errors
    /// If the device fails.
    pub fn ask(
        &self,
        instrument: &Instrument,
        batch: &Batch,
        repeat: u32,
    ) -> Result<(Vec<Answer>, f64)> {
        let milliseconds = self.time(instrument, batch, repeat)?;
        Ok((batch.answers.read()?, milliseconds))
    }

    /// As [`Probe::ask`], but leaves the answers on the device.
    ///
    /// # Errors
    /// If the device fails.
    pub fn time(&self, instrument: &Instrument, batch: &Batch, repeat: u32) -> Result<f64> {
        let level = if instrument.device { &batch.triangles } else { &batch.boxes };
        let descriptors = match (instrument.way, level) {
            (Way::Direct, _) => Vec::new(),
            (Way::Traced, Some(level)) => vec![Descriptor::AccelerationStructure(&level.tlas)],
            (Way::Traced, None) => anyhow::bail!("{} is not traced", batch.primitive.name()),
        };
        // Rows of rays, as some devices take no more than 2^16 in one direction.
        let width = batch.count.min(1024);
        let extent = vk::Extent2D { width, height: batch.count.div_ceil(width) };
        let mut milliseconds = 0.0;
        for from in (0..batch.samples).step_by(SAMPLES_AT_ONCE as usize) {
            let push = Push {
                queries: batch.queries.address.into(),
                answers: batch.answers.address.into(),
                numbers: batch.numbers.address.into(),
                count: batch.count,
                repeat,
                from,
                until: from + SAMPLES_AT_ONCE,
            };
            self.gpu.submit(|cmd| {
                self.timer.start(cmd);
                instrument.pipeline.bind(cmd, &descriptors, &push)?;
                instrument.sbt.trace(cmd, extent.into());
                self.timer.stop(cmd);
                barrier::trace_to_trace(&self.gpu, cmd);
                Ok(())
            })?;
            milliseconds += self.timer.milliseconds()?;
        }
        Ok(milliseconds)
    }
}
