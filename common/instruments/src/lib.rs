//! Instruments that observe a run of a sample, one folder per subject. The framework, [`common`], does not depend
//! on them.
//!
//! - [`report`]: `--report`, a run's facts and measurements
//! - [`compare`]: `--compare`, the cost of a choice
//! - [`sums`]: `--samples`, long renders that can be split, stopped and merged
//! - [`compile_for`]: `--compile-for`, a GPU compiler's statistics for a sample's pipelines
//! - [`arithmetic`]: `--arithmetic worst`, the worst-case rounding allowed by Vulkan
//! - [`pixel`]: `--pixel`, the rays of one pixel as text
//! - [`idle`]: devices that execute nothing
//! - [`columns`](mod@columns): a table for a terminal
//!
//! They connect to the framework in two places. [`Instruments`] is a [`RunHooks`](common::app::RunHooks): it is
//! called after each frame and at the end. [`Arithmetic`](arithmetic::Arithmetic) is a
//! [`DriverShim`](common::gpu::DriverShim): it changes the SPIR-V of shaders and the input of builds; [`pixel`]
//! has another.

// The tests below run on the software driver.
#[cfg(test)]
use device as _;

pub mod arithmetic;
pub mod columns;
pub mod compare;
pub mod compile_for;
pub mod idle;
mod instruments;
mod options;
pub mod pixel;
pub mod report;
pub mod sums;

use anyhow::Result;
use common::Sample;
use common::app::{Args, Program};

pub use instruments::{Instruments, all, check_files};
pub use options::{Options, command, parse, parse_with};
pub use report::{Milliseconds, Report};

/// Does what arguments ask of a sample, for a program that has read them itself.
///
/// # Errors
/// Whatever went wrong.
pub fn start<S: Sample>(name: &'static str, args: &Args, options: Options) -> Result<()> {
    let (program, mut args) = (Program::of::<S>(name), args.clone());
    let mut hooks = Instruments::new(options);
    if hooks.prepare(&program, &mut args)? { program.start(&args, &mut hooks) } else { Ok(()) }
}
