//! `chapters verify`: runs the book's commands again, and compares the results with the stored ones.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::time::Duration;

use anyhow::{Result, bail};
use common::UsageError;
use common::files::NewFolder;
use common::output::print;
use common::workers;
use indicatif::{ProgressBar, ProgressStyle};
use manuscript::project::Project;

use crate::mistakes::mistake::{Mistake, Outcome};
use crate::mistakes::reproduction::Reproduction;
use crate::pages::book::Book;
use crate::pictures::picture::Picture;
use crate::pictures::stamp::{Maker, Stored};
use crate::pictures::tour;
use crate::programs::program::Programs;
use crate::programs::{change, interrupt};
use crate::values::measurement::{self, Measurement};
use crate::values::record::{Record, Records, renew};
use crate::values::{budget, given};

/// The largest number of edited chapters whose pictures a quick run compares.
const FEW: usize = 6;

/// The largest error of a channel on the driver that made a picture, of 255: a software driver compiles for
/// the present processor, and two processors may round a filtered colour differently.
const STEP: u8 = 1;

/// One result of a command.
enum Item<'a> {
    Picture(&'a Picture),
    Mistake(&'a Mistake),
    /// All measurements of one command.
    Values(Vec<&'a Measurement>),
    Tour,
}

/// The outcome of comparing one item.
#[derive(Default)]
struct Verdict {
    /// The differences, each as a line with its remedy.
    differences: Vec<String>,
    /// The items that could not be compared here.
    notes: Vec<String>,
}

/// Compares the items of these names, or all; with `changed`, only the pictures of edited chapters.
///
/// # Errors
/// If a name is unknown, or anything differs.
pub fn run(book: &Book, names: &[String], changed: bool) -> Result<()> {
    interrupt::listen();
    let project = book.programs.project;
    let (pictures, wrong) = Picture::all(project, &book.pages);
    if let Some(fault) = wrong.first() {
        bail!("{fault}");
    }
    let mistakes = Mistake::whole(project)?;
    let (stored, _) = Record::all(project);
    let measurements = measurement::all(&book.pages, &stored).0;
    let mut items = all(&pictures, &mistakes, &measurements, &stored);
    items.extend(tour::is_shown(project).then_some(Item::Tour));
    if changed {
        let edited = change::chapters(project);
        if edited.len() > FEW {
            let what =
                "chapters have changed, too many for a quick run; run: cargo chapters verify";
            return print(&format!("{} {what}\n", edited.len()));
        }
        items.retain(|item| matches!(item, Item::Picture(one) if edited.contains(one.chapter())));
    }
    let named = |name: &String| {
        let name = project.chapter(name).map_or(name.as_str(), |chapter| &chapter.name);
        name.to_owned()
    };
    let names: Vec<String> = names.iter().map(named).collect();
    if let Some(name) = names.iter().find(|name| !items.iter().any(|item| item.is(name))) {
        return Err(UsageError(format!("nothing of the book is called '{name}'")).into());
    }
    items.retain(|item| names.is_empty() || names.iter().any(|name| item.is(name)));

    let log = Log::open(book.programs);
    let before = items.len();
    items.retain(|item| !log.passed.contains(&item.name()));
    if items.len() < before {
        print(&format!("{} of {before} were verified before\n", before - items.len()))?;
    }
    let bar = ProgressBar::new(items.len() as u64);
    let form = "{bar:30} {pos}/{len} {msg}, {elapsed} so far, about {eta} more";
    bar.set_style(ProgressStyle::with_template(form)?);
    bar.enable_steady_tick(Duration::from_secs(1));
    let compare = |item: &Item| -> Result<Verdict> {
        interrupt::asked()?;
        bar.set_message(item.name());
        let verdict = item.compare(book.programs, &stored)?;
        bar.suspend(|| {
            let lines = verdict.differences.iter().chain(&verdict.notes);
            lines.into_iter().try_for_each(|line| print(&format!("{line}\n")))
        })?;
        if verdict.differences.is_empty() {
            log.add(&item.name())?;
        }
        bar.inc(1);
        Ok(verdict)
    };
    let verdicts: Vec<Result<Verdict>> = workers::each(&items, compare);
    bar.finish_and_clear();
    let verdicts = verdicts.into_iter().collect::<Result<Vec<_>>>()?;
    let differ = verdicts.iter().filter(|verdict| !verdict.differences.is_empty()).count();
    match differ {
        0 => {
            log.remove();
            print(&format!("{before} verified, no difference\n"))
        }
        _ => bail!("{differ} of {before} differ"),
    }
}

/// Every item; pictures first, because they take longest.
fn all<'a>(
    pictures: &'a [Picture],
    mistakes: &'a [Mistake],
    measurements: &'a [Measurement],
    stored: &Records,
) -> Vec<Item<'a>> {
    let mut commands = BTreeMap::<&str, Vec<&Measurement>>::new();
    for measurement in measurements {
        commands.entry(&measurement.command).or_default().push(measurement);
    }
    let stays = |one: &&Measurement| {
        stored.get(&one.name).is_some_and(|record| record.timed || record.commit.is_some())
    };
    let values = commands.into_values().filter(|group| !group.iter().all(stays));
    let pictures = pictures.iter().map(Item::Picture);
    let mistakes = mistakes.iter().map(Item::Mistake);
    pictures.chain(mistakes).chain(values.map(Item::Values)).collect()
}

impl Item<'_> {
    /// Its unique name.
    fn name(&self) -> String {
        match self {
            Self::Picture(picture) => picture.file(),
            Self::Mistake(mistake) => mistake.file(),
            Self::Values(group) => group[0].name.clone(),
            Self::Tour => tour::FILE.to_owned(),
        }
    }

    /// True if it has this name, or belongs to the chapter or page of this name.
    fn is(&self, name: &str) -> bool {
        match self {
            Self::Picture(one) => one.name == name || one.chapter() == name,
            Self::Mistake(one) => one.name == name || one.chapter == name,
            Self::Values(group) => group.iter().any(|m| m.name == name || m.page_name() == name),
            Self::Tour => name == "tour",
        }
    }

    /// Runs its command, and compares the result.
    ///
    /// # Errors
    /// If a signal requests termination.
    fn compare(&self, programs: &Programs, stored: &Records) -> Result<Verdict> {
        let project = programs.project;
        let mut verdict = Verdict::default();
        match self {
            Self::Picture(picture) => {
                let folder = NewFolder::temporary()?;
                let made = picture.make(programs, folder.path());
                verdict.picture(
                    project,
                    &picture.file(),
                    picture.chapter(),
                    made,
                    &picture.remedy(),
                );
            }
            Self::Mistake(mistake) => {
                let (folder, trial) =
                    (NewFolder::temporary()?, Reproduction::new(programs, mistake));
                let made = trial.make(folder.path());
                // Labels contain times, and uninitialised memory may contain anything.
                let is_steady =
                    !matches!(mistake.outcome, Outcome::Slower(_)) && mistake.unwritten.is_none();
                match made {
                    Ok(_) if !is_steady => {}
                    made => verdict.picture(
                        project,
                        &mistake.picture(),
                        &mistake.chapter,
                        made,
                        &mistake.remedy(),
                    ),
                }
            }
            Self::Values(group) => verdict.values(programs, group, stored),
            Self::Tour => {
                let made = tour::bytes(project)?;
                if fs::read(project.root.join(tour::FILE))? != made {
                    verdict.differences.push(format!(
                        "{}: differs; run: {}",
                        tour::FILE,
                        tour::COMMAND
                    ));
                }
            }
        }
        interrupt::asked()?;
        Ok(verdict)
    }
}

impl Verdict {
    fn picture(
        &mut self,
        project: &Project,
        file: &str,
        chapter: &str,
        made: Result<(PathBuf, Maker)>,
        remedy: &str,
    ) {
        let opened = made.and_then(|(made, maker)| {
            Ok((Stored::open(&made)?.frames, maker, Stored::open(&project.root.join(file))?))
        });
        let (made, maker, stored) = match opened {
            Ok(opened) => opened,
            Err(error) => return self.differences.push(format!("{file}: {error:#}; {remedy}")),
        };
        let sizes = |frames: &[image::RgbImage]| -> Vec<(u32, u32)> {
            frames.iter().map(image::RgbImage::dimensions).collect()
        };
        if sizes(&made) != sizes(&stored.frames) {
            let what = format!("{file}: another size or number of frames; {remedy}");
            return self.differences.push(what);
        }
        let is_same_maker = maker == stored.maker;
        if is_same_maker && made != stored.frames {
            let pairs = made.iter().zip(&stored.frames);
            let is_far = |(a, b): &(&image::Rgb<u8>, &image::Rgb<u8>)| {
                a.0.iter().zip(b.0).any(|(a, b)| a.abs_diff(b) > STEP)
            };
            let apart = |(a, b): (&image::RgbImage, &image::RgbImage)| {
                a.pixels().zip(b.pixels()).filter(is_far).count()
            };
            match pairs.map(apart).sum() {
                0usize => self.notes.push(format!("{file}: differs by at most 1 of 255")),
                pixels => {
                    self.differences.push(format!("{file}: {pixels} pixels differ; {remedy}"))
                }
            }
        } else if !is_same_maker {
            self.elsewhere(file, chapter, &made, &stored, remedy);
        }
    }

    /// Compares with a picture of another device or driver, which may differ by rounding.
    fn elsewhere(
        &mut self,
        file: &str,
        chapter: &str,
        made: &[image::RgbImage],
        stored: &Stored,
        remedy: &str,
    ) {
        let device = &stored.maker.device;
        let size = made[0].dimensions();
        let Some(bound) = flip::near::golden(chapter, size, flip::TOLERANCE) else {
            let note = format!("{file}: shows the errors of its device, {device}: not compared");
            return self.notes.push(note);
        };
        let far =
            |(a, b): (&image::RgbImage, &image::RgbImage)| flip::mean(size, b.as_raw(), a.as_raw());
        let most = made.iter().zip(&stored.frames).map(far).fold(0.0, f32::max);
        if most > bound {
            let what = format!(
                "{file}: FLIP {most:.4} from that of {device}, where rounding explains {bound:.4}; {remedy}"
            );
            self.differences.push(what);
        }
    }

    fn values(&mut self, programs: &Programs, group: &[&Measurement], stored: &Records) {
        let command = &group[0].command;
        let recorded = |one: &&Measurement| {
            let old = stored.get(&one.name)?;
            Some((
                one.name.clone(),
                Record { values: budget::values(programs.project, old)?, ..old.clone() },
            ))
        };
        let recorded: Option<BTreeMap<String, Record>> = group.iter().map(recorded).collect();
        if let Some(recorded) = recorded {
            return self.compare(group, &recorded, stored);
        }
        let given = match given::run(programs, command) {
            Ok(given) => given,
            Err(error) => {
                let what = format!("{}: {error:#}; {}", group[0].name, renew(&group[0].name));
                return self.differences.push(what);
            }
        };
        self.compare(group, &given, stored);
    }

    fn compare(
        &mut self,
        group: &[&Measurement],
        given: &BTreeMap<String, Record>,
        stored: &Records,
    ) {
        for Measurement { name, .. } in group {
            let old = stored.get(name);
            if old.is_some_and(|old| old.timed) {
                continue;
            }
            let (Some(old), Some(new)) = (old, given.get(name).or(given.get(""))) else {
                self.differences
                    .push(format!("{name}: nothing is stored, or given; {}", renew(name)));
                continue;
            };
            if !old.is_of_device_of(new) {
                let values = serde_json::Value::from(new.values.clone());
                let (device, driver) = (&old.device, &old.driver);
                self.notes.push(format!("{name}: stored of {device}, {driver}; here {values}"));
            } else if old.values != new.values {
                let differ = |(key, value): (&String, &serde_json::Value)| {
                    let new = new.values.get(key);
                    let is = new.map_or("missing".to_owned(), ToString::to_string);
                    (!new.is_some_and(|new| is_near(value, new)))
                        .then(|| format!("{key} was {value}, is {is}"))
                };
                let all: Vec<String> = old.values.iter().filter_map(differ).collect();
                let first = match all.first() {
                    Some(first) => first,
                    None if old.values.len() == new.values.len() => {
                        self.notes.push(format!("{name}: differs by at most 1 of 10,000"));
                        continue;
                    }
                    None => "more values are given",
                };
                let more = match all.len() {
                    0 | 1 => String::new(),
                    count => format!(" (and {} more)", count - 1),
                };
                self.differences.push(format!("{name}: {first}{more}; {}", renew(name)));
            }
        }
    }
}

/// True if two values are equal, or are means that differ by no more than another processor's rounding: a
/// software driver compiles for the present processor. Counts must be equal.
fn is_near(old: &serde_json::Value, new: &serde_json::Value) -> bool {
    let (Some(a), Some(b)) = (old.as_f64(), new.as_f64()) else { return old == new };
    let is_count = old.is_u64() || old.is_i64();
    a == b || !is_count && (a - b).abs() <= 1e-4 * a.abs()
}

/// The items that have passed since the code last changed, in `target/verify`, so that an interrupted run can
/// continue.
struct Log {
    file: PathBuf,
    passed: BTreeSet<String>,
    lines: Mutex<String>,
}

impl Log {
    fn open(programs: &Programs) -> Self {
        let file = programs.target().join("verify");
        let head = state(&programs.project.root);
        let text = fs::read_to_string(&file).unwrap_or_default();
        let (old, passed) = text.split_once('\n').unwrap_or_default();
        let passed = if old == head { passed } else { "" };
        let lines = Mutex::new(format!("{head}\n{passed}"));
        Self { file, passed: passed.lines().map(str::to_owned).collect(), lines }
    }

    fn add(&self, name: &str) -> Result<()> {
        let mut lines = self.lines.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        *lines += &format!("{name}\n");
        common::files::write_whole(&self.file, lines.as_bytes())
    }

    fn remove(&self) {
        let _ = fs::remove_file(&self.file);
    }
}

/// A hash of the commit and of all differences from it.
fn state(root: &Path) -> String {
    let mut hasher = DefaultHasher::new();
    change::text(root, &["rev-parse", "HEAD"]).hash(&mut hasher);
    change::text(root, &["diff", "HEAD"]).hash(&mut hasher);
    format!("{:016x}", hasher.finish())
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::is_near;

    #[test]
    fn counts_are_equal_and_means_are_near() {
        for (old, new, near) in [
            (json!(723), json!(723), true),
            (json!(100_000), json!(100_001), false),
            (json!(0.09921577), json!(0.09921809), true),
            (json!(0.0992), json!(0.0994), false),
            (json!(0.0), json!(1e-9), false),
            (json!("a"), json!("a"), true),
            (json!(null), json!(0.5), false),
        ] {
            assert_eq!(is_near(&old, &new), near, "{old} {new}");
        }
    }
}
