//! The options of all instruments, beside those of every sample.

use common::UsageError;
use common::app::Args;

use crate::arithmetic::Arithmetic;
use crate::{compare, compile_for, pixel, report, sums};

/// What instruments are asked to do.
#[derive(Clone, Debug, Default, clap::Args)]
#[group(skip)]
#[command(next_help_heading = "Instruments")]
pub struct Options {
    /// `--report`.
    #[command(flatten)]
    pub report: report::Options,

    /// `--compare`.
    #[command(flatten)]
    pub compare: compare::Options,

    /// `--samples`.
    #[command(flatten)]
    pub sums: sums::Options,

    /// `--compile-for`.
    #[command(flatten)]
    pub compile_for: compile_for::Options,

    /// `--pixel`.
    #[command(flatten)]
    pub pixel: pixel::Options,

    /// Compute as the driver does, or as badly as Vulkan lets any driver: what must hold everywhere holds here
    #[arg(long, value_name = "WHOSE", value_enum, default_value = "driver")]
    pub arithmetic: Arithmetic,
}

impl Options {
    /// Whether nothing is asked of any instrument.
    pub fn are_none(&self) -> bool {
        let Self { report, compare, sums, compile_for, pixel, arithmetic } = self;
        let told = report.report.is_some() || report.compiler_figures;
        let rendered = compare.compare.is_some() || sums.samples.is_some() || sums.save.is_some();
        let compiled = compile_for.compile_for.is_some();
        let printed = pixel.pixel.is_some();
        !(told || rendered || compiled || printed) && arithmetic.or_seeded() == Arithmetic::Driver
    }

    /// Refuses options that do not go together.
    fn check(&self, args: &Args) -> Result<(), UsageError> {
        let asked = args.list_controls || self.compile_for.compile_for.is_some();
        self.pixel.check(args)?;
        self.sums.check(asked || args.out.is_some() || self.report.report.is_some())
    }
}

/// The command line of every sample.
pub fn command() -> clap::Command {
    <Options as clap::Args>::augment_args(<Args as clap::CommandFactory>::command())
}

/// The process's arguments: those of every sample, and the instruments'.
///
/// # Errors
/// One line that says what is wrong and where to look.
pub fn parse(name: &'static str) -> Result<(Args, Options), UsageError> {
    let (args, options, ()) = parse_with(name)?;
    Ok((args, options))
}

/// As [`parse`], for a sample with arguments of its own.
///
/// # Errors
/// As [`parse`].
pub fn parse_with<Own: clap::Args>(name: &'static str) -> Result<(Args, Options, Own), UsageError> {
    #[derive(clap::Args)]
    struct More<Own: clap::Args> {
        #[command(flatten)]
        own: Own,
        #[command(flatten)]
        options: Options,
    }
    let (args, More { options, own }) = Args::parse_with(name)?;
    if !options.are_none() {
        options.check(&args)?;
    }
    Ok((args, options, own))
}
