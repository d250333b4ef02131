//! Costs of builds and updates, by the device's clock.

use std::cell::{Cell, RefCell};

use anyhow::Result;
use ash::vk;
use common::gpu::{Gpu, Timer};
use instruments::Milliseconds;

/// Maximum number of times kept of each kind: a window may stay open for days.
const MOST: usize = 10_000;

/// A clock for each of two levels, and its results: builds separate from updates.
pub struct Costs {
    levels: [Level; 2],
}

struct Level {
    timer: Timer,
    /// Work recorded and not read back yet: true for a build.
    recorded: Cell<Option<bool>>,
    /// Milliseconds of updates, and of builds.
    times: RefCell<[Vec<f64>; 2]>,
}

impl Costs {
    pub fn new(gpu: &Gpu) -> Result<Self> {
        let level = || -> Result<_> {
            let (recorded, times) = (Cell::default(), RefCell::default());
            Ok(Level { timer: Timer::new(gpu)?, recorded, times })
        };
        Ok(Self { levels: [level()?, level()?] })
    }

    /// Records what `record` does, and how long it takes. Of two in one submission the last is kept.
    pub fn time(
        &self,
        cmd: vk::CommandBuffer,
        level: usize,
        is_build: bool,
        record: impl FnOnce() -> Result<()>,
    ) -> Result<()> {
        let level = &self.levels[level];
        level.timer.start(cmd);
        record()?;
        level.timer.stop(cmd);
        level.recorded.set(Some(is_build));
        Ok(())
    }

    /// Asks the clocks; the commands are done.
    pub fn settle(&self) -> Result<()> {
        for level in &self.levels {
            if let Some(is_build) = level.recorded.take() {
                let times = &mut level.times.borrow_mut()[usize::from(is_build)];
                if times.len() == MOST {
                    times.clear();
                }
                times.push(level.timer.milliseconds()?);
            }
        }
        Ok(())
    }

    /// The median of a level's builds, or of its updates; 0 without any.
    pub fn median(&self, level: usize, of_builds: bool) -> f64 {
        let times = &self.levels[level].times.borrow()[usize::from(of_builds)];
        Milliseconds::of(times).median
    }
}
