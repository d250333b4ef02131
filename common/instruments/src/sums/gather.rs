//! A long render: samples of one picture, summed exactly, stored in a file, and continued another day.
//!
//! A frame is one sample of every pixel and depends on its number alone. A compute shader adds it to the sums. So
//! it does not matter which machine renders which sample, when, or in how many pieces.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Weak};
use std::time::{Duration, Instant};

use anyhow::{Context, Result, anyhow, bail, ensure};
use ash::vk;
use glam::UVec2;

use super::{Header, Origin, SampleSet, Spoiled, Sums, range};
use common::UsageError;
use common::app::{Args, Run, controls};
use common::exit::{Interrupt, Stopped};
use common::gpu::{
    Address, Binding, Buffer, ComputePipeline, Descriptor, Gpu, Image, PipelineDesc, barrier,
};
use common::model::text::{opened, shown};
use common::{files, output};

/// The samples to render, and the file for their sums.
#[derive(Clone, Debug, Default, clap::Args)]
#[group(skip)]
pub struct Options {
    /// Without a window, render the samples A to B-1 of a picture that is the mean of many; the output is their exact mean
    #[arg(long, value_name = "A..B", value_parser = range, allow_hyphen_values = true, conflicts_with_all = ["frames", "compare", "animate", "then"])]
    pub samples: Option<Range<u32>>,

    /// With --samples, store their exact sums in this file: every --save-every seconds, at the end, and at Ctrl-C
    #[arg(long, value_name = "FILE")]
    pub save: Option<PathBuf>,

    /// With --samples, start from the sums in this file and render the missing samples; the output is the mean of both. With --save of the same name, it need not exist yet
    #[arg(long, value_name = "FILE", requires = "samples")]
    pub resume: Option<PathBuf>,

    /// Seconds from one --save to the next; 0 saves after each sample
    #[arg(long, value_name = "SECONDS", default_value = "60", value_parser = seconds, requires = "save", allow_hyphen_values = true)]
    pub save_every: u64,
}

fn seconds(text: &str) -> Result<u64, String> {
    text.parse().map_err(|_| "seconds are a whole number, such as 60".to_owned())
}

impl Options {
    /// Refuses sums of no samples; sums under the name of a picture, which no viewer could open; and a render that
    /// would lose its samples, perhaps after days.
    ///
    /// # Errors
    /// [`UsageError`], with the correct form.
    pub fn check(&self, is_kept: bool) -> Result<(), UsageError> {
        if let (Some(path), None) = (&self.save, &self.samples) {
            let path = path.display();
            return Err(UsageError(format!(
                "--save {path} stores sums of samples: add --samples A..B; --out FILE writes a picture"
            )));
        }
        let others = ["png", "exr", "jpg", "jpeg", "tif", "tiff", "json"];
        if let Some(path) = &self.save {
            let ends = |end: &&str| path.extension().is_some_and(|it| it.eq_ignore_ascii_case(end));
            if others.iter().any(ends) || path.as_os_str() == "-" {
                return Err(UsageError(format!(
                    "--save {}: sums of samples are not a picture: name the file .sums; --out writes a picture",
                    path.display()
                )));
            }
        }
        if self.samples.is_some() && self.save.is_none() && !is_kept {
            return Err(UsageError(
                "--samples would store nothing: add --out for the picture or --save for the sums"
                    .to_owned(),
            ));
        }
        Ok(())
    }
}

/// Width and height of a workgroup.
const WORKGROUP: [u32; 2] = [8, 8];

common::shader_struct! {
    /// Push constants of the shader that adds samples.
    struct Push {
        sums: Address,
        size: UVec2,
    }
}

/// Sums on the device, and their destination.
pub struct Gather {
    header: Header,
    /// The samples still to be rendered.
    missing: SampleSet,
    sums: Buffer,
    pipeline: ComputePipeline,
    /// The file, and the interval at which it is written.
    save: Option<(PathBuf, Duration)>,
    saved: Instant,
    interrupt: Option<Arc<Interrupt>>,
    /// The name of the resumed file, for messages.
    resumed: String,
    /// True if this run has added a sample; the shaders are checked then.
    has_added: Arc<AtomicBool>,
}

/// Reads the file of `--resume`, and refuses options early that would fail after the work.
///
/// # Errors
/// If it is not a file of sums, or `--save` would overwrite samples that are not resumed.
pub fn resumed(options: &Options) -> Result<Option<Sums>> {
    let (save, resume) = (options.save.as_deref(), options.resume.as_deref());
    let is_there = |path: &Path| path.symlink_metadata().is_ok();
    if let Some(save) =
        save.filter(|save| !resume.is_some_and(|it| files::same(it, save)) && is_there(save))
    {
        let name = shown(save);
        if Sums::begins(save) {
            bail!("'{name}' exists: --resume '{name}' continues it");
        }
        bail!("'{name}' exists and was not written by --save: choose another name");
    }
    // The same command starts and continues a render: a batch system repeats it unchanged.
    let resume = resume
        .filter(|resume| !save.is_some_and(|save| files::same(save, resume)) || is_there(resume));
    resume.map(Sums::open).transpose()
}

impl Gather {
    /// Begins a run of `--samples`, with the sums of an earlier run if there are any.
    ///
    /// # Errors
    /// If the sample does not gather, the earlier sums do not fit, or memory is short.
    pub fn begin(
        options: &Options,
        samples: Range<u32>,
        run: &mut Run,
        resumed: Option<Sums>,
    ) -> Result<Self> {
        let (name, args) = (run.name, run.args);
        if !run.sample.gathers() {
            // All chapters that support it do so by default: without settings, this is not one of them.
            let when = if args.sets.is_empty() { "" } else { " with these values of --set" };
            let why = "each of its frames is a picture by itself, not a sample of one";
            let which = "docs/long-renders.md names the chapters that gather samples";
            return Err(UsageError(format!("{name} has no --samples{when}: {why}; {which}")).into());
        }
        let interrupt = options.save.as_ref().map(|_| Arc::new(Interrupt::listen()));
        let origin = origin(run)?;
        let gpu = &run.gpu;
        let pixels = args.size.width as usize * args.size.height as usize;
        let file = options.resume.as_deref().map(shown).unwrap_or_default();
        let sums = match resumed {
            Some(sums) => {
                fit(&file, &sums.header.origin, &origin)?;
                sums
            }
            None => {
                Sums { header: Header { origin, ..Header::default() }, values: vec![0; 4 * pixels] }
            }
        };
        Ok(Self {
            missing: sums.header.samples.missing(samples),
            sums: buffer(gpu, &sums)?,
            header: sums.header,
            pipeline: pipeline(gpu)?,
            save: options.save.clone().map(|file| (file, Duration::from_secs(options.save_every))),
            saved: Instant::now(),
            interrupt,
            resumed: file,
            has_added: Arc::default(),
        })
    }

    /// The samples still to be rendered.
    pub fn missing(&self) -> &SampleSet {
        &self.missing
    }

    /// For [`Run::between_bands`]: allows stopping during the first sample of a run.
    ///
    /// # Errors
    /// [`Stopped`] if a signal came before there is anything new to save.
    pub fn stop(&self) -> Box<dyn Fn() -> Result<()>> {
        let interrupt = self.interrupt.as_ref().map_or_else(Weak::new, Arc::downgrade);
        let has_added = self.has_added.clone();
        Box::new(move || {
            let came = interrupt.upgrade().is_some_and(|interrupt| interrupt.came());
            if came && !has_added.load(Ordering::Relaxed) {
                let what = "stopped before the first sample: nothing is saved";
                return Err(Stopped(what.to_owned()).into());
            }
            Ok(())
        })
    }

    /// Adds the sample of this number, the current picture; writes the file if that is due.
    ///
    /// # Errors
    /// If the device or the disk fails, or the shaders differ from those of the sums so far; [`Stopped`] if a
    /// signal came, after writing the file.
    pub fn add(&mut self, gpu: &Gpu, picture: &Image, index: u32) -> Result<()> {
        self.check_shaders(gpu)?;
        let extent = picture.extent;
        gpu.submit(|cmd| {
            let size = UVec2::new(extent.width, extent.height);
            let push = Push { sums: self.sums.address.into(), size };
            self.pipeline.bind(cmd, &[Descriptor::StorageImage(picture)], &push)?;
            self.pipeline.dispatch(cmd, extent.into());
            barrier::trace_to_trace(gpu, cmd);
            Ok(())
        })?;
        let added = self.header.samples.add(&(index..index + 1).into());
        added.map_err(|both| anyhow!("samples {both} are already in the sums"))?;
        let stop = self.interrupt.as_ref().is_some_and(|interrupt| interrupt.came());
        let Some((file, every)) = &self.save else { return Ok(()) };
        if stop || self.saved.elapsed() >= *every {
            let kept = self.read()?.save_unless_behind(file)?;
            self.saved = Instant::now();
            if stop {
                let name = shown(file);
                let hint = format!("--resume '{name}' continues");
                return Err(Stopped(format!("stopped: '{name}' has samples {kept}; {hint}")).into());
            }
        }
        Ok(())
    }

    /// Compares the shaders with those of the sums so far. They are known only now, because a sample creates its
    /// pipelines when it renders.
    fn check_shaders(&mut self, gpu: &Gpu) -> Result<()> {
        if self.has_added.swap(true, Ordering::Relaxed) {
            return Ok(());
        }
        let shaders = Some(crc_of(&gpu.statistics().descs));
        let here = Origin { shaders, ..self.header.origin.clone() };
        fit(&self.resumed, &self.header.origin, &here)?;
        self.header.origin = here;
        Ok(())
    }

    /// Writes the file, if there is one, and returns the sums.
    ///
    /// # Errors
    /// If the disk or the device fails.
    pub fn finish(self) -> Result<Sums> {
        let sums = self.read()?;
        if let Some((file, _)) = &self.save {
            let kept = sums.save_unless_behind(file)?;
            ensure!(
                kept == sums.header.samples,
                "'{}' has samples {kept} of another run and is left unchanged; this run's are not saved",
                shown(file)
            );
        }
        let [width, _] = sums.header.origin.size;
        output::warn(&Vec::from_iter(sums.header.spoiled.warning(width)));
        Ok(sums)
    }

    fn read(&self) -> Result<Sums> {
        let mut values: Vec<i128> = self.sums.read()?;
        let notes = values.remove(0);
        let first = !((notes >> 64) as u32);
        let spoiled =
            Spoiled { count: notes as u64, first: Some(first).filter(|_| first < u32::MAX) };
        Ok(Sums { header: Header { spoiled, ..self.header.clone() }, values })
    }
}

impl Sums {
    /// Writes the file, unless another run has put more into it: then that stays. Returns its contents.
    fn save_unless_behind(&self, path: &Path) -> Result<SampleSet> {
        let there = Header::open(path).ok();
        let there = there.filter(|there| self.header.origin.difference(&there.origin).is_none());
        if let Some(there) = there.filter(|there| !self.header.samples.contain(&there.samples)) {
            return Ok(there.samples);
        }
        self.save(path)?;
        Ok(self.header.samples.clone())
    }
}

/// Sums in their form for the device, after the notes.
fn buffer(gpu: &Gpu, sums: &Sums) -> Result<Buffer> {
    let Spoiled { count, first } = sums.header.spoiled;
    let notes = i128::from(count) | i128::from(!first.unwrap_or(u32::MAX)) << 64;
    let mut values = Vec::new();
    values.try_reserve_exact(1 + sums.values.len()).context("no memory for the sums")?;
    values.push(notes);
    values.extend_from_slice(&sums.values);
    let usage = vk::BufferUsageFlags::STORAGE_BUFFER
        | vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS
        | vk::BufferUsageFlags::TRANSFER_SRC;
    Buffer::with_data(gpu, "sums", &values, usage)
}

fn pipeline(gpu: &Gpu) -> Result<ComputePipeline> {
    ComputePipeline::builder("common")
        .compute("gather.comp")
        .workgroup(0, WORKGROUP)
        .binding(Binding::StorageImage)
        .push_constants::<Push>()
        .build_compute(gpu)
}

/// Everything a picture depends on, except the shaders, which are not compiled yet.
fn origin(run: &mut Run) -> Result<Origin> {
    let controls = controls::list(|c| run.sample.controls(c));
    let Run { name, args, gpu, .. } = run;
    let args: &Args = args;
    let mut settings: BTreeMap<_, _> =
        controls.into_iter().map(|control| (control.name, control.value)).collect();
    // If a name is given twice, one control decided what the next applied to, and no longer shows that.
    let names = || args.sets.iter().map(|(name, _)| name);
    if names().enumerate().any(|(i, name)| names().take(i).any(|before| before == name)) {
        let sets: Vec<_> =
            args.sets.iter().map(|(name, value)| format!("{name}={value}")).collect();
        settings.insert("--set".to_owned(), sets.join("; "));
    }
    let mut scene = BTreeMap::new();
    for path in opened() {
        let crc = Sums::crc_of(&path)?;
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        // Two files of one name, from two folders, are counted together.
        let both = |known: &mut u32| {
            *known = crc32fast::hash(&[known.to_le_bytes(), crc.to_le_bytes()].concat());
        };
        scene.entry(name).and_modify(both).or_insert(crc);
    }
    Ok(Origin {
        chapter: (*name).to_owned(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        size: [args.size.width, args.size.height],
        settings,
        scene,
        unordered: args.unordered,
        shaders: None,
        device: gpu.name.clone(),
        driver: gpu.driver.clone(),
        arithmetic: gpu.driver_shim.name().to_owned(),
    })
}

/// The CRC-32 of the SPIR-V and the constants of pipelines.
fn crc_of(pipelines: &[Arc<PipelineDesc>]) -> u32 {
    let mut hasher = crc32fast::Hasher::new();
    for PipelineDesc { stages, constants, .. } in pipelines.iter().map(AsRef::as_ref) {
        stages.iter().for_each(|stage| hasher.update(bytemuck::cast_slice(&stage.words)));
        hasher.update(bytemuck::cast_slice(constants));
    }
    hasher.finalize()
}

/// Fails if a file's origin differs from that of this run.
fn fit(file: &str, theirs: &Origin, ours: &Origin) -> Result<()> {
    let difference = theirs.difference(ours);
    let line = difference.map(|difference| difference.line(["in it", "here"]));
    ensure!(line.is_none(), "{file} does not fit: {}", line.unwrap_or_default());
    Ok(())
}
