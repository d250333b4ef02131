//! 24 · Accuracy: the laboratory, where every way of intersecting is asked, timed and held to the truth.
//!
//! New since 08_intersection: the full ladders, hard cases whose answers are known to 50 digits, a
//! picture of each rung's errors, and what they cost in time.

mod cases;
mod compiled;
mod disagreement;
mod drawing;
mod families;
mod geometry;
mod hard;
mod judge;
mod ladder;
mod live;
mod measure;
mod plot;
mod probe;
mod shape;
mod specimen;
mod table;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context, Result, bail};
use common::app::{self, Args, check_validation, output};
use common::files::{self, write_whole};
use common::gpu::{
    Address, Binding, Buffer, Descriptor, Gpu, GpuOptions, RayTracingPipeline, Requirements,
    ShaderBindingTable,
};
use common::scene::{CameraBasis, input_usage};
use common::usage::Usage;
use common::{Controls, Frame, Sample, Setup};
use disagreement::Disagreement;
use drawing::Drawing;
use glam::Vec3;
use ladder::{Code, Primitive, Rung};
use live::Live;
use plot::Plot;
use probe::Probe;
use specimen::Specimen;

fn main() -> ExitCode {
    let parsed = Args::parse_with::<Lab>(env!("CARGO_BIN_NAME")).map_err(Into::into);
    app::finish(parsed.and_then(|(args, lab)| lab.start(&args)))
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
    /// What the picture's shader can read.
    struct View {
        camera: CameraBasis,
        numbers: Address,
        count: u32,
        sun: Vec3,
        show: u32,
    }
}

impl Sample for Demo {
    fn requirements() -> Requirements {
        Requirements::ray_tracing().float64_where_offered()
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

    // ANCHOR: controls
    fn controls(&mut self, c: &mut Controls) {
        c.choice("show", &mut self.show, &["split", "picture", "error"]);
        let names = specimen::PRIMITIVES.map(Primitive::name);
        if c.choice("primitive", &mut self.specimen.primitive, &names) {
            self.rung = 0;
        }
        let rungs: Vec<&str> = rungs(self.specimen.primitive()).map(|rung| rung.name).collect();
        c.choice("rung", &mut self.rung, &rungs);
        c.slider("distance", &mut self.specimen.distance, 1.5..=1e6);
        if let (Some(live), Ok(rung)) = (&self.live, self.rung()) {
            c.chart(&live.chart(rung.label));
        }
    }
    // ANCHOR_END: controls

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
        let view = View {
            camera: self.specimen.camera().basis(aspect),
            numbers: numbers.address.into(),
            count: (numbers.size / 4) as u32,
            sun: specimen::SUN.normalize(),
            show: self.show,
        };
        pipeline.bind(frame.cmd, &[Descriptor::StorageImage(frame.image)], &view)?;
        sbt.trace(frame.cmd, frame.image.extent);
        self.ask_live(frame.gpu)
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
        // The picture's shaders declare what two-floats need, whichever rung they show.
        if let Some(why) = Code::Exact.unavailable(gpu) {
            bail!("the picture is not available: {why}");
        }
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
            .constant(1, self.probe.fused.into())
            .constant(2, top.constant)
            .binding(Binding::StorageImage)
            .push_constants::<View>()
            .build(gpu)?;
        // ANCHOR_END: pipeline
        let sbt = ShaderBindingTable::new(gpu, &pipeline)?;
        self.pipeline = Some((wanted.0, wanted.1, pipeline, sbt));
        Ok(())
    }
}

/// What the laboratory takes beside every sample's arguments.
#[derive(clap::Args)]
struct Lab {
    /// Run every case of a file of hard cases through every rung; exit 1 if a top rung is wrong
    #[arg(long, value_name = "FILE.json", conflicts_with = "measure")]
    cases: Option<PathBuf>,

    /// Measure errors and time of every rung on seeded random rays, and ask a GPU's compiler about each;
    /// write accuracy.md, .json, plots as .svg and .png to a folder
    #[arg(long, value_name = "FOLDER")]
    measure: Option<PathBuf>,

    /// With --measure: only this primitive; repeatable
    #[arg(long, value_name = "NAME", value_parser = primitive, requires = "measure")]
    only: Vec<Primitive>,

    /// With --measure: rays of each family
    #[arg(long, value_name = "N", default_value = "10000", requires = "measure", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    rays: u32,

    /// With --measure: rounds of timing; 0 measures errors alone
    #[arg(long, value_name = "N", default_value = "30", requires = "measure", value_parser = clap::value_parser!(u32).range(..=1000))]
    rounds: u32,
}

fn primitive(name: &str) -> Result<Primitive, String> {
    let found = Primitive::ALL.into_iter().find(|primitive| primitive.name() == name);
    let names = Primitive::ALL.map(Primitive::name).join(", ");
    found.ok_or_else(|| format!("there is {names}"))
}

/// What --measure writes.
const FILES: [&str; 6] = [
    "accuracy.json",
    "accuracy.md",
    "accuracy.svg",
    "accuracy.png",
    "accuracy_compiled.svg",
    "accuracy_compiled.png",
];

/// Makes the folder, and finds out whether all files can be written, before a minute's work.
fn prepare(folder: &Path) -> Result<()> {
    std::fs::create_dir_all(folder)
        .with_context(|| format!("cannot make the folder '{}'", folder.display()))?;
    FILES.iter().try_for_each(|file| files::check_writable(&folder.join(file)))
}

impl Lab {
    fn start(&self, args: &Args) -> Result<()> {
        let is_asked = self.cases.is_some() || self.measure.is_some();
        if !is_asked || args.list_controls {
            return app::start::<Demo>(env!("CARGO_BIN_NAME"), args);
        }
        if args.compare.is_some() || args.list_devices || !args.sets.is_empty() {
            let line = "--cases and --measure take no controls, and list no devices";
            return Err(Usage(line.to_owned()).into());
        }
        if args.out.is_some() || args.frames_given {
            let line = "--cases and --measure make no picture for --out or --frames";
            return Err(Usage(line.to_owned()).into());
        }
        if args.scene.is_some() {
            let line = "--cases and --measure bring their own shapes and take no --scene";
            return Err(Usage(line.to_owned()).into());
        }
        if args.compile_for.is_some() {
            let line = "--compile-for is for the picture's pipeline; --measure asks by itself about every rung";
            return Err(Usage(line.to_owned()).into());
        }
        if self.measure.is_some() && args.report.is_some() {
            let line = "--measure writes its report to the folder and takes no --report";
            return Err(Usage(line.to_owned()).into());
        }
        if let (Some(cases), Some(report)) = (&self.cases, &args.report)
            && files::same(cases, report)
        {
            let line = format!("--cases and --report both name '{}'", report.display());
            return Err(Usage(line).into());
        }
        app::check_files(args)?;
        if let Some(folder) = &self.measure {
            prepare(folder)?;
        }
        let gpu = Gpu::new(&GpuOptions {
            requirements: Demo::requirements(),
            device: args.device.as_deref(),
            validate: args.validate,
            window: None,
        })?;
        let validation = gpu.validation();
        if let Some(cases) = &self.cases {
            hard::run(&gpu, cases, args.report.as_deref())?;
        }
        if let Some(folder) = &self.measure {
            self.measure(&gpu, folder)?;
        }
        drop(gpu);
        check_validation(&validation)
    }

    fn measure(&self, gpu: &Gpu, folder: &Path) -> Result<()> {
        let measured = measure::measure(gpu, &self.only, self.rays as usize, self.rounds)?;
        let save = |name: &str, bytes: &[u8]| write_whole(&folder.join(name), bytes);
        save("accuracy.json", (serde_json::to_string_pretty(&measured)? + "\n").as_bytes())?;
        save("accuracy.md", measured.markdown().as_bytes())?;
        if let Some(plot) = Plot::new(&measured) {
            save("accuracy.svg", plot.svg()?.as_bytes())?;
            save("accuracy.png", &plot.png()?)?;
        }
        if let Some(plot) = Disagreement::new(&measured) {
            save("accuracy_compiled.svg", plot.svg()?.as_bytes())?;
            save("accuracy_compiled.png", &plot.png()?)?;
        }
        if let Some(why) = &measured.no_compiler {
            output::print(&format!("no estimates: {why}\n"))?;
        }
        Ok(())
    }
}
