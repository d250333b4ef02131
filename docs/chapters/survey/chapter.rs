//! One chapter's line of a report card: its golden picture under validation, its time, the compilers' figures.

use std::error::Error;
use std::fmt::{Display, Formatter};
use std::fs;
use std::path::Path;

use anyhow::{Context, Result, bail};
use instruments::report::Limits;
use manuscript::project::Chapter;

use super::card::{Card, ChapterResult};
use super::command::{Survey, VALIDATE, device, lacks_layer, read, rows, told, words};

/// The size and number of the timed pictures. A GPU needs enough rays to be full, and some time to raise its
/// clocks.
const TIMED_ON_SOFTWARE: (&str, &str) = ("480x300", "9");
const TIMED_ON_A_GPU: (&str, &str) = ("1920x1200", "61");

/// The start of its error message if no device is suitable.
pub const NO_DEVICE: &str = "no device can run this";
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

impl Survey<'_> {
    /// Runs one chapter: its golden picture under validation, its time, and the compilers' statistics.
    ///
    /// # Errors
    /// If the device executes nothing.
    pub fn chapter(
        &self,
        chapter: &Chapter,
        folder: &Path,
        card: &mut Card,
    ) -> Result<ChapterResult> {
        let mut line = ChapterResult { name: chapter.name.clone(), ..ChapterResult::default() };
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
        line: &mut ChapterResult,
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
        let out = picture.to_string_lossy();
        let mut drawn = vec!["--out", &*out];
        drawn.extend(chapter.golden.iter().map(String::as_str));
        let size = format!("{width}x{height}");
        let run = |validate: bool| {
            let validate = validate.then_some(VALIDATE);
            let more: Vec<&str> = drawn.iter().copied().chain(validate).collect();
            self.reported(chapter, &size, &report, &more)
        };
        let mut result = run(card.validated);
        // Without the layer, the pictures can still be compared.
        if card.validated && lacks_layer(&result) {
            card.validated = false;
            result = run(false);
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
        if self.full {
            let timed = if is_software { TIMED_ON_SOFTWARE } else { TIMED_ON_A_GPU };
            self.time(chapter, timed, &report, line)?;
            card.timed = timed.0.to_owned();
        }
        if mean > tolerance {
            bail!("its picture differs: mean FLIP {mean:.4}, above {tolerance}");
        }
        Ok(())
    }

    /// Measures the time of a frame, and takes the compilers' figures.
    fn time(
        &self,
        chapter: &Chapter,
        (size, frames): (&str, &str),
        report: &Path,
        line: &mut ChapterResult,
    ) -> Result<()> {
        let arguments = ["--frames", frames, "--compiler-figures"];
        self.reported(chapter, size, report, &arguments).context("without validation")?;
        let said = read(report)?;
        line.milliseconds = said["gpu_milliseconds"]["median"].as_f64();
        line.compiler = rows(&said["executables"]);
        // RADV may be missing or refuse; then there are no statistics.
        if self.reported(chapter, "8x8", report, &["--compile-for", "navi31"]).is_ok() {
            line.radv = rows(&read(report)?["compiled_for"]);
        }
        Ok(())
    }

    /// Runs the chapter with a report.
    fn reported(&self, chapter: &Chapter, size: &str, report: &Path, more: &[&str]) -> Result<()> {
        let mut arguments = words(&["--headless", "--size", size, "--report"]);
        arguments.push(report.to_string_lossy().into_owned());
        arguments.extend(words(more));
        self.ask(&chapter.name, &arguments)
    }
}

/// A chapter's golden picture.
pub fn golden(chapter: &Chapter) -> String {
    format!("tests/golden/{}.png", chapter.name)
}
