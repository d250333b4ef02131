//! What a run found out about itself, as JSON: for scripts, tests and the tables on the pages.

use std::path::Path;

use anyhow::Result;
use serde::Serialize;

use super::compare::Comparison;
use super::compile_for::CompiledFor;
use super::output;
use crate::files::write_whole;
use crate::gpu::{Executable, Limits};

/// The report of one run.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Report {
    /// The sample's name, such as `02_basic`.
    pub sample: String,
    /// The device's name.
    pub device: String,
    /// Its driver, in its maker's words.
    pub driver: String,
    /// What it has, and how much of it.
    pub limits: Limits,
    /// How shaders computed: the value of `--arithmetic`.
    pub arithmetic: String,
    /// Pixels a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// How many frames were rendered.
    pub frames: u32,
    /// The device's time for a frame.
    pub gpu_milliseconds: Milliseconds,
    /// Bands of rows that the last frame was traced in.
    pub bands: usize,
    /// The device's time for a band, of all frames.
    pub band_milliseconds: Milliseconds,
    /// Primary rays a second: pixels over the median time.
    pub primary_rays_per_second: f64,
    /// From the start of the process to the end of the first frame.
    pub first_frame_milliseconds: f64,
    /// Host time to build all acceleration structures, uploads left out.
    pub acceleration_structure_milliseconds: f64,
    /// Bytes of all acceleration structures that are there after the last frame.
    pub acceleration_structure_bytes: u64,
    /// Host time to compile shaders and make pipelines.
    pub pipeline_milliseconds: f64,
    /// Shader stages compiled, by path below `shaders/`.
    pub stages: Vec<String>,
    /// Shader groups in the pipelines.
    pub groups: usize,
    /// Device memory in use after the last frame.
    pub bytes_allocated: u64,
    /// What validation said; empty where it is off.
    pub validation_messages: Vec<String>,
    /// What `--compare` measured.
    pub comparison: Option<Comparison>,
    /// What `--compile-for` found out, a row a program.
    pub compiled_for: Vec<CompiledFor>,
    /// What the device's own compiler says of the last pipeline, where it was asked and tells.
    pub executables: Vec<Executable>,
    /// What the chapter itself has to tell.
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
