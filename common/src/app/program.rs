//! A sample as a program: its name, and how it begins and ends.

use std::process::ExitCode;

use anyhow::Result;

use super::{Args, RunHooks, Sample, Setup, headless, window};
use crate::UsageError;
use crate::gpu::{self, Gpu, Requirements};
use crate::{output, paths};

/// Runs a sample of the crate in the folder `home` as a program: reads the arguments, renders, and turns errors
/// into one line. [`run!`](crate::run) calls it.
///
/// Exit codes: 0 done, 1 failed, 2 wrong arguments.
pub fn run<S: Sample>(name: &'static str, home: &str) -> ExitCode {
    paths::set(home);
    let run = || {
        let (args, ()) = Args::parse_with(name)?;
        Program::of::<S>(name).start(&args, &mut ())
    };
    let Err(error) = run() else { return ExitCode::SUCCESS };
    output::complain(&output::line_of(&error));
    if error.is::<UsageError>() { ExitCode::from(2) } else { ExitCode::FAILURE }
}

/// Runs a [`Sample`](crate::Sample) as the program of a crate outside the book: `raybook::run!(Demo)` is all of
/// `main`. Its shaders lie beside its manifest in `shaders/`, in a folder with the program's name.
#[macro_export]
macro_rules! run {
    ($sample:ty) => {
        $crate::app::run::<$sample>(env!("CARGO_BIN_NAME"), env!("CARGO_MANIFEST_DIR"))
    };
}

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
    pub fn start(&self, args: &Args, watch: &mut dyn RunHooks) -> Result<()> {
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
