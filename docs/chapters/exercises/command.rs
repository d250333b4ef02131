//! `cargo chapters exercise`: the commands for readers and authors of exercises.

use std::path::PathBuf;

use anyhow::{Result, bail};
use clap::Args;
use common::UsageError;
use common::output::print;
use common::workers;
use manuscript::project::Project;

use super::answer::Answer;
use super::attempt::{Attempt, Originals};
use super::exercise::{Exercise, Takes};
use super::formula::plain;
use super::making;
use super::moved::Moved;
use super::progress::Progress;
use super::solution::Solution;
use super::variant;
use super::window::has_display;
use super::workbench::{Workbench, solved};
use crate::programs::command_line::quoted;
use crate::programs::interrupt;
use crate::programs::program::Programs;

/// The arguments of `cargo chapters exercise`.
#[derive(Debug, Args)]
pub struct ExerciseArguments {
    /// An exercise, such as 05.2, or a chapter
    #[arg(value_name = "NN.k")]
    names: Vec<String>,
    /// List the exercises, of all chapters or one
    #[arg(long, group = "what")]
    list: bool,
    /// Check once, without waiting: exit code 0 if it is solved, 1 if not yet
    #[arg(long, group = "what")]
    check: bool,
    /// Print what helps
    #[arg(long, group = "what")]
    hint: bool,
    /// Print the solution
    #[arg(long, group = "what")]
    solution: bool,
    /// Make the solution's changes where you edit
    #[arg(long, requires = "solution")]
    apply: bool,
    /// Write the picture of the solution beside yours, once two attempts have failed
    #[arg(long, group = "what")]
    target: bool,
    /// Answer the question of an exercise that takes only looking: a number, or one of the words it lists
    #[arg(long, value_name = "ANSWER", group = "what", allow_hyphen_values = true)]
    answer: Option<String>,
    /// Put your copy of the shaders there [default: target/exercises/NN.k]
    #[arg(long, value_name = "FOLDER")]
    folder: Option<PathBuf>,
    /// Open no window
    #[arg(long)]
    headless: bool,
    /// For authors: write the exercise's diff, from what you have edited since the last commit, or from a copy of the
    /// shaders that --folder names
    #[arg(long, group = "what")]
    make: bool,
    /// For authors: hold exercises to what their files claim, unsolved before the solution, solved after it
    #[arg(long, group = "what")]
    prove: bool,
    /// For authors: hold that each solution with one number halved, doubled, negated or a tenth more is refused
    #[arg(long, group = "what")]
    vary: bool,
}

impl ExerciseArguments {
    /// Runs the command.
    ///
    /// # Errors
    /// If it fails, or if it checks an exercise that is not solved yet.
    pub fn run(&self, project: &Project) -> Result<()> {
        interrupt::listen();
        if self.prove || self.vary {
            return self.prove(project);
        }
        if self.make {
            let [name] = &self.names[..] else {
                let what = "--make writes one exercise: name it, such as 05.2";
                return Err(UsageError(what.to_owned()).into());
            };
            return print(&making::make(project, name, self.folder.as_deref())?);
        }
        let exercises = match &self.names[..] {
            [] if self.list => Exercise::whole(project)?,
            [] => {
                let what = "no exercise is named; --list shows them";
                return Err(UsageError(what.to_owned()).into());
            }
            [name] => Exercise::named(project, name)?,
            [_, second, ..] => {
                let what = format!(
                    "'{second}' is one too many: name one exercise, put an answer in quotes"
                );
                return Err(UsageError(what).into());
            }
        };
        let one = self.names.first().is_some_and(|name| name.contains('.'));
        match &exercises[..] {
            [exercise] if one && !self.list => {
                let name = exercise.to_string();
                if let Some(new) = Moved::read(project).now(&name) {
                    print(&format!(
                        "What was exercise {name} before its chapter was split is {new} now.\n"
                    ))?;
                }
                self.about(project, exercise)
            }
            _ => {
                let asked = self.check
                    || self.hint
                    || self.solution
                    || self.target
                    || self.answer.is_some();
                if asked || self.folder.is_some() {
                    let what = "a chapter has several exercises: name one, such as";
                    let first = exercises.first().map_or("05.2".to_owned(), Exercise::to_string);
                    return Err(UsageError(format!("{what} {first}")).into());
                }
                list(project, &exercises)
            }
        }
    }

    fn about(&self, project: &Project, exercise: &Exercise) -> Result<()> {
        let programs = Programs::beside_this(project)?;
        let bench = Workbench::new(&programs, exercise, self.folder.as_deref())?;
        let mut progress = Progress::open(project);
        if self.hint {
            return print(&format!("{}\n", plain(&exercise.hint)));
        }
        if self.solution {
            return self.solution(exercise, &bench);
        }
        if let Some(answer) = &self.answer {
            return answer_to(exercise, answer, &mut progress);
        }
        if self.target {
            return target(exercise, &bench, &progress);
        }
        if self.check {
            return check(exercise, &bench, &mut progress);
        }
        let takes = exercise.takes();
        let title = &exercise.patch.title;
        let time = exercise.time();
        let text = plain(&exercise.text);
        let heading = format!("{exercise} · {title} ({takes}, {time})\n\n{text}\n\n");
        // The final result would give the answer away.
        if exercise.takes == Takes::Look {
            bench.set_up()?;
            print(&heading)?;
            return self.look(exercise, &bench);
        }
        print(&heading)?;
        let there = bench.set_up()?;
        let on = if there { "You go on where you left it.\n" } else { "" };
        print(&format!("{}{on}\n", bench.introduction()))?;
        bench.practise(!self.headless && has_display(), &mut progress)
    }

    fn look(&self, exercise: &Exercise, bench: &Workbench) -> Result<()> {
        let form = exercise.answer.as_ref().map_or_else(String::new, Answer::form);
        let answer =
            format!("Your answer, {form}: cargo chapters exercise {exercise} --answer ANSWER\n");
        if !self.headless && has_display() {
            print(&answer)?;
            return bench.window()?.closed();
        }
        let render = bench.render().map_or_else(String::new, |render| format!("{render}\n"));
        print(&format!("{render}{answer}"))
    }

    fn solution(&self, exercise: &Exercise, bench: &Workbench) -> Result<()> {
        if !self.apply {
            let why = exercise.why.as_deref().map(plain);
            let why = why.map_or_else(String::new, |why| format!("\nWhy: {why}\n"));
            let check = plain(&exercise.check);
            return match &exercise.answer {
                Some(answer) => {
                    print(&format!("Answer: {}\nCheck: {check}\n{why}", answer.right()))
                }
                None => print(&format!("{}\nCheck: {check}\n{why}", exercise.patch.diff())),
            };
        }
        if exercise.takes == Takes::Look {
            let what = format!("exercise {exercise} changes nothing: there is nothing to apply");
            return Err(UsageError(what).into());
        }
        bench.set_up()?;
        for file in bench.apply()? {
            print(&format!("{file}: changed\n"))?;
        }
        Ok(())
    }

    /// Proves the named exercises, or all.
    fn prove(&self, project: &Project) -> Result<()> {
        let mut exercises = Vec::new();
        for name in &self.names {
            exercises.extend(Exercise::named(project, name)?);
        }
        if self.names.is_empty() {
            exercises = Exercise::whole(project)?;
        }
        if self.vary {
            // Each variant of Rust code would need a build.
            exercises.retain(|exercise| exercise.takes == Takes::Shader);
        }
        let programs = &Programs::beside_this(project)?;
        let originals = &Originals::new(programs);
        // Printed one by one, because an exercise that needs a build takes minutes.
        let prove = |exercise: &Exercise| {
            interrupt::asked()?;
            let line = if self.vary {
                variant::prove(programs, originals, exercise)
            } else {
                let solution = &Solution::new(programs, exercise);
                Attempt { programs, originals, exercise, solution }.prove()
            };
            interrupt::asked()?;
            let proved = line.is_ok();
            print(&format!("{}\n", line.unwrap_or_else(|error| format!("{error:#}"))))
                .map(|()| proved)
        };
        let proved = workers::each(&exercises, prove).into_iter().collect::<Result<Vec<bool>>>()?;
        let failed = proved.iter().filter(|proved| !**proved).count();
        match failed {
            0 => Ok(()),
            _ => bail!("{failed} of {} exercises are not what their files say", exercises.len()),
        }
    }
}

fn check(exercise: &Exercise, bench: &Workbench, progress: &mut Progress) -> Result<()> {
    if exercise.takes == Takes::Look {
        if progress.has(exercise) {
            return print(&solved(exercise));
        }
        bail!("{exercise} is not solved yet: it asks a question; answer it with --answer");
    }
    bench.set_up()?;
    match bench.missed()? {
        Some(missed) => {
            progress.count_failure(exercise)?;
            let target = offer(exercise, progress);
            bail!("{exercise} is not solved yet: {missed}{target}")
        }
        None => {
            progress.note(exercise)?;
            print(&solved(exercise))
        }
    }
}

/// The addition to the failure message once the target may be shown.
pub fn offer(exercise: &Exercise, progress: &Progress) -> String {
    if progress.shows_target(exercise) {
        format!("; --target shows the target of {exercise}")
    } else {
        String::new()
    }
}

fn target(exercise: &Exercise, bench: &Workbench, progress: &Progress) -> Result<()> {
    let Some(arguments) = exercise.target().filter(|_| exercise.takes != Takes::Look) else {
        let what = format!("exercise {exercise} has no target: no picture tells that it is solved");
        return Err(UsageError(what).into());
    };
    if !progress.shows_target(exercise) {
        let failed = progress.failures(exercise);
        bail!(
            "the target of {exercise} is shown once two attempts have failed, not after {failed}"
        );
    }
    print(&format!("{}: the target with {}\n", bench.target(arguments)?, quoted(arguments)))
}

fn answer_to(exercise: &Exercise, answer: &str, progress: &mut Progress) -> Result<()> {
    let Some(right) = &exercise.answer else {
        let what =
            format!("exercise {exercise} asks no question; --check tells whether it is solved");
        return Err(UsageError(what).into());
    };
    let is_right = right
        .accept(answer)
        .map_err(|form| UsageError(format!("'{answer}' is no answer: {exercise} takes {form}")))?;
    if !is_right {
        bail!("'{answer}' is not the answer; --hint helps");
    }
    progress.note(exercise)?;
    print(&format!("Right: {}\n{}", plain(&exercise.check), solved(exercise)))
}

fn list(project: &Project, exercises: &[Exercise]) -> Result<()> {
    let progress = Progress::open(project);
    let line = |exercise: &Exercise| {
        let done = if progress.has(exercise) { "solved" } else { "" };
        let (name, takes) = (exercise.to_string(), exercise.takes());
        let time = format!("{} min", exercise.minutes);
        format!("{name:5} {takes:13} {time:>6}  {done:7} {}\n", exercise.patch.title)
    };
    print(&exercises.iter().map(line).collect::<String>())
}
