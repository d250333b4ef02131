//! A run without a window: set controls, render frames, write picture and report.

use std::collections::HashMap;
use std::path::Path;
use std::time::{Duration, Instant};

use anyhow::{Result, bail};
use ash::vk;

use super::args::Args;
use super::bands::Bands;
use super::gather::{self, Gather};
use super::{
    Format, Milliseconds, Picture, Progress, Report, Sample, Setup, compare, compile_for, controls,
    output,
};
use crate::files;
use crate::gpu::{Gpu, GpuOptions, Image, Messages, Timer};
use crate::scene::text;
use crate::usage::Usage;

/// Renders `args.frames` frames of a sample and writes what `args` asks for.
///
/// # Errors
/// On wrong arguments ([`Usage`]), if anything fails, or if validation had something to say.
pub fn headless<S: Sample>(name: &str, args: &Args) -> Result<()> {
    let start = Instant::now();
    check_files(args)?;
    let resumed = gather::resumed(args)?;
    let comparison = args.compare.as_deref().map(compare::parse).transpose()?;
    let requirements = match args.compiler_figures {
        true => S::requirements().compiler_figures_where_offered(),
        false => S::requirements(),
    };
    let gpu = Gpu::new(&GpuOptions {
        requirements,
        device: args.device.as_deref(),
        validate: args.validate,
        window: None,
        arithmetic: args.arithmetic,
    })?;
    check_size(&gpu, args.size)?;
    let setup = Setup::new(args);
    let mut sample = S::new(&gpu, &setup)?;
    setup.check()?;
    check_scene(args)?;
    controls::set_all(&args.sets, |c| sample.controls(c))?;
    if args.list_controls {
        for control in controls::list(|c| sample.controls(c)) {
            let controls::Listed { name, kind, possible, value } = control;
            // What is possible may be the names of a scene's materials.
            let cells = [&*name, kind, &*possible, &*value].map(output::plain);
            output::print(&(cells.join("\t") + "\n"))?;
        }
        return Ok(());
    }

    let image = Image::storage(&gpu, "picture", args.size)?;
    let timer = Timer::new(&gpu)?;
    let heed = |gather: &Option<Gather>| gather.as_ref().map_or(Ok(()), Gather::heed);
    let render = |sample: &mut S,
                  bands: &mut Bands,
                  frame: (u32, u32),
                  gather: &Option<Gather>|
     -> Result<f64> {
        bands.begin(args.size, true);
        let frame = (&image, frame.0, frame.1);
        let mut sum = 0.0;
        while let Some(milliseconds) = bands.trace(sample, (&gpu, &timer), frame)? {
            sum += milliseconds;
            heed(gather)?;
        }
        Ok(sum)
    };
    let comparison = match comparison {
        None => None,
        Some((control, values)) => {
            let turns = u64::from(args.frames) * (values.len() as u64 + 1) + values.len() as u64;
            let progress = Progress::new(turns, "frames");
            // What a picture costs is known of each value.
            let mut bands = HashMap::<_, Bands>::new();
            Some(compare::compare(&control, &values, args.frames, |value| {
                controls::set_beside(&args.sets, &control, value, |c| sample.controls(c))?;
                progress.step();
                sample.changed(&gpu)?;
                render(&mut sample, bands.entry(value.to_owned()).or_default(), (0, 0), &None)
            })?)
        }
    };
    let mut gather = match args.samples.clone() {
        Some(samples) => Some(Gather::begin((name, args, samples), &gpu, &mut sample, resumed)?),
        None => None,
    };
    let frames = match &gather {
        Some(gather) => gather.missing(),
        None if comparison.is_some() => (0..1).into(),
        None => (0..args.frames).into(),
    };
    let mut times = Vec::new();
    let mut first_frame = Duration::ZERO;
    let progress = Progress::new(frames.count(), gather.as_ref().map_or("frames", |_| "samples"));
    let mut bands = Bands::default();
    let mut band_times = Vec::new();
    sample.changed(&gpu)?;
    for (number, index) in frames.ranges().iter().cloned().flatten().enumerate() {
        if let (true, Some(playback)) = (number > 0, sample.playback()) {
            playback.advance(1);
        }
        // Samples are pictures alone: their mean is the sums'.
        let accumulated = gather.as_ref().map_or(index, |_| 0);
        times.push(render(&mut sample, &mut bands, (index, accumulated), &gather)?);
        band_times.extend(&bands.times);
        if first_frame.is_zero() {
            first_frame = start.elapsed();
        }
        if let Some(gather) = &mut gather {
            gather.add(&gpu, &image, index)?;
        }
        progress.step();
    }
    drop(progress);
    let gathered = gather.map(Gather::finish).transpose()?;
    if let (Some(comparison), false) = (&comparison, args.report == Some("-".into())) {
        output::print(&format!("{} · {}\n\n{}", gpu.name, gpu.driver, comparison.table()))?;
    }

    let compiled_for = match args.compile_for {
        Some(family) => compile_for::compile_for(family, &gpu.statistics().blueprints)?,
        None => Vec::new(),
    };
    if args.compile_for.is_some() && args.report != Some("-".into()) {
        output::print(&compile_for::table(&compiled_for))?;
    }

    if let Some(out) = &args.out {
        let (width, height) = (args.size.width, args.size.height);
        let picture = match &gathered {
            Some(sums) => sums.mean(),
            None => Picture { width, height, pixels: image.read()? },
        };
        picture.save(out)?;
    }
    if let Some(path) = &args.report {
        let median = Milliseconds::of(&times).median;
        let pixels = f64::from(args.size.width) * f64::from(args.size.height);
        let statistics = gpu.statistics();
        Report {
            sample: name.to_owned(),
            device: gpu.name.clone(),
            driver: gpu.driver.clone(),
            limits: gpu.limits,
            arithmetic: gpu.arithmetic.to_string(),
            width: args.size.width,
            height: args.size.height,
            frames: gathered.as_ref().map_or(args.frames, |_| times.len() as u32),
            gpu_milliseconds: Milliseconds::of(&times),
            bands: bands.times.len(),
            band_milliseconds: Milliseconds::of(&band_times),
            primary_rays_per_second: if median > 0.0 { pixels / median * 1e3 } else { 0.0 },
            first_frame_milliseconds: first_frame.as_secs_f64() * 1e3,
            acceleration_structure_milliseconds: statistics.build_time.as_secs_f64() * 1e3,
            acceleration_structure_bytes: statistics.acceleration_structure_bytes,
            pipeline_milliseconds: statistics.pipeline_time.as_secs_f64() * 1e3,
            stages: statistics.stages,
            groups: statistics.groups,
            bytes_allocated: gpu.allocated_bytes(),
            validation_messages: gpu.validation().all(),
            comparison,
            compiled_for,
            executables: statistics.executables,
            chapter: sample.report()?,
        }
        .save(path)?;
    }
    // Messages about what was never destroyed come when the device is.
    let validation = gpu.validation();
    drop((sample, image, timer, gpu));
    check_validation(&validation)
}

/// Fails if validation has said anything.
///
/// # Errors
/// With the number of messages and the first.
pub fn check_validation(validation: &Messages) -> Result<()> {
    match validation.all().as_slice() {
        [] => Ok(()),
        messages => bail!("{} validation messages; the first: {}", messages.len(), messages[0]),
    }
}

/// Refuses before the work what would be refused after it: a picture or report that cannot be written,
/// or one file for both.
///
/// # Errors
/// With the file, and why.
pub fn check_files(args: &Args) -> Result<()> {
    args.out.as_deref().map(Format::of).transpose()?;
    let files = outputs(args);
    let inputs = [("--scene", args.scene.as_deref()), ("--resume", args.resume.as_deref())];
    for (i, (name, file)) in files.iter().enumerate() {
        files::check_writable(file)?;
        if let Some((other, _)) = files[..i].iter().find(|(_, other)| files::same(other, file)) {
            let file = file.display();
            return Err(Usage(format!("{other} and {name} both name '{file}'")).into());
        }
        // Only sums are written into the file from which they come.
        let mut read = inputs.iter().filter(|(input, _)| (*input, *name) != ("--resume", "--save"));
        if let Some((input, _)) = read.find(|(_, it)| it.is_some_and(|it| files::same(it, file))) {
            let file = file.display();
            return Err(Usage(format!("{input} and {name} both name '{file}'")).into());
        }
    }
    let is_json = |path: &Path| path.extension().is_some_and(|it| it.eq_ignore_ascii_case("json"));
    let report = files.iter().find(|(name, _)| *name == "--report");
    if let Some((_, report)) = report.filter(|(_, path)| !is_json(path)) {
        let line = "a report is .json, or - for standard output";
        bail!(Usage(format!("--report {}: {line}", report.display())));
    }
    Ok(())
}

/// The files that a run writes, each with its option.
fn outputs(args: &Args) -> Vec<(&'static str, &Path)> {
    let report = args.report.as_deref().filter(|path| *path != Path::new("-"));
    let files =
        [("--out", args.out.as_deref()), ("--report", report), ("--save", args.save.as_deref())];
    files.into_iter().filter_map(|(name, file)| Some((name, file?))).collect()
}

/// Fails if an output is one of the scene's files: what they are is known only once they were opened.
fn check_scene(args: &Args) -> Result<(), Usage> {
    let opened = text::opened();
    let mut outputs = outputs(args).into_iter();
    match outputs.find(|(_, file)| opened.iter().any(|read| files::same(read, file))) {
        Some((name, file)) => {
            Err(Usage(format!("{name} names '{}', a file of the scene", file.display())))
        }
        None => Ok(()),
    }
}

/// Fails if a picture is larger than the device allows.
///
/// # Errors
/// With what it allows.
pub fn check_size(gpu: &Gpu, size: vk::Extent2D) -> Result<(), Usage> {
    if gpu.limits.fits(size) {
        return Ok(());
    }
    let (side, rays) =
        (gpu.limits.max_image_dimension, gpu.limits.max_ray_dispatch_invocation_count);
    let (width, height) = (size.width, size.height);
    Err(Usage(format!(
        "{width}x{height} is too large for {}: at most {side} a side and {rays} pixels",
        gpu.name
    )))
}

#[cfg(test)]
mod tests {
    use std::sync::Mutex;

    use clap::Parser;

    use super::*;
    use crate::app::{Controls, Frame};
    use crate::gpu::Requirements;

    /// A sample that notes what it was asked to build, and of which frames it was asked for.
    #[derive(Default)]
    struct Noting {
        preset: u32,
        height: u32,
    }

    static NOTES: Mutex<Vec<String>> = Mutex::new(Vec::new());

    impl Sample for Noting {
        fn requirements() -> Requirements {
            Requirements::ray_tracing()
        }

        fn new(_: &Gpu, _: &Setup) -> Result<Self> {
            Ok(Self::default())
        }

        fn controls(&mut self, c: &mut Controls) {
            if c.integer("preset", &mut self.preset, 0..=9) {
                self.height = 10 * self.preset;
            }
            c.integer("height", &mut self.height, 0..=99);
        }

        fn changed(&mut self, _: &Gpu) -> Result<()> {
            NOTES.lock().unwrap().push(format!("build {}, {}", self.preset, self.height));
            Ok(())
        }

        fn render(&mut self, frame: &Frame) -> Result<()> {
            NOTES.lock().unwrap().push(format!("frame {}", frame.index));
            Ok(())
        }
    }

    fn notes(args: &[&str]) -> Vec<String> {
        let args = ["test", "--headless", "--size", "8x8"].iter().chain(args);
        headless::<Noting>("test", &Args::try_parse_from(args).unwrap()).unwrap();
        let mut notes = std::mem::take(&mut *NOTES.lock().unwrap());
        // A frame is asked for once for each of its bands.
        notes.dedup();
        notes
    }

    #[test]
    fn what_settings_ask_for_is_built_once_before_the_first_frame() {
        assert_eq!(notes(&[]), ["build 0, 0", "frame 0"]);
        for sets in [["height=3", "preset=2"], ["preset=2", "height=3"]] {
            let built = notes(&["--set", sets[0], "--set", sets[1], "--frames", "2"]);
            assert_eq!(built, ["build 2, 3", "frame 0", "frame 1"], "{sets:?}");
        }
        let compared = notes(&["--compare", "preset=1|2"]);
        assert_eq!(compared[..4], ["build 1, 10", "frame 0", "build 2, 20", "frame 0"]);
    }
}
