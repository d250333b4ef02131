//! Keeps the book's pages consistent with the code, and shows readers any two chapters side by side.
//!
//! - `list`: the chapters, what each teaches and builds on
//! - `diff A B`: the changes from one chapter to another: code, shaders and page
//! - `new 13 NAME --from 05`: makes a chapter that compiles, runs and is tested
//! - `start ../my_tracer`: makes a crate of a reader's own, outside the workspace
//! - `sync`: fills snippets, diffs, tables, gallery and contents; `--pictures` renders what is out of date
//! - `mistake NAME`: makes a patched copy of a chapter that shows a classic mistake
//! - `exercise 05.2`: sets up an exercise for a reader, and checks it on each save
//! - `measure`: runs the commands that give the pages' values, and fills those in
//! - `verify`: runs the commands of pictures, mistakes and values again, and compares
//! - `merge OUT FILE…`: adds the sums that parts of a long render have saved
//! - `hard`: runs hard cases and random rays by the textbook's formulas and ours
//! - `prices`: measures what accuracy costs on this device, the table of `docs/prices.md`
//! - `survey`: runs every chapter on this device and writes a report card
//! - `book`: makes a website of the pages
//! - `tour`: makes the README's moving picture
//! - `words`: counts the words of each page
//! - `check`: reports everything that is stale, missing or stray, and every missing thing a page mentions, each
//!   with a remedy
//!
//! The layers, each of which depends only on those below it:
//!
//! - [`pages`]: their contents, and the checks of their statements
//! - [`exercises`], [`values`], [`mistakes`], [`survey`], [`prices`]: their parts of the pages, and their commands
//! - [`patches`], [`pictures`]: changed editions of the code; rendered pictures
//! - [`programs`]: the programs that are run

mod arguments;
mod chapter_list;
mod comparison;
mod exercises;
mod hard;
mod merge;
mod mistakes;
mod new_chapter;
mod nightly;
mod pages;
mod patches;
mod pictures;
mod prices;
mod programs;
mod start;
mod survey;
mod values;
mod verify;

use std::path::Path;
use std::process::{self, ExitCode};
use std::time::Duration;

use anyhow::{Result, bail};
use common::UsageError;
use common::gpu::DriverShim as _;
use common::output::{complain, print};
use manuscript::diff::{self, Parts};
use manuscript::fault::Fault;
use manuscript::project::{Project, Unknown};
use time_limit::Limit;

use arguments::{Arguments, Command, parse};
use new_chapter::NewChapter;
use pages::book::Book;
use pages::breath;
use pictures::tour;
use programs::child;
use programs::program::Programs;
use start::Start;
use survey::command::Survey;

fn main() -> ExitCode {
    common::exit::exit_code(|| {
        // An unknown chapter is an error in the arguments.
        run(&parse()?).map_err(|error| match error.downcast() {
            Ok(Unknown(line)) => UsageError(line).into(),
            Err(error) => error,
        })
    })
}

fn run(arguments: &Arguments) -> Result<()> {
    common::exit::watch();
    let project = Project::open(&arguments.root)?;
    match &arguments.command {
        Command::List { json } => print(&chapter_list::list(&project, *json)?),
        Command::Diff { old, new, stat, code, shaders, page, context } => {
            let (mut old, mut new) = (project.chapter(old)?, project.chapter(new)?);
            // A chapter's changes are shown relative to its parent, whichever is named first.
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
            comparison::print(&text)
        }
        Command::New { number, name, from } => {
            let new = NewChapter::plan(&project, *number, name, project.chapter(from)?)?;
            let files = new.write()?;
            let list: String = files.iter().map(|file| format!("{file}\n")).collect();
            print(&format!("{list}\nNext:\n{}", new.next()))
        }
        Command::Start { folder, git, apart } => {
            let programs = Programs::beside_this(&project)?;
            let start = Start::plan(&programs, folder, git.as_deref(), *apart)?;
            let list: String = start.write()?.iter().map(|file| format!("{file}\n")).collect();
            print(&format!("{list}\nNext:\n{}", start.next()))
        }
        Command::Survey { device, out, limit, full, risky, atlas, arithmetic, list } => {
            let programs = Programs::beside_this(&project)?;
            let limit = Limit::waited(Duration::from_secs(*limit));
            let mut survey = Survey::new(&programs, limit, *full);
            survey.device = device.as_deref();
            survey.atlas = atlas.then(|| arithmetic.name());
            survey.risky = *risky;
            if *list { print(&survey.list()) } else { survey.run(out) }
        }
        Command::Hard(arguments) => arguments.run(&project),
        Command::Prices(arguments) => arguments.run(&project),
        Command::Mistake { name, list, out, check } => {
            mistakes::command::run(&project, name.as_deref(), *list, out.as_deref(), *check)
        }
        Command::Exercise(arguments) => arguments.run(&project),
        Command::Measure { names } => measure(&project, names),
        Command::Sync { pictures } => sync(&project, pictures.as_deref()),
        Command::Book { out } => site(&project, out.as_deref()),
        Command::Merge { out, files, samples } => print(&merge::run(out, files, samples.clone())?),
        Command::Nightly { names, list } => nightly::run(&project, names, *list),
        Command::Tour => print(&tour::make(&project)?),
        Command::Words => print(&breath::table(&project)),
        Command::Verify { names, changed } => {
            let programs = Programs::beside_this(&project)?;
            verify::run(&Book::open(&programs)?, names, *changed)
        }
        Command::Check => {
            let programs = Programs::beside_this(&project)?;
            let book = Book::open(&programs)?;
            for warning in book.warnings() {
                complain(&format!("warning: {warning}"));
            }
            report(&book.check()?)
        }
    }
}

/// Runs the program that makes the website, which alone depends on mdBook.
fn site(project: &Project, out: Option<&Path>) -> Result<()> {
    // In the current folder, because `--out` is relative to it.
    let mut cargo = child::cargo(Path::new("."));
    cargo.args(["run", "--quiet", "--package", "site", "--manifest-path"]);
    cargo.arg(project.root.join("Cargo.toml")).arg("--").arg("--root").arg(&project.root);
    if let Some(out) = out {
        cargo.arg("--out").arg(out);
    }
    let status = child::show(&mut cargo)?;
    // It has printed its own error.
    if status.success() { Ok(()) } else { process::exit(status.code().unwrap_or(1)) }
}

fn sync(project: &Project, pictures: Option<&[String]>) -> Result<()> {
    let programs = Programs::beside_this(project)?;
    let book = Book::open(&programs)?;
    book.check_pictures(pictures.unwrap_or_default())?;
    let (changed, mut faults) = book.sync()?;
    for file in changed {
        print(&format!("{file}: renewed\n"))?;
    }
    if let Some(names) = pictures {
        let failed = book.render(names, |file, became| {
            let _ = print(&format!("{file}: {became}\n"));
        })?;
        faults.extend(failed);
    }
    report(&faults)
}

fn measure(project: &Project, names: &[String]) -> Result<()> {
    let programs = Programs::beside_this(project)?;
    let mut faults = Book::open(&programs)?.measure(names, |line| {
        let _ = print(&format!("{line}\n"));
    })?;
    let (changed, others) = Book::open(&programs)?.sync()?;
    for file in changed {
        print(&format!("{file}: renewed\n"))?;
    }
    faults.extend(others);
    report(&faults)
}

/// Prints the faults; returns an error if there are any.
fn report(faults: &[Fault]) -> Result<()> {
    print(&faults.iter().map(|fault| format!("{fault}\n")).collect::<String>())?;
    match faults.len() {
        0 => Ok(()),
        1 => bail!("1 fault in the book"),
        count => bail!("{count} faults in the book"),
    }
}
