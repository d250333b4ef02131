//! A report card: the result of every chapter on one device.
//!
//! `chapters survey` writes it, as Markdown with every detail and as JSON with the values used by the book.
//! The JSON of cards sent in by readers is stored in `docs/devices`, one file per device, and checked.

use common::gpu::Executable;
use instruments::report::Limits;
use manuscript::fault::Fault;
use manuscript::project::Project;
use serde::{Deserialize, Serialize};

use super::atlas::{self, Atlas};
use super::chapter::NO_DEVICE;
use super::faults::FaultRow;
use super::price::Price;

/// The folder of the cards.
pub const FOLDER: &str = "docs/devices";

/// A report card.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Card {
    /// The day, as `2026-11-22`.
    pub date: String,
    /// Operating system and processor, such as `linux x86_64`.
    pub system: String,
    /// The commit of the project, with `+` if code or shaders differ from it; `None` if unknown to Git.
    #[serde(default)]
    pub commit: Option<String>,
    /// The device; `None` if no chapter found one.
    pub device: Option<Device>,
    /// True if the chapters were run under validation.
    pub validated: bool,
    /// True if it also has times, random rays and everything else that takes longer than three minutes, as all cards
    /// had before this field existed.
    #[serde(default = "yes", skip_serializing_if = "is_true")]
    pub full: bool,
    /// The steps for which the three minutes were not enough.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub left_out: Vec<String>,
    /// The largest mean FLIP error that passes on the software driver, which made the golden pictures.
    pub tolerance: f32,
    /// The size of the timed pictures.
    #[serde(default = "small")]
    pub timed: String,
    /// Every chapter, by number.
    pub chapters: Vec<ChapterResult>,
    /// The hard cases of chapter 24.
    pub hard_cases: HardCases,
    /// Known faults of drivers, and whether this device has them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub faults: Vec<FaultRow>,
    /// The price of accuracy on this device, row by row.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub prices: Vec<Price>,
    /// A short measurement of chapter 24.
    pub measured: Measured,
    /// The errors of its traversal, if they were measured. For an arithmetic other than the driver's, the
    /// card has nothing else.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub atlas: Option<Atlas>,
}

/// The size of cards that predate this field.
fn small() -> String {
    "480x300".to_owned()
}

/// The value of [`Card::full`] in cards that predate it.
fn yes() -> bool {
    true
}

fn is_true(full: &bool) -> bool {
    *full
}

/// The device that ran them.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Device {
    /// Its name, as reported by its driver.
    pub name: String,
    /// Its driver, as its maker names it.
    pub driver: String,
    /// Its version of Vulkan: major, minor, patch.
    pub vulkan: [u32; 3],
    /// The limits that the chapters depend on.
    #[serde(skip)]
    pub limits: Limits,
}

impl Device {
    /// A device with its limits.
    pub fn new(name: String, driver: String, limits: Limits) -> Self {
        Self { name, driver, vulkan: limits.vulkan, limits }
    }
}

/// One chapter's line.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ChapterResult {
    /// Its name, such as `02_basic`.
    pub name: String,
    /// The reason for its failure; `None` if it passes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub failed: Option<String>,
    /// The extension it needs that the device lacks; then nothing was run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lacks: Option<String>,
    /// The mean FLIP error of its picture against the golden one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mean_flip: Option<f32>,
    /// The largest error that passes on this device, which may round as Vulkan allows; 1 if the picture shows
    /// the device's own errors.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<f32>,
    /// The device's time for a frame of the card's size, the median.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub milliseconds: Option<f64>,
    /// The number of validation messages.
    #[serde(skip)]
    pub validation_messages: usize,
    /// The statistics of the device's own compiler, if it reports any.
    #[serde(skip)]
    pub compiler: Vec<Executable>,
    /// The statistics of Mesa's compiler for AMD GPUs (RDNA 3), if it is installed.
    #[serde(skip)]
    pub radv: Vec<Radv>,
}

impl ChapterResult {
    /// The result in a line.
    pub fn result(&self) -> String {
        match (&self.failed, &self.lacks, self.milliseconds) {
            (Some(why), ..) => why.clone(),
            (None, Some(lacks), _) => format!("not run: the device lacks {lacks}"),
            (None, None, Some(milliseconds)) => format!("passes, {milliseconds:.2} ms"),
            (None, None, None) => "passes".to_owned(),
        }
    }
}

/// A program, as reported by Mesa's compiler for AMD GPUs.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[allow(missing_docs, reason = "they are those of `--compile-for`")]
pub struct Radv {
    pub stage: String,
    pub registers: u64,
    pub spilled_registers: u64,
    pub scratch_bytes: u64,
    pub instructions: u64,
    pub waves: u64,
    pub latency: u64,
}

/// The hard cases of chapter 24, counted over all top rungs, which must be right in every case.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct HardCases {
    /// The reason for a failure; `None` if they pass.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub failed: Option<String>,
    /// The number of right answers of top rungs.
    pub right: u64,
    /// The number of their cases.
    pub cases: u64,
    /// The number of top rungs that the device cannot run.
    pub missing: u64,
    /// Every rung, called directly and traced.
    #[serde(skip)]
    pub rungs: Vec<HardCase>,
}

impl HardCases {
    /// The counts of these rungs.
    pub fn new(failed: Option<String>, rungs: Vec<HardCase>) -> Self {
        let mut all = Self { failed, ..Self::default() };
        for rung in rungs.iter().filter(|rung| rung.top) {
            if rung.unavailable.is_some() {
                all.missing += 1;
            } else {
                all.right += rung.right;
                all.cases += rung.cases;
            }
        }
        Self { rungs, ..all }
    }
}

/// The number of hard cases in which a rung is right.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[allow(missing_docs, reason = "they are those of `--cases`")]
pub struct HardCase {
    pub primitive: String,
    pub rung: String,
    pub name: String,
    /// `direct` or `traced`.
    pub way: String,
    /// True if every case must be right.
    pub top: bool,
    #[serde(default)]
    pub cases: u64,
    #[serde(default)]
    pub right: u64,
    /// The reason why this device cannot run it.
    #[serde(default)]
    pub unavailable: Option<String>,
}

/// A measurement of chapter 24 on random rays.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Measured {
    /// The reason for a failure; `None` if there is none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub failed: Option<String>,
    /// Every rung.
    pub rungs: Vec<MeasuredRung>,
}

/// The error of a rung on random rays, over all families of them, and its cost.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MeasuredRung {
    /// The primitive that is intersected.
    pub primitive: String,
    /// The rung's place.
    pub rung: String,
    /// Its time relative to the ladder's plain rung, the median of all rounds; `None` if unknown.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time_ratio: Option<f64>,
    /// The rung's name.
    #[serde(skip)]
    pub name: String,
    /// The largest error of all rays, in ULP.
    #[serde(skip)]
    pub worst_ulp: f64,
    /// The number of wrong hits and misses.
    #[serde(skip)]
    pub wrong: u64,
    /// The quartiles of the time's ratio over the rounds.
    #[serde(skip)]
    pub time_quartiles: Option<[f64; 2]>,
}

impl Card {
    /// The name of its files, without extension: the device's name in small letters, and the arithmetic if it
    /// is not the driver's.
    pub fn stem(&self) -> String {
        let name = self.device.as_ref().map_or("no device", |device| &device.name);
        let letter = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { ' ' };
        let words: String = name.chars().map(letter).collect();
        let words = words.split_whitespace().chain(self.arithmetic());
        words.collect::<Vec<_>>().join("-")
    }

    /// Its JSON file.
    ///
    /// # Errors
    /// If a number is not finite.
    pub fn json(&self) -> serde_json::Result<String> {
        Ok(serde_json::to_string_pretty(self)? + "\n")
    }

    /// The arithmetic of its atlas if it is not the driver's; then the card has nothing else.
    fn arithmetic(&self) -> Option<&str> {
        let arithmetic = self.atlas.as_ref()?.arithmetic.as_str();
        (!["", atlas::DRIVER].contains(&arithmetic)).then_some(arithmetic)
    }

    /// The number of chapters that pass.
    pub fn passed(&self) -> usize {
        let passes = |chapter: &&ChapterResult| chapter.failed.is_none() && chapter.lacks.is_none();
        self.chapters.iter().filter(passes).count()
    }

    /// The number of chapters that the device could run.
    pub fn offered(&self) -> usize {
        self.chapters.iter().filter(|chapter| chapter.lacks.is_none()).count()
    }

    /// Returns whether anything fails.
    pub fn fails(&self) -> bool {
        let atlas = self.atlas.as_ref().and_then(|atlas| atlas.failed.as_ref());
        let tables = [self.hard_cases.failed.as_ref(), self.measured.failed.as_ref(), atlas];
        let prices = self.prices.iter().filter_map(|price| price.failed.as_ref());
        self.passed() < self.offered()
            || self.faults.iter().any(FaultRow::is_seen)
            || tables.into_iter().any(|failed| failed.is_some())
            || prices.into_iter().any(|why| !why.starts_with(NO_DEVICE))
    }

    /// The faults of a card; none if it is valid.
    fn wrong(&self, project: &Project, text: &str) -> Vec<String> {
        let mut wrong = Vec::new();
        let digits = self.date.split('-').map(|part| part.parse::<u32>().map_or(0, |_| part.len()));
        if digits.collect::<Vec<_>>() != [4, 2, 2] {
            wrong.push(format!("'{}' is no date such as 2026-11-22", self.date));
        }
        if self.device.is_none() {
            wrong.push("it names no device".to_owned());
        }
        if self.tolerance != flip::TOLERANCE {
            wrong.push(format!("its tolerance is {}, not {}", self.tolerance, flip::TOLERANCE));
        }
        wrong.extend(self.atlas.as_ref().and_then(Atlas::wrong));
        if self.chapters.is_empty() && self.arithmetic().is_none() {
            wrong.push("it has no chapters".to_owned());
        }
        for (index, chapter) in self.chapters.iter().enumerate() {
            let name = &chapter.name;
            if project.named(name).is_none() {
                wrong.push(format!("there is no chapter '{name}'"));
            }
            if self.chapters[..index].iter().any(|other| other.name == *name) {
                wrong.push(format!("{name} stands there twice"));
            }
            let allowed = chapter.tolerance.unwrap_or(self.tolerance);
            let near = chapter.mean_flip.is_some_and(|mean| mean <= allowed);
            let passes = chapter.failed.is_none() && chapter.lacks.is_none();
            if passes && !(near && (chapter.milliseconds.is_some() || !self.full)) {
                wrong.push(format!(
                    "{name} passes without a picture like its golden, or without a time"
                ));
            }
        }
        if let Some(path) = PRIVATE.into_iter().find(|path| text.contains(path)) {
            wrong.push(format!("it holds a path of somebody's machine, '{path}'"));
        }
        wrong
    }
}

/// The beginnings of paths that reveal whose machine it is.
const PRIVATE: [&str; 6] = ["/home/", "/Users/", "\\Users\\", "/root/", "/tmp/", "/mnt/"];

/// Removes the paths of this machine from a line, except for the last part of each. A path with blanks is in
/// quotation marks, as in all error messages of this project.
pub fn without_paths(line: &str) -> String {
    let mut text = String::new();
    for (index, piece) in line.split('\'').enumerate() {
        let quoted = index % 2 == 1;
        let mark = if index == 0 { "" } else { "'" };
        text.push_str(mark);
        let is_path = quoted && (piece.starts_with(['/', '\\']) || piece.get(1..2) == Some(":"));
        if is_path {
            text.push_str(piece.rsplit(['/', '\\']).next().unwrap_or_default())
        } else {
            text.push_str(&words_without_paths(piece))
        }
    }
    text
}

fn words_without_paths(line: &str) -> String {
    let part = |word: &str| -> String {
        let at = word.find(['/', '\\']);
        let absolute = at.is_some_and(|at| at == 0 && word.len() > 1 || word[..at].ends_with(':'));
        if absolute {
            word.rsplit(['/', '\\']).next().unwrap_or_default().to_owned()
        } else {
            word.to_owned()
        }
    };
    let marks = |c: char| [' ', '"', '(', ')', '[', ']', '<', '>', '=', ',', ';', '`'].contains(&c);
    let mut text = String::new();
    for piece in line.split_inclusive(marks) {
        let word = piece.trim_end_matches(marks);
        text.push_str(&part(word));
        text.push_str(&piece[word.len()..]);
    }
    text
}

/// All cards of the project, by file name, and the faults of invalid ones.
pub fn all(project: &Project) -> (Vec<Card>, Vec<Fault>) {
    let (mut cards, mut faults) = (Vec::new(), Vec::new());
    let files = project.files(FOLDER);
    for file in files.iter().filter(|file| file.ends_with(".json")) {
        let remedy = "send the file that cargo chapters survey wrote";
        let mut fault = |line, what| faults.push(Fault::new(file, line, what, remedy));
        let text = project.read(file).unwrap_or_default();
        match serde_json::from_str::<Card>(&text) {
            Ok(card) => {
                let mut wrong = card.wrong(project, &text);
                if *file != format!("{FOLDER}/{}.json", card.stem()) {
                    wrong.push(format!("the card of this device is {}.json", card.stem()));
                }
                match &wrong[..] {
                    [] => cards.push(card),
                    wrong => {
                        wrong.iter().for_each(|what| fault(1, format!("no valid card: {what}")))
                    }
                }
            }
            Err(error) => {
                let what = error.to_string();
                let what = what.split(" at line").next().unwrap_or_default();
                fault(error.line().max(1), format!("no valid card: {what}"));
            }
        }
    }
    (cards, faults)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_keeps_of_a_path_its_last_part() {
        for (line, kept) in [
            (
                "cannot read the shader '/home/ada/mine/02_basic/sky.rmiss'",
                "cannot read the shader 'sky.rmiss'",
            ),
            (
                "02_basic/sky.rmiss:7: 'x' : undeclared; a/b",
                "02_basic/sky.rmiss:7: 'x' : undeclared; a/b",
            ),
            ("C:\\Users\\ada\\a.dll is gone", "a.dll is gone"),
            (
                "cannot read the shader '/srv/Jane Doe/copy/decide.rahit': no such file",
                "cannot read the shader 'decide.rahit': no such file",
            ),
            ("in=/srv/jane/a.so [/srv/jane/b.so]", "in=a.so [b.so]"),
            ("1 / 2", "1 / 2"),
        ] {
            assert_eq!(without_paths(line), kept);
        }
    }

    #[test]
    fn a_card_is_called_after_its_device() {
        let device =
            Device { name: "AMD Radeon RX 7900 (RADV NAVI31)".to_owned(), ..Device::default() };
        let card = Card { device: Some(device), ..Card::default() };
        assert_eq!(card.stem(), "amd-radeon-rx-7900-radv-navi31");
        assert_eq!(Card::default().stem(), "no-device");
    }

    /// A stored card has exactly the form that the survey writes.
    #[test]
    fn stored_cards_are_as_the_survey_writes_them() {
        let tool = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
        let project = Project::open(tool.ancestors().nth(2).expect("a project")).expect("its list");
        let (cards, faults) = all(&project);
        assert!(faults.is_empty() && cards.len() >= 4);
        for card in cards {
            let stored = project.read(&format!("{FOLDER}/{}.json", card.stem())).expect("a card");
            let written = card.json().expect("JSON");
            let differs = stored.lines().zip(written.lines()).find(|(one, other)| one != other);
            assert_eq!(differs, None, "{}", card.stem());
            assert_eq!(stored.len(), written.len(), "{}", card.stem());
        }
    }

    #[test]
    fn hard_cases_are_counted_over_top_rungs() {
        let rung = |top, right, unavailable: Option<&str>| HardCase {
            top,
            right,
            cases: 29,
            unavailable: unavailable.map(str::to_owned),
            ..HardCase::default()
        };
        let rungs = vec![
            rung(true, 29, None),
            rung(true, 28, None),
            rung(false, 3, None),
            rung(true, 0, Some("no 64-bit floats")),
        ];
        let all = HardCases::new(None, rungs);
        assert_eq!((all.right, all.cases, all.missing), (57, 58, 1));
    }

    #[test]
    fn a_card_without_an_atlas_stays_readable_and_one_of_another_arithmetic_says_so() {
        let old = serde_json::to_value(Card::default()).expect("JSON");
        assert!(old.get("atlas").is_none());
        assert_eq!(serde_json::from_value::<Card>(old).expect("a card"), Card::default());
        let of = |arithmetic: &str| {
            let atlas = Atlas { arithmetic: arithmetic.to_owned(), ..Atlas::default() };
            Card { atlas: Some(atlas), ..Card::default() }.stem()
        };
        assert_eq!([of("driver"), of("worst")], ["no-device", "no-device-worst"]);
    }
}
