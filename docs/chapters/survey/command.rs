//! `chapters survey`: runs every chapter on this device, each in its own process, and records the result.
//!
//! A chapter that fails, crashes, loses the device or hangs becomes a line of the card; the others still run.
//! Nothing is written before all have finished.

use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, SystemTime};

use anyhow::{Context, Result, anyhow, bail};
use common::UsageError;
use common::files::{NewFolder, check_writable, folder};
use common::output::print;
use serde_json::Value;
use time_limit::Limit;

use super::card::{self, Card, Device};
use super::chapter::golden;
use super::price::{self, PriceList};
use super::steps::{Allowance, Progress, Step};
use super::{accuracy, atlas, card_page, faults};
use crate::patches::copy::file_on_the_way;
use crate::programs::child::{self, Ended, STOPPED};
use crate::programs::interrupt;
use crate::programs::program::Programs;

/// The argument that turns validation on.
pub const VALIDATE: &str = "--validate";

/// The atlas's name in the progress lines.
const ATLAS: &str = "atlas";

/// The start of a program's error message if there is no device.
const NO_DRIVER: &str = "no Vulkan driver";

/// The time that a survey may take unless it is full.
const ALLOWED: Duration = Duration::from_secs(180);

/// A survey of one device.
pub struct Survey<'a> {
    /// Their programs.
    pub programs: &'a Programs<'a>,
    /// The device, as given to `--device`.
    pub device: Option<&'a str>,
    /// The longest time of a program.
    pub limit: Limit,
    /// True to take as long as it takes, and to measure also times, compilers' figures and random rays.
    pub full: bool,
    /// True to look for faults that may hang the machine.
    pub risky: bool,
    /// The arithmetic of the atlas, if one is requested; for one other than the driver's, only the atlas is
    /// made.
    pub atlas: Option<&'a str>,
    /// The time it may take; [`Survey::run`] restarts it.
    allowance: Allowance,
}

impl<'a> Survey<'a> {
    /// A survey that has not begun.
    pub fn new(programs: &'a Programs<'a>, limit: Limit, full: bool) -> Self {
        let allowance = Allowance::new(None);
        Self { programs, device: None, limit, full, risky: false, atlas: None, allowance }
    }

    /// The runs, one line per program.
    pub fn list(&self) -> String {
        let prices = PriceList::new(self.programs);
        let line = |step: &Step| match step {
            Step::Chapter(chapter) => {
                let arguments: String =
                    chapter.golden.iter().map(|argument| format!(" {argument}")).collect();
                let golden = golden(chapter);
                format!("{}: --headless --validate{arguments}, against {golden}\n", chapter.name)
            }
            Step::Laboratory(what, arguments) => {
                format!("{}: {} ({what})\n", accuracy::NAME, arguments.join(" "))
            }
            Step::Price(record) => format!("prices: {record}\n"),
        };
        self.steps(Path::new("FOLDER"), &prices).iter().map(line).collect()
    }

    /// Returns whether the card has only an atlas.
    fn is_alone(&self) -> bool {
        self.atlas.is_some_and(|arithmetic| arithmetic != atlas::DRIVER)
    }

    /// Everything it runs. What matters most comes first, in case the time is not enough for all; what may hang the
    /// machine comes last.
    fn steps(&self, folder: &Path, prices: &PriceList) -> Vec<Step<'a>> {
        let project = self.programs.project;
        let has_laboratory = project.named(accuracy::NAME).is_some();
        let atlas = self.atlas.filter(|_| has_laboratory);
        let atlas = atlas.map(|arithmetic| (ATLAS, atlas::run(folder, arithmetic)));
        let laboratory = |(what, arguments)| Step::Laboratory(what, arguments);
        if self.is_alone() {
            return atlas.map(laboratory).into_iter().collect();
        }
        let mut steps = Vec::new();
        if has_laboratory {
            steps.push((accuracy::HARD_CASES, accuracy::hard(folder)));
            steps.push((faults::KNOWN, faults::run(folder, false)));
        }
        let mut steps: Vec<Step> = steps.into_iter().map(laboratory).collect();
        steps.extend(project.chapters.iter().map(Step::Chapter));
        steps.extend(prices.records().into_iter().map(Step::Price));
        if has_laboratory && self.full {
            steps.push(laboratory((accuracy::RANDOM_RAYS, accuracy::random(folder))));
        }
        steps.extend(atlas.map(laboratory));
        if has_laboratory && self.risky {
            steps.push(laboratory((faults::RISKY, faults::run(folder, true))));
        }
        steps
    }

    /// Runs everything, prints a line per step, and writes the card to a folder.
    ///
    /// # Errors
    /// If there is no device, it executes nothing, the card cannot be written, a signal requests termination,
    /// or a step fails; in the last case the message says where the card is.
    pub fn run(mut self, out: &Path) -> Result<()> {
        interrupt::listen();
        check_place(out)?;
        // A program that is built, even if it is old, can refuse a device before minutes of building.
        self.check_device(true)?;
        self.build()?;
        self.check_device(false)?;
        let folder = NewFolder::temporary()?;
        let prices = PriceList::new(self.programs);
        let steps = self.steps(folder.path(), &prices);
        let time = (!self.full && !self.is_alone()).then_some(ALLOWED);
        let most = time
            .map_or(String::new(), |time| format!(", all after {} minutes", time.as_secs() / 60));
        let (count, limit) = (steps.len(), self.limit);
        print(&format!("{count} lines to come; a program is stopped after {limit}{most}\n"))?;
        self.allowance = Allowance::new(time);
        let mut progress = Progress::new(steps.len())?;
        let mut card = Card {
            date: humantime::format_rfc3339_seconds(SystemTime::now()).to_string()[..10].to_owned(),
            system: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
            commit: self.commit(),
            validated: true,
            full: self.full || self.is_alone(),
            tolerance: flip::TOLERANCE,
            ..Card::default()
        };
        let mut drawn = None;
        for step in &steps {
            let name = step.name();
            if self.allowance.is_over() {
                progress.end(&name, "left out: the time is over")?;
                card.left_out.push(name);
                continue;
            }
            progress.begin(&name);
            let told = match step {
                Step::Chapter(chapter) => {
                    let line = self.chapter(chapter, folder.path(), &mut card)?;
                    let told = line.result();
                    if !self.was_cut(&told) {
                        card.chapters.push(line);
                    }
                    told
                }
                Step::Price(record) => {
                    let limit = self.allowance.within(self.limit);
                    let measured = prices.measure(self.programs, record, self.device, limit, told);
                    let told = price::told(&measured);
                    if !self.was_cut(&told) {
                        card.prices.extend(measured);
                    }
                    told
                }
                Step::Laboratory(what, arguments) => {
                    let failed = self.laboratory(arguments, &mut card);
                    let told = failed.clone().unwrap_or_else(|| "done".to_owned());
                    self.take(what, failed, folder.path(), &mut card, &mut drawn);
                    told
                }
            };
            interrupt::asked()?;
            progress.end(&name, &told)?;
            if self.was_cut(&told) {
                card.left_out.push(name);
            }
        }
        drop(progress);
        write(&card, drawn.as_deref(), out, self.is_alone())
    }

    /// True if a step ended because the survey's time was over.
    fn was_cut(&self, told: &str) -> bool {
        self.allowance.is_over() && told.starts_with(STOPPED)
    }

    /// Runs chapter 24, without validation if that is not installed; returns the reason if it fails.
    fn laboratory(&self, arguments: &[String], card: &mut Card) -> Option<String> {
        let mut result = self.ask(accuracy::NAME, arguments);
        if lacks_layer(&result) {
            card.validated = false;
            let without = arguments.iter().filter(|word| *word != VALIDATE).cloned();
            result = self.ask(accuracy::NAME, &without.collect::<Vec<_>>());
        }
        result.err().map(|error| told(&error))
    }

    /// Puts what a run of chapter 24 has found onto the card, and the text of an atlas into `drawn`.
    fn take(
        &self,
        what: &str,
        failed: Option<String>,
        folder: &Path,
        card: &mut Card,
        drawn: &mut Option<String>,
    ) {
        match what {
            accuracy::HARD_CASES => card.hard_cases = accuracy::hard_cases(failed, folder),
            accuracy::RANDOM_RAYS => card.measured = accuracy::measured(failed, folder),
            faults::KNOWN | faults::RISKY => {
                card.faults.extend(faults::found(what, failed, folder));
            }
            _ => {
                let (atlas, device, text) = atlas::found(failed, folder);
                *drawn = Some(card_page::atlas(&text));
                card.device = card.device.take().or(device);
                card.atlas = Some(atlas);
            }
        }
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

    /// Fails early if there is no device, or `--device` matches none; `old` lets an old program decide that, and a
    /// missing one pass.
    fn check_device(&self, old: bool) -> Result<()> {
        let Some(chapter) = self.programs.project.chapters.last() else { return Ok(()) };
        let mut command = match self.programs.command(&chapter.name) {
            Ok(command) if !old => command,
            Err(_) if old => match self.programs.old(&chapter.name) {
                Some(command) => command,
                None => return Ok(()),
            },
            // It will be run when everything is built; or it did not build, which the card says.
            _ => return Ok(()),
        };
        command.arg("--list-controls");
        command.args(self.device.into_iter().flat_map(|device| ["--device", device]));
        let ended = child::run(&mut command, self.limit)?;
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
    pub fn is_idle(&self) -> bool {
        let Some(chapter) = self.programs.project.chapters.last() else { return false };
        let pixel = words(&["--headless", "--size", "8x8", "--pixel", "0,0"]);
        self.ask(&chapter.name, &pixel)
            .is_err_and(|error| told(&error).contains("executes nothing"))
    }

    /// Runs a program to its end.
    ///
    /// # Errors
    /// If it cannot be run, or fails; in one line.
    pub fn ask(&self, name: &str, arguments: &[String]) -> Result<()> {
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
        child::run(command.args(arguments), self.allowance.within(self.limit))
    }
}

/// Returns whether a program did not run because the validation layer is not installed.
pub fn lacks_layer(result: &Result<()>) -> bool {
    result.as_ref().is_err_and(|error| told(error).contains("--validate needs"))
}

/// Writes the card, and says where it is and what to do with it.
fn write(card: &Card, drawn: Option<&str>, out: &Path, is_alone: bool) -> Result<()> {
    let stem = card.stem();
    let json = card.json()?;
    common::files::write_whole(&out.join(format!("{stem}.json")), json.as_bytes())?;
    let text = card_page::card(card) + drawn.unwrap_or_default();
    common::files::write_whole(&out.join(format!("{stem}.md")), text.as_bytes())?;
    let files = format!("{stem}.md and {stem}.json in {}", out.display());
    let (passed, all) = (card.passed(), card.offered());
    let left_out = match card.left_out.len() {
        0 => String::new(),
        count => format!("; {count} of the lines above were left out, run them with --full"),
    };
    let send = format!(
        "Read the .md; then open an issue with the template 'A device' and attach {stem}.json, or copy it to {} and \
         run cargo chapters sync. It has no name and no path of yours.\n",
        card::FOLDER
    );
    if card.fails() {
        print(&send)?;
        bail!(
            "{passed} of {all} chapters pass, hard cases, faults and measurements apart; the card is {files}{left_out}"
        );
    }
    let passed = if is_alone { "done".to_owned() } else { format!("{all} chapters pass") };
    print(&format!("{passed}; the card is {files}{left_out}\n{send}"))
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
