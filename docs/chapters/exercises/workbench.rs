//! The place in which a reader solves an exercise: a copy of the shaders, or the project itself. It is
//! checked on each save, with the chapter's window open.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow};
use common::UsageError;
use common::output::print;

use super::attempt::{Attempt, Originals, Verdict};
use super::command::offer;
use super::exercise::{Exercise, Takes};
use super::formula::plain;
use super::progress::Progress;
use super::proof::Run;
use super::solution::Solution;
use super::watcher::FolderWatcher;
use super::window::Window;
use crate::patches::copy::{Changed, copy_shaders, file_on_the_way};
use crate::patches::edition::Edition;
use crate::programs::command_line::quoted;
use crate::programs::interrupt;
use crate::programs::program::Programs;

/// The place of an exercise.
pub struct Workbench<'a> {
    programs: &'a Programs<'a>,
    exercise: &'a Exercise,
    /// The copy of the shaders; for Rust code, the folder of the book's pictures.
    folder: PathBuf,
    /// The folder as the reader wrote it.
    shown: String,
}

impl<'a> Workbench<'a> {
    /// The place for an exercise; [`Workbench::set_up`] creates it.
    ///
    /// # Errors
    /// If the folder cannot be used, or the exercise needs none.
    pub fn new(
        programs: &'a Programs<'a>,
        exercise: &'a Exercise,
        folder: Option<&Path>,
    ) -> Result<Self> {
        if folder.is_some() && exercise.takes != Takes::Shader {
            let what = match exercise.takes {
                Takes::File | Takes::Rust => "is done in the project itself",
                _ => "changes nothing",
            };
            return Err(
                UsageError(format!("exercise {exercise} {what} and takes no --folder")).into()
            );
        }
        let own = format!("target/exercises/{exercise}");
        let shown = folder.map_or_else(|| own.clone(), |folder| folder.display().to_string());
        let folder = match folder {
            Some(folder) => std::path::absolute(folder).context("no folder is named")?,
            None => programs.project.root.join(own),
        };
        if let Some(file) = file_on_the_way(&folder) {
            let what = if file == folder { shown } else { file.display().to_string() };
            return Err(
                UsageError(format!("'{what}' is no folder; name another with --folder")).into()
            );
        }
        Ok(Self { programs, exercise, folder, shown })
    }

    /// Creates the place, or continues with the reader's edits if it exists. Returns whether it existed.
    ///
    /// # Errors
    /// If it cannot be created, contains something else, or the chapter's program is not built.
    pub fn set_up(&self) -> Result<bool> {
        let project = self.programs.project;
        let built = || self.programs.built(&self.exercise.chapter);
        match self.exercise.takes {
            Takes::Look => {
                built()?;
                // The folder in which the printed command writes its picture.
                fs::create_dir_all(project.root.join("target/exercises"))?;
                Ok(true)
            }
            Takes::Shader => {
                built()?;
                let book = project.root.join("shaders");
                let is_book =
                    |folder: &Path| folder.canonicalize().ok() == book.canonicalize().ok();
                let refused = |what: &str| {
                    UsageError(format!("'{}' {what}; name another with --folder", self.shown))
                };
                if self.folder.ancestors().any(is_book) {
                    return Err(refused("holds the book's own shaders").into());
                }
                let filled =
                    self.folder.read_dir().is_ok_and(|mut entries| entries.next().is_some());
                if filled {
                    let own = self.folder.join(&self.exercise.chapter).is_dir();
                    let what = "holds something else than a copy of the shaders";
                    return if own { Ok(true) } else { Err(refused(what).into()) };
                }
                let failed = || format!("cannot make '{}'", self.shown);
                let above = self.folder.parent().with_context(failed)?;
                fs::create_dir_all(above).with_context(failed)?;
                // Copied next to it and then renamed, so that the folder is never incomplete.
                let whole = tempfile::tempdir_in(above).with_context(failed)?;
                copy_shaders(project, whole.path(), &Changed::new())?;
                fs::rename(whole.keep(), &self.folder).with_context(failed)?;
                Ok(false)
            }
            Takes::File | Takes::Rust => {
                if self.kept().is_dir() {
                    return Ok(true);
                }
                let fits = self.exercise.patch.patched_in(project);
                let what =
                    "the project is not as the book has it: undo your changes and begin again";
                fits.map_err(|fault| {
                    let misfit = fault.what.replace("this hunk", "the solution");
                    anyhow!("{misfit}: {what}")
                })?;
                let solution = Solution::new(self.programs, self.exercise);
                Originals::new(self.programs).keep(self.exercise, &solution, &self.kept())?;
                Ok(false)
            }
        }
    }

    /// The folder of the book's pictures from before its own files were edited.
    fn kept(&self) -> PathBuf {
        self.folder.join("book")
    }

    fn edition(&self) -> Edition {
        match self.exercise.takes {
            Takes::Look => Edition::Book,
            Takes::Shader => Edition::Shaders(self.folder.clone()),
            Takes::File | Takes::Rust => Edition::Edited,
        }
    }

    /// The list of files to edit, as printed for the reader.
    pub fn introduction(&self) -> String {
        let project = self.programs.project;
        let shader = self.exercise.takes == Takes::Shader;
        let places = self.exercise.patch.places(project).into_iter().map(|(file, items)| {
            let there = project.has(&file);
            let file = if shader { file.trim_start_matches("shaders/") } else { &*file };
            match (there, &items[..]) {
                (false, _) => format!("{file} (new)"),
                (true, []) => file.to_owned(),
                (true, items) => format!("{file} ({})", items.join(", ")),
            }
        });
        let places = places.collect::<Vec<_>>().join("; ");
        let (shown, name) = (&self.shown, self.exercise);
        let place = match self.exercise.takes {
            Takes::Look => return String::new(),
            Takes::Shader => format!("Edit in {shown}, a copy of the shaders: {places}"),
            Takes::File | Takes::Rust => {
                format!(
                    "Edit in the project itself; `git restore` undoes it, but for new files: {places}"
                )
            }
        };
        let mut lines = vec![place];
        if let Some(render) = self.render() {
            lines.push(format!("The picture after each save: {shown}.png"));
            lines.push(format!("Make it yourself: {render}"));
        }
        lines.push(format!("Stuck? cargo chapters exercise {name} --hint"));
        lines.iter().map(|line| format!("{line}\n")).collect()
    }

    /// The command that renders the reader's first picture without a window: that of the checked run, or for
    /// an exercise without edits a run in the usual size. `None` if the exercise only runs tests.
    pub fn render(&self) -> Option<String> {
        let look = self.exercise.takes == Takes::Look;
        let mut words = if look { self.look() } else { self.first_run()?.to_vec() };
        words.extend(["--headless".to_owned(), "--out".to_owned(), self.own_picture()]);
        let shaders = match self.exercise.takes {
            Takes::Shader => format!("SHADERS={} ", quoted(std::slice::from_ref(&self.shown))),
            _ => String::new(),
        };
        let chapter = &self.exercise.chapter;
        Some(format!("{shaders}cargo run --bin {chapter} -- {}", quoted(&words)))
    }

    /// The file of the reader's picture.
    fn own_picture(&self) -> String {
        format!("{}.png", self.shown)
    }

    /// The file of the picture it was compared with.
    fn other_picture(&self) -> String {
        format!("{}.other.png", self.shown)
    }

    /// Renders the solution next to the reader's picture, and returns the path.
    ///
    /// # Errors
    /// If it cannot be rendered or written.
    pub fn target(&self, arguments: &[String]) -> Result<String> {
        let shown = format!("{}.target.png", self.shown);
        let file = PathBuf::from(format!("{}.target.png", self.folder.display()));
        self.solution().picture(arguments)?.save(&file)?;
        Ok(shown)
    }

    /// The reason why the exercise is not solved, in one line; keeps the pictures next to the folder.
    ///
    /// # Errors
    /// If there is no verdict.
    pub fn missed(&self) -> Result<Option<String>> {
        self.missed_with(&self.originals(), &self.solution())
    }

    fn originals(&self) -> Originals<'a> {
        match self.exercise.takes {
            Takes::File | Takes::Rust => Originals::kept(self.programs, &self.kept()),
            _ => Originals::new(self.programs),
        }
    }

    /// The solution. For Rust code these are the kept pictures, because its patch does not apply to edited
    /// code.
    fn solution(&self) -> Solution<'a> {
        match self.exercise.takes {
            Takes::File | Takes::Rust => Solution::kept(self.programs, self.exercise, &self.kept()),
            _ => Solution::new(self.programs, self.exercise),
        }
    }

    fn missed_with(&self, originals: &Originals, solution: &Solution) -> Result<Option<String>> {
        let Self { programs, exercise, .. } = *self;
        let Verdict { missed, picture } =
            Attempt { programs, originals, exercise, solution }.verdict(&self.edition())?;
        let [own, other] = ["png", "other.png"]
            .map(|extension| PathBuf::from(format!("{}.{extension}", self.folder.display())));
        fs::create_dir_all(own.parent().context("a file lies in a folder")?)?;
        if let Some(picture) = &picture {
            picture.save(&own)?;
        }
        match missed.as_ref().and_then(|missed| missed.beside.as_ref()) {
            Some((_, picture)) => picture.save(&other)?,
            // It may be left over from the previous save.
            None => drop(fs::remove_file(&other)),
        }
        Ok(missed.map(|missed| missed.told(&self.own_picture(), &self.other_picture())))
    }

    /// Checks on each save until the exercise is solved, and prints one line per check.
    ///
    /// # Errors
    /// If the window does not start, or the progress cannot be written.
    pub fn practise(&self, with_window: bool, progress: &mut Progress) -> Result<()> {
        let folders = match self.exercise.takes {
            Takes::File | Takes::Rust => ["common", "samples", "shaders", "tests"]
                .map(|f| self.programs.project.root.join(f))
                .to_vec(),
            _ => vec![self.folder.clone()],
        };
        let mut watcher = FolderWatcher::of(folders);
        let (originals, solution) = (self.originals(), self.solution());
        let mut first = true;
        let mut window = with_window.then(|| self.window()).transpose()?;
        loop {
            watcher.wait()?;
            // Some systems cannot rebuild a program while it runs.
            let again = self.exercise.takes != Takes::Shader && window.take().is_some();
            let missed = self
                .missed_with(&originals, &solution)
                .unwrap_or_else(|error| Some(format!("{error:#}")));
            interrupt::asked()?;
            if again {
                window = self.window().ok();
            }
            match missed {
                None => break,
                Some(missed) => {
                    // The initial state does not count as an attempt.
                    if !first {
                        progress.count_failure(self.exercise)?;
                    }
                    first = false;
                    let target = offer(self.exercise, progress);
                    print(&format!("not yet: {missed}{target}\n"))?;
                }
            }
        }
        progress.note(self.exercise)?;
        print(&solved(self.exercise))?;
        window.map_or(Ok(()), Window::closed)
    }

    /// Opens the chapter's window with the settings of the first run.
    ///
    /// # Errors
    /// If it does not start.
    pub fn window(&self) -> Result<Window> {
        let command = self.edition().command(self.programs, &self.exercise.chapter);
        Window::open(command?.args(self.settings()))
    }

    /// The arguments of the first run that apply to a window.
    fn settings(&self) -> Vec<String> {
        let mut words = self.first_run().into_iter().flatten();
        let mut settings = Vec::new();
        while let Some(word) = words.next() {
            match &**word {
                "--size" | "--frames" => drop(words.next()),
                _ => settings.push(word.clone()),
            }
        }
        settings
    }

    /// The arguments of the first run, with the size that the text mentions, or else the usual one.
    fn look(&self) -> Vec<String> {
        let mut words = self.first_run().unwrap_or_default().to_vec();
        if let Some(at) = words.iter().position(|word| word == "--size") {
            words.drain(at..at + 2);
        }
        let mut named = self.exercise.text.split("--size ").skip(1);
        let is_part = |letter: char| letter == 'x' || letter.is_ascii_digit();
        if let Some(size) = named.next().and_then(|rest| rest.split(|c: char| !is_part(c)).next()) {
            words.extend(["--size".to_owned(), size.to_owned()]);
        }
        words
    }

    /// The arguments of the first run of the program.
    fn first_run(&self) -> Option<&'a [String]> {
        self.exercise.steps.iter().find_map(|step| match &step.run {
            Run::Program(arguments) => Some(&arguments[..]),
            Run::Test(..) => None,
        })
    }

    /// Applies the solution to the reader's place, and returns the files that it changes.
    ///
    /// # Errors
    /// If it no longer applies there, or cannot be written.
    pub fn apply(&self) -> Result<Vec<String>> {
        let below = |file: &str| match self.exercise.takes {
            Takes::Shader => self.folder.join(file.trim_start_matches("shaders/")),
            _ => self.programs.project.root.join(file),
        };
        let read = |file: &str| {
            fs::read_to_string(below(file)).ok().map(|text| text.replace("\r\n", "\n"))
        };
        let patched = self.exercise.patch.patched(read).map_err(|fault| {
            let (place, anew) = match self.exercise.takes {
                Takes::Shader => (format!("in {}", self.shown), ", or delete it to begin anew"),
                _ => ("in the project".to_owned(), ""),
            };
            let what = fault.what.replace("this hunk", "the solution");
            anyhow!("{what} {place} any more: undo what you have changed there{anew}")
        })?;
        for (file, text) in &patched {
            common::files::write_whole(&below(file), text.as_bytes())?;
        }
        Ok(patched.into_keys().collect())
    }
}

/// The lines to print once an exercise is solved.
pub fn solved(exercise: &Exercise) -> String {
    // A reader who has answered has read the text.
    let check = match exercise.takes {
        Takes::Look => String::new(),
        _ => format!("Check: {}\n", plain(&exercise.check)),
    };
    let why = exercise.why.as_deref().map(plain);
    let why = why.map_or_else(String::new, |why| format!("Why: {why}\n"));
    format!("{exercise} is solved.\n{check}{why}")
}
