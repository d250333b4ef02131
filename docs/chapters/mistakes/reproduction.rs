//! Reproduces a mistake: runs the chapter with and without the patch, and compares the two.

use std::path::{Path, PathBuf};
use std::process::ExitStatus;

use anyhow::{Context, Result, bail, ensure};
use common::files::NewFolder;
use image::RgbImage;
use panels::{Panel, sheet};
use time_limit::Limit;

use super::mistake::{Mistake, Outcome};
use crate::patches::edition::{Edition, Patched};
use crate::pictures::difference::mean_difference;
use crate::pictures::stamp::{self, Maker};
use crate::programs::program::Programs;
use crate::programs::run_result::{RunResult, is_software};

/// The size of a mistake's picture.
const SHOWN: (u32, u32) = (320, 200);
/// The size when pictures are only compared.
const COMPARED: (u32, u32) = (160, 100);

/// The longest time of a program.
const LIMIT: Limit = Limit::worked(40);
/// The longest time of a program that the mistake may keep from ending.
const UNTIL_CRASHED: Limit = Limit::worked(10);

/// A mistake, and the runs that show it.
pub struct Reproduction<'a> {
    programs: &'a Programs<'a>,
    mistake: &'a Mistake,
}

impl<'a> Reproduction<'a> {
    /// A trial of a mistake by built programs; a patch of Rust code is built here.
    pub fn new(programs: &'a Programs<'a>, mistake: &'a Mistake) -> Self {
        Self { programs, mistake }
    }

    /// Checks the effect of the mistake, and describes it in one line.
    ///
    /// # Errors
    /// If it differs from the claims in its file.
    pub fn check(&self) -> Result<String> {
        let right = self.right(COMPARED)?;
        if let Some(why) = self.not_tried(right.device())? {
            return Ok(why);
        }
        let wrong = self.wrong(COMPARED)?;
        self.compare(&right, &wrong)
    }

    /// Renders its picture into its file, unless the file already has the same pixels; returns its maker, and
    /// whether the file has changed.
    ///
    /// # Errors
    /// As [`Reproduction::make`], or if the file cannot be written.
    pub fn render(&self) -> Result<(Maker, bool)> {
        let folder = NewFolder::temporary()?;
        let (made, maker) = self.make(folder.path())?;
        let (project, mistake) = (self.programs.project, self.mistake);
        let changed = stamp::store(project, &mistake.picture(), &made, &mistake.command(), &maker)?;
        Ok((maker, changed))
    }

    /// Renders its picture into a file of a folder, and returns that file and its maker.
    ///
    /// # Errors
    /// If the effect differs from the claims in its file.
    pub fn make(&self, folder: &Path) -> Result<(PathBuf, Maker)> {
        let right = self.right(SHOWN)?;
        if let Some(why) = self.not_tried(right.device())? {
            bail!("{why}");
        }
        let wrong = self.wrong(SHOWN)?;
        self.compare(&right, &wrong)?;
        let label =
            |word: &str, seen: &RunResult| match (&self.mistake.outcome, &seen.messages()[..]) {
                (Outcome::Slower(_), _) => format!("{word}: {:.0} ms", seen.milliseconds()),
                // The pictures are the same; only the validation messages differ.
                (Outcome::Forgiven, [_, ..]) => {
                    format!("{word}: {}", self.mistake.validation.as_deref().unwrap_or_default())
                }
                _ => word.to_owned(),
            };
        let labels = [label("right", &right), label("wrong", &wrong)];
        let panel =
            |seen: &RunResult| match (&seen.picture, self.mistake.outcome == Outcome::Crashes) {
                (Some(picture), _) => {
                    RgbImage::from_raw(picture.width, picture.height, picture.srgb())
                        .map_or(Panel::Words("No picture".to_owned()), Panel::Picture)
                }
                (None, true) => Panel::Words(format!("No picture: {}", end(seen.status))),
                (None, false) => Panel::Words(format!("No picture: {}", seen.said)),
            };
        let panels: Vec<(String, Panel)> =
            labels.into_iter().zip([&right, &wrong].map(panel)).collect();
        let sheet = sheet(SHOWN, &[panels])?;
        let file = folder.join("sheet.png");
        sheet.save(&file)?;
        Ok((file, Maker::of(&right.report)))
    }

    fn right(&self, size: (u32, u32)) -> Result<RunResult> {
        let right = self.run(&Edition::Book, size)?;
        ensure!(right.succeeded(), "{} fails as it is: {}", self.mistake.chapter, right.said);
        Ok(right)
    }

    fn wrong(&self, size: (u32, u32)) -> Result<RunResult> {
        let wrong = Patched::of(self.programs, &self.mistake.patch)?;
        self.run(&wrong.edition, size)
    }

    /// The reason why the mistake is not run on this device, if its behaviour is undefined and the device is
    /// not a software driver.
    fn not_tried(&self, device: &str) -> Result<Option<String>> {
        let Mistake { name, chapter, undefined, .. } = self.mistake;
        let Some(what) = undefined else { return Ok(None) };
        let is_software = is_software(self.programs, chapter, device, LIMIT)?;
        let why = format!("{name}: not tried on {device}: undefined in Vulkan: {what}");
        Ok((!is_software).then_some(why))
    }

    fn run(&self, edition: &Edition, (width, height): (u32, u32)) -> Result<RunResult> {
        let command = edition.command(self.programs, &self.mistake.chapter)?;
        let own = shlex::split(&self.mistake.arguments).context("the arguments do not end")?;
        let mut arguments = vec!["--size".to_owned(), format!("{width}x{height}")];
        arguments.extend(own);
        let may_hang = matches!(self.mistake.outcome, Outcome::Crashes);
        RunResult::of(command, &arguments, if may_hang { UNTIL_CRASHED } else { LIMIT })
    }

    /// Compares two runs with the mistake's claims; the returned line says what was seen.
    fn compare(&self, right: &RunResult, wrong: &RunResult) -> Result<String> {
        let Mistake { name, outcome, validation, .. } = self.mistake;
        let file = self.mistake.file();
        let heard = match (validation, &wrong.messages()[..]) {
            (None, []) => "validation says nothing".to_owned(),
            (None, [first, ..]) => bail!("{file}: validation says: {first}"),
            (Some(text), []) => bail!("{file}: validation says nothing, not '{text}'"),
            (Some(text), messages) => match messages.iter().find(|said| !said.contains(&**text)) {
                Some(other) => bail!("{file}: validation says, beside '{text}': {other}"),
                None => format!("validation says {text}"),
            },
        };
        let seen = match outcome {
            Outcome::Refused(text) => {
                let refused =
                    wrong.status.and_then(|status| status.code()).is_some_and(|code| code != 0);
                ensure!(
                    refused && wrong.said.contains(text),
                    "{file}: not refused by '{text}': {}",
                    wrong.said
                );
                "refused".to_owned()
            }
            Outcome::Crashes => {
                // The program prints this itself, unless RUST_BACKTRACE leaves the crash to the system.
                let ended = wrong.status.is_some_and(|status| status.code().is_some());
                let crashed = !ended || wrong.said.contains("crashed (SIG");
                ensure!(crashed, "{file}: no crash: {}", end(wrong.status));
                end(wrong.status)
            }
            Outcome::Differs(_) | Outcome::Slower(_) | Outcome::Forgiven => {
                let picture = |seen: &RunResult| {
                    let picture = seen.picture.clone();
                    picture.with_context(|| format!("{file}: no picture: {}", seen.said))
                };
                let apart = mean_difference(&picture(right)?, &picture(wrong)?);
                let slower = wrong.milliseconds() / right.milliseconds().max(1e-3);
                match outcome {
                    Outcome::Differs(least) => {
                        ensure!(apart >= *least, "{file}: differs by {apart:.4}, not by {least}");
                        format!("differs by {apart:.4}")
                    }
                    Outcome::Slower(least) => {
                        ensure!(apart == 0.0, "{file}: not only slower: differs by {apart:.4}");
                        ensure!(slower >= *least, "{file}: slower {slower:.1} times, not {least}");
                        format!("slower {slower:.1} times")
                    }
                    _ => {
                        ensure!(apart == 0.0, "{file}: not forgiven: differs by {apart:.4}");
                        "forgiven: the same picture".to_owned()
                    }
                }
            }
        };
        Ok(format!("{name}: {seen}; {heard}"))
    }
}

/// Describes how a program ended.
fn end(status: Option<ExitStatus>) -> String {
    match status {
        Some(status) => format!("the program ends by {status}"),
        None => "the program does not end".to_owned(),
    }
}
