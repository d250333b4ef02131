//! A sample's picture in a window: rendered at the size that the moment allows.

use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::{Context, Result, bail};
use ash::vk;

use super::facts::Facts;
use super::pace::{Hands, Pace, Step};
use crate::app::{Frame, Picture, Sample};
use crate::gpu::{Gpu, Image, Timer, barrier};

/// The sample and its last picture.
pub struct View<S> {
    /// The sample.
    pub sample: S,
    /// The last picture.
    pub image: Image,
    pace: Pace,
    timer: Timer,
    index: u32,
    changed: bool,
    milliseconds: f64,
    full: vk::Extent2D,
    picture_due: bool,
    gpu: Gpu,
}

/// What came of a step of the view.
pub enum Stepped {
    /// A new picture, and what the device took for it.
    New {
        /// Device time.
        milliseconds: f64,
        /// Whether it is full size.
        full: bool,
        /// Whether that was the time of tracing alone: the first picture also compiles.
        telling: bool,
    },
    /// The last picture still shows how things stand; something may be due then.
    Kept(Option<Instant>),
}

impl<S: Sample> View<S> {
    /// A view that has rendered nothing yet.
    ///
    /// # Errors
    /// If the device has no memory left for it.
    pub fn new(gpu: &Gpu, sample: S) -> Result<Self> {
        let nothing = vk::Extent2D { width: 1, height: 1 };
        Ok(Self {
            sample,
            image: Image::storage(gpu, "picture", nothing)?,
            pace: Pace::new(gpu.software, Instant::now()),
            timer: Timer::new(gpu)?,
            index: 0,
            changed: true,
            milliseconds: 0.0,
            full: nothing,
            picture_due: false,
            gpu: gpu.clone(),
        })
    }

    /// The picture no longer shows how things stand.
    pub fn change(&mut self) {
        self.changed = true;
        self.pace.change(Instant::now());
    }

    /// Someone is at the controls.
    pub fn input(&mut self) {
        self.pace.input(Instant::now());
    }

    /// Takes the place of the sample, once a first picture shows that it can; the old one stays if not.
    ///
    /// # Errors
    /// If the new sample cannot render.
    pub fn replace(&mut self, sample: S) -> Result<()> {
        let old = std::mem::replace(&mut self.sample, sample);
        self.changed = true;
        self.pace.restart(Instant::now());
        let tried = self.render(self.image.extent);
        if tried.is_err() {
            self.sample = old;
            self.changed = true;
        }
        tried.map(drop)
    }

    /// Writes the next full picture, which will be rendered at once.
    pub fn ask_picture(&mut self) {
        self.picture_due = true;
    }

    /// Renders the next picture for a window of size `full`, if one is due.
    ///
    /// # Errors
    /// If the sample or the device fails.
    pub fn step(&mut self, full: vk::Extent2D, hands: Hands) -> Result<Stepped> {
        if full != self.full {
            self.full = full;
            self.change();
        }
        let busy = self.sample.is_busy() || self.gpu.is_building();
        let improves = self.sample.accumulates() || busy;
        let step = if self.picture_due && !self.pace.is_sharp() {
            self.pace.full(full)
        } else {
            self.pace.step(Instant::now(), full, hands, improves)
        };
        let extent = match step {
            Step::Render(extent) => extent,
            Step::Keep(until) => return Ok(Stepped::Kept(until)),
        };
        let was_building = self.gpu.is_building();
        let telling = self.render(extent)?;
        if was_building && !self.gpu.is_building() {
            // What was waited for is there: frames of the old pipeline are not to be mixed with it.
            self.change();
        }
        Ok(Stepped::New { milliseconds: self.milliseconds, full: extent == full, telling })
    }

    fn render(&mut self, extent: vk::Extent2D) -> Result<bool> {
        let resized = self.image.extent != extent;
        if resized {
            self.image = Image::storage(&self.gpu, "picture", extent)?;
        }
        self.index = if self.changed || resized { 0 } else { self.index + 1 };
        self.changed = false;
        let frame = |cmd| Frame { gpu: &self.gpu, cmd, image: &self.image, index: self.index };
        let start = Instant::now();
        self.gpu.submit(|cmd| {
            self.timer.start(cmd);
            self.sample.render(&frame(cmd))?;
            self.timer.stop(cmd);
            barrier::trace_to_trace(&self.gpu, cmd);
            Ok(())
        })?;
        // Where the queue has no timestamps, the host's clock must do.
        self.milliseconds = match self.timer.milliseconds()? {
            0.0 => start.elapsed().as_secs_f64() * 1e3,
            milliseconds => milliseconds,
        };
        let pixels = u64::from(extent.width) * u64::from(extent.height);
        Ok(self.pace.took(pixels, self.milliseconds))
    }

    /// Adds what is known of the last picture.
    pub fn facts(&self, facts: &mut Facts) {
        let pair = |extent: vk::Extent2D| [extent.width, extent.height];
        facts.milliseconds = self.milliseconds;
        (facts.rendered, facts.full) = (pair(self.image.extent), pair(self.full));
        facts.accumulated = self.sample.accumulates().then_some(self.index + 1);
    }

    /// Writes the picture that was asked for, once it is there, and returns its file.
    ///
    /// # Errors
    /// If the current folder cannot be written.
    pub fn take_picture(&mut self, name: &str) -> Option<Result<PathBuf>> {
        let ready = self.picture_due && self.pace.is_sharp();
        self.picture_due &= !ready;
        ready.then(|| {
            let path = free_name(Path::new("."), name)?;
            let vk::Extent2D { width, height } = self.image.extent;
            Picture { width, height, pixels: self.image.read()? }.save(&path)?;
            Ok(path)
        })
    }
}

/// The first of `NAME-001.png`, `NAME-002.png`, … that there is not.
fn free_name(folder: &Path, name: &str) -> Result<PathBuf> {
    for number in 1..1000 {
        let path = folder.join(format!("{name}-{number:03}.png"));
        if !path.try_exists().with_context(|| format!("cannot look for '{}'", path.display()))? {
            return Ok(path);
        }
    }
    bail!("there are 999 pictures of {name} here already")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_never_takes_the_name_of_another() {
        let folder = tempfile::tempdir().unwrap();
        for number in 1..=3 {
            let path = free_name(folder.path(), "02_basic").unwrap();
            assert_eq!(path, folder.path().join(format!("02_basic-00{number}.png")));
            std::fs::write(path, b"").unwrap();
        }
    }
}
