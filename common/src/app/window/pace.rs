//! The size of the next picture, chosen to keep the window responsive on any device.
//!
//! While something changes, pictures are as large as a rate of 60 per second allows, or 15 on a software driver.
//! Once nothing has changed for a moment, the picture sharpens: to full size at once if that is fast, otherwise to
//! the largest size that is fast, and then in steps of four times the pixels. A change abandons a slow picture
//! that is being traced. A device that traces full size within the budget is not affected.

use std::time::{Duration, Instant};

use ash::vk::Extent2D;

/// Milliseconds for a picture while something moves: a sixtieth of a second, minus the panel's share.
const MOVING: f64 = 14.0;
/// The same on a software driver, which would otherwise have too few pixels: a fifteenth of a second.
const MOVING_IN_SOFTWARE: f64 = 40.0;
/// Milliseconds for the first still picture.
const QUICK: f64 = 120.0;
/// Time without changes before the picture sharpens.
const STILL: Duration = Duration::from_millis(150);
/// The initial level of a software driver, before its speed is known.
const UNKNOWN: u32 = 9;
/// Levels from a slow picture to the next: twice the width and height.
const STEP: u32 = 4;
/// The smallest picture: a sixteenth of the width and height.
const LAST: u32 = 16;

/// The action for the next frame of the window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Step {
    /// Render a picture of this size.
    Render(Extent2D),
    /// Show the last one again; the next step is due then, or when something changes.
    Keep(Option<Instant>),
}

/// Chooses sizes from the times of earlier pictures.
pub struct Pace {
    /// Milliseconds for a picture while something moves.
    moving: f64,
    /// Milliseconds per pixel.
    cost: Option<f64>,
    /// The first picture after a start also compiles shaders in the driver, so its time is ignored.
    warm: bool,
    start: u32,
    level: u32,
    shown: Option<u32>,
    changed: Instant,
}

impl Pace {
    /// No measurements yet; a software driver begins with a small picture.
    pub fn new(software: bool, now: Instant) -> Self {
        let (start, moving) = if software { (UNKNOWN, MOVING_IN_SOFTWARE) } else { (0, MOVING) };
        let (cost, shown) = (None, None);
        Self { moving, cost, warm: false, start, level: start, shown, changed: now }
    }

    /// The picture is out of date.
    pub fn change(&mut self, now: Instant) {
        self.shown = None;
        self.changed = now;
    }

    /// New shaders: the measured speed no longer applies.
    pub fn restart(&mut self, now: Instant) {
        self.warm = false;
        self.change(now);
    }

    /// Records the milliseconds of a picture of `pixels`; returns true if they are representative.
    pub fn took(&mut self, pixels: u64, milliseconds: f64) -> bool {
        let cost = milliseconds / pixels.max(1) as f64;
        if self.warm {
            // The mean of the last few, so that one hiccup of the machine does not change the size.
            self.cost = Some(self.cost.map_or(cost, |before| 0.6 * before + 0.4 * cost));
        }
        std::mem::replace(&mut self.warm, true)
    }

    /// The next step for a window of size `full`; `accumulates` if further pictures of the same view improve it.
    pub fn step(&mut self, now: Instant, full: Extent2D, accumulates: bool) -> Step {
        let level = match self.shown {
            None => {
                self.level = self.level_within(self.moving, full, self.level);
                self.level
            }
            Some(0) if accumulates => 0,
            Some(0) => return Step::Keep(None),
            // The first picture was not representative: render another like it.
            Some(level) if self.cost.is_none() => level,
            Some(_) if !self.is_still(now) => {
                return Step::Keep(Some(self.changed + STILL));
            }
            Some(shown) => {
                let quick = self.level_within(QUICK, full, 0);
                if quick < shown { quick } else { shown.saturating_sub(STEP) }
            }
        };
        self.shown = Some(level);
        Step::Render(size(full, level))
    }

    /// True if nothing has changed for a moment.
    pub fn is_still(&self, now: Instant) -> bool {
        now >= self.changed + STILL
    }

    /// Full size at once, however long it takes.
    pub fn full(&mut self, full: Extent2D) -> Step {
        self.shown = Some(0);
        Step::Render(full)
    }

    /// True if the last picture had full size and is up to date.
    pub fn is_sharp(&self) -> bool {
        self.shown == Some(0)
    }

    /// The largest size whose predicted time is within `budget`; one step larger than `current` only with a
    /// margin, so that sizes do not flicker.
    fn level_within(&self, budget: f64, full: Extent2D, current: u32) -> u32 {
        let Some(cost) = self.cost else { return self.start };
        let predicted = cost * f64::from(full.width) * f64::from(full.height);
        // A level has 1/√2 of the pixels of the one before.
        let exact = 2.0 * (predicted / budget).log2();
        let fits = exact.ceil().clamp(0.0, LAST.into()) as u32;
        if fits + 1 == current && exact > f64::from(fits) - 0.4 { current } else { fits }
    }
}

fn size(full: Extent2D, level: u32) -> Extent2D {
    let scale = (-f64::from(level) / 4.0).exp2();
    let side = |pixels: u32| ((f64::from(pixels) * scale).round() as u32).max(1);
    Extent2D { width: side(full.width), height: side(full.height) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FULL: Extent2D = Extent2D { width: 1280, height: 720 };

    struct Simulation {
        pace: Pace,
        now: Instant,
        full_milliseconds: f64,
    }

    impl Simulation {
        fn new(software: bool, full_milliseconds: f64) -> Self {
            let now = Instant::now();
            Self { pace: Pace::new(software, now), now, full_milliseconds }
        }

        /// Takes a step and returns its time in milliseconds, 0 for none.
        fn step(&mut self) -> f64 {
            let Step::Render(size) = self.pace.step(self.now, FULL, false) else {
                self.now += Duration::from_millis(10);
                return 0.0;
            };
            let pixels = u64::from(size.width) * u64::from(size.height);
            let part = pixels as f64 / (1280.0 * 720.0);
            self.pace.took(pixels, part * self.full_milliseconds);
            self.now += Duration::from_secs_f64(part * self.full_milliseconds / 1e3);
            part * self.full_milliseconds
        }
    }

    #[test]
    fn a_drag_stays_within_the_budget_and_then_sharpens() {
        let devices = [(true, MOVING_IN_SOFTWARE), (false, MOVING)];
        let times = [20.0, 30.0, 100.0, 325.0, 5000.0];
        for ((software, most), full) in devices.into_iter().flat_map(|d| times.map(|t| (d, t))) {
            let mut run = Simulation::new(software, full);
            for frame in 0..100 {
                run.pace.change(run.now);
                let took = run.step();
                // The smallest picture has a 256th of the pixels.
                let least = full / 256.0;
                assert!(took > 0.0 && (took <= most.max(least) || frame < 2), "{full}: {took}");
            }
            let released = run.now;
            while !run.pace.is_sharp() {
                run.step();
                assert!(run.now < released + Duration::from_secs(9), "{full} never sharpens");
            }
            assert_eq!(run.step(), 0.0, "a sharp picture is kept");
        }
    }

    #[test]
    fn a_fast_device_renders_full_size_from_the_first_frame() {
        let now = Instant::now();
        let mut pace = Pace::new(false, now);
        assert_eq!(pace.step(now, FULL, false), Step::Render(FULL));
        pace.took(1280 * 720, 900.0);
        pace.change(now);
        pace.step(now, FULL, false);
        pace.took(1280 * 720, 2.0);
        pace.change(now);
        assert_eq!(pace.step(now, FULL, false), Step::Render(FULL));
    }

    #[test]
    fn accumulation_goes_on_at_full_size() {
        let now = Instant::now();
        let mut pace = Pace::new(false, now);
        for _ in 0..5 {
            assert_eq!(pace.step(now, FULL, true), Step::Render(FULL));
            pace.took(1280 * 720, 5.0);
        }
        assert_eq!(pace.step(now, FULL, false), Step::Keep(None));
    }
}
