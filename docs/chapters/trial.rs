//! A mistake held to its word: the chapter is run as it is and patched, and both are compared.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use anyhow::{Context, Result, anyhow, bail, ensure};
use image::RgbImage;
use panels::{Panel, sheet};
use serde_json::Value;

use crate::child;
use crate::mistake::{Mistake, Outcome};
use crate::picture::{self, Sources};
use crate::program::{BUILD, Programs};
use crate::project::Project;

/// How large a mistake is shown.
const SHOWN: (u32, u32) = (320, 200);
/// How large it is where only the comparison counts.
const COMPARED: (u32, u32) = (160, 100);

/// How long a program may take.
const LIMIT: Duration = Duration::from_secs(20);
/// How long it may where the mistake may keep it from ending.
const UNTIL_CRASHED: Duration = Duration::from_secs(5);

/// What a run gave.
struct Seen {
    picture: Option<RgbImage>,
    /// `None` if it did not end.
    status: Option<ExitStatus>,
    /// What it said on standard error.
    said: String,
    messages: Vec<String>,
    /// Of the device, for a frame.
    milliseconds: f64,
    device: String,
}

/// A mistake, and the runs that show it.
pub struct Trial<'a> {
    project: &'a Project,
    programs: &'a Programs,
    mistake: &'a Mistake,
}

impl<'a> Trial<'a> {
    /// A trial of a mistake by built programs; a patch of Rust code is built here.
    pub fn new(project: &'a Project, programs: &'a Programs, mistake: &'a Mistake) -> Self {
        Self { project, programs, mistake }
    }

    /// What the mistake does, in a line.
    ///
    /// # Errors
    /// If that is not what its file says.
    pub fn check(&self) -> Result<String> {
        let (right, wrong) = self.runs(COMPARED)?;
        self.compare(&right, &wrong)
    }

    /// Makes its picture, and returns the device that did.
    ///
    /// # Errors
    /// If it does not do what its file says, or the picture cannot be written.
    pub fn render(&self, sources: &mut Sources) -> Result<String> {
        let (right, wrong) = self.runs(SHOWN)?;
        self.compare(&right, &wrong)?;
        let label = |word: &str, seen: &Seen| match (&self.mistake.outcome, &seen.messages[..]) {
            (Outcome::Slower(_), _) => format!("{word}: {:.0} ms", seen.milliseconds),
            // The pictures are the same: all that differs is what validation says.
            (Outcome::Forgiven, [_, ..]) => {
                format!("{word}: {}", self.mistake.validation.as_deref().unwrap_or_default())
            }
            _ => word.to_owned(),
        };
        let labels = [label("right", &right), label("wrong", &wrong)];
        let device = right.device.clone();
        let panel = |seen: Seen| match (seen.picture, self.mistake.outcome == Outcome::Crashes) {
            (Some(picture), _) => Panel::Picture(picture),
            (None, true) => Panel::Words(format!("No picture: {}", end(seen.status))),
            (None, false) => Panel::Words(format!("No picture: {}", seen.said)),
        };
        let panels: Vec<(String, Panel)> =
            labels.into_iter().zip([right, wrong].map(panel)).collect();
        let sheet = sheet(SHOWN, &[panels])?;
        let hash = self.mistake.sources(self.project, sources);
        let folder = tempfile::tempdir().context("cannot make a temporary folder")?;
        let plain = folder.path().join("sheet.png");
        sheet.save(&plain)?;
        let bytes = picture::stamped(&plain, &self.mistake.command(), &hash, &device)?;
        let file = self.project.root.join(self.mistake.picture());
        fs::create_dir_all(file.parent().context("a picture lies in a folder")?)?;
        common::files::write_whole(&file, &bytes)?;
        Ok(device)
    }

    fn runs(&self, size: (u32, u32)) -> Result<(Seen, Seen)> {
        let built = || {
            self.programs.command(&self.mistake.chapter).map_err(|what| anyhow!("{what}; {BUILD}"))
        };
        let right = self.run(built()?, size)?;
        ensure!(
            right.status.is_some_and(|status| status.success()),
            "{} fails as it is: {}",
            self.mistake.chapter,
            right.said
        );
        if self.mistake.is_in_shaders() {
            let folder = tempfile::tempdir().context("cannot make a temporary folder")?;
            self.mistake.copy_to(self.project, folder.path())?;
            let mut command = built()?;
            command.env("SHADERS", folder.path());
            return Ok((right, self.run(command, size)?));
        }
        // All patches share a copy and what is built of it: no other trial may change them meanwhile.
        let folder = self.project.root.join("target/mistakes");
        let copy = folder.join("copy");
        fs::create_dir_all(&copy).with_context(|| format!("cannot make '{}'", copy.display()))?;
        let lock = File::create(folder.join("lock")).context("cannot make a lock")?;
        lock.lock().context("cannot wait for a lock")?;
        self.mistake.copy_over(self.project, &copy)?;
        let mut command = Command::new(self.build(&copy, &folder.join("build"))?);
        command.current_dir(&self.project.root).env("SHADERS", copy.join("shaders"));
        Ok((right, self.run(command, size)?))
    }

    /// Builds the chapter in a patched copy, which takes minutes for the first.
    fn build(&self, copy: &Path, target: &Path) -> Result<PathBuf> {
        let output = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
            .args(["build", "--quiet", "--bin", &self.mistake.chapter])
            .current_dir(copy)
            .env("CARGO_TARGET_DIR", target)
            .output()
            .context("cargo does not start")?;
        let said = String::from_utf8_lossy(&output.stderr).trim().replace('\n', " ");
        ensure!(output.status.success(), "the patched copy does not build: {said}");
        let name = format!("{}{}", self.mistake.chapter, std::env::consts::EXE_SUFFIX);
        Ok(target.join("debug").join(name))
    }

    fn run(&self, mut command: Command, (width, height): (u32, u32)) -> Result<Seen> {
        let folder = tempfile::tempdir().context("cannot make a temporary folder")?;
        let (out, report) = (folder.path().join("out.png"), folder.path().join("report.json"));
        let arguments =
            shlex::split(&self.mistake.arguments).context("the arguments do not end")?;
        command.args(["--headless", "--validate", "--size", &format!("{width}x{height}")]);
        command.arg("--out").arg(&out).arg("--report").arg(&report).args(arguments);
        let may_hang = matches!(self.mistake.outcome, Outcome::Crashes);
        let limit = if may_hang { UNTIL_CRASHED } else { LIMIT };
        let ended = child::run(&mut command, limit).context("the program does not start")?;
        let report: Value = fs::read(&report)
            .ok()
            .and_then(|text| serde_json::from_slice(&text).ok())
            .unwrap_or_default();
        let messages = report["validation_messages"].as_array().into_iter().flatten();
        let said = ended.said.trim().replace('\n', " ");
        Ok(Seen {
            picture: image::open(&out).ok().map(|picture| picture.to_rgb8()),
            status: ended.status,
            said: said.trim_start_matches("error: ").to_owned(),
            messages: messages
                .map(|message| message.as_str().unwrap_or_default().to_owned())
                .collect(),
            milliseconds: report["gpu_milliseconds"]["median"].as_f64().unwrap_or_default(),
            device: report["device"].as_str().unwrap_or("unknown").to_owned(),
        })
    }

    /// Holds two runs to what the mistake claims; the line says what was seen.
    fn compare(&self, right: &Seen, wrong: &Seen) -> Result<String> {
        let Mistake { name, outcome, validation, .. } = self.mistake;
        let file = self.mistake.file();
        let heard = match (validation, &wrong.messages[..]) {
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
                let ended = wrong.status.is_some_and(|status| status.code().is_some());
                ensure!(!ended, "{file}: no crash: {}", end(wrong.status));
                end(wrong.status)
            }
            Outcome::Differs(_) | Outcome::Slower(_) | Outcome::Forgiven => {
                let picture = |seen: &Seen| {
                    seen.picture
                        .clone()
                        .with_context(|| format!("{file}: no picture: {}", seen.said))
                };
                let apart = difference(&picture(right)?, &picture(wrong)?);
                let slower = wrong.milliseconds / right.milliseconds.max(1e-3);
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

/// How a program ended, in words.
fn end(status: Option<ExitStatus>) -> String {
    match status {
        Some(status) => format!("the program ends by {status}"),
        None => "the program does not end".to_owned(),
    }
}

/// Checks several mistakes, as many at once as there are processors; the lines come in their order.
pub fn check_all(
    project: &Project,
    programs: &Programs,
    mistakes: &[Mistake],
) -> Vec<Result<String>> {
    let next = AtomicUsize::new(0);
    let found = Mutex::new(BTreeMap::new());
    let workers = thread::available_parallelism().map_or(1, usize::from);
    thread::scope(|scope| {
        for _ in 0..workers.min(mistakes.len()) {
            scope.spawn(|| {
                loop {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    let Some(mistake) = mistakes.get(index) else { break };
                    let line = Trial::new(project, programs, mistake).check();
                    found.lock().unwrap_or_else(PoisonError::into_inner).insert(index, line);
                }
            });
        }
    });
    found.into_inner().unwrap_or_else(PoisonError::into_inner).into_values().collect()
}

/// The mean difference of all channels, of 1.
fn difference(a: &RgbImage, b: &RgbImage) -> f64 {
    let sum: u64 = a.iter().zip(b.iter()).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
    sum as f64 / 255.0 / a.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn black_and_white_are_one_apart() {
        let plain = |value| RgbImage::from_pixel(3, 2, image::Rgb([value; 3]));
        assert_eq!(difference(&plain(0), &plain(255)), 1.0);
        assert_eq!(difference(&plain(7), &plain(7)), 0.0);
    }
}
