//! A classic mistake: a small patch to a chapter and its effect on the picture.
//!
//! Each is a file `docs/mistakes/NAME.diff`, a [`Patch`].
//! A run of the patched chapter checks the claims of the fields ([`super::reproduction`]).

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::Result;
use common::UsageError;
use common::files::NewFolder;
use manuscript::fault::Fault;
use manuscript::project::Project;

use crate::pages::reference::slug;
use crate::patches::copy::file_on_the_way;
use crate::patches::patch::{self, Field, Patch};
use crate::pictures::stamp;

/// The folder of the mistakes.
pub const FOLDER: &str = "docs/mistakes";

/// The form of a mistake's file.
const FORM: &str = "write a title, a blank line, `Symptom: WORDS`, `Chapter: NN_name` and the other fields, a blank line, a diff";

/// The effect of a mistake.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// Pixels differ from the right ones by at least this much, on a scale of 0 to 1: the mean over all
    /// channels, in sRGB.
    Differs(f64),
    /// The same picture takes at least this many times as long.
    Slower(f64),
    /// The program refuses to start, with a line that contains this.
    Refused(String),
    /// A signal ends the program, or it does not end.
    Crashes,
    /// The picture is the same, and only validation reports the mistake.
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

/// A mistake.
#[derive(Clone, Debug)]
pub struct Mistake {
    /// Its name: that of the file, without folder and extension.
    pub name: String,
    /// Its title.
    pub title: String,
    /// The symptom: a word to sort by, a colon, and a few more words.
    pub symptom: String,
    /// The chapter that makes it.
    pub chapter: String,
    /// The program's arguments, as in a shell.
    pub arguments: String,
    /// Its effect.
    pub outcome: Outcome,
    /// The words that occur in every validation message; `None` if there is no message.
    pub validation: Option<String>,
    /// The behaviour Vulkan leaves undefined here, if any. A GPU or its system may hang, so the mistake is
    /// only run on a software driver.
    pub undefined: Option<String>,
    /// The uninitialised memory it reads, if any: its picture differs from run to run.
    pub unwritten: Option<String>,
    /// The reason why the picture is wrong.
    pub cause: String,
    /// The way to find it.
    pub find: String,
    /// The cure.
    pub cure: String,
    /// Its file, and what it changes.
    pub patch: Patch,
}

impl Mistake {
    /// All mistakes, by name, and the faults in their files.
    pub fn all(project: &Project) -> (Vec<Self>, Vec<Fault>) {
        patch::all(project, FOLDER, |file, text| Self::parse(project, file, text))
    }

    /// All mistakes, by name.
    ///
    /// # Errors
    /// If a file is wrong.
    pub fn whole(project: &Project) -> Result<Vec<Self>> {
        patch::whole(Self::all(project))
    }

    /// The mistake of this name.
    ///
    /// # Errors
    /// If there is none; the message lists the existing ones.
    pub fn named(project: &Project, name: &str) -> Result<Self> {
        let mistakes = Self::whole(project)?;
        let names: Vec<String> = mistakes.iter().map(|mistake| mistake.name.clone()).collect();
        mistakes.into_iter().find(|mistake| mistake.name == name).ok_or_else(|| {
            UsageError(format!("no mistake '{name}'; there is {}", names.join(", "))).into()
        })
    }

    fn parse(project: &Project, file: &str, text: &str) -> Result<Self, Fault> {
        let wrong = |line, what: String, remedy: &str| Fault::new(file, line, what, remedy);
        let name = file.rsplit_once('/').map_or(file, |(_, name)| name);
        let Some(name) = name.strip_suffix(".diff") else {
            return Err(wrong(1, "a mistake is a file NAME.diff".to_owned(), "rename it"));
        };
        let mut patch = Patch::parse(file, text, FORM)?;
        let symptom = patch.field("Symptom")?.value;
        let Field { line, value: chapter, .. } = patch.field("Chapter")?;
        if project.named(&chapter).is_none() {
            let what = format!("there is no chapter '{chapter}'");
            return Err(wrong(line, what, "name one of `chapters list`"));
        }
        let arguments = patch.field_if_any("Arguments")?.map_or(String::new(), |field| field.value);
        let Field { line, value: outcome, .. } = patch.field("Outcome")?;
        let outcome = Outcome::parse(&outcome).ok_or_else(|| {
            let what = format!("'{outcome}' is no outcome");
            let there = "differs by 0.05, slower 3 times, refused: TEXT, crashes or forgiven";
            wrong(line, what, &format!("write {there}"))
        })?;
        let validation = Some(patch.field("Validation")?.value).filter(|text| text != "nothing");
        let undefined = patch.field_if_any("Undefined")?.map(|field| field.value);
        let unwritten = patch.field_if_any("Unwritten")?.map(|field| field.value);
        if outcome == Outcome::Crashes && undefined.is_none() {
            let what = "a crash is of what Vulkan leaves undefined".to_owned();
            return Err(wrong(line, what, "write `Undefined: WHAT`"));
        }
        let mut text_of = |key| patch.field(key).map(|field| field.value);
        let (cause, find, cure) = (text_of("Cause")?, text_of("Find")?, text_of("Cure")?);
        patch.no_other_field("a mistake")?;
        if patch.is_empty() {
            return Err(wrong(1, "there is no diff".to_owned(), FORM));
        }
        Ok(Self {
            name: name.to_owned(),
            title: patch.title.clone(),
            symptom,
            chapter,
            arguments,
            outcome,
            validation,
            undefined,
            unwritten,
            cause,
            find,
            cure,
            patch,
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

    /// Returns whether it changes only shaders; then the built program can show it.
    pub fn is_in_shaders(&self) -> bool {
        self.patch.is_in_shaders()
    }

    /// The contents of the patched files.
    ///
    /// # Errors
    /// If a hunk's lines do not occur exactly once in its file.
    pub fn patched(&self, project: &Project) -> Result<BTreeMap<String, String>, Fault> {
        self.patch.patched_in(project)
    }

    /// Makes a patched copy in an empty folder: of the shaders, or of everything a build needs.
    ///
    /// # Errors
    /// If the patch does not apply, the folder is not empty, or it cannot be written.
    pub fn copy_to(&self, project: &Project, folder: &Path) -> Result<()> {
        let refused = |path: &Path, what: &str| {
            UsageError(format!("'{}' {what}; name another folder with --out", path.display()))
        };
        if let Some(file) = file_on_the_way(folder) {
            return Err(refused(file, "is a file, and the copy is a folder").into());
        }
        if folder.read_dir().is_ok_and(|mut entries| entries.next().is_some()) {
            return Err(refused(folder, "is not empty").into());
        }
        let whole = NewFolder::at(folder)?;
        self.patch.copy_to(project, whole.path())?;
        whole.keep();
        Ok(())
    }

    /// The command that runs a patched copy, for a reader; on the software driver if the behaviour is
    /// undefined.
    pub fn run(&self, folder: &Path) -> String {
        let (bin, folder) = (&self.chapter, folder.display());
        let device = self.undefined.as_ref().map_or("", |_| "--device llvmpipe");
        let arguments = match [&*self.arguments, device].join(" ").trim() {
            "" => String::new(),
            arguments => format!(" -- {arguments}"),
        };
        if self.is_in_shaders() {
            format!("SHADERS={folder} cargo run --bin {bin}{arguments}")
        } else {
            format!(
                "CARGO_TARGET_DIR=target/mistakes/build cargo run --manifest-path \
                 {folder}/Cargo.toml --bin {bin}{arguments}"
            )
        }
    }

    /// The fault of its picture's file, if it is missing or another command made it.
    pub fn fault(&self, project: &Project) -> Option<Fault> {
        let what = stamp::fault(project, &self.picture(), &self.command())?;
        Some(Fault::new(self.file(), 1, what, self.remedy()))
    }

    /// The command that renders its picture again.
    pub fn remedy(&self) -> String {
        format!("run: cargo chapters sync --pictures {}", self.name)
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

/// A table of all mistakes, sorted by symptom.
pub fn symptoms(project: &Project) -> String {
    let mut mistakes = Mistake::all(project).0;
    mistakes.sort_by_key(|mistake| mistake.symptom.to_lowercase());
    let row = |mistake: &Mistake| {
        let Mistake { title, symptom, .. } = mistake;
        let picture = mistake.picture();
        let (picture, anchor) = (picture.trim_start_matches("docs/"), slug(title));
        format!("| [![{title}]({picture})](#{anchor}) | {symptom} | [{title}](#{anchor}) |\n")
    };
    let rows: String = mistakes.iter().map(row).collect();
    format!(
        "| as it should be, and as it is | what you see | what it may be |\n|---|---|---|\n{rows}"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

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
