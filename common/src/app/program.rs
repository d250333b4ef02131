//! A sample as a program: its name, start and end.

use std::process::ExitCode;

use anyhow::Result;

use super::{Args, RunHooks, Sample, Setup, headless, window};
use crate::gpu::{self, Gpu, Requirements};
use crate::{exit, output, paths};

/// Runs a sample as a program: reads the arguments, renders in a window or without one, and turns errors into one
/// line.
///
/// Exit codes: as [`exit::finish`].
pub fn run<S: Sample>(name: &'static str, mut hooks: impl RunHooks) -> ExitCode {
    exit::finish(|| {
        let program = Program::of::<S>(name);
        let (mut args, matches) = Args::parse(name, |command| hooks.options(command))?;
        if std::env::var_os("SHADERS").is_none() {
            output::warn(paths::elsewhere().as_slice());
        }
        if hooks.asked(&program, &matches, &mut args)? {
            program.start(&args, &mut hooks)?;
        }
        Ok(())
    })
}

/// As [`run`], for a sample of the crate in the folder `home`; [`run!`](crate::run!) calls it.
pub fn run_at<S: Sample>(name: &'static str, home: &str) -> ExitCode {
    paths::set(home, name);
    run::<S>(name, ())
}

/// Runs a [`Sample`](crate::Sample) as the program of a crate outside the book: `raybook::run!(Demo)` is all of
/// `main`. Its shaders are in `shaders/` next to its manifest, in a folder with the program's name.
#[macro_export]
macro_rules! run {
    ($sample:ty) => {
        $crate::app::run_at::<$sample>(env!("CARGO_BIN_NAME"), env!("CARGO_MANIFEST_DIR"))
    };
}

/// A sample that has not been created yet.
pub struct Program {
    /// The sample's name, such as `02_basic`.
    pub name: &'static str,
    /// The features and limits it needs.
    pub requirements: fn() -> Requirements,
    /// Creates the sample.
    pub make: fn(&Gpu, &Setup) -> Result<Box<dyn Sample>>,
}

impl Program {
    /// The program of a sample.
    pub fn of<S: Sample>(name: &'static str) -> Self {
        let make = |gpu: &Gpu, setup: &Setup| Ok(Box::new(S::new(gpu, setup)?) as Box<dyn Sample>);
        Self { name, requirements: S::requirements, make }
    }

    /// Runs the command that the arguments select.
    ///
    /// # Errors
    /// Any failure of the run.
    pub fn start(&self, args: &Args, hooks: &mut dyn RunHooks) -> Result<()> {
        if args.list_devices {
            return list_devices(&(self.requirements)());
        }
        if args.headless || args.list_controls || args.list_records {
            headless::run(self, args, hooks)
        } else {
            window::open(self, args, hooks)
        }
    }
}

/// Prints every device with its driver and the features it lacks.
fn list_devices(requirements: &Requirements) -> Result<()> {
    for line in gpu::device_lines(requirements)? {
        output::print(&format!("{line}\n"))?;
    }
    Ok(())
}
