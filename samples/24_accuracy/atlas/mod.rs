//! `--atlas`: what this device's own traversal computes, row by row, against exact arithmetic.

mod ball;
mod boxes;
mod corners;
mod duplicates;
mod errors;
mod row;
mod seams;
mod tracer;
mod triangles;
mod truth;
mod world;

use std::fmt::Write as _;
use std::time::SystemTime;

use anyhow::{Result, bail, ensure};
use common::app::Progress;
use common::gpu::{Gpu, GpuOptions};
use instruments::report::Limits;
use serde::Serialize;

use crate::ladder::Code;
use row::Row;
use seams::Asked;
use tracer::{Tracer, What};
pub use world::Traversal;

/// The schema of the file.
const SCHEMA: &str = "rt-atlas/1";

/// All that is found.
#[derive(Serialize)]
pub struct Atlas {
    pub schema: &'static str,
    pub device: String,
    pub driver: String,
    /// The arithmetic of the shaders: the value of `--arithmetic`.
    pub arithmetic: String,
    /// The traversal whose triangles were tested.
    pub traversal: &'static str,
    /// The day, as 2026-11-21.
    pub date: String,
    /// Rays of each case.
    pub rays: usize,
    pub limits: Limits,
    pub rows: Vec<Row>,
    pub validation_messages: Vec<String>,
}

/// The size of the measurement.
#[derive(Clone, Copy)]
pub struct Extent {
    /// Rays of each case.
    pub rays: usize,
    /// Rays of each row that rationals alone decide, too.
    pub exact: usize,
}

/// Draws the atlas of a device that was opened with `options`.
///
/// # Errors
/// If the device fails, or lacks what the software's triangles need; if rationals contradict a proved bound.
pub fn draw(
    gpu: &Gpu,
    options: &GpuOptions,
    traversal: Traversal,
    extent: Extent,
) -> Result<Atlas> {
    if traversal == Traversal::Software
        && let Some(why) = Code::Exact.unavailable(gpu)
    {
        bail!("--traversal software cannot be had: {why}");
    }
    let Extent { rays, exact } = extent;
    let tracer = Tracer::new(gpu, What::Triangles(traversal))?;
    let boxed = Tracer::new(gpu, What::Boxes)?;
    let asked = Asked { gpu, tracer: &tracer, traversal, rays, exact };
    let mut progress = Progress::new(6, "rows");
    let mut rows = Vec::new();
    let mut add = |row: Row| {
        progress.step();
        rows.push(row);
    };
    add(triangles::row(gpu, &tracer, traversal, rays, exact)?);
    add(asked.seams()?);
    add(asked.instances()?);
    add(boxes::row(gpu, &boxed, rays, exact)?);
    add(duplicates::row(gpu, &tracer, traversal, rays, exact)?);
    let (fetched, mut messages) = corners::row(gpu, options, rays)?;
    add(fetched);
    drop(progress);
    for row in &rows {
        let (checked, beyond) = (row.checked, row.beyond);
        ensure!(
            beyond == 0,
            "the atlas contradicts itself: of {checked} rays of '{}' rationals have {beyond} beyond the bound of \
             64-bit floats; there should be none",
            row.row
        );
    }
    messages.extend(gpu.validation().all());
    Ok(Atlas {
        schema: SCHEMA,
        device: gpu.name.clone(),
        driver: gpu.driver.clone(),
        arithmetic: gpu.driver_shim.name().to_owned(),
        traversal: traversal.name(),
        date: humantime::format_rfc3339_seconds(SystemTime::now()).to_string()[..10].to_owned(),
        rays,
        limits: Limits::of(gpu),
        rows,
        validation_messages: messages,
    })
}

impl Atlas {
    /// As Markdown: a section a row.
    pub fn markdown(&self) -> String {
        let mut text = format!("# What {} computes\n\n", self.device);
        let _ = writeln!(
            text,
            "{}, {}. Arithmetic: {}; triangles: {}. {} rays a case.",
            self.driver, self.date, self.arithmetic, self.traversal, self.rays
        );
        self.rows.iter().for_each(|row| text.push_str(&row.markdown()));
        text
    }
}

/// The same numbers in every run, and others for each case (FNV-1a).
fn seed(row: &str, case: &str) -> u64 {
    let bytes = row.bytes().chain([0]).chain(case.bytes());
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    })
}
