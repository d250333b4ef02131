//! `chapters survey`: runs every chapter on this device, each in its own process, and records the result.
//!
//! A chapter that fails, crashes, loses the device or hangs becomes a line of the card; the others still run.
//! Nothing is written before all have finished.

use std::error::Error;
use std::fmt::{Display, Formatter};
use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::{Instant, SystemTime};

use anyhow::{Context, Result, anyhow, bail};
use common::UsageError;
use common::files::{NewFolder, check_writable, folder};
use common::output::print;
use instruments::report::Limits;
use manuscript::project::Chapter;
use serde_json::Value;
use time_limit::Limit;

use super::card::{self, Card, Device};
use super::card_page;
use super::{accuracy, atlas};
use crate::patches::copy::file_on_the_way;
use crate::programs::child::{self, Ended};
use crate::programs::interrupt;
use crate::programs::program::Programs;

/// The size and number of the timed pictures. A GPU needs enough rays to be full, and some time to raise its
/// clocks.
const TIMED_ON_SOFTWARE: (&str, &str) = ("480x300", "9");
const TIMED_ON_A_GPU: (&str, &str) = ("1920x1200", "61");

/// The argument that turns validation on.
pub const VALIDATE: &str = "--validate";

/// The atlas's name in the progress lines.
const ATLAS: &str = "atlas";

/// The start of a program's error message if there is no device.
const NO_DRIVER: &str = "no Vulkan driver";

/// The start of its error message if no device is suitable.
const NO_DEVICE: &str = "no device can run this";
/// The name of a software driver's device, and the driver whose device made the golden pictures.
const SOFTWARE: &str = "llvmpipe";
const GOLDEN_DRIVER: &str = "llvmpipe Mesa 25.0.7";

/// A device that executes nothing, such as a stand-in for a card: its results would be false.
#[derive(Debug)]
struct Idle {
    device: String,
    chapter: String,
}

impl Display for Idle {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        let Self { device, chapter } = self;
        write!(
            f,
            "{device} executes nothing: every pixel of {chapter} is zero; there is nothing to judge"
        )
    }
}

impl Error for Idle {}

/// A survey of one device.
pub struct Survey<'a> {
    /// Their programs.
    pub programs: &'a Programs<'a>,
    /// The device, as given to `--device`.
    pub device: Option<&'a str>,
    /// The longest time of a program.
    pub limit: Limit,
    /// The arithmetic of the atlas, if one is requested; for one other than the driver's, only the atlas is
    /// made.
    pub atlas: Option<&'a str>,
}

impl Survey<'_> {
    /// The runs, one line per program.
    pub fn list(&self) -> String {
        let project = self.programs.project;
        let line = |chapter: &Chapter| {
            let arguments: String =
                chapter.golden.iter().map(|argument| format!(" {argument}")).collect();
            format!(
                "{}: --headless --validate{arguments}, against {}\n",
                chapter.name,
                golden(chapter)
            )
        };
        let mut text: String = project.chapters.iter().map(line).collect();
        if self.is_alone() {
            text.clear();
        }
        for (what, arguments) in self.laboratory(Path::new("FOLDER")) {
            text.push_str(&format!("{}: {} ({what})\n", accuracy::NAME, arguments.join(" ")));
        }
        text
    }

    /// Returns whether the card has only an atlas.
    fn is_alone(&self) -> bool {
        self.atlas.is_some_and(|arithmetic| arithmetic != atlas::DRIVER)
    }

    /// The runs of 24.
    fn laboratory(&self, folder: &Path) -> Vec<(&'static str, Vec<String>)> {
        let project = self.programs.project;
        let mut runs = accuracy::runs(project, folder);
        if self.is_alone() {
            runs.clear();
        }
        let arithmetic = self.atlas.filter(|_| project.named(accuracy::NAME).is_some());
        runs.extend(arithmetic.map(|arithmetic| (ATLAS, atlas::run(folder, arithmetic))));
        runs
    }

    /// Runs everything, prints a line per chapter, and writes the card to a folder.
    ///
    /// # Errors
    /// If there is no device, it executes nothing, the card cannot be written, a signal requests termination,
    /// or a chapter fails; in the last case the message says where the card is.
    pub fn run(&self, out: &Path) -> Result<()> {
        let project = self.programs.project;
        interrupt::listen();
        check_place(out)?;
        self.build()?;
        self.check_device()?;
        let folder = NewFolder::temporary()?;
        let laboratory = self.laboratory(folder.path());
        let chapters = if self.is_alone() { &[] } else { &project.chapters[..] };
        let mut countdown = Countdown::new(chapters.len() + laboratory.len());
        let limit = self.limit;
        print(&format!("{} lines to come; a program is stopped after {limit}\n", countdown.all))?;
        let mut card = Card {
            date: humantime::format_rfc3339_seconds(SystemTime::now()).to_string()[..10].to_owned(),
            system: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
            commit: self.commit(),
            validated: true,
            tolerance: flip::TOLERANCE,
            ..Card::default()
        };
        for chapter in chapters {
            let line = self.chapter(chapter, folder.path(), &mut card)?;
            interrupt::asked()?;
            let told = match (&line.failed, &line.lacks, line.milliseconds) {
                (Some(why), ..) => why.clone(),
                (None, Some(lacks), _) => format!("not run: the device lacks {lacks}"),
                (None, None, milliseconds) => {
                    format!("passes, {:.2} ms", milliseconds.unwrap_or_default())
                }
            };
            countdown.told(&chapter.name, &told)?;
            card.chapters.push(line);
        }
        let mut drawn = None;
        for (what, arguments) in &laboratory {
            let mut result = self.ask(accuracy::NAME, arguments);
            if lacks_layer(&result) {
                card.validated = false;
                let without = arguments.iter().filter(|word| *word != VALIDATE).cloned();
                result = self.ask(accuracy::NAME, &without.collect::<Vec<_>>());
            }
            let failed = result.err().map(|error| told(&error));
            interrupt::asked()?;
            countdown.told(what, failed.as_deref().unwrap_or("done"))?;
            match *what {
                accuracy::HARD_CASES => {
                    card.hard_cases = accuracy::hard_cases(failed, folder.path());
                }
                accuracy::RANDOM_RAYS => card.measured = accuracy::measured(failed, folder.path()),
                _ => {
                    let (atlas, device, text) = atlas::found(failed, folder.path());
                    drawn = Some(card_page::atlas(&text));
                    card.device = card.device.or(device);
                    card.atlas = Some(atlas);
                }
            }
        }
        let stem = card.stem();
        let json = card.json()?;
        common::files::write_whole(&out.join(format!("{stem}.json")), json.as_bytes())?;
        let text = card_page::card(&card) + drawn.as_deref().unwrap_or_default();
        common::files::write_whole(&out.join(format!("{stem}.md")), text.as_bytes())?;
        let files = format!("{stem}.md and {stem}.json in {}", out.display());
        let (passed, all) = (card.passed(), card.offered());
        if card.fails() {
            bail!(
                "{passed} of {all} chapters pass, hard cases and measurements apart; the card is {files}"
            );
        }
        let passed =
            if self.is_alone() { "done".to_owned() } else { format!("{all} chapters pass") };
        print(&format!("{passed}; the card is {files}\n"))
    }

    /// The surveyed commit, marked if code or shaders differ from it.
    fn commit(&self) -> Option<String> {
        let git = |arguments: &[&str]| {
            let mut git = Command::new("git");
            let ended = git.args(arguments).current_dir(&self.programs.project.root);
            let ended = child::run(ended, Limit::NONE).ok().filter(Ended::succeeded)?;
            Some(ended.told.trim().to_owned())
        };
        let commit = git(&["rev-parse", "--short=12", "HEAD"])?;
        let changed = git(&["status", "--porcelain", "--", "samples", "common", "shaders"])?;
        Some(if changed.is_empty() { commit } else { commit + "+" })
    }

    /// Builds the programs if one is missing or older than its sources.
    fn build(&self) -> Result<()> {
        let project = self.programs.project;
        let names = project.chapters.iter().map(|chapter| &*chapter.name);
        let mut stale = names.filter_map(|name| self.programs.command(name).err());
        let Some(why) = stale.next() else { return Ok(()) };
        print(&format!("{why}: cargo build --bins, some minutes the first time\n"))?;
        let mut cargo = child::cargo(&project.root);
        cargo.args(["build", "--quiet", "--bins"]);
        if self.programs.are_released() {
            cargo.arg("--release");
        }
        // Build failures are reported chapter by chapter.
        child::show(&mut cargo).map(drop)
    }

    /// Fails early if there is no device, or `--device` matches none.
    fn check_device(&self) -> Result<()> {
        let Some(chapter) = self.programs.project.chapters.last() else { return Ok(()) };
        let ended = self.end_of(&chapter.name, &words(&["--list-controls"]))?;
        if let Some(line) = ended.refused().filter(|_| self.device.is_some()) {
            return Err(UsageError(line).into());
        }
        // Any other failure becomes a line of the card.
        match ended.failed().filter(|line| line.starts_with(NO_DRIVER)) {
            Some(line) => bail!("{line}"),
            None => Ok(()),
        }
    }

    /// Returns whether a program finds that the device executes nothing: it says so if there are no rays to print.
    fn is_idle(&self) -> bool {
        let Some(chapter) = self.programs.project.chapters.last() else { return false };
        let pixel = words(&["--headless", "--size", "8x8", "--pixel", "0,0"]);
        self.ask(&chapter.name, &pixel)
            .is_err_and(|error| told(&error).contains("executes nothing"))
    }

    /// Runs a program to its end.
    ///
    /// # Errors
    /// If it cannot be run, or fails; in one line.
    fn ask(&self, name: &str, arguments: &[String]) -> Result<()> {
        match self.end_of(name, arguments)?.failed() {
            Some(why) => bail!("{why}"),
            None => Ok(()),
        }
    }

    fn end_of(&self, name: &str, arguments: &[String]) -> Result<Ended> {
        let mut command = self.programs.command(name).map_err(anyhow::Error::msg)?;
        if let Some(shaders) = std::env::var_os("SHADERS") {
            command.env("SHADERS", shaders);
        }
        if let Some(device) = self.device {
            command.args(["--device", device]);
        }
        child::run(command.args(arguments), self.limit)
    }

    /// Runs one chapter: its golden picture under validation, its time, and the compilers' statistics.
    ///
    /// # Errors
    /// If the device executes nothing.
    fn chapter(
        &self,
        chapter: &Chapter,
        folder: &Path,
        card: &mut Card,
    ) -> Result<card::ChapterResult> {
        let mut line =
            card::ChapterResult { name: chapter.name.clone(), ..card::ChapterResult::default() };
        if let Err(error) = self.try_chapter(chapter, folder, card, &mut line) {
            if error.is::<Idle>() {
                return Err(error);
            }
            let why = told(&error);
            // A chapter whose requirements are missing is not judged.
            let lacking = chapter.needs.iter().find(|extension| {
                why.starts_with(NO_DEVICE) && why.contains(&format!("lacks {extension}"))
            });
            match lacking {
                Some(extension) => line.lacks = Some(extension.clone()),
                None => line.failed = Some(why),
            }
        }
        Ok(line)
    }

    fn try_chapter(
        &self,
        chapter: &Chapter,
        folder: &Path,
        card: &mut Card,
        line: &mut card::ChapterResult,
    ) -> Result<()> {
        let (picture, report) = (folder.join("picture.png"), folder.join("report.json"));
        for file in [&picture, &report] {
            let _ = fs::remove_file(file);
        }
        let golden = self.programs.project.root.join(golden(chapter));
        let golden = image::open(&golden)
            .map_err(|_| anyhow::Error::msg("its golden picture is missing"))?;
        let golden = golden.to_rgb8();
        let (width, height) = golden.dimensions();
        let run = |validate: bool, more: &[&str], size: &str| {
            let mut arguments = words(&["--headless", "--size", size, "--report"]);
            arguments.push(report.to_string_lossy().into_owned());
            arguments.extend(validate.then(|| VALIDATE.to_owned()));
            arguments.extend(words(more));
            self.ask(&chapter.name, &arguments)
        };
        let out = picture.to_string_lossy();
        let mut drawn = vec!["--out", &*out];
        drawn.extend(chapter.golden.iter().map(String::as_str));
        let size = format!("{width}x{height}");
        let mut result = run(card.validated, &drawn, &size);
        // Without the layer, the pictures can still be compared.
        if card.validated && lacks_layer(&result) {
            card.validated = false;
            result = run(false, &drawn, &size);
        }
        let said = read(&report).unwrap_or_default();
        // 01, which is a single file, reports no limits.
        let known = card.device.as_ref().is_some_and(|device| device.limits != Limits::default());
        card.device = if known { card.device.take() } else { device(&said) };
        line.validation_messages = said["validation_messages"].as_array().map_or(0, Vec::len);
        result?;
        let shown = image::open(&picture).context("it has written no picture")?.to_rgb8();
        if shown.iter().all(|channel| *channel == 0) && self.is_idle() {
            let device = said["device"].as_str().unwrap_or("this device").to_owned();
            bail!(Idle { device, chapter: chapter.name.clone() });
        }
        let mean = flip::mean((width, height), &golden, &shown);
        let is_software = said["device"].as_str().is_some_and(|name| name.starts_with(SOFTWARE));
        let made_golden =
            said["driver"].as_str().is_some_and(|name| name.starts_with(GOLDEN_DRIVER));
        let tolerance = if made_golden {
            flip::TOLERANCE
        } else {
            // A picture of the device's own errors may look like anything.
            flip::near::golden(&chapter.name, (width, height), flip::TOLERANCE).unwrap_or(1.0)
        };
        (line.mean_flip, line.tolerance) = (Some(mean), Some(tolerance));
        let (size, frames) = if is_software { TIMED_ON_SOFTWARE } else { TIMED_ON_A_GPU };
        run(false, &["--frames", frames, "--compiler-figures"], size)
            .context("without validation")?;
        card.timed = size.to_owned();
        let said = read(&report)?;
        line.milliseconds = said["gpu_milliseconds"]["median"].as_f64();
        line.compiler = rows(&said["executables"]);
        // RADV may be missing or refuse; then there are no statistics.
        if run(false, &["--compile-for", "navi31"], "8x8").is_ok() {
            line.radv = rows(&read(&report)?["compiled_for"]);
        }
        if mean > tolerance {
            bail!("its picture differs: mean FLIP {mean:.4}, above {tolerance}");
        }
        Ok(())
    }
}

/// Returns whether a program did not run because the validation layer is not installed.
fn lacks_layer(result: &Result<()>) -> bool {
    result.as_ref().is_err_and(|error| told(error).contains("--validate needs"))
}

/// Creates the folder for the card, and fails if the card could not be written there.
fn check_place(out: &Path) -> Result<()> {
    let another = "name another folder with --out";
    if let Some(file) = file_on_the_way(out) {
        let what = format!("'{}' is a file, and the card goes to a folder", file.display());
        return Err(UsageError(format!("{what}; {another}")).into());
    }
    folder::make(out)
        .and_then(|()| check_writable(&out.join("card.md")))
        .map_err(|error| anyhow!("the card cannot go to '{}': {error:#}; {another}", out.display()))
}

/// Prints the progress and an estimate of the remaining time.
struct Countdown {
    all: usize,
    done: usize,
    start: Instant,
}

impl Countdown {
    fn new(all: usize) -> Self {
        Self { all, done: 0, start: Instant::now() }
    }

    fn told(&mut self, name: &str, what: &str) -> Result<()> {
        self.done += 1;
        let left =
            self.start.elapsed().as_secs_f64() / self.done as f64 * (self.all - self.done) as f64;
        let left =
            if self.done < self.all { format!("; about {left:.0} s left") } else { String::new() };
        print(&format!("[{}/{}] {name}: {what}{left}\n", self.done, self.all))
    }
}

/// A chapter's golden picture.
fn golden(chapter: &Chapter) -> String {
    format!("tests/golden/{}.png", chapter.name)
}

/// Arguments of a program.
pub fn words(words: &[&str]) -> Vec<String> {
    words.iter().map(|word| (*word).to_owned()).collect()
}

/// An error in the form used on a card: one line, without paths of this machine.
pub fn told(error: &anyhow::Error) -> String {
    card::without_paths(&format!("{error:#}").replace('\n', " "))
}

/// Reads the report of a program.
pub fn read(report: &Path) -> Result<Value> {
    let text = fs::read_to_string(report).context("it has written no report")?;
    serde_json::from_str(&text).context("its report is no JSON")
}

/// The device of a report, if the report has its limits.
pub fn device(report: &Value) -> Option<Device> {
    let text = |key: &str| report[key].as_str().map(str::to_owned);
    let limits = serde_json::from_value(report["limits"].clone()).ok()?;
    Some(Device::new(text("device")?, text("driver")?, limits))
}

/// The rows of a list, without those of another shape.
pub fn rows<T: serde::de::DeserializeOwned>(list: &Value) -> Vec<T> {
    let rows = list.as_array().into_iter().flatten();
    rows.filter_map(|row| serde_json::from_value(row.clone()).ok()).collect()
}
