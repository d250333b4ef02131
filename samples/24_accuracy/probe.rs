//! Runs rungs on the device: queries go to its shaders, and answers come back.

use anyhow::Result;
use ash::vk;
use common::gpu::{
    Address, Binding, Descriptor, Gpu, HitGroup, PipelineDesc, RayTracingPipeline,
    ShaderBindingTable, Timer, barrier,
};
use glam::Vec3;

use crate::batch::Batch;
use crate::ladder::{Code, Primitive, Rung};
use crate::query::{Answer, Query, Ray};
use crate::shape::Shape;

common::shader_struct! {
    struct Push {
        queries: Address<Query>,
        answers: Address<Answer>,
        numbers: Address,
        count: u32,
        asked: u32,
        repeat: u32,
        from: u32,
        until: u32,
        never: f32,
    }
}

/// Samples that one dispatch adds to a sum: a shader that runs for longer may be taken for a hang.
const SAMPLES_AT_ONCE: u32 = 1 << 19;

/// The load of a launch that is timed.
#[derive(Clone, Copy, Debug)]
pub struct Load {
    /// Queries that an invocation computes, one after the other.
    pub repeat: u32,
    /// Invocations that begin with each query. One keeps its answer; the others fill a device that takes more at
    /// once.
    pub copies: u32,
}

impl Load {
    /// Every query once.
    pub const ONCE: Self = Self { repeat: 1, copies: 1 };

    /// Number of times a query is computed.
    pub const fn times(self) -> u32 {
        self.repeat * self.copies
    }
}

/// The way in which a rung is run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// The raygen shader calls the intersection.
    Direct,
    /// The device's box test decides first whether it is called.
    Traced,
}

/// The specialization constant that is 1 if `fma()` rounds once.
const FUSED: u32 = 1;

/// A rung with its pipeline, ready to be run in one way.
pub struct Instrument {
    pub way: Way,
    device: bool,
    pipeline: RayTracingPipeline,
    sbt: ShaderBindingTable,
}

impl Instrument {
    /// Description of the pipeline for a GPU whose `fma()` rounds once, as AMD's does: the one that the laboratory
    /// would make on that GPU, where it would have asked.
    pub fn desc(&self) -> PipelineDesc {
        let mut desc = (*self.pipeline.desc).clone();
        for [constant, value] in &mut desc.constants {
            if *constant == FUSED {
                *value = 1;
            }
        }
        desc
    }
}

/// The laboratory on one device.
pub struct Probe {
    gpu: Gpu,
    timer: Timer,
    /// True if `fma()` rounds once.
    pub fused: bool,
}

impl Probe {
    /// Determines whether the device's `fma()` rounds once.
    ///
    /// # Errors
    /// If a shader or a buffer cannot be made.
    pub fn new(gpu: &Gpu) -> Result<Self> {
        let mut probe = Self { gpu: gpu.clone(), timer: Timer::new(gpu)?, fused: false };
        let pipeline = probe.pipeline("fma.rgen", Primitive::Sphere, 0).build(gpu)?;
        let sbt = ShaderBindingTable::new(gpu, &pipeline)?;
        let instrument = Instrument { way: Way::Direct, device: false, pipeline, sbt };
        // a·a = 1 + 2^-11 + 2^-24, rounded to 1 + 2^-11: only a single rounding preserves the rest.
        let a = 1.0 + 2f32.powi(-12);
        let numbers = [Vec3::new(a, a, -(1.0 + 2f32.powi(-11)))];
        let ray = Ray { origin: Vec3::ZERO, direction: Vec3::X, tmin: 0.0, tmax: 1.0 };
        let shape = Shape::Triangles(vec![[numbers[0]; 3]]);
        let batch = Batch::new(gpu, &[shape], &[(0, ray)], false)?;
        let answers = probe.ask(&instrument, &batch)?;
        probe.fused = answers[0].t == 2f32.powi(-24);
        Ok(probe)
    }

    /// Tests whether the device is a software driver.
    pub fn is_software(&self) -> bool {
        self.gpu.software
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
            .fma_rounded_once(&self.gpu)
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

    /// Runs every query of the batch.
    ///
    /// # Errors
    /// If the device fails.
    pub fn ask(&self, instrument: &Instrument, batch: &Batch) -> Result<Vec<Answer>> {
        self.time(instrument, batch, Load::ONCE)?;
        batch.answers.read()
    }

    /// Runs every query as often as the load says, keeping the results on the device: its milliseconds.
    ///
    /// # Errors
    /// If the device fails.
    pub fn time(&self, instrument: &Instrument, batch: &Batch, load: Load) -> Result<f64> {
        let level = if instrument.device { &batch.triangles } else { &batch.boxes };
        let descriptors = match (instrument.way, level) {
            (Way::Direct, _) => Vec::new(),
            (Way::Traced, Some(level)) => vec![Descriptor::AccelerationStructure(&level.tlas)],
            (Way::Traced, None) => anyhow::bail!("{} is not traced", batch.primitive.name()),
        };
        // Rows of rays, as some devices take no more than 2^16 in one direction.
        let asked = batch.count * load.copies;
        let width = asked.min(1024);
        let extent = vk::Extent2D { width, height: asked.div_ceil(width) };
        let mut milliseconds = 0.0;
        for from in (0..batch.samples).step_by(SAMPLES_AT_ONCE as usize) {
            let push = Push {
                queries: batch.queries.address.into(),
                answers: batch.answers.address.into(),
                numbers: batch.numbers.address.into(),
                count: batch.count,
                asked,
                repeat: load.repeat,
                from,
                until: from + SAMPLES_AT_ONCE,
                never: f32::MIN,
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
