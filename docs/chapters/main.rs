//! Keeps the book's pages true to the code, and shows readers any two chapters side by side.
//!
//! - `list`: the chapters, what each teaches and builds on
//! - `diff A B`: what one chapter changes in another: code, shaders and page
//! - `new 13 NAME --from 05`: makes a chapter that compiles, runs and is tested
//! - `sync`: fills snippets, diffs, tables, gallery and contents; `--pictures` renders what is out of date
//! - `mistake NAME`: makes a patched copy of a chapter that shows a classic mistake
//! - `exercise 05.2`: sets up an exercise for a reader, and checks it on each save
//! - `measure`: runs what gave the pages' figures, and fills those in
//! - `merge OUT FILE…`: adds the sums that parts of a long render have saved
//! - `survey`: runs every chapter on this device and writes a report card
//! - `book`: makes a website of the pages
//! - `check`: names everything that is stale, missing or stray, what a page names and is not there, and
//!   what to do about it
//!
//! Arrows between the rooms point one way: [`pages`] → [`exercises`], [`figures`], [`mistakes`], [`survey`] →
//! [`patches`], [`pictures`] → [`sources`], [`programs`].

mod comparison;
mod exercises;
mod figures;
mod merge;
mod mistakes;
mod new_chapter;
mod nightly;
mod pages;
mod patches;
mod pictures;
mod programs;
mod sources;
mod survey;

use std::env;
use std::io::{ErrorKind, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::process::{self, ExitCode};
use std::time::Duration;

use anyhow::{Context, Result, bail};
use clap::{Parser, Subcommand};
use common::usage::Usage;
use manuscript::diff::{self, Parts};
use manuscript::fault::Fault;
use manuscript::project::{Chapter, Project, Unknown};
use patience::Limit;

use exercises::command::Practice;
use mistakes::reproduction;
use new_chapter::New;
use pages::book::Book;
use programs::program::Programs;
use survey::command::Survey;

/// Shows any two chapters side by side, and keeps the book's pages true to the code
#[derive(Debug, Parser)]
#[command(name = "chapters", disable_version_flag = true)]
struct Arguments {
    #[command(subcommand)]
    command: Command,

    /// The project's root
    #[arg(long, value_name = "DIR", global = true, default_value = concat!(env!("CARGO_MANIFEST_DIR"), "/../.."), hide_default_value = true)]
    root: PathBuf,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// List the chapters: what each teaches, builds on, and needs of the device
    List {
        /// As JSON, for scripts
        #[arg(long)]
        json: bool,
    },
    /// Show what a chapter changes in another, such as `diff 02 03`; coloured unless piped or NO_COLOR
    ///
    /// Its code and its shaders, unless a part is named. Of a chapter and one that builds on it, the other
    /// is the newer, whichever is named first.
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
        #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u16))]
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
    /// Fill in what pages show of the code: snippets, diffs, tables, gallery, contents
    Sync {
        /// Also render the pictures of these names, or all that are out of date
        #[arg(long, value_name = "NAME", num_args = 0..)]
        pictures: Option<Vec<String>>,
    },
    /// Run the commands that gave the figures of these pages or measurements, such as `05` or
    /// `05_shadow_miss/acne`, or of all that are out of date, and fill the figures in
    Measure {
        /// Chapters, pages, measurements; a time is measured again only if it is named
        names: Vec<String>,
    },
    /// Run every chapter on this device, hold it to its golden picture, and write a report card; exit code
    /// 1 if a chapter fails. About two minutes on a software driver; a GPU should take no longer
    Survey {
        /// Use this device: a number of --list-devices or a part of its name
        #[arg(long, value_name = "N|NAME")]
        device: Option<String>,
        /// Where the card goes, as Markdown and as JSON
        #[arg(long, value_name = "FOLDER", default_value = "target/survey")]
        out: PathBuf,
        /// Stop a program after so many whole seconds, 1 to 86400
        #[arg(long, value_name = "SECONDS", default_value_t = 180,
            value_parser = clap::value_parser!(u64).range(1..=86400))]
        limit: u64,
        /// Only print what would be run
        #[arg(long)]
        list: bool,
    },
    /// Make a copy of the shaders, or of all code, with a classic mistake in it, and say how to run it
    Mistake {
        /// Its name, as --list shows it
        name: Option<String>,
        /// List the mistakes
        #[arg(long)]
        list: bool,
        /// Where the copy goes [default: target/mistakes/NAME]
        #[arg(long, value_name = "FOLDER")]
        out: Option<PathBuf>,
        /// Run it and hold it to what its file claims; without a name, every one that is in shaders alone
        #[arg(long)]
        check: bool,
    },
    /// Do an exercise of a page: `exercise 05.2` sets it up and checks it on each save until it is solved
    Exercise(Practice),
    /// Add the files that --save has written: OUT is the picture (.png or .exr), or such a file again
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
    /// Make a website of the book with mdBook, to be read from a file or from any folder of a server
    Book {
        /// Where it goes: a folder that this command made before, or that is empty or new [default: book]
        #[arg(long, value_name = "FOLDER")]
        out: Option<PathBuf>,
    },
    /// Run the tests that plain `cargo test` leaves out, a test program after the other, with their times
    Nightly {
        /// Test programs, such as `samples`; all of them if none is named
        names: Vec<String>,
        /// Only list the tests, each with why it is left out
        #[arg(long)]
        list: bool,
    },
    /// Name everything that is stale, missing or stray; exit code 1 if anything is
    Check,
}

fn main() -> ExitCode {
    instruments::guard::exit_code(|| {
        // Whoever asks for a chapter that is not there has given a wrong argument.
        run(&parse()?).map_err(|error| match error.downcast() {
            Ok(Unknown(line)) => Usage(line).into(),
            Err(error) => error,
        })
    })
}

fn parse() -> Result<Arguments> {
    Arguments::try_parse().map_err(|error| {
        if !error.use_stderr() {
            common::output::print_and_exit(&error.to_string());
        }
        let text = error.to_string();
        // Without a command clap's error is the help, in which no line says what is missing.
        // What is required is listed in lines of its own below it.
        let mut lines = text.lines().skip_while(|line| !line.starts_with("error: "));
        let first = lines.next().map(|line| line.trim_start_matches("error: ").to_owned());
        let listed = lines.take_while(|line| line.starts_with("  ")).map(str::trim);
        let line = first.map(|first| listed.fold(first, |line, next| format!("{line} {next}")));
        let line = line.as_deref().unwrap_or(
            "no command; there is list, diff, new, sync, measure, merge, survey, mistake, exercise, book, nightly, check",
        );
        Usage(format!("{line}; --help lists the commands")).into()
    })
}

fn run(arguments: &Arguments) -> Result<()> {
    // These two have children to end first, and wait for it.
    if !matches!(arguments.command, Command::Survey { .. } | Command::Exercise(_)) {
        instruments::guard::watch();
    }
    let project = Project::open(&arguments.root)?;
    match &arguments.command {
        Command::List { json } => print(&list(&project, *json)?),
        Command::Diff { old, new, stat, code, shaders, page, context } => {
            let (mut old, mut new) = (project.chapter(old)?, project.chapter(new)?);
            // What a chapter adds is read from its parent on, whichever is named first.
            if project.descends(old, new) {
                (old, new) = (new, old);
            }
            let all = !(*code || *shaders || *page);
            let parts = Parts { code: *code || all, shaders: *shaders || all, page: *page };
            let diffs = diff::chapters(&project, old, new, parts)?;
            let mut text = comparison::heading(old, new);
            if !stat {
                text.push_str(&comparison::read_first(&diffs));
                text.push_str(&comparison::changes(old, new, &diffs, usize::from(*context)));
            }
            text.push_str(&comparison::statistics(&diffs));
            print(&text)
        }
        Command::New { number, name, from } => {
            let new = New::plan(&project, *number, name, project.chapter(from)?)?;
            let files = new.write()?;
            let list: String = files.iter().map(|file| format!("{file}\n")).collect();
            print(&format!("{list}\nNext:\n{}", new.next()))
        }
        Command::Survey { device, out, limit, list } => {
            let programs = Programs::beside_this(&project.root)?;
            let limit = Limit::waited(Duration::from_secs(*limit));
            let survey =
                Survey { project: &project, programs: &programs, device: device.as_deref(), limit };
            match list {
                true => print(&survey.list()),
                false => survey.run(out),
            }
        }
        Command::Mistake { name, list, out, check } => {
            reproduction::mistake(&project, name.as_deref(), *list, out.as_deref(), *check)
        }
        Command::Exercise(practice) => practice.run(&project),
        Command::Measure { names } => measure(&project, names),
        Command::Sync { pictures } => sync(&project, pictures.as_deref()),
        Command::Book { out } => site(&project, out.as_deref()),
        Command::Merge { out, files, samples } => print(&merge::run(out, files, samples.clone())?),
        Command::Nightly { names, list } => nightly::run(&project, names, *list),
        Command::Check => {
            let programs = Programs::beside_this(&project.root)?;
            report(&Book::open(&project, &programs)?.check())
        }
    }
}

/// Runs the program that makes the website: mdBook is compiled for it alone.
fn site(project: &Project, out: Option<&Path>) -> Result<()> {
    let mut cargo = process::Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    cargo.args(["run", "--quiet", "--package", "site", "--manifest-path"]);
    cargo.arg(project.root.join("Cargo.toml")).arg("--").arg("--root").arg(&project.root);
    if let Some(out) = out {
        cargo.arg("--out").arg(out);
    }
    let status = cargo.status().context("cargo does not start")?;
    // It has said itself what is wrong.
    if status.success() { Ok(()) } else { process::exit(status.code().unwrap_or(1)) }
}

fn list(project: &Project, json: bool) -> Result<String> {
    if json {
        return Ok(serde_json::to_string_pretty(&project.chapters)? + "\n");
    }
    let width = |of: fn(&Chapter) -> &str| {
        project.chapters.iter().map(|chapter| of(chapter).chars().count()).max().unwrap_or(0)
    };
    let (names, titles) = (width(|chapter| &chapter.name), width(|chapter| &chapter.title));
    let line = |chapter: &Chapter| {
        let Chapter { name, title, teaches, from, needs, .. } = chapter;
        // As `diff` takes it: a number is enough.
        let from = from.as_deref().and_then(|from| from.split('_').next()).unwrap_or("–");
        let needs = match &needs[..] {
            [] => String::new(),
            _ => format!(" (needs {})", needs.join(", ")),
        };
        format!("{name:names$}  {title:titles$}  from {from:2}  {teaches}{needs}\n")
    };
    let parts = project.parted().into_iter().map(|(heading, chapters)| {
        let heading = if heading.is_empty() { heading } else { heading + "\n" };
        heading + &chapters.into_iter().map(line).collect::<String>()
    });
    Ok(parts.collect::<Vec<_>>().join("\n"))
}

fn sync(project: &Project, pictures: Option<&[String]>) -> Result<()> {
    let programs = Programs::beside_this(&project.root)?;
    let book = Book::open(project, &programs)?;
    book.check_pictures(pictures.unwrap_or_default())?;
    let (changed, mut faults) = book.sync()?;
    for file in changed {
        print(&format!("{file}: renewed\n"))?;
    }
    if let Some(names) = pictures {
        let failed = book.render(names, |file, device| {
            let _ = print(&format!("{file}: rendered on {device}\n"));
        })?;
        faults.extend(failed);
    }
    report(&faults)
}

fn measure(project: &Project, names: &[String]) -> Result<()> {
    let programs = Programs::beside_this(&project.root)?;
    let mut faults = Book::open(project, &programs)?.measure(names, |line| {
        let _ = print(&format!("{line}\n"));
    })?;
    let (changed, others) = Book::open(project, &programs)?.sync()?;
    for file in changed {
        print(&format!("{file}: renewed\n"))?;
    }
    faults.extend(others);
    report(&faults)
}

/// Prints what is wrong; an error if anything is.
fn report(faults: &[Fault]) -> Result<()> {
    print(&faults.iter().map(|fault| format!("{fault}\n")).collect::<String>())?;
    match faults.len() {
        0 => Ok(()),
        1 => bail!("1 fault in the book"),
        count => bail!("{count} faults in the book"),
    }
}

/// Prints to standard output, without colours where nobody would see them.
fn print(text: &str) -> Result<()> {
    match anstream::stdout().write_all(text.as_bytes()) {
        // A reader that has seen enough, as `head` has.
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        result => result.context("cannot write to standard output"),
    }
}
