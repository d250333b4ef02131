//! A classic mistake: a small patch to a chapter, and what it does to the picture.
//!
//! Each is a file `docs/mistakes/NAME.diff`: a title, fields, and a unified diff, which any tool applies.
//! What the fields claim is held against a run of the patched chapter by [`crate::trial`].

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use anyhow::{Context, Result, bail};
use common::usage::Usage;

use crate::fault::Fault;
use crate::picture::{self, Sources};
use crate::project::Project;

/// Where the mistakes lie.
pub const FOLDER: &str = "docs/mistakes";

/// The parts of a project that a copy needs to be built.
const PARTS: [&str; 6] = ["Cargo.toml", "Cargo.lock", "common", "samples", "shaders", "tests"];

/// What a mistake does.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// Pixels differ from the right ones by at least so much, of 1: the mean over all channels, in sRGB.
    Differs(f64),
    /// The same picture takes at least so many times as long.
    Slower(f64),
    /// The program refuses to start, with a line that holds this.
    Refused(String),
    /// A signal ends the program, or it does not end.
    Crashes,
    /// The picture is the same, and only validation tells.
    Forgiven,
}

impl Outcome {
    fn parse(text: &str) -> Option<Self> {
        let (word, rest) = text.split_once(' ').unwrap_or((text, ""));
        match word {
            "differs" => rest.strip_prefix("by ")?.parse().ok().map(Self::Differs),
            "slower" => rest.strip_suffix(" times")?.parse().ok().map(Self::Slower),
            "refused:" if !rest.is_empty() => Some(Self::Refused(rest.to_owned())),
            "crashes" => Some(Self::Crashes),
            "forgiven" => Some(Self::Forgiven),
            _ => None,
        }
    }
}

/// Lines of a file, and what stands there instead.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Hunk {
    /// Its line in the diff, from 1.
    line: usize,
    file: String,
    old: Vec<String>,
    new: Vec<String>,
}

/// A mistake.
#[derive(Clone, Debug)]
pub struct Mistake {
    /// Its name: that of the file, without folder and extension.
    pub name: String,
    /// Its title.
    pub title: String,
    /// The chapter that makes it.
    pub chapter: String,
    /// The program's arguments, as in a shell.
    pub arguments: String,
    /// What it does.
    pub outcome: Outcome,
    /// What every validation message holds; `None` if there is none.
    pub validation: Option<String>,
    /// Why the picture is wrong.
    pub cause: String,
    /// What shows it.
    pub find: String,
    /// What is right.
    pub cure: String,
    /// The whole file.
    text: String,
    hunks: Vec<Hunk>,
}

impl Mistake {
    /// Every mistake, by name, and what is wrong with the files.
    pub fn all(project: &Project) -> (Vec<Self>, Vec<Fault>) {
        let (mut mistakes, mut faults) = (Vec::new(), Vec::new());
        for file in project.files(FOLDER) {
            let text = project.read(&file).unwrap_or_default();
            match Self::parse(project, &file, &text) {
                Ok(mistake) => mistakes.push(mistake),
                Err(fault) => faults.push(fault),
            }
        }
        (mistakes, faults)
    }

    /// Every mistake, by name.
    ///
    /// # Errors
    /// If a file is wrong.
    pub fn whole(project: &Project) -> Result<Vec<Self>> {
        let (mistakes, faults) = Self::all(project);
        faults.into_iter().next().map_or(Ok(mistakes), |fault| Err(fault.error()))
    }

    /// The mistake of this name.
    ///
    /// # Errors
    /// If there is none; the line lists those that there are.
    pub fn named(project: &Project, name: &str) -> Result<Self> {
        let mistakes = Self::whole(project)?;
        let names: Vec<String> = mistakes.iter().map(|mistake| mistake.name.clone()).collect();
        mistakes.into_iter().find(|mistake| mistake.name == name).ok_or_else(|| {
            Usage(format!("no mistake '{name}'; there is {}", names.join(", "))).into()
        })
    }

    fn parse(project: &Project, file: &str, text: &str) -> Result<Self, Fault> {
        let wrong = |line, what: String, remedy: &str| Fault::new(file, line, what, remedy);
        let form = "write a title, a blank line, `Chapter: NN_name` and the other fields, a diff";
        let name = file.rsplit_once('/').map_or(file, |(_, name)| name);
        let Some(name) = name.strip_suffix(".diff") else {
            return Err(wrong(1, "a mistake is a file NAME.diff".to_owned(), "rename it"));
        };
        let end = text.lines().position(|line| line.starts_with("--- ")).unwrap_or(0);
        let head: Vec<&str> = text.lines().take(end).collect();
        let mut fields: BTreeMap<&str, (usize, &str)> = BTreeMap::new();
        for (index, line) in head.iter().enumerate().skip(1).filter(|(_, line)| !line.is_empty()) {
            let Some((key, value)) = line.split_once(": ") else {
                return Err(wrong(index + 1, format!("'{line}' is no field"), form));
            };
            fields.insert(key, (index + 1, value));
        }
        let mut field = |key: &str| {
            let missing = || wrong(1, format!("there is no field '{key}'"), form);
            fields.remove(key).map(|(line, value)| (line, value.to_owned())).ok_or_else(missing)
        };
        let (line, chapter) = field("Chapter")?;
        if !project.chapters.iter().any(|known| known.name == chapter) {
            let what = format!("there is no chapter '{chapter}'");
            return Err(wrong(line, what, "name one of `chapters list`"));
        }
        let arguments = field("Arguments").map_or(String::new(), |(_, arguments)| arguments);
        let (line, outcome) = field("Outcome")?;
        let outcome = Outcome::parse(&outcome).ok_or_else(|| {
            let what = format!("'{outcome}' is no outcome");
            let there = "differs by 0.05, slower 3 times, refused: TEXT, crashes or forgiven";
            wrong(line, what, &format!("write {there}"))
        })?;
        let validation = Some(field("Validation")?.1).filter(|text| text != "nothing");
        let (cause, find, cure) = (field("Cause")?.1, field("Find")?.1, field("Cure")?.1);
        if let Some((key, (line, _))) = fields.into_iter().next() {
            return Err(wrong(line, format!("'{key}' is no field of a mistake"), form));
        }
        let hunks = hunks(text);
        if hunks.is_empty() {
            return Err(wrong(1, "there is no diff".to_owned(), form));
        }
        Ok(Self {
            name: name.to_owned(),
            title: head[0].to_owned(),
            chapter,
            arguments,
            outcome,
            validation,
            cause,
            find,
            cure,
            text: text.to_owned(),
            hunks,
        })
    }

    /// Its file, from the project's root.
    pub fn file(&self) -> String {
        format!("{FOLDER}/{}.diff", self.name)
    }

    /// Its picture, from the project's root.
    pub fn picture(&self) -> String {
        format!("docs/images/mistakes/{}.png", self.name)
    }

    /// The command that shows it.
    pub fn command(&self) -> String {
        format!("cargo chapters mistake {}", self.name)
    }

    /// Whether it changes shaders alone: then the built program shows it.
    pub fn is_in_shaders(&self) -> bool {
        self.hunks.iter().all(|hunk| hunk.file.starts_with("shaders/"))
    }

    /// What the patched files hold.
    ///
    /// # Errors
    /// If a hunk's lines do not stand in its file, once.
    pub fn patched(&self, project: &Project) -> Result<BTreeMap<String, String>, Fault> {
        let mut files: BTreeMap<String, Vec<String>> = BTreeMap::new();
        for hunk in &self.hunks {
            let lines = files.entry(hunk.file.clone()).or_insert_with(|| {
                project.read(&hunk.file).unwrap_or_default().lines().map(str::to_owned).collect()
            });
            let old = hunk.old.len();
            let mut found = (0..(lines.len() + 1).saturating_sub(old))
                .filter(|&at| lines[at..at + old] == hunk.old[..]);
            let (Some(at), None) = (found.next(), found.next()) else {
                let what = format!("this hunk does not fit {}", hunk.file);
                return Err(Fault::new(self.file(), hunk.line, what, "make the patch again"));
            };
            lines.splice(at..at + old, hunk.new.iter().cloned());
        }
        let joined = |lines: Vec<String>| lines.iter().map(|line| format!("{line}\n")).collect();
        Ok(files.into_iter().map(|(file, lines)| (file, joined(lines))).collect())
    }

    /// Makes a patched copy in an empty folder: of the shaders, or of all that a build needs.
    ///
    /// # Errors
    /// If the patch does not fit, the folder holds something, or it cannot be written.
    pub fn copy_to(&self, project: &Project, folder: &Path) -> Result<()> {
        if folder.read_dir().is_ok_and(|mut entries| entries.next().is_some()) {
            bail!("'{}' is not empty; name another folder with --out", folder.display());
        }
        self.copy_over(project, folder)
    }

    /// Makes a folder a patched copy. What is right already is left alone, so that Cargo builds only what
    /// differs from the copy before.
    ///
    /// # Errors
    /// If the patch does not fit, or the folder cannot be written.
    pub fn copy_over(&self, project: &Project, folder: &Path) -> Result<()> {
        let patched = self.patched(project).map_err(Fault::error)?;
        let parts: &[&str] = if self.is_in_shaders() { &["shaders"] } else { &PARTS };
        let mut files: Vec<String> = parts.iter().flat_map(|part| project.files(part)).collect();
        if !self.is_in_shaders() {
            files.extend(["Cargo.toml", "Cargo.lock"].map(str::to_owned));
            files.extend(project.files("docs/chapters"));
        }
        for file in files {
            let to = match self.is_in_shaders() {
                true => folder.join(file.trim_start_matches("shaders/")),
                false => folder.join(&file),
            };
            let bytes = match patched.get(&file) {
                Some(text) => text.clone().into_bytes(),
                None => fs::read(project.root.join(&file))?,
            };
            if fs::read(&to).is_ok_and(|there| there == bytes) {
                continue;
            }
            let parent = to.parent().context("a file lies in a folder")?;
            fs::create_dir_all(parent)
                .with_context(|| format!("cannot make '{}'", parent.display()))?;
            fs::write(&to, bytes).with_context(|| format!("cannot write '{}'", to.display()))?;
        }
        Ok(())
    }

    /// The command that runs a patched copy, for a reader.
    pub fn run(&self, folder: &Path) -> String {
        let (bin, folder) = (&self.chapter, folder.display());
        let arguments = match &*self.arguments {
            "" => String::new(),
            arguments => format!(" -- {arguments}"),
        };
        match self.is_in_shaders() {
            true => format!("SHADERS={folder} cargo run --bin {bin}{arguments}"),
            false => format!(
                "CARGO_TARGET_DIR=target/mistakes/build cargo run --manifest-path \
                 {folder}/Cargo.toml --bin {bin}{arguments}"
            ),
        }
    }

    /// What its picture is made from, as a hash: the chapter and the patch.
    pub fn sources(&self, project: &Project, sources: &mut Sources) -> String {
        let chapter = sources.of(project, &self.chapter);
        picture::hash([chapter.as_bytes(), self.text.as_bytes()])
    }

    /// What is out of date about its picture, if anything is.
    pub fn stale(&self, project: &Project, sources: &mut Sources) -> Option<Fault> {
        let hash = self.sources(project, sources);
        let what = picture::stale(project, &self.picture(), &self.command(), &hash, "its patch")?;
        let remedy = format!("run: cargo chapters sync --pictures {}", self.name);
        Some(Fault::new(self.file(), 1, what, remedy))
    }

    /// Its part of a page.
    pub fn section(&self) -> String {
        let Self { title, name, cause, find, cure, .. } = self;
        let picture = self.picture();
        let picture = picture.trim_start_matches("docs/");
        let number = self.chapter.split('_').next().unwrap_or_default();
        let heard = |message| format!(" **Validation:** `{message}`.");
        let heard = self.validation.as_ref().map_or_else(String::new, heard);
        format!(
            "### {title}\n\n![{title}]({picture})\n\n[{number}, \
             `{name}`](mistakes/{name}.diff). {cause}{heard} **Find:** {find} \
             **Cure:** {cure}\n"
        )
    }
}

/// The gallery's part of a page: every mistake.
pub fn gallery(project: &Project) -> String {
    let sections: Vec<String> = Mistake::all(project).0.iter().map(Mistake::section).collect();
    sections.join("\n")
}

/// The hunks of a unified diff.
fn hunks(text: &str) -> Vec<Hunk> {
    let mut hunks: Vec<Hunk> = Vec::new();
    let mut file = None;
    for (index, line) in text.lines().enumerate() {
        if let Some(path) = line.strip_prefix("+++ ") {
            file = Some(path.trim().to_owned());
        } else if line.starts_with("--- ") {
            file = None;
        } else if let (true, Some(file)) = (line.starts_with("@@"), &file) {
            hunks.push(Hunk { line: index + 1, file: file.clone(), old: vec![], new: vec![] });
        } else if let (Some(_), Some(hunk)) = (&file, hunks.last_mut()) {
            let (sign, rest) = line.split_at_checked(1).unwrap_or((" ", ""));
            if sign != "+" {
                hunk.old.push(rest.to_owned());
            }
            if sign != "-" {
                hunk.new.push(rest.to_owned());
            }
        }
    }
    hunks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hunks_hold_what_was_and_what_is() {
        let text =
            "T\n\nCause: -x\n\n--- a\n+++ b/c\n@@ -1,2 +1,2 @@\n x\n-y\n+z\n@@ -9 +9 @@\n+w\n";
        let lines = |lines: &[&str]| lines.iter().map(|line| (*line).to_owned()).collect();
        let file = || "b/c".to_owned();
        let (first, second) = (lines(&["x", "y"]), lines(&["x", "z"]));
        let expected = [
            Hunk { line: 7, file: file(), old: first, new: second },
            Hunk { line: 11, file: file(), old: vec![], new: lines(&["w"]) },
        ];
        assert_eq!(hunks(text), expected);
    }

    #[test]
    fn outcomes_are_told_by_their_first_word() {
        let outcomes = ["differs by 0.5", "slower 3 times", "refused: a b", "crashes", "forgiven"];
        let expected = [
            Outcome::Differs(0.5),
            Outcome::Slower(3.0),
            Outcome::Refused("a b".to_owned()),
            Outcome::Crashes,
            Outcome::Forgiven,
        ];
        assert_eq!(outcomes.map(|text| Outcome::parse(text).unwrap()), expected);
        assert_eq!(["", "differs", "refused:"].map(Outcome::parse), [None, None, None]);
    }
}
