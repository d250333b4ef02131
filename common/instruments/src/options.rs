//! The options of all instruments, in addition to those of every sample.

use std::path::Path;

use clap::{ArgMatches, Args as _, Command, FromArgMatches};
use common::UsageError;
use common::app::{Args, Files, usage_error};

use crate::arithmetic::Arithmetic;
use crate::{compare, compile_for, pixel, report, sums};

/// The options of all instruments.
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

    /// Arithmetic of shaders: the driver's own, or the worst-case rounding allowed by Vulkan
    #[arg(long, value_name = "MODE", value_enum, default_value = "driver")]
    pub arithmetic: Arithmetic,
}

impl Options {
    /// True if no instrument is used.
    pub fn are_none(&self) -> bool {
        let Self { report, compare, sums, compile_for, pixel, arithmetic } = self;
        let told = report.report.is_some() || report.compiler_figures;
        let rendered = compare.compare.is_some() || sums.samples.is_some() || sums.save.is_some();
        let compiled = compile_for.compile_for.is_some();
        let printed = pixel.pixel.is_some();
        !(told || rendered || compiled || printed) && arithmetic.or_seeded() == Arithmetic::Driver
    }

    /// Reads the options from a command line, and names the files they read and write.
    ///
    /// # Errors
    /// If options contradict each other.
    pub fn read(matches: &ArgMatches, args: &mut Args) -> Result<Self, UsageError> {
        let options = Self::from_arg_matches(matches).map_err(|error| usage_error(&error))?;
        if !options.are_none() {
            options.check(args)?;
        }
        let Self { report, sums, compare, .. } = &options;
        let (save, resume) = (sums.save.clone(), sums.resume.clone());
        let outputs = [("--report", report.file().map(Path::to_owned)), ("--save", save)];
        let outputs = outputs.into_iter().filter_map(|(name, file)| Some((name, file?)));
        // Only sums may be written into the file they come from.
        let updated = Some(("--resume", "--save"));
        let inputs = [("--resume", resume), ("--against", compare.against.clone())];
        let inputs = inputs.into_iter().filter_map(|(name, file)| Some((name, file?))).collect();
        args.files = Files { inputs, outputs: outputs.collect(), updated };
        Ok(options)
    }

    /// Refuses options that contradict each other.
    fn check(&self, args: &Args) -> Result<(), UsageError> {
        let asked = args.list_controls || self.compile_for.compile_for.is_some();
        self.pixel.check(args)?;
        self.sums.check(asked || args.out.is_some() || self.report.report.is_some())
    }
}

/// The book's own words about an option of every program.
pub fn of_the_book(command: Command) -> Command {
    command.mut_arg("scene", |scene| {
        scene.help(
            "Open this model (.obj, .gltf, .glb) instead of the chapter's own; 14 and 23 instead read the moves of pieces (.legs), \
             25 also scene files (.toml)",
        )
    })
}

/// The command line of every sample, including the instruments.
pub fn command() -> clap::Command {
    <Options as clap::Args>::augment_args(<Args as clap::CommandFactory>::command())
}

/// The process's arguments: the sample's and the instruments'.
///
/// # Errors
/// One line with the mistake and where to look.
pub fn parse(name: &'static str) -> Result<(Args, Options), UsageError> {
    let (args, options, NoMore {}) = parse_with(name)?;
    Ok((args, options))
}

#[derive(clap::Args)]
struct NoMore {}

/// As [`parse`], for a sample with arguments of its own.
///
/// # Errors
/// As [`parse`].
pub fn parse_with<Own: clap::Args>(name: &'static str) -> Result<(Args, Options, Own), UsageError> {
    let (mut args, matches) = Args::parse(name, |command| {
        Options::augment_args(Own::augment_args(of_the_book(command)))
    })?;
    let own = Own::from_arg_matches(&matches).map_err(|error| usage_error(&error))?;
    let options = Options::read(&matches, &mut args)?;
    Ok((args, options, own))
}
