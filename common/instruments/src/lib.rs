//! What watches a run of a sample, a folder a subject. The framework, [`common`], knows none of it.
//!
//! - [`report`]: `--report`, what a run found out about itself
//! - [`compare`]: `--compare`, what a choice costs
//! - [`sums`]: `--samples`, long renders that can be cut, stopped and merged
//! - [`compile_for`]: `--compile-for`, what a GPU's compiler makes of a sample's pipelines
//! - [`arithmetic`]: `--arithmetic worst`, as inexact as Vulkan lets any driver be
//! - [`pixel`]: `--pixel`, the rays of one pixel as text
//! - [`exit`]: how a program ends
//!
//! They meet the framework in two places. [`Instruments`] is a [`RunHooks`](common::app::RunHooks): it sees each frame
//! and the end. [`Arithmetic`](arithmetic::Arithmetic) is an [`DriverShim`](common::gpu::DriverShim): it changes
//! shaders' words and what builds are given; [`pixel`] has another.

// The tests below run on the software driver.
#[cfg(test)]
use device as _;

pub mod arithmetic;
pub mod compare;
pub mod compile_for;
pub mod exit;
mod instruments;
mod options;
pub mod pixel;
pub mod report;
pub mod sums;

use std::process::ExitCode;

use anyhow::Result;
use common::Sample;
use common::app::{Args, Program};

pub use exit::finish;
pub use instruments::{Instruments, check_files};
pub use options::{Options, command, parse, parse_with};
pub use report::{Milliseconds, Report};

/// Runs a sample as a program, with every instrument at hand: reads the arguments, renders, and turns errors
/// into one line.
///
/// Exit codes: as [`finish`].
pub fn run<S: Sample>(name: &'static str) -> ExitCode {
    finish(|| {
        let (args, options) = parse(name)?;
        start::<S>(name, &args, options)
    })
}

/// Does what the arguments ask of a sample; the part of [`run`] after they are read.
///
/// # Errors
/// Whatever went wrong.
pub fn start<S: Sample>(name: &'static str, args: &Args, options: Options) -> Result<()> {
    if options.compile_for.answer_compile_for && !args.list_devices {
        return compile_for::answer(&S::requirements());
    }
    if !args.headless {
        exit::compile_process::want();
    }
    let program = Program::of::<S>(name);
    match options.are_none() {
        true => program.start(args, &mut ()),
        false => program.start(args, &mut Instruments::new(options)),
    }
}
