//! A run without a window: set controls, render frames, write picture and report.

use std::io::IsTerminal;
use std::path::Path;
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail};
use ash::vk;
use indicatif::{ProgressBar, ProgressStyle};

use super::args::Args;
use super::{Format, Frame, Milliseconds, Picture, Report, Sample, Setup, compare, controls};
use crate::gpu::{Gpu, GpuOptions, Image, Timer, barrier};
use crate::usage::Usage;

/// How long a run may take before it shows its progress.
const PATIENCE: Duration = Duration::from_secs(1);

/// Renders `args.frames` frames of a sample and writes what `args` asks for.
///
/// # Errors
/// On wrong arguments ([`Usage`]), if anything fails, or if validation had something to say.
pub fn headless<S: Sample>(name: &str, args: &Args) -> Result<()> {
    let start = Instant::now();
    // What would be refused after the work is refused before it.
    args.out.as_deref().map(Format::of).transpose()?;
    for file in [&args.out, &args.report].into_iter().flatten() {
        check_writable(file)?;
    }
    let comparison = args.compare.as_deref().map(compare::parse).transpose()?;
    let gpu = Gpu::new(&GpuOptions {
        requirements: S::requirements(),
        device: args.device.as_deref(),
        validate: args.validate,
        surface_extensions: Vec::new(),
    })?;
    check_size(&gpu, args.size)?;
    let setup = Setup::new(args);
    let mut sample = S::new(&gpu, &setup)?;
    setup.check()?;
    for (control, value) in &args.sets {
        controls::set(control, value, |c| sample.controls(c))?;
    }
    if args.list_controls {
        for control in controls::list(|c| sample.controls(c)) {
            let controls::Listed { name, kind, possible, value } = control;
            println!("{name}\t{kind}\t{possible}\t{value}");
        }
        return Ok(());
    }

    let image = Image::storage(&gpu, "picture", args.size)?;
    let timer = Timer::new(&gpu)?;
    let render = |sample: &mut S, index| {
        gpu.submit(|cmd| {
            timer.start(cmd);
            sample.render(&Frame { gpu: &gpu, cmd, image: &image, index })?;
            timer.stop(cmd);
            barrier::trace_to_trace(&gpu, cmd);
            Ok(())
        })?;
        timer.milliseconds()
    };
    let comparison = match comparison {
        None => None,
        Some((control, values)) => {
            let turns = u64::from(args.frames) * (values.len() as u64 + 1) + values.len() as u64;
            let progress = Progress::new(turns, start);
            Some(compare::compare(&control, &values, args.frames, |value| {
                controls::set(&control, value, |c| sample.controls(c))?;
                progress.step();
                render(&mut sample, 0)
            })?)
        }
    };
    let mut times = Vec::new();
    let mut first_frame = Duration::ZERO;
    let frames = if comparison.is_some() { 1 } else { args.frames };
    let progress = Progress::new(frames.into(), start);
    for index in 0..frames {
        times.push(render(&mut sample, index)?);
        if index == 0 {
            first_frame = start.elapsed();
        }
        progress.step();
    }
    drop(progress);
    if let (Some(comparison), false) = (&comparison, args.report == Some("-".into())) {
        print!("{} · {}\n\n{}", gpu.name, gpu.driver, comparison.table());
    }

    if let Some(out) = &args.out {
        let (width, height) = (args.size.width, args.size.height);
        Picture { width, height, pixels: image.read()? }.save(out)?;
    }
    if let Some(path) = &args.report {
        let median = Milliseconds::of(&times).median;
        let pixels = f64::from(args.size.width) * f64::from(args.size.height);
        let statistics = gpu.statistics();
        Report {
            sample: name.to_owned(),
            device: gpu.name.clone(),
            driver: gpu.driver.clone(),
            width: args.size.width,
            height: args.size.height,
            frames: args.frames,
            gpu_milliseconds: Milliseconds::of(&times),
            primary_rays_per_second: if median > 0.0 { pixels / median * 1e3 } else { 0.0 },
            first_frame_milliseconds: first_frame.as_secs_f64() * 1e3,
            acceleration_structure_milliseconds: statistics.build_time.as_secs_f64() * 1e3,
            acceleration_structure_bytes: statistics.acceleration_structure_bytes,
            pipeline_milliseconds: statistics.pipeline_time.as_secs_f64() * 1e3,
            stages: statistics.stages,
            groups: statistics.groups,
            bytes_allocated: gpu.allocated_bytes(),
            validation_messages: gpu.validation_messages(),
            comparison,
            chapter: sample.report()?,
        }
        .save(path)?;
    }
    check_validation(&gpu)
}

/// Fails if validation has said anything.
///
/// # Errors
/// With the number of messages and the first.
pub fn check_validation(gpu: &Gpu) -> Result<()> {
    match gpu.validation_messages().as_slice() {
        [] => Ok(()),
        messages => bail!("{} validation messages; the first: {}", messages.len(), messages[0]),
    }
}

fn check_writable(file: &Path) -> Result<()> {
    if file == Path::new("-") {
        return Ok(());
    }
    let folder = match file.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    if file.is_dir() {
        bail!("cannot write '{}': it is a folder", file.display());
    }
    tempfile::NamedTempFile::new_in(folder)
        .map(drop)
        .with_context(|| format!("cannot write '{}'", file.display()))
}

fn check_size(gpu: &Gpu, size: vk::Extent2D) -> Result<(), Usage> {
    let side = gpu.limits.max_image_dimension;
    let rays = u64::from(gpu.limits.max_ray_dispatch_invocation_count);
    let fits = size.width <= side
        && size.height <= side
        && u64::from(size.width) * u64::from(size.height) <= rays;
    if fits {
        return Ok(());
    }
    let (width, height) = (size.width, size.height);
    Err(Usage(format!(
        "{width}x{height} is too large for {}: at most {side} a side and {rays} pixels",
        gpu.name
    )))
}

/// A bar on standard error, once the run has taken a while and if someone can see it.
struct Progress {
    bar: ProgressBar,
    start: Instant,
}

impl Progress {
    fn new(frames: u64, start: Instant) -> Self {
        let bar = ProgressBar::hidden();
        bar.set_length(frames);
        let style = ProgressStyle::with_template("{bar:40} {pos}/{len} frames, {eta} left");
        Self { bar: style.map_or(bar.clone(), |style| bar.with_style(style)), start }
    }

    fn step(&self) {
        let visible = self.start.elapsed() > PATIENCE && std::io::stderr().is_terminal();
        if self.bar.is_hidden() && visible {
            self.bar.set_draw_target(indicatif::ProgressDrawTarget::stderr());
        }
        self.bar.inc(1);
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
