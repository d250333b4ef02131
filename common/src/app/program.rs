//! A sample as a program: its name, and how it begins and ends.

use anyhow::Result;

use super::{Args, Sample, Setup, Watch, headless, window};
use crate::gpu::{self, Gpu, Requirements};
use crate::output;

/// A sample that is still to be made.
pub struct Program {
    /// The sample's name, such as `02_basic`.
    pub name: &'static str,
    /// What it asks of a device.
    pub requirements: fn() -> Requirements,
    /// Makes it.
    pub make: fn(&Gpu, &Setup) -> Result<Box<dyn Sample>>,
}

impl Program {
    /// The program of a sample.
    pub fn of<S: Sample>(name: &'static str) -> Self {
        let make = |gpu: &Gpu, setup: &Setup| Ok(Box::new(S::new(gpu, setup)?) as Box<dyn Sample>);
        Self { name, requirements: S::requirements, make }
    }

    /// Does what the arguments ask for.
    ///
    /// # Errors
    /// Whatever went wrong.
    pub fn start(&self, args: &Args, watch: &mut dyn Watch) -> Result<()> {
        if args.list_devices {
            return list_devices(&(self.requirements)());
        }
        match args.headless || args.list_controls || watch.needs_no_window() {
            true => headless::run(self, args, watch),
            false => window::open(self, args, watch),
        }
    }
}

/// Prints every device with its driver, and what it lacks.
fn list_devices(requirements: &Requirements) -> Result<()> {
    for line in gpu::device_lines(requirements)? {
        output::print(&format!("{line}\n"))?;
    }
    Ok(())
}
