//! A sample rendered without a window, picture by picture.

use std::ops::Range;
use std::time::{Duration, Instant};

use anyhow::{Result, bail};
use ash::vk;

use super::bands::{self, Bands};
use super::{Args, Picture, Program, RunHooks, Sample, Setup, controls, files};
use crate::gpu::{Gpu, Image, Messages, Timer};
use crate::output;

/// A sample on its device, and its picture.
pub struct Run<'a> {
    /// The sample's name.
    pub name: &'static str,
    /// The command line.
    pub args: &'a Args,
    /// The sample, all controls set.
    pub sample: Box<dyn Sample>,
    /// The image it renders to.
    pub image: Image,
    /// The frames to render, by [`Frame::index`](super::Frame::index).
    pub frames: Vec<Range<u32>>,
    /// True if each frame is a separate picture, rather than a part of one that accumulates.
    pub apart: bool,
    /// Milliseconds of each frame, and of each of its bands.
    pub times: Vec<Vec<f64>>,
    /// From the start of the run to the end of the first frame.
    pub first_frame: Duration,
    /// Called after each band of a frame except the last; an error ends the frame.
    pub between_bands: Box<dyn Fn() -> Result<()>>,
    bands: Bands,
    timer: Timer,
    start: Instant,
    /// The device.
    pub gpu: Gpu,
}

impl<'a> Run<'a> {
    /// Opens a device, makes the sample and sets its controls.
    ///
    /// # Errors
    /// If there is no such device, or a file or a setting is wrong.
    pub fn new(
        program: &Program,
        args: &'a Args,
        hooks: &dyn RunHooks,
        start: Instant,
    ) -> Result<Self> {
        let mut options = args.device((program.requirements)());
        hooks.device(&mut options);
        let gpu = Gpu::new(&options)?;
        files::check_size(&gpu, args.size)?;
        let setup = Setup::new(args);
        let mut sample = (program.make)(&gpu, &setup)?;
        setup.check()?;
        files::check_scene(args)?;
        controls::check(|c| sample.controls(c))?;
        controls::set_all(&args.sets, |c| sample.controls(c))?;
        let names = args.sets.iter().map(|(name, _)| &**name);
        output::warn(&controls::without_effect(names, |c| sample.controls(c)));
        for (_, (name, text)) in &args.then {
            // A setting before this one may declare the control.
            let alone = args.then.iter().all(|(_, (other, _))| other == name);
            controls::try_to_set(name, text, alone, |c| sample.controls(c))?;
        }
        Ok(Self {
            name: program.name,
            args,
            sample,
            image: Image::storage(&gpu, "picture", args.size)?,
            frames: std::iter::once(0..args.frames).collect(),
            apart: false,
            times: Vec::new(),
            first_frame: Duration::ZERO,
            between_bands: Box::new(|| Ok(())),
            bands: Bands::default(),
            timer: Timer::new(&gpu)?,
            start,
            gpu,
        })
    }

    /// Prints a line for each control: name, kind, possible values, current value.
    ///
    /// # Errors
    /// If the lines cannot be written.
    pub fn list_controls(&mut self) -> Result<()> {
        for control in controls::list(|c| self.sample.controls(c)) {
            let controls::Listed { name, kind, possible, value } = control;
            // The possible values may include names from a scene file.
            let cells = [&*name, kind, &*possible, &*value].map(output::plain);
            output::print(&(cells.join("\t") + "\n"))?;
        }
        Ok(())
    }

    /// Prints a line for each record of the shader binding tables: pipeline, record, shaders, what asks for it.
    ///
    /// # Errors
    /// If the sample's pipelines cannot be built, or the lines cannot be written.
    pub fn list_records(&mut self) -> Result<()> {
        self.sample.changed(&self.gpu)?;
        // Many samples build their pipelines only for a frame: one pixel is enough.
        let pixel = vk::Extent2D { width: 1, height: 1 };
        self.image = Image::storage(&self.gpu, "picture", pixel)?;
        self.render(0)?;
        let statistics = self.gpu.statistics();
        for table in &statistics.tables {
            for line in table.lines(&statistics.asked) {
                let cells: Vec<_> = line.split('\t').map(output::plain).collect();
                output::print(&(cells.join("\t") + "\n"))?;
            }
        }
        Ok(())
    }

    /// Sets the controls that `--then` names for a frame, by its place in the run; returns true if there are any.
    ///
    /// # Errors
    /// If there is no such control or value, or the sample fails.
    pub fn set_before(&mut self, frame: u32) -> Result<bool> {
        let due = self.args.then.iter().filter(|(at, _)| *at == frame);
        let sets: Vec<_> = due.map(|(_, set)| set.clone()).collect();
        if sets.is_empty() {
            return Ok(false);
        }
        controls::set_all(&sets, |c| self.sample.controls(c))?;
        let names = sets.iter().map(|(name, _)| &**name);
        output::warn(&controls::without_effect(names, |c| self.sample.controls(c)));
        self.sample.changed(&self.gpu)?;
        Ok(true)
    }

    /// Renders the frame with this number.
    ///
    /// # Errors
    /// If the sample or the device fails, or the first error of [`Run::between_bands`].
    pub fn render(&mut self, index: u32) -> Result<()> {
        let accumulated = if self.apart { 0 } else { index };
        let Self { sample, image, bands, timer, gpu, between_bands, .. } = self;
        // Nothing has changed since the frame before, unless this one is the first.
        bands.begin(image.extent, index > 0);
        while bands.trace(&mut **sample, (gpu, timer, None), (image, index, accumulated))?.is_some()
        {
            between_bands()?;
        }
        self.times.push(self.bands.times.clone());
        if self.first_frame.is_zero() {
            self.first_frame = self.start.elapsed();
        }
        Ok(())
    }

    /// As [`Run::render`], with the costs in `bands`, and without adding the time to [`Run::times`]; returns its
    /// milliseconds. The frame is number `index` of a picture that accumulates since number 0.
    ///
    /// # Errors
    /// As [`Run::render`].
    pub fn time(&mut self, bands: &mut Bands, index: u32) -> Result<f64> {
        self.sample.changed(&self.gpu)?;
        bands.begin(self.image.extent, true);
        let device = (&self.gpu, &self.timer, None);
        while bands.trace(&mut *self.sample, device, (&self.image, index, index))?.is_some() {}
        Ok(bands.times.iter().sum())
    }

    /// Traces a single pixel of the frame with this number, with the same result as in the whole frame.
    ///
    /// # Errors
    /// If the sample or the device fails.
    pub fn trace_pixel(&mut self, pixel: [u32; 2], index: u32) -> Result<()> {
        let frame = (&self.image, index, if self.apart { 0 } else { index });
        bands::trace_pixel(&mut *self.sample, &self.gpu, frame, pixel)
    }

    /// The last frame.
    ///
    /// # Errors
    /// If the copy fails.
    pub fn picture(&self) -> Result<Picture> {
        let (width, height) = (self.image.extent.width, self.image.extent.height);
        Ok(Picture { width, height, pixels: self.image.read()? })
    }

    /// Closes the device.
    ///
    /// # Errors
    /// If validation reported a message, for example a leak.
    pub fn close(self) -> Result<()> {
        let validation = self.gpu.validation();
        drop(self);
        check_validation(&validation)
    }
}

/// Fails if validation has reported a message.
///
/// # Errors
/// States the number of messages and the first one.
pub fn check_validation(validation: &Messages) -> Result<()> {
    match validation.all().as_slice() {
        [] => Ok(()),
        messages => bail!("{} validation messages; the first: {}", messages.len(), messages[0]),
    }
}
