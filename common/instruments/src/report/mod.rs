//! `--report`: a run's facts and measurements as JSON, for scripts, tests and the tables on the pages.

use std::path::{Path, PathBuf};

use anyhow::Result;
use serde::Serialize;

use common::UsageError;
use common::app::Run;
use common::files::write_whole;
use common::gpu::Executable;
use common::output;

use crate::compare::Comparison;
use crate::compile_for::CompiledFor;

mod limits;

pub use limits::Limits;

/// The options of `--report`.
#[derive(Clone, Debug, Default, clap::Args)]
#[group(skip)]
pub struct Options {
    /// With --headless, write device, times, stages and messages as JSON; - is standard output
    #[arg(long, value_name = "FILE")]
    pub report: Option<PathBuf>,

    /// Add statistics from the device's own compiler to the report, if the driver offers them
    #[arg(long, hide = true)]
    pub compiler_figures: bool,
}

impl Options {
    /// The output file; `None` for standard output.
    pub fn file(&self) -> Option<&Path> {
        self.report.as_deref().filter(|path| *path != Path::new("-"))
    }

    /// True if the report goes to standard output.
    pub fn takes_output(&self) -> bool {
        self.report.as_deref() == Some(Path::new("-"))
    }

    /// Refuses a file whose name does not end in .json.
    ///
    /// # Errors
    /// [`UsageError`], with the correct form.
    pub fn check(&self) -> Result<(), UsageError> {
        let is_json =
            |path: &Path| path.extension().is_some_and(|it| it.eq_ignore_ascii_case("json"));
        match self.file().filter(|path| !is_json(path)) {
            None => Ok(()),
            Some(report) => {
                let line = "a report is .json, or - for standard output";
                Err(UsageError(format!("--report {}: {line}", report.display())))
            }
        }
    }
}

/// The report of one run.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Report {
    /// The sample's name, such as `02_basic`.
    pub sample: String,
    /// The device's name.
    pub device: String,
    /// Its driver, in its maker's words.
    pub driver: String,
    /// The device's features and limits.
    pub limits: Limits,
    /// The arithmetic of shaders: the value of `--arithmetic`.
    pub arithmetic: String,
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Number of frames rendered.
    pub frames: u32,
    /// The device time of a frame.
    pub gpu_milliseconds: Milliseconds,
    /// Number of bands in the last frame.
    pub bands: usize,
    /// The device time of a band, over all frames.
    pub band_milliseconds: Milliseconds,
    /// Primary rays per second: pixels over the median time.
    pub primary_rays_per_second: f64,
    /// From the start of the process to the end of the first frame.
    pub first_frame_milliseconds: f64,
    /// Host time to build all acceleration structures, without uploads.
    pub acceleration_structure_milliseconds: f64,
    /// Bytes of all acceleration structures after the last frame.
    pub acceleration_structure_bytes: u64,
    /// Host time to compile shaders and create pipelines.
    pub pipeline_milliseconds: f64,
    /// Shader stages compiled, by path below `shaders/`.
    pub stages: Vec<String>,
    /// Shader groups in the pipelines.
    pub groups: usize,
    /// Device memory in use after the last frame.
    pub bytes_allocated: u64,
    /// Validation messages; empty if validation is off.
    pub validation_messages: Vec<String>,
    /// Measurements of `--compare`.
    pub comparison: Option<Comparison>,
    /// Results of `--compile-for`, one row per program.
    pub compiled_for: Vec<CompiledFor>,
    /// Statistics from the device's own compiler for the last pipeline, if requested and supported.
    pub executables: Vec<Executable>,
    /// The chapter's own report.
    pub chapter: serde_json::Value,
}

/// A spread of times, in milliseconds.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Milliseconds {
    /// The shortest.
    pub min: f64,
    /// The median.
    pub median: f64,
    /// The longest.
    pub max: f64,
}

impl Milliseconds {
    /// The spread of `times`; zeros for none.
    pub fn of(times: &[f64]) -> Self {
        let mut sorted = times.to_vec();
        sorted.sort_by(f64::total_cmp);
        let at = |i: usize| sorted.get(i).copied().unwrap_or_default();
        Self { min: at(0), median: at(sorted.len() / 2), max: at(sorted.len().saturating_sub(1)) }
    }
}

impl Report {
    /// The report of a completed run, without the results of other instruments.
    ///
    /// # Errors
    /// If the sample's own report fails.
    pub fn of(run: &Run) -> Result<Self> {
        let Run { gpu, args, .. } = run;
        let (width, height) = (args.size.width, args.size.height);
        let times: Vec<f64> = run.times.iter().map(|bands| bands.iter().sum()).collect();
        let median = Milliseconds::of(&times).median;
        let pixels = f64::from(width) * f64::from(height);
        let statistics = gpu.statistics();
        Ok(Self {
            sample: run.name.to_owned(),
            device: gpu.name.clone(),
            driver: gpu.driver.clone(),
            limits: Limits::of(gpu),
            arithmetic: gpu.driver_shim.name().to_owned(),
            width,
            height,
            frames: if run.apart { times.len() as u32 } else { args.frames },
            gpu_milliseconds: Milliseconds::of(&times),
            bands: run.times.last().map_or(0, Vec::len),
            band_milliseconds: Milliseconds::of(&run.times.concat()),
            primary_rays_per_second: if median > 0.0 { pixels / median * 1e3 } else { 0.0 },
            first_frame_milliseconds: run.first_frame.as_secs_f64() * 1e3,
            acceleration_structure_milliseconds: statistics.build_time.as_secs_f64() * 1e3,
            acceleration_structure_bytes: statistics.acceleration_structure_bytes,
            pipeline_milliseconds: statistics.pipeline_time.as_secs_f64() * 1e3,
            stages: statistics.stages(),
            groups: statistics.groups(),
            bytes_allocated: gpu.allocated_bytes(),
            validation_messages: gpu.validation().all(),
            executables: statistics.executables,
            chapter: run.sample.report()?,
            ..Self::default()
        })
    }

    /// Writes the report to a file, or to standard output if `path` is `-`.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn save(&self, path: &Path) -> Result<()> {
        let mut text = serde_json::to_string_pretty(self)?;
        text.push('\n');
        if path == Path::new("-") {
            output::print(&text)
        } else {
            write_whole(path, text.as_bytes())
        }
    }
}
