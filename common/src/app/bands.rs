//! Tracing in bands of rows, so that the device never works for long without responding.
//!
//! Systems consider a device lost if it does not respond for a second or two, and a window that waits for a
//! picture cannot respond either. So a picture is traced in bands, each submitted and waited for separately. The
//! number of rows in a band follows from the cost of the rows before.

use std::sync::Arc;

use anyhow::Result;
use ash::vk;

use super::variants::Background;
use super::{Frame, Sample};
use crate::gpu::{Gpu, Image, Timer, barrier};

/// Milliseconds for the first band after a change, which may have made every pixel a hundred times as expensive.
const FIRST: f64 = 1.0;
/// Milliseconds for the next ones: below a cheap sky there may be rows far more expensive than any so far.
const UNSEEN: f64 = 4.0;
/// Milliseconds for a band of a picture that was traced before and has not changed.
const SEEN: f64 = 50.0;

/// Progress through a picture's rows, and the estimated cost of the next ones.
#[derive(Clone, Debug, Default)]
pub struct Bands {
    extent: vk::Extent2D,
    row: u32,
    /// Milliseconds per pixel in the last band.
    cost: Option<f64>,
    /// The highest cost per pixel of any band of this picture, in milliseconds.
    most: f64,
    /// The same for the whole previous picture, if this one is comparable.
    most_before: Option<f64>,
    /// Milliseconds of each band of this picture, and then of each pass.
    pub times: Vec<f64>,
    /// The names of its passes.
    passes: Vec<&'static str>,
}

impl Bands {
    /// Begins a picture; `like_the_last` if nothing has changed that could make it more expensive.
    pub fn begin(&mut self, extent: vk::Extent2D, like_the_last: bool) {
        let complete = self.row > 0 && self.row == self.extent.height;
        self.most_before = (like_the_last && complete).then_some(self.most);
        (self.extent, self.row, self.most) = (extent, 0, 0.0);
        self.times.clear();
        self.passes.clear();
    }

    /// Abandons the picture.
    pub fn stop(&mut self) {
        (self.extent.height, self.row) = (0, 0);
    }

    /// Number of pixels traced so far.
    pub fn pixels(&self) -> u64 {
        u64::from(self.extent.width) * u64::from(self.row)
    }

    /// The next band; `None` if the picture is complete or was abandoned.
    pub fn next(&self) -> Option<vk::Rect2D> {
        let left = self.extent.height - self.row;
        if left == 0 {
            return None;
        }
        let (budget, cost) = match (self.most_before, self.cost) {
            (Some(cost), _) => (SEEN, cost),
            (None, Some(cost)) if self.row == 0 => (FIRST, cost),
            (None, Some(cost)) => (UNSEEN, cost),
            // Nothing is known: a single row.
            (None, None) => (0.0, 1.0),
        };
        let most = (budget / (cost * f64::from(self.extent.width))).clamp(1.0, left.into()) as u32;
        // As few bands as the limit allows, all equally high.
        let height = left.div_ceil(left.div_ceil(most));
        let offset = vk::Offset2D { x: 0, y: self.row as i32 };
        Some(vk::Rect2D { offset, extent: vk::Extent2D { height, ..self.extent } })
    }

    /// Records that a band was traced and how many milliseconds it took.
    pub fn took(&mut self, band: vk::Rect2D, milliseconds: f64) {
        let vk::Extent2D { width, height } = band.extent;
        let cost = milliseconds / (f64::from(width) * f64::from(height));
        // The very first also compiles, in some drivers.
        if self.cost.is_some() {
            self.most = self.most.max(cost);
        }
        self.cost = Some(cost);
        self.times.push(milliseconds);
        self.row += height;
    }

    /// Milliseconds of all bands together and of the passes of each name, in their order; empty if there are no passes.
    pub fn parts(&self) -> Vec<(&'static str, f64)> {
        if self.passes.is_empty() {
            return Vec::new();
        }
        let (bands, passes) = self.times.split_at(self.times.len() - self.passes.len());
        let mut parts = vec![("trace", bands.iter().sum::<f64>())];
        for (&name, time) in self.passes.iter().zip(passes) {
            match parts.iter_mut().find(|(known, _)| *known == name) {
                Some((_, sum)) => *sum += time,
                None => parts.push((name, *time)),
            }
        }
        parts
    }

    /// Traces the next band of a frame and returns its time in milliseconds; `None` if no band is left.
    ///
    /// # Errors
    /// If the sample or the device fails.
    pub fn trace(
        &mut self,
        sample: &mut dyn Sample,
        (gpu, timer, background): (&Gpu, &Timer, Option<&Arc<Background>>),
        (image, index, accumulated): (&Image, u32, u32),
    ) -> Result<Option<f64>> {
        let Some(area) = self.next() else { return Ok(None) };
        let first_band = area.offset.y == 0;
        let submit = |area, record: &mut dyn FnMut(&Frame) -> Result<()>| {
            gpu.submit(|cmd| {
                timer.start(cmd);
                record(&Frame {
                    gpu,
                    cmd,
                    image,
                    area,
                    index,
                    accumulated,
                    first_band,
                    background,
                })?;
                timer.stop(cmd);
                barrier::trace_to_trace(gpu, cmd);
                Ok(())
            })?;
            timer.milliseconds()
        };
        let mut milliseconds = submit(area, &mut |frame| sample.render(frame))?;
        tracing::trace!("{} rows: {milliseconds:.1} ms", area.extent.height);
        self.took(area, milliseconds);
        // Passes are no bands: a row that is traced costs what it did.
        if self.row == self.extent.height {
            self.passes = sample.passes();
        }
        let whole = vk::Rect2D { extent: self.extent, ..Default::default() };
        for number in 0..self.passes.len() {
            let took = submit(whole, &mut |frame| sample.pass(frame, number as u32))?;
            self.times.push(took);
            milliseconds += took;
        }
        Ok(Some(milliseconds))
    }
}

/// Traces a single pixel of a frame, with the same result as in the whole frame.
///
/// # Errors
/// If the sample or the device fails.
pub fn trace_pixel(
    sample: &mut dyn Sample,
    gpu: &Gpu,
    (image, index, accumulated): (&Image, u32, u32),
    [x, y]: [u32; 2],
) -> Result<()> {
    let offset = vk::Offset2D { x: x as i32, y: y as i32 };
    let area = vk::Rect2D { offset, extent: vk::Extent2D { width: 1, height: 1 } };
    gpu.submit(|cmd| {
        let (first_band, background) = (true, None);
        sample.render(&Frame {
            gpu,
            cmd,
            image,
            area,
            index,
            accumulated,
            first_band,
            background,
        })?;
        barrier::trace_to_trace(gpu, cmd);
        Ok(())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const EXTENT: vk::Extent2D = vk::Extent2D { width: 800, height: 600 };

    /// Traces a picture whose rows take `row(y)` milliseconds, and returns the time of each band.
    fn picture(bands: &mut Bands, like_the_last: bool, row: impl Fn(u32) -> f64) -> Vec<f64> {
        bands.begin(EXTENT, like_the_last);
        let (mut times, mut next) = (Vec::new(), 0);
        while let Some(area) = bands.next() {
            assert_eq!((area.offset.x, area.offset.y), (0, next));
            assert_eq!(area.extent.width, EXTENT.width);
            let rows = next as u32..next as u32 + area.extent.height;
            next += area.extent.height as i32;
            let milliseconds = rows.map(&row).sum();
            bands.took(area, milliseconds);
            times.push(milliseconds);
        }
        assert_eq!(next, 600, "every row once");
        times
    }

    fn longest(times: &[f64]) -> f64 {
        times.iter().copied().fold(0.0, f64::max)
    }

    #[test]
    fn a_quick_picture_is_one_band_and_so_is_its_like() {
        let mut bands = Bands::default();
        assert!(picture(&mut bands, false, |_| 1e-3).len() <= 3);
        assert_eq!(picture(&mut bands, true, |_| 1e-3).len(), 1);
        assert_eq!(picture(&mut bands, false, |_| 1e-3).len(), 1);
    }

    #[test]
    fn a_slow_picture_is_many_bands_none_of_them_long() {
        let mut bands = Bands::default();
        // A sky, and below it rows 25 times as expensive.
        let row = |y| if y < 250 { 0.4 } else { 10.0 };
        assert!(longest(&picture(&mut bands, false, row)) <= 100.0);
        let again = picture(&mut bands, true, row);
        assert!(longest(&again) <= 60.0 && again.len() <= 130, "{again:?}");
    }

    #[test]
    fn a_change_that_makes_all_a_hundred_times_as_dear_is_met_by_a_short_band() {
        let mut bands = Bands::default();
        picture(&mut bands, false, |_| 0.1);
        picture(&mut bands, true, |_| 0.1);
        assert!(longest(&picture(&mut bands, false, |_| 10.0)) <= 100.0);
    }

    #[test]
    fn a_first_row_that_waits_for_a_compiler_is_forgotten() {
        let mut bands = Bands::default();
        picture(&mut bands, false, |y| if y == 0 { 900.0 } else { 1e-3 });
        assert_eq!(picture(&mut bands, true, |_| 1e-3).len(), 1);
    }

    #[test]
    fn passes_of_one_name_are_added() {
        let mut bands = Bands { times: vec![1.0, 2.0, 0.25, 0.5, 0.5], ..Bands::default() };
        assert_eq!(bands.parts(), []);
        bands.passes = vec!["history", "filter", "filter"];
        assert_eq!(bands.parts(), [("trace", 3.0), ("history", 0.25), ("filter", 1.0)]);
    }

    #[test]
    fn what_was_given_up_has_no_next_band_and_is_no_measure() {
        let mut bands = Bands::default();
        bands.begin(EXTENT, false);
        let first = bands.next().unwrap();
        bands.took(first, 1.0);
        bands.stop();
        assert_eq!(bands.next(), None);
        bands.begin(EXTENT, true);
        assert!(bands.next().unwrap().extent.height < 600);
    }
}
