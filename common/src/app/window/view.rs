//! A sample's picture in a window, at a size that keeps the window responsive.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};

use anyhow::{Error, Result};
use ash::vk;

use super::facts::Facts;
use super::pace::{Pace, Step};
use super::shot::Shot;
use super::stepped::Stepped;
use crate::app::playback::Clock;
use crate::app::variants::Background;
use crate::app::{Bands, Clicked, Development, Sample, bands};
use crate::gpu::{Gpu, Image, Timer};

/// Time for tracing bands before the window looks for input again.
const SLICE: Duration = Duration::from_millis(40);

/// Time for adding pictures to a mean before one is shown: most of a frame at 60 per second.
const FRAME: Duration = Duration::from_millis(12);

/// Milliseconds a preview may take before a change abandons it.
const PATIENCE: f64 = 150.0;

/// The sample and its last picture.
pub struct View {
    /// The sample.
    pub sample: Box<dyn Sample>,
    /// The last complete picture.
    pub image: Image,
    /// The next one, traced in bands.
    next: Image,
    bands: Bands,
    /// Milliseconds of its bands so far.
    spent: f64,
    /// True if a change began it: then it is small.
    is_preview: bool,
    pace: Pace,
    clock: Clock,
    timer: Timer,
    index: u32,
    /// Number of complete pictures.
    pub pictures: u32,
    changed: bool,
    milliseconds: f64,
    /// The parts of that time.
    parts: Vec<(&'static str, f64)>,
    full: vk::Extent2D,
    shot: Shot,
    background: Arc<Background>,
    /// The reason why the sample could not follow its controls.
    refused: Option<String>,
    gpu: Gpu,
}

impl View {
    /// A view that has rendered nothing yet.
    ///
    /// # Errors
    /// If the device has no memory left for it.
    pub fn new(gpu: &Gpu, sample: Box<dyn Sample>) -> Result<Self> {
        let nothing = vk::Extent2D { width: 1, height: 1 };
        Ok(Self {
            sample,
            image: Image::storage(gpu, "picture", nothing)?,
            next: Image::storage(gpu, "next picture", nothing)?,
            bands: Bands::default(),
            spent: 0.0,
            is_preview: true,
            pace: Pace::new(gpu.software, Instant::now()),
            clock: Clock::default(),
            timer: Timer::new(gpu)?,
            index: 0,
            pictures: 0,
            changed: true,
            milliseconds: 0.0,
            parts: Vec::new(),
            full: nothing,
            shot: Shot::default(),
            background: Arc::default(),
            refused: None,
            gpu: gpu.clone(),
        })
    }

    /// The picture is out of date.
    pub fn change(&mut self) {
        self.changed = true;
        self.pace.change(Instant::now());
        // Finish the preview if it is fast, so that movement stays visible.
        if !self.is_preview || self.spent > PATIENCE {
            self.give_up();
        }
    }

    fn give_up(&mut self) {
        if self.spent > 0.0 {
            self.pace.took(self.bands.pixels(), self.spent);
        }
        self.spent = 0.0;
        self.bands.stop();
    }

    /// Replaces the sample once a first picture has succeeded; otherwise the old one stays.
    ///
    /// # Errors
    /// If the new sample cannot render.
    pub fn replace(&mut self, sample: Box<dyn Sample>) -> Result<()> {
        let old = std::mem::replace(&mut self.sample, sample);
        self.changed = true;
        self.pace.restart(Instant::now());
        let tried = self.sample.changed(&self.gpu);
        let tried = tried.and_then(|()| self.begin(self.image.extent));
        let tried = tried.and_then(|()| self.trace_band());
        match tried {
            Ok(true) => _ = self.show(),
            Ok(false) => {}
            Err(_) => {
                self.sample = old;
                self.bands.stop();
                self.change();
            }
        }
        tried.map(drop)
    }

    /// Saves the next full picture, which is rendered at once.
    pub fn ask_picture(&mut self) {
        self.shot.is_due = true;
    }

    /// Renders part of the next picture for a window of size `full`, if one is due. A window may be larger than
    /// the device's largest picture, which is then stretched.
    ///
    /// # Errors
    /// If the sample or the device fails.
    pub fn step(&mut self, full: vk::Extent2D) -> Result<Stepped> {
        let full = self.gpu.limits.fitted(full);
        if full != self.full {
            self.full = full;
            self.change();
        }
        if self.bands.next().is_some() {
            if self.changed {
                // The rest of a preview shows the new values, so everything derived from them must be ready.
                if let Some(kept) = self.build()? {
                    return Ok(kept);
                }
            }
            return self.go_on();
        }
        self.go_on_in_time();
        let busy = self.background.is_building();
        let improves = self.sample.accumulates() || busy;
        let now = Instant::now();
        let step = if self.shot.is_due && !self.pace.is_sharp() && self.pace.is_still(now) {
            self.pace.full(full)
        } else {
            self.pace.step(now, full, improves)
        };
        let extent = match step {
            Step::Render(extent) => extent,
            Step::Keep(until) => return Ok(Stepped::Kept(until)),
        };
        if let (true, Some(kept)) = (self.changed, self.build()?) {
            return Ok(kept);
        }
        self.begin(extent)?;
        let stepped = self.go_on()?;
        self.add_pictures(now, stepped)
    }

    /// Adds pictures to a mean for the time of a display's frame. A display shows 60 pictures per second, and a
    /// device may trace ten times as many.
    fn add_pictures(&mut self, since: Instant, mut stepped: Stepped) -> Result<Stepped> {
        let fits = |took: f64| since.elapsed().as_secs_f64() + took / 1e3 < FRAME.as_secs_f64();
        while matches!(stepped, Stepped::New { milliseconds, full: true, .. } if fits(milliseconds))
            && self.sample.accumulates()
            && !self.plays()
            && !self.background.is_building()
        {
            self.begin(self.full)?;
            stepped = self.go_on()?;
        }
        Ok(stepped)
    }

    /// Has the sample build what depends on its controls. If it fails and there is a picture, that stays.
    fn build(&mut self) -> Result<Option<Stepped>> {
        match self.sample.changed(&self.gpu) {
            Err(error) if self.milliseconds > 0.0 && !is_loss(&error) => {
                let error = format!("{error:#}");
                // Try again, in case the sample has returned to its last valid state.
                let again = (self.refused.as_ref() != Some(&error)).then(Instant::now);
                self.refused = Some(error);
                Ok(Some(Stepped::Kept(again)))
            }
            result => {
                self.refused = None;
                result.map(|()| None)
            }
        }
    }

    /// Traces bands as long as the window can wait.
    fn go_on(&mut self) -> Result<Stepped> {
        let start = Instant::now();
        while start.elapsed() < SLICE {
            let built = self.background.built();
            let whole = self.trace_band()?;
            if built != self.background.built() {
                // The new pipeline is ready: its picture must not be mixed with bands of the old one.
                self.give_up();
                self.change();
                return Ok(Stepped::Part);
            }
            if whole {
                return Ok(self.show());
            }
        }
        Ok(Stepped::Part)
    }

    /// True if the next picture is due because the animation advances.
    pub fn plays(&mut self) -> bool {
        self.sample.playback().is_some_and(|playback| playback.playing)
    }

    /// Advances the animation to the current time. A picture in progress is finished first, so that all of it
    /// shows one moment.
    fn go_on_in_time(&mut self) {
        let now = Instant::now();
        if self.clock.advance(self.sample.playback(), now) {
            self.pace.change(now);
        }
    }

    fn begin(&mut self, extent: vk::Extent2D) -> Result<()> {
        if self.next.extent != extent {
            self.next = Image::storage(&self.gpu, "next picture", extent)?;
        }
        let like_the_last = !self.changed && self.image.extent == extent;
        self.is_preview = self.changed;
        self.index = if like_the_last { self.index + 1 } else { 0 };
        (self.changed, self.spent) = (false, 0.0);
        self.bands.begin(extent, like_the_last);
        Ok(())
    }

    /// Traces a band; returns true if the picture is complete.
    fn trace_band(&mut self) -> Result<bool> {
        let device = (&self.gpu, &self.timer, Some(&self.background));
        let frame = (&self.next, self.index, self.index);
        let took = self.bands.trace(&mut *self.sample, device, frame)?;
        self.spent += took.unwrap_or_default();
        Ok(self.bands.next().is_none())
    }

    /// Traces a single pixel of the last picture, at a position in fractions of its width and height. The next
    /// picture starts from scratch: otherwise a mean would contain that pixel twice.
    ///
    /// # Errors
    /// If the sample or the device fails.
    pub fn trace_pixel(&mut self, part: [f32; 2]) -> Result<Clicked> {
        let vk::Extent2D { width, height } = self.image.extent;
        let size = [width, height];
        let at = |i: usize| ((part[i] * size[i] as f32) as u32).min(size[i] - 1);
        let pixel = [at(0), at(1)];
        bands::trace_pixel(&mut *self.sample, &self.gpu, (&self.image, 0, 0), pixel)?;
        self.bands.stop();
        self.change();
        Ok(Clicked { pixel, size, passes: self.sample.passes() })
    }

    /// Replaces the last picture by the completed one.
    fn show(&mut self) -> Stepped {
        std::mem::swap(&mut self.image, &mut self.next);
        self.pictures += 1;
        self.milliseconds = std::mem::take(&mut self.spent);
        self.parts = self.bands.parts();
        let extent = self.image.extent;
        let pixels = u64::from(extent.width) * u64::from(extent.height);
        let telling = self.pace.took(pixels, self.milliseconds);
        Stepped::New { milliseconds: self.milliseconds, full: extent == self.full, telling }
    }

    /// The reason why the controls' values are not shown.
    pub fn refused(&mut self) -> Option<String> {
        self.background.refused().pop().or_else(|| self.refused.clone())
    }

    /// Adds the facts about the last picture.
    pub fn facts(&self, facts: &mut Facts) {
        let pair = |extent: vk::Extent2D| [extent.width, extent.height];
        facts.milliseconds = self.milliseconds;
        facts.parts.clone_from(&self.parts);
        (facts.rendered, facts.full) = (pair(self.image.extent), pair(self.full));
        facts.accumulated = self.sample.accumulates().then_some(self.index + 1);
    }

    /// Writes the requested picture once it is ready, and returns its file.
    ///
    /// # Errors
    /// If the current folder is not writable.
    pub fn take_picture(
        &mut self,
        name: &str,
        development: Development,
    ) -> Option<Result<PathBuf>> {
        let ready = self.pace.is_sharp() && self.bands.next().is_none();
        self.shot.take(ready, &self.image, (name, development))
    }
}

/// Returns whether an error means that the device is lost, and with it all that was made from it.
fn is_loss(error: &Error) -> bool {
    let lost = vk::Result::ERROR_DEVICE_LOST;
    error.chain().any(|cause| cause.downcast_ref::<vk::Result>() == Some(&lost))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_loss_is_known_by_its_cause() {
        let lost = Error::from(vk::Result::ERROR_DEVICE_LOST).context("the device failed");
        assert!(is_loss(&lost) && !is_loss(&vk::Result::ERROR_OUT_OF_HOST_MEMORY.into()));
    }
}
