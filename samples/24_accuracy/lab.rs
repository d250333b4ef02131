//! The laboratory's work without a picture: hard cases through every rung, measurements, the atlas, and known faults
//! of drivers.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use common::UsageError;
use common::app::{Args, Development, RunHooks, check_validation};
use common::files::{self, write_whole};
use common::gpu::{Gpu, Requirements};
use common::output;
use instruments::{Instruments, Options, check_files, idle};

use crate::atlas::{self, Extent, Traversal};
use crate::disagreement::Disagreement;
use crate::drawing::Drawing;
use crate::families::Draw;
use crate::ladder::Primitive;
use crate::measure::Plan;
use crate::plot::Plot;
use crate::{Demo, faults, hard, measure};

/// Arguments of the laboratory, beside every sample's.
#[derive(clap::Args)]
pub struct Lab {
    /// Run every case of a file of hard cases through every rung; exit 1 if a top rung is wrong
    #[arg(long, value_name = "FILE.json", group = "work")]
    cases: Option<PathBuf>,

    /// Measure errors and time of every rung on seeded random rays, and ask a GPU's compiler about each;
    /// write accuracy.md, .json, plots as .svg and .png to a folder
    #[arg(long, value_name = "FOLDER", group = "work")]
    measure: Option<PathBuf>,

    /// Find out what this device's own traversal computes, against exact arithmetic: triangles, edges, boxes;
    /// write atlas.json and atlas.md to a folder
    #[arg(long, value_name = "FOLDER", group = "work")]
    atlas: Option<PathBuf>,

    /// Look for known faults of drivers: boxes lost after an update, wrong hit attributes; exit 1 if this device has
    /// one
    #[arg(long, group = "work", conflicts_with_all = ["tops", "rays"])]
    faults: bool,

    /// With --faults: look for the one that has hung machines instead, a top level without instances
    #[arg(long, requires = "faults")]
    risky: bool,

    /// With --cases or --measure: only the rungs that must be right
    #[arg(long, requires = "work", conflicts_with = "atlas")]
    tops: bool,

    /// With --measure: only this primitive; repeatable
    #[arg(long, value_name = "NAME", value_parser = primitive, requires = "measure", conflicts_with_all = ["atlas", "cases"])]
    only: Vec<Primitive>,

    /// With --measure or --atlas: rays of each family [default: 10000; of the atlas 50000]
    #[arg(long, value_name = "N", requires = "work", conflicts_with = "cases", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    rays: Option<u32>,

    /// With --measure: rounds of timing; 0 measures errors alone
    #[arg(long, value_name = "N", default_value = "30", requires = "measure", conflicts_with_all = ["atlas", "cases"], value_parser = clap::value_parser!(u32).range(..=1000))]
    rounds: u32,

    /// With --measure: the seed of the random rays; 0 draws those of the stored figures
    #[arg(long, value_name = "N", default_value = "0", requires = "measure", conflicts_with_all = ["atlas", "cases"])]
    seed: u64,

    /// With --measure: rungs alone, without a GPU compiler's estimates and without the sphere's meshes
    #[arg(long, requires = "measure", conflicts_with_all = ["atlas", "cases"])]
    rungs_alone: bool,

    /// With --atlas: rays of each row that rational numbers alone decide, too, as a check of the 64-bit floats
    #[arg(long, value_name = "N", default_value = "1000", requires = "atlas", value_parser = clap::value_parser!(u32).range(..=1_000_000))]
    exact: u32,

    /// With --atlas: whose triangles they are, the device's, or an intersection shader's that is nearly exact,
    /// which shows what the atlas can tell
    #[arg(long, value_name = "WHOSE", value_enum, default_value = "device", requires = "atlas")]
    traversal: Traversal,
}

fn primitive(name: &str) -> Result<Primitive, String> {
    let found = Primitive::ALL.into_iter().find(|primitive| primitive.name() == name);
    let names = Primitive::ALL.map(Primitive::name).join(", ");
    found.ok_or_else(|| format!("there is {names}"))
}

/// Rays of a family, of --measure and of --atlas.
const RAYS: u32 = 10_000;
const ATLAS_RAYS: u32 = 50_000;

/// Files written by --atlas.
const ATLAS: [&str; 2] = ["atlas.json", "atlas.md"];

/// Files written by --measure.
const FILES: [&str; 6] = [
    "accuracy.json",
    "accuracy.md",
    "accuracy.svg",
    "accuracy.png",
    "accuracy_compiled.svg",
    "accuracy_compiled.png",
];

/// Makes the folder, and finds out whether all files can be written, before a minute's work.
fn prepare(folder: &Path, files: &[&str]) -> Result<()> {
    std::fs::create_dir_all(folder)
        .with_context(|| format!("cannot make the folder '{}'", folder.display()))?;
    files.iter().try_for_each(|file| files::check_writable(&folder.join(file)))
}

impl Lab {
    /// Runs the requested work: hard cases, measurements, the atlas or known faults, or else a picture.
    ///
    /// # Errors
    /// Whatever went wrong.
    pub fn start(&self, args: &Args, options: Options) -> Result<()> {
        let files = [&self.cases, &self.measure, &self.atlas];
        let is_asked = self.faults || files.iter().any(|file| file.is_some());
        if !is_asked || args.list_controls {
            return instruments::start::<Demo>(env!("CARGO_BIN_NAME"), args, options);
        }
        self.check(args, &options)?;
        check_files(args, &options)?;
        if let Some(folder) = &self.measure {
            prepare(folder, &FILES)?;
        }
        if let Some(folder) = &self.atlas {
            prepare(folder, &ATLAS)?;
        }
        // A rung that the device lacks is reported, and the others are run.
        let mut device =
            args.device(Requirements::ray_tracing().float64_where_offered().fma_where_offered());
        let report = options.report.report.clone();
        Instruments::new(options).device(&mut device);
        let gpu = Gpu::new(&device)?;
        idle::refuse(&gpu, "there are no answers to compare")?;
        let validation = gpu.validation();
        if let Some(cases) = &self.cases {
            hard::run(&gpu, cases, self.tops, report.as_deref())?;
        }
        if self.faults {
            faults::run(&gpu, self.risky, report.as_deref())?;
        }
        if let Some(folder) = &self.measure {
            self.measure(&gpu, folder)?;
        }
        if let Some(folder) = &self.atlas {
            let extent = Extent {
                rays: self.rays.unwrap_or(ATLAS_RAYS) as usize,
                exact: self.exact as usize,
            };
            let atlas = atlas::draw(&gpu, &device, self.traversal, extent)?;
            let save = |name: &str, text: &str| write_whole(&folder.join(name), text.as_bytes());
            save("atlas.json", &(serde_json::to_string_pretty(&atlas)? + "\n"))?;
            save("atlas.md", &atlas.markdown())?;
        }
        drop(gpu);
        check_validation(&validation)
    }

    /// Refuses what goes with a picture alone.
    fn check(&self, args: &Args, options: &Options) -> Result<(), UsageError> {
        if options.compare.compare.is_some()
            || args.list_devices
            || !(args.sets.is_empty() && args.then.is_empty())
        {
            let line =
                "--cases, --measure, --atlas and --faults take no controls, and list no devices";
            return Err(UsageError(line.to_owned()));
        }
        if args.out.is_some() || args.frames_given {
            let line =
                "--cases, --measure, --atlas and --faults make no picture for --out or --frames";
            return Err(UsageError(line.to_owned()));
        }
        if args.sky.is_some() || args.development != Development::default() {
            let line = "--cases, --measure, --atlas and --faults show no picture for --sky, --exposure or --tone";
            return Err(UsageError(line.to_owned()));
        }
        if args.scene.is_some() {
            let line = "--cases, --measure, --atlas and --faults bring their own shapes and take no --scene";
            return Err(UsageError(line.to_owned()));
        }
        if options.compile_for.compile_for.is_some() {
            let line = "--compile-for is for the picture's pipeline; --measure asks by itself about every rung";
            return Err(UsageError(line.to_owned()));
        }
        if self.cases.is_none() && !self.faults && options.report.report.is_some() {
            let work = if self.measure.is_some() { "--measure" } else { "--atlas" };
            let line = format!("{work} writes its report to the folder and takes no --report");
            return Err(UsageError(line));
        }
        if let (Some(cases), Some(report)) = (&self.cases, &options.report.report)
            && files::same(cases, report)
        {
            let line = format!("--cases and --report both name '{}'", report.display());
            return Err(UsageError(line));
        }
        Ok(())
    }

    fn measure(&self, gpu: &Gpu, folder: &Path) -> Result<()> {
        let &Self { ref only, tops, rays, rounds, seed, rungs_alone, .. } = self;
        let draw = Draw { rays: rays.unwrap_or(RAYS) as usize, seed };
        let measured = measure::measure(gpu, &Plan { only, tops, rungs_alone, draw, rounds })?;
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
        if let Some(why) = measured.no_compiler.as_ref().filter(|_| !self.rungs_alone) {
            output::print(&format!("no estimates: {why}\n"))?;
        }
        Ok(())
    }
}
