//! 24 · Accuracy: the laboratory, where every way of intersecting is run, timed and checked.
//!
//! New since 42_distant_spheres: the full ladders, hard cases whose answers are known to 50 digits, a
//! picture of each rung's errors, and what they cost in time.

mod atlas;
mod batch;
mod cases;
mod compiled;
mod disagreement;
mod drawing;
mod families;
mod faults;
mod geometry;
mod hard;
mod judge;
mod lab;
mod ladder;
mod live;
mod measure;
mod measurement;
mod plot;
mod probe;
mod query;
mod shape;
mod specimen;
mod table;

use std::process::ExitCode;

use anyhow::{Context, Result, bail};
use common::gpu::{
    Address, Binding, Buffer, Descriptor, Gpu, RayTracingPipeline, Requirements, ShaderBindingTable,
};
use common::scene::{CameraBasis, input_usage};
use common::{Controls, Frame, Sample, Setup};
use glam::Vec3;
use lab::Lab;
use ladder::{Code, Primitive, Rung};
use live::Live;
use probe::Probe;
use specimen::Specimen;

fn main() -> ExitCode {
    common::exit::finish(|| {
        let (args, options, lab) = instruments::parse_with::<Lab>(env!("CARGO_BIN_NAME"))?;
        lab.start(&args, options)
    })
}

struct Demo {
    probe: Probe,
    specimen: Specimen,
    numbers: Option<(Specimen, Buffer)>,
    live: Option<Live>,
    pipeline: Option<(u32, u32, RayTracingPipeline, ShaderBindingTable)>,
    rung: u32,
    show: u32,
}

common::shader_struct! {
    /// Push constants of the picture's shader.
    struct Push {
        camera: CameraBasis,
        numbers: Address,
        count: u32,
        sun: Vec3,
        show: u32,
    }
}

impl Sample for Demo {
    /// The picture's shaders declare what two-floats need, whichever rung they show.
    fn requirements() -> Requirements {
        Requirements::ray_tracing().float64_where_offered().fma_where_offered().exact_floats()
    }

    fn new(gpu: &Gpu, _: &Setup) -> Result<Self> {
        Ok(Self {
            probe: Probe::new(gpu)?,
            specimen: Specimen { primitive: 0, distance: 1e3 },
            numbers: None,
            live: None,
            pipeline: None,
            rung: 0,
            show: 0,
        })
    }

    fn controls(&mut self, c: &mut Controls) {
        c.one_of("show", &mut self.show, &["split", "picture", "error"]);
        let names = specimen::PRIMITIVES.map(Primitive::name);
        if c.one_of("primitive", &mut self.specimen.primitive, &names) {
            self.rung = 0;
        }
        let rungs: Vec<&str> = rungs(self.specimen.primitive()).map(|rung| rung.name).collect();
        c.one_of("rung", &mut self.rung, &rungs);
        c.slider("distance", &mut self.specimen.distance, 1.5..=1e6);
        if let (Some(live), Ok(rung)) = (&self.live, self.rung()) {
            c.chart(&live.chart(rung.label));
        }
    }

    fn render(&mut self, frame: &Frame) -> Result<()> {
        self.choose_pipeline(frame.gpu)?;
        if self.numbers.as_ref().is_none_or(|(known, _)| *known != self.specimen) {
            let numbers = self.specimen.shape().numbers(self.specimen.camera().eye.as_vec3());
            let numbers = Buffer::with_data(frame.gpu, "numbers", &numbers, input_usage())?;
            self.numbers = Some((self.specimen, numbers));
        }
        let (Some((_, numbers)), Some((.., pipeline, sbt))) = (&self.numbers, &self.pipeline)
        else {
            bail!("nothing to look at");
        };
        // Half of the picture is a picture, in the usual view.
        let aspect = if self.show == 0 { 0.5 } else { 1.0 } * frame.aspect();
        let push = Push {
            camera: self.specimen.camera().basis(aspect),
            numbers: numbers.address.into(),
            count: (numbers.size / 4) as u32,
            sun: specimen::SUN.normalize(),
            show: self.show,
        };
        pipeline.bind(frame.cmd, &[Descriptor::StorageImage(frame.image)], &push)?;
        sbt.trace(frame.cmd, frame.area);
        if frame.is_first_band() {
            self.ask_live(frame.gpu)?
        }
        Ok(())
    }

    fn report(&self) -> Result<serde_json::Value> {
        Ok(serde_json::to_value(self.live.as_ref().map(Live::found))?)
    }
}

/// The rungs that a picture can be made by.
fn rungs(primitive: Primitive) -> impl Iterator<Item = &'static Rung> {
    primitive.ladder().iter().filter(|rung| rung.code != Code::Device)
}

impl Demo {
    fn rung(&self) -> Result<&'static Rung> {
        let mut rungs = rungs(self.specimen.primitive());
        rungs.nth(self.rung as usize).context("there is no such rung")
    }

    fn ask_live(&mut self, gpu: &Gpu) -> Result<()> {
        let (rung, primitive) = (self.rung()?, self.specimen.primitive());
        if self.live.as_ref().is_none_or(|live| live.specimen() != self.specimen) {
            self.live = Some(Live::new(gpu, self.specimen)?);
        }
        let live = self.live.as_mut().context("made above")?;
        live.ask(&self.probe, primitive, rung)
    }

    fn choose_pipeline(&mut self, gpu: &Gpu) -> Result<()> {
        let primitive = self.specimen.primitive();
        let rung = self.rung()?;
        let top =
            primitive.ladder().iter().find(|rung| rung.is_top).context("every ladder has a top")?;
        for needed in [rung, top] {
            if let Some(why) = needed.unavailable(gpu) {
                bail!("rung {} {} is not available: {why}", needed.label, needed.name);
            }
        }
        let wanted = (self.specimen.primitive, self.rung);
        if self.pipeline.as_ref().is_some_and(|&(a, b, ..)| (a, b) == wanted) {
            return Ok(());
        }
        let raygen = if rung.code == Code::Float64 { "view_f64.rgen" } else { "view.rgen" };
        // ANCHOR: pipeline
        let pipeline = RayTracingPipeline::builder(env!("CARGO_BIN_NAME"))
            .raygen(raygen)
            .define("PRIMITIVE", primitive as u32)
            .constant(0, rung.constant)
            .constant(1, self.probe.fused)
            .constant(2, top.constant)
            .binding(Binding::StorageImage)
            .fma_rounded_once(gpu)
            .push_constants::<Push>()
            .build(gpu)?;
        // ANCHOR_END: pipeline
        let sbt = ShaderBindingTable::new(gpu, &pipeline)?;
        self.pipeline = Some((wanted.0, wanted.1, pipeline, sbt));
        Ok(())
    }
}
