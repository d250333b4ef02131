//! The commands of the tool, and their arguments.

use std::ops::Range;
use std::path::{Path, PathBuf};

use anyhow::Result;
use clap::{CommandFactory, Parser, Subcommand};
use common::UsageError;
use instruments::arithmetic::Arithmetic;

use crate::exercises::command::ExerciseArguments;
use crate::hard::HardArguments;
use crate::prices::command::PricesArguments;

/// Shows any two chapters side by side, and keeps the book's pages true to the code
#[derive(Debug, Parser)]
#[command(name = "chapters", disable_version_flag = true)]
pub struct Arguments {
    /// The command to run
    #[command(subcommand)]
    pub command: Command,

    /// The project's root
    #[arg(long, value_name = "DIR", global = true, default_value_os_t = own_project(), hide_default_value = true)]
    pub root: PathBuf,
}

#[derive(Debug, Subcommand)]
pub enum Command {
    /// List the chapters: what each teaches, builds on, and needs of the device
    List {
        /// As JSON, for scripts
        #[arg(long)]
        json: bool,
    },
    /// Show the differences between two chapters, such as `diff 02 03`; coloured unless piped or NO_COLOR
    ///
    /// Code and shaders, unless a part is named. If one of the two builds on the other, it counts as the newer,
    /// whichever is named first.
    Diff {
        /// The older chapter: its number or name
        old: String,
        /// The newer chapter
        new: String,
        /// Only count lines
        #[arg(long)]
        stat: bool,
        /// Compare the Rust code
        #[arg(long)]
        code: bool,
        /// Compare the shaders
        #[arg(long)]
        shaders: bool,
        /// Compare the pages
        #[arg(long)]
        page: bool,
        /// Lines around each change
        #[arg(long, value_name = "N", default_value_t = 3, value_parser = context, allow_hyphen_values = true)]
        context: u16,
    },
    /// Make a chapter as a copy of another, such as `new 13 callable_shader --from 05`
    New {
        /// Its number
        number: u32,
        /// Its name
        name: String,
        /// The chapter it builds on: its number or name
        #[arg(long)]
        from: String,
    },
    /// Make a crate of your own outside the book, such as `start ../my_tracer`: a scene with a mirror, a test
    Start {
        /// An empty or new folder, with the crate's name
        folder: PathBuf,
        /// Take the framework from this Git repository instead of from this checkout
        #[arg(long, value_name = "URL")]
        git: Option<String>,
        /// Compile everything for this crate alone; without it, the crate uses what the book has compiled, and its
        /// first build takes a minute instead of many
        #[arg(long)]
        apart: bool,
    },
    /// Bring the generated parts of pages up to date: snippets, diffs, tables, gallery, contents
    Sync {
        /// Also render the pictures of these names, or all that are out of date
        #[arg(long, value_name = "NAME", num_args = 0..)]
        pictures: Option<Vec<String>>,
    },
    /// Measure the values of these pages or measurements again, such as `05` or `05_shadow_miss/acne`, and fill them
    /// in; without a name, all values that are missing or whose command has changed
    Measure {
        /// Chapters, pages, measurements
        names: Vec<String>,
    },
    /// Run the commands of all pictures, mistakes and values again, and compare; exit code 1 if anything differs.
    /// About an hour on two cores; an interrupted run continues where it stopped
    ///
    /// A picture must be the same on the device and driver that made it; elsewhere it may differ by rounding. Values
    /// are compared on the stored device and driver, and only printed on others. Times are not compared.
    Verify {
        /// Chapters, pages, pictures, mistakes, measurements [default: all]
        names: Vec<String>,
        /// Only the pictures of chapters whose code or shaders differ from the last commit; in a clean tree from the
        /// one before, or from the commit in the environment variable CHANGED_SINCE
        #[arg(long, conflicts_with = "names")]
        changed: bool,
    },
    /// Run every chapter on this device, look for known faults of drivers, measure what accuracy costs, and write a
    /// report card to send in; exit code 1 if anything fails. At most three minutes, once everything is built
    Survey {
        /// Use this device: a number of --list-devices or a part of its name
        #[arg(long, value_name = "N|NAME")]
        device: Option<String>,
        /// Folder for the card, as Markdown and as JSON
        #[arg(long, value_name = "FOLDER", default_value = "target/survey")]
        out: PathBuf,
        /// Stop a program after this many whole seconds, 1 to 86400
        #[arg(long, value_name = "SECONDS", default_value_t = 60, value_parser = limit,
            allow_hyphen_values = true)]
        limit: u64,
        /// Also measure frame times and random rays, and take the compilers' figures, for as long as it takes
        #[arg(long)]
        full: bool,
        /// At the end, also trace rays through a top level without instances, which has hung machines: save your work
        /// first
        #[arg(long)]
        risky: bool,
        /// Also measure what the device's own traversal computes: half a minute on a software driver
        #[arg(long)]
        atlas: bool,
        /// With --atlas: the driver's own arithmetic, or the worst-case rounding allowed by Vulkan; the card then has
        /// only the atlas
        #[arg(long, value_name = "MODE", value_enum, default_value = "driver", requires = "atlas")]
        arithmetic: Arithmetic,
        /// Only print what would be run
        #[arg(long)]
        list: bool,
    },
    /// Run hard cases and random rays with the textbook's formulas and with ours, on this device; exit code
    /// 1 if ours is ever wrong. About half a minute on a software driver
    Hard(HardArguments),
    /// Measure what accuracy costs on this device: the table of docs/prices.md with a column for yours, in a minute
    Prices(PricesArguments),
    /// Make a copy of the shaders, or of all code, with a classic mistake in it, and say how to run it
    Mistake {
        /// Its name, as --list shows it
        name: Option<String>,
        /// List the mistakes
        #[arg(long)]
        list: bool,
        /// Folder for the copy [default: target/mistakes/NAME]
        #[arg(long, value_name = "FOLDER")]
        out: Option<PathBuf>,
        /// Run it and compare with the claims of its file; without a name, every mistake that changes only shaders
        #[arg(long)]
        check: bool,
    },
    /// Do an exercise of a page: `exercise 05.2` sets it up and checks it on each save until it is solved
    Exercise(ExerciseArguments),
    /// Merge files that --save has written: OUT is the picture (.png or .exr), or such a file again
    Merge {
        /// The picture or file to write
        out: PathBuf,
        /// The files; no sample may be in two of them
        #[arg(required = true, value_name = "FILE")]
        files: Vec<PathBuf>,
        /// Fail if one of these samples is missing
        #[arg(long, value_name = "A..B", value_parser = instruments::sums::range)]
        samples: Option<Range<u32>>,
    },
    /// Build the book's website with mdBook, to be read from files or from any folder of a server
    Book {
        /// Folder for it, which this command made before, or which is empty or new [default: book]
        #[arg(long, value_name = "FOLDER")]
        out: Option<PathBuf>,
    },
    /// Run the tests that plain `cargo test` skips, one test program after the other, with their times
    Nightly {
        /// Test programs, such as `samples`; all of them if none is named
        names: Vec<String>,
        /// Only list the tests, each with the reason for skipping it
        #[arg(long)]
        list: bool,
    },
    /// Make the moving picture at the head of the README from the chapters' pictures
    Tour,
    /// Count the words of each chapter's page, its tables, and the words of its longest section without a break
    Words,
    /// Name everything that is stale, missing or stray; exit code 1 if anything is
    Check,
}

/// Lines around a change.
fn context(text: &str) -> Result<u16, String> {
    text.parse().map_err(|_| format!("lines are a whole number from 0 to {}", u16::MAX))
}

/// Seconds for a program.
fn limit(text: &str) -> Result<u64, String> {
    let known = text.parse().ok().filter(|seconds| (1..=86400).contains(seconds));
    known.ok_or_else(|| "a limit is a whole number of seconds from 1 to 86400, a day".to_owned())
}

/// The project that this tool belongs to, as a path without `..`, because error messages print it.
fn own_project() -> PathBuf {
    let tool = Path::new(env!("CARGO_MANIFEST_DIR"));
    tool.ancestors().nth(2).unwrap_or(tool).to_owned()
}

/// Reads the arguments.
///
/// # Errors
/// A one-line description of what is wrong with the arguments.
pub fn parse() -> Result<Arguments> {
    Arguments::try_parse().map_err(|error| {
        if !error.use_stderr() {
            common::output::print_and_exit(&error.to_string());
        }
        let text = error.to_string();
        // Without a command, clap's error is the help text, which does not say what is missing. Missing
        // arguments are listed on lines of their own below the error.
        let mut lines = text.lines().skip_while(|line| !line.starts_with("error: "));
        let first = lines.next().map(|line| line.trim_start_matches("error: ").to_owned());
        let listed = lines.take_while(|line| line.starts_with("  ")).map(str::trim);
        let line = first.map(|first| listed.fold(first, |line, next| format!("{line} {next}")));
        let line = line.unwrap_or_else(|| {
            let command = Arguments::command();
            let names: Vec<_> = command.get_subcommands().map(clap::Command::get_name).collect();
            format!("no command; there is {}", names.join(", "))
        });
        UsageError(format!("{line}; --help lists the commands")).into()
    })
}
