//! An exercise: what a reader is to do, how to check it, and the patch that solves it.
//!
//! Each is a file `docs/exercises/NN.k.diff`, a [`Patch`]. [`super::attempt`] checks the claims in its fields
//! by running the chapter; the list on the chapter's page is generated from these files.

use std::collections::BTreeSet;
use std::fmt;

use anyhow::Result;
use common::UsageError;
use manuscript::fault::Fault;
use manuscript::project::{Chapter, Project};

use super::answer::Answer;
use super::expectation::Expectation;
use super::moved::Moved;
use super::proof::{Run, Step, steps};
use super::variant::Exempt;
use crate::patches::patch::{self, Field, Patch};

/// The folder of the exercises.
pub const FOLDER: &str = "docs/exercises";

/// The form of an exercise's file.
pub const FORM: &str = "write a title, a blank line, `Takes: shader`, `Minutes: 5`, `Text`, `Check`, `Hint`, `Run` with its \
    `Expect` lines, a blank line, the diff that solves it";

/// The kind of work an exercise needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Takes {
    /// No edits: settings, observation and an answer.
    Look,
    /// Edits of shaders alone.
    Shader,
    /// Edits of files that programs read, such as scenes.
    File,
    /// Edits of Rust code, and a build.
    Rust,
}

impl Takes {
    /// The words in its file.
    const WORDS: [(Self, &str); 4] = [
        (Self::Look, "look"),
        (Self::Shader, "shader"),
        (Self::File, "file"),
        (Self::Rust, "Rust"),
    ];
}

/// An exercise.
#[derive(Clone, Debug)]
pub struct Exercise {
    /// The name of its chapter.
    pub chapter: String,
    /// Its number in the chapter, from 1.
    pub number: usize,
    /// The kind of work it needs.
    pub takes: Takes,
    /// The minutes a reader needs, waiting included.
    pub minutes: u32,
    /// The task.
    pub text: String,
    /// The result, once it is done.
    pub check: String,
    /// A hint.
    pub hint: String,
    /// The explanation of the result.
    pub why: Option<String>,
    /// The answer, for an exercise that needs no edits.
    pub answer: Option<Answer>,
    /// The runs that prove it solved.
    pub steps: Vec<Step>,
    /// The variants of the solution that give the same picture.
    pub same: Vec<Exempt>,
    /// Its title, and what solves it.
    pub patch: Patch,
}

impl Exercise {
    /// All exercises, by chapter and number, and the faults found in their files.
    pub fn all(project: &Project) -> (Vec<Self>, Vec<Fault>) {
        let (mut exercises, faults): (Vec<Self>, _) =
            patch::all(project, FOLDER, |file, text| Self::parse(project, file, text));
        exercises.sort_by(|a, b| (&a.chapter, a.number).cmp(&(&b.chapter, b.number)));
        (exercises, faults)
    }

    /// Every exercise, by chapter and number.
    ///
    /// # Errors
    /// If a file is wrong.
    pub fn whole(project: &Project) -> Result<Vec<Self>> {
        patch::whole(Self::all(project))
    }

    /// The exercises that `05.2` stands for, or all exercises of chapter `05`.
    ///
    /// # Errors
    /// If the file of one of them is wrong, or there is no such exercise; the message gives its new number or
    /// lists the existing ones.
    pub fn named(project: &Project, name: &str) -> Result<Vec<Self>> {
        let (chapter, number) = name.split_once('.').unwrap_or((name, ""));
        let chapter = project.chapter(chapter)?;
        let (mut found, faults) = Self::all(project);
        let files = match number {
            "" => format!("{FOLDER}/{}.", chapter.number()),
            _ => format!("{FOLDER}/{}.{number}.diff", chapter.number()),
        };
        if let Some(fault) = faults.into_iter().find(|fault| fault.file.starts_with(&files)) {
            return Err(fault.error());
        }
        found.retain(|exercise| exercise.chapter == chapter.name);
        if !name.contains('.') {
            return Ok(found);
        }
        let names: Vec<String> = found.iter().map(Self::to_string).collect();
        found.retain(|exercise| number.parse() == Ok(exercise.number));
        if found.is_empty() {
            let old = format!("{}.{number}", chapter.number());
            let there = match Moved::read(project).now(&old) {
                Some(new) => format!("it is {new} now; run: cargo chapters exercise {new}"),
                None => format!("there is {}", names.join(", ")),
            };
            Err(UsageError(format!("no exercise '{name}'; {there}")).into())
        } else {
            Ok(found)
        }
    }

    fn parse(project: &Project, file: &str, text: &str) -> Result<Self, Fault> {
        let wrong = |line, what: &str, remedy: &str| Err(Fault::new(file, line, what, remedy));
        let name = file.rsplit_once('/').map_or(file, |(_, name)| name);
        let name = name.strip_suffix(".diff").and_then(|name| name.split_once('.'));
        let Some((chapter, Ok(number))) = name.map(|(chapter, k)| (chapter, k.parse())) else {
            return wrong(1, "an exercise is a file NN.k.diff", "rename it");
        };
        let known = |known: &&Chapter| known.number() == chapter;
        let Some(chapter) = project.chapters.iter().find(known) else {
            return wrong(1, &format!("there is no chapter {chapter}"), "rename it");
        };
        let mut patch = Patch::parse(file, text, FORM)?;
        let Field { line, value: takes, .. } = patch.field("Takes")?;
        let word = takes.trim_end_matches(", test");
        let Some(&(takes, _)) = Takes::WORDS.iter().find(|(_, known)| *known == word) else {
            let what = format!("an exercise takes no '{takes}'");
            return wrong(line, &what, "write look, shader, file or Rust");
        };
        let minutes = patch.field("Minutes")?;
        let Some(minutes) = minutes.value.parse().ok().filter(|minutes| *minutes > 0) else {
            let what = format!("'{}' is no number of minutes", minutes.value);
            return wrong(minutes.line, &what, "write a whole number");
        };
        let mut text_of = |key| patch.field(key).map(|field| field.value);
        let (text, check, hint) = (text_of("Text")?, text_of("Check")?, text_of("Hint")?);
        let why = patch.field_if_any("Why")?.map(|field| field.value);
        let answer = patch.field_if_any("Answer")?;
        let choices = patch.field_if_any("Choices")?;
        let same = patch.fields_of(&["Same"]);
        let same: Vec<Vec<Exempt>> =
            same.iter().map(|field| Exempt::parse(file, field)).collect::<Result<_, _>>()?;
        let same = same.concat();
        let steps = steps(file, patch.fields_of(&["Run", "Expect"]))?;
        patch.no_other_field("an exercise")?;
        let what = match (takes, &answer, patch.is_empty()) {
            (Takes::Look, Some(_), true) => None,
            (Takes::Look, None, _) => {
                Some(("what takes only looking asks a question", "add `Answer: …`"))
            }
            (Takes::Look, ..) => {
                Some(("what takes only looking has no diff", "write what it takes"))
            }
            (_, Some(_), _) => Some(("what is solved by a diff has no answer", "remove it")),
            _ if choices.is_some() && answer.is_none() => {
                Some(("what is solved by a diff has no choices", "remove them"))
            }
            (_, _, true) => Some(("there is no diff that solves it", FORM)),
            (Takes::Shader, ..) if !patch.is_in_shaders() => {
                Some(("the diff changes more than shaders", "write `Takes: Rust`"))
            }
            (Takes::File | Takes::Rust, ..) if patch.is_in_shaders() => {
                Some(("the diff changes shaders alone", "write `Takes: shader`"))
            }
            (Takes::File, ..) if patch.is_in_rust() => {
                Some(("the diff changes Rust code", "write `Takes: Rust`"))
            }
            (Takes::Rust, ..) if !patch.is_in_rust() => {
                Some(("the diff changes no Rust code", "write `Takes: file`"))
            }
            _ if steps.is_empty() => Some(("nothing tells when it is solved", FORM)),
            _ => None,
        };
        if let Some((what, remedy)) = what {
            return wrong(line, what, remedy);
        }
        let choices = choices.as_ref().map(|field| &*field.value);
        let answer = answer.map(|field| (field.line, Answer::parse(&field.value, choices, &text)));
        let answer = match answer {
            Some((line, Err(what))) => {
                return wrong(line, &what, "correct `Answer`, `Choices` or `Text`");
            }
            Some((_, Ok(answer))) => Some(answer),
            None => None,
        };
        let chapter = chapter.name.clone();
        let exercise = Self {
            chapter,
            number,
            takes,
            minutes,
            text,
            check,
            hint,
            why,
            answer,
            steps,
            same,
            patch,
        };
        match exercise.gives_itself_away() {
            Some(word) => wrong(
                line,
                &format!("the first run, which a reader is shown, holds the answer: {word}"),
                "begin with another run",
            ),
            None => Ok(exercise),
        }
    }

    /// The kind of work it needs, in words.
    pub fn takes(&self) -> String {
        let word = Takes::WORDS.iter().find(|(takes, _)| *takes == self.takes);
        let word = word.map_or("", |(_, word)| word);
        let test = if self.runs_tests() { ", test" } else { "" };
        format!("{word}{test}")
    }

    /// The time it needs, in words.
    pub fn time(&self) -> String {
        format!("{} minute{}", self.minutes, if self.minutes == 1 { "" } else { "s" })
    }

    /// Returns whether tests decide if it is solved.
    pub fn runs_tests(&self) -> bool {
        self.steps.iter().any(|step| matches!(step.run, Run::Test(..)))
    }

    /// The arguments of the first run that is compared with the solution's, or of the first run if none is.
    pub fn target(&self) -> Option<&[String]> {
        let judged = |step: &&Step| {
            step.expectations.iter().any(|one| matches!(one, Expectation::AsSolution(_)))
        };
        let step = self.steps.iter().find(judged).or(self.steps.first())?;
        match &step.run {
            Run::Program(arguments) => Some(arguments),
            Run::Test(..) => None,
        }
    }

    /// The argument of its first run that contains the answer, unless the text mentions it anyway.
    fn gives_itself_away(&self) -> Option<&str> {
        let Run::Program(arguments) = &self.steps.first()?.run else { return None };
        let value = |word: &str| word.split_once('=').map_or(word, |(_, value)| value).to_owned();
        let answer = self.answer.as_ref()?;
        let mut told = arguments.iter().filter(|word| !self.text.contains(&***word));
        told.find(|word| answer.accept(&value(word)) == Ok(true)).map(String::as_str)
    }

    /// Its item in the list on its page. The answer to a question is folded away.
    fn item(&self) -> String {
        let Self { number, patch, text, check, .. } = self;
        let (takes, time) = (self.takes(), self.time());
        let check = match self.takes {
            Takes::Look => {
                let indent = " ".repeat(format!("{number}. ").len());
                let check = capitalised(check);
                format!(
                    "\n\n{indent}<details><summary>Check</summary>\n\n{indent}{check}\n\n{indent}</details>\n"
                )
            }
            _ => format!(" *Check:* {check}"),
        };
        format!("{number}. **{}** ({takes}, {time}). {text}{check}\n", patch.title)
    }
}

/// A sentence that begins with a capital letter.
fn capitalised(sentence: &str) -> String {
    let mut letters = sentence.chars();
    letters.next().map(|first| first.to_uppercase().chain(letters).collect()).unwrap_or_default()
}

impl fmt::Display for Exercise {
    /// Its name, such as `05.2`.
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let chapter = self.chapter.split('_').next().unwrap_or_default();
        write!(f, "{chapter}.{}", self.number)
    }
}

/// The list on a chapter's page.
pub fn list(project: &Project, chapter: &Chapter) -> String {
    let mut own = Exercise::all(project).0;
    own.retain(|exercise| exercise.chapter == chapter.name);
    let items: String = own.iter().map(Exercise::item).collect();
    let edited = own.iter().find(|exercise| exercise.takes != Takes::Look);
    let (chapter, number) = (chapter.number(), edited.map_or(1, |exercise| exercise.number));
    format!(
        "`cargo chapters exercise {chapter}.{number}` sets up exercise {number}, checks it on each save, and \
         gives `--hint` and `--solution`.\n\n{items}"
    )
}

/// The faults in the files: missing numbers, and diffs that do not apply.
pub fn check(project: &Project) -> Vec<Fault> {
    let (exercises, mut faults) = Exercise::all(project);
    let there: BTreeSet<(&str, usize)> =
        exercises.iter().map(|exercise| (&*exercise.chapter, exercise.number)).collect();
    for exercise in &exercises {
        let before = exercise.number.saturating_sub(1);
        let first = before == 0 && exercise.number == 1;
        // A file that is not an exercise has already been reported.
        if faults.is_empty() && !first && !there.contains(&(&*exercise.chapter, before)) {
            let what = format!("there is no exercise {before} before this one");
            faults.push(Fault::new(&*exercise.patch.file, 1, what, "count from 1"));
        }
        faults.extend(exercise.patch.patched_in(project).err());
    }
    faults.extend(Moved::read(project).check(project, &exercises));
    faults
}
