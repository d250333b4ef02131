//! A report card: what every chapter did on one device.
//!
//! `chapters survey` makes it. Cards that readers send in lie in `docs/devices`, one file a device, and
//! are held to what a card may say.

use common::gpu::Executable;
use instruments::report::Limits;
use manuscript::fault::Fault;
use manuscript::project::Project;
use serde::{Deserialize, Serialize};

use super::atlas::{self, Atlas};

/// Where the cards lie.
pub const FOLDER: &str = "docs/devices";

/// A report card.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Card {
    /// The day, as `2026-11-22`.
    pub date: String,
    /// Operating system and processor, as `linux x86_64`.
    pub system: String,
    /// The commit of the project, with `+` if code or shaders differ from it; `None` where Git does not tell.
    #[serde(default)]
    pub commit: Option<String>,
    /// The device; `None` if no chapter found one.
    pub device: Option<Device>,
    /// Whether the chapters ran under validation.
    pub validated: bool,
    /// The largest mean FLIP error that passes on the software driver, which made the golden pictures.
    pub tolerance: f32,
    /// The size of the pictures whose time was taken.
    #[serde(default = "small")]
    pub timed: String,
    /// Every chapter, by number.
    pub chapters: Vec<ChapterResult>,
    /// The hard cases of chapter 24.
    pub hard_cases: Table<HardCases>,
    /// A short measurement of chapter 24.
    pub measured: Table<Measured>,
    /// What its traversal computes, if that was asked for. In another arithmetic than the driver's it is all that
    /// the card has.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub atlas: Option<Atlas>,
}

/// The size that the first cards do not name.
fn small() -> String {
    "480x300".to_owned()
}

/// The device that ran them.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Device {
    /// Its name, as its driver gives it.
    pub name: String,
    /// Its driver, in its maker's words.
    pub driver: String,
    /// The limits that the chapters heed.
    pub limits: Limits,
}

/// One chapter's line.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ChapterResult {
    /// Its name, such as `02_basic`.
    pub name: String,
    /// Why it fails; `None` if it passes.
    pub failed: Option<String>,
    /// The extension that it needs and the device does not offer; then nothing was run.
    #[serde(default)]
    pub lacks: Option<String>,
    /// How far its picture is from the golden one: the mean FLIP error.
    pub mean_flip: Option<f32>,
    /// How far it may be on this device, which rounds as Vulkan lets it; 1 where the picture shows the device's
    /// own errors.
    #[serde(default)]
    pub tolerance: Option<f32>,
    /// The device's time for a frame of the card's size, the median.
    pub milliseconds: Option<f64>,
    /// How many messages validation had.
    pub validation_messages: usize,
    /// What the device's own compiler says of the programs, if it tells.
    pub compiler: Vec<Executable>,
    /// What Mesa's compiler for AMD GPUs says of them (RDNA 3), if it is installed.
    pub radv: Vec<Radv>,
}

/// A program, as Mesa's compiler for AMD GPUs sees it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
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

/// Rows of chapter 24, or why there are none.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Table<Row> {
    /// Why it fails; `None` if it passes.
    pub failed: Option<String>,
    /// A row a rung and way.
    #[serde(default = "Vec::new")]
    pub rungs: Vec<Row>,
}

/// How often a rung is right on the hard cases.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs, reason = "they are those of `--cases`")]
pub struct HardCases {
    pub primitive: String,
    pub rung: String,
    pub name: String,
    /// `direct` or `traced`.
    pub way: String,
    /// Whether every case must be right.
    pub top: bool,
    #[serde(default)]
    pub cases: u64,
    #[serde(default)]
    pub right: u64,
    /// Why this device cannot run it.
    #[serde(default)]
    pub unavailable: Option<String>,
}

/// How far a rung is off on random rays, over all families of them, and what it costs.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Measured {
    /// What is asked.
    pub primitive: String,
    /// The rung's place.
    pub rung: String,
    /// The rung's name.
    pub name: String,
    /// The largest error of all rays, in ULP.
    pub worst_ulp: f64,
    /// Hits and misses that are wrong.
    pub wrong: u64,
    /// Its time by that of the ladder's plain rung, the middle of all rounds; `None` where it cannot be told.
    pub time_ratio: Option<f64>,
    /// A quarter of the rounds lie below the first, and a quarter above the second; cards of before 2026-11-28
    /// have none.
    #[serde(default)]
    pub time_quartiles: Option<[f64; 2]>,
}

impl Card {
    /// The name of its files, without extension: the device's, in small letters, and the arithmetic's if that is
    /// not the driver's.
    pub fn stem(&self) -> String {
        let name = self.device.as_ref().map_or("no device", |device| &device.name);
        let letter = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { ' ' };
        let words: String = name.chars().map(letter).collect();
        let words = words.split_whitespace().chain(self.arithmetic());
        words.collect::<Vec<_>>().join("-")
    }

    /// The arithmetic of its atlas, if that is not the driver's: then the card has nothing else.
    fn arithmetic(&self) -> Option<&str> {
        let arithmetic = self.atlas.as_ref()?.arithmetic.as_str();
        (!["", atlas::DRIVER].contains(&arithmetic)).then_some(arithmetic)
    }

    /// How many of the chapters pass.
    pub fn passed(&self) -> usize {
        let passes = |chapter: &&ChapterResult| chapter.failed.is_none() && chapter.lacks.is_none();
        self.chapters.iter().filter(passes).count()
    }

    /// How many of the chapters the device could run.
    pub fn offered(&self) -> usize {
        self.chapters.iter().filter(|chapter| chapter.lacks.is_none()).count()
    }

    /// Whether anything fails.
    pub fn fails(&self) -> bool {
        let atlas = self.atlas.as_ref().and_then(|atlas| atlas.failed.as_ref());
        let tables = [self.hard_cases.failed.as_ref(), self.measured.failed.as_ref(), atlas];
        self.passed() < self.offered() || tables.into_iter().any(|failed| failed.is_some())
    }

    /// What it must not say, or says wrongly; nothing if it is a card.
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
            if passes && !(near && chapter.milliseconds.is_some()) {
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

/// How paths begin that say whose machine it is.
const PRIVATE: [&str; 6] = ["/home/", "/Users/", "\\Users\\", "/root/", "/tmp/", "/mnt/"];

/// A line without the paths of this machine: of each, only its last part. A path with blanks stands in
/// quotation marks, as all that errors of this project tell.
pub fn without_paths(line: &str) -> String {
    let mut text = String::new();
    for (index, piece) in line.split('\'').enumerate() {
        let quoted = index % 2 == 1;
        let mark = if index == 0 { "" } else { "'" };
        text.push_str(mark);
        let is_path = quoted && (piece.starts_with(['/', '\\']) || piece.get(1..2) == Some(":"));
        match is_path {
            true => text.push_str(piece.rsplit(['/', '\\']).next().unwrap_or_default()),
            false => text.push_str(&words_without_paths(piece)),
        }
    }
    text
}

fn words_without_paths(line: &str) -> String {
    let part = |word: &str| -> String {
        let at = word.find(['/', '\\']);
        let absolute = at.is_some_and(|at| at == 0 && word.len() > 1 || word[..at].ends_with(':'));
        match absolute {
            true => word.rsplit(['/', '\\']).next().unwrap_or_default().to_owned(),
            false => word.to_owned(),
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

/// Every card of the project, by the name of its file, and what is wrong with those that are none.
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
