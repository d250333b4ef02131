//! What watches a run of a sample, a folder a subject. The framework, [`common`], knows none of it.
//!
//! - [`report`]: `--report`, what a run found out about itself
//! - [`compare`]: `--compare`, what a choice costs
//! - [`sums`]: `--samples`, long renders that can be cut, stopped and merged
//! - [`compile_for`]: `--compile-for`, what a GPU's compiler makes of a sample's pipelines
//! - [`arithmetic`]: `--arithmetic worst`, as inexact as Vulkan lets any driver be
//! - [`pixel`]: `--pixel`, the rays of one pixel as text
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
