//! Checks each `cargo run` and `cargo chapters` on a page against the arguments its program accepts.

use clap::CommandFactory;
use manuscript::fault::Fault;
use manuscript::project::Project;

use super::markdown::Code;
use crate::arguments::Arguments;
use crate::programs::command_line::{CommandLine, runs};
use crate::programs::program::{BUILD, Programs};

impl CommandLine {
    /// The controls that the command sets or compares, with all their values.
    fn settings(&self) -> Vec<(String, String)> {
        let command = instruments::command().no_binary_name(true);
        let Ok(found) = command.try_get_matches_from(&self.arguments) else { return Vec::new() };
        let sets = found.get_many::<(String, String)>("sets").into_iter().flatten().cloned();
        let compared = found.get_one::<String>("compare").and_then(|text| text.split_once('='));
        let compared = compared.into_iter().flat_map(|(name, values)| {
            values.split('|').map(|value| (name.trim().to_owned(), value.trim().to_owned()))
        });
        sets.chain(compared).collect()
    }

    /// The fault of a comparison of chapters that do not exist; `NN` may stand for any chapter.
    fn unknown_chapter(&self, project: &Project) -> Option<String> {
        let [command, chapters @ ..] = &self.arguments[..] else { return None };
        let tool = self.bin.as_deref() == Some("chapters") && command == "diff";
        let chapters = chapters.iter().take(2).filter(|given| tool && !given.contains("NN"));
        chapters.into_iter().find_map(|given| project.chapter(given).err()).map(|usage| usage.0)
    }

    /// The fault of the command, and its remedy.
    fn wrong(&self, programs: &Programs) -> Option<(String, &'static str)> {
        let wrong =
            |what: String| Some((format!("this command does not run: {what}"), "correct it"));
        let name = self.program(programs.project)?;
        if !programs.project.bins.iter().any(|bin| bin.name == name) {
            let names: Vec<&str> = programs.project.bins.iter().map(|bin| &*bin.name).collect();
            return wrong(format!("there is no program '{name}', only {}", names.join(", ")));
        }
        let sample = programs.project.named(name).is_some();
        let command = match name {
            _ if sample => instruments::command(),
            "chapters" => Arguments::command(),
            _ => return None,
        };
        let takes = || programs.takes(name, &self.arguments);
        let parsed = command.no_binary_name(true).try_get_matches_from(&self.arguments);
        if let Some(error) = parsed.err().filter(|error| error.use_stderr()) {
            let taken = if sample { takes() } else { Ok(false) };
            match taken {
                Ok(true) => {}
                Ok(false) => {
                    let text = error.to_string();
                    let line = text.lines().next().unwrap_or_default();
                    let line = line.trim_start_matches("error: ");
                    return wrong(format!("{name} does not take this: {line}"));
                }
                Err(what) => return Some((what, BUILD)),
            }
        }
        if let Some(unknown) = self.unknown_chapter(programs.project) {
            return wrong(unknown);
        }
        let settings = if sample { self.settings() } else { Vec::new() };
        if settings.is_empty() {
            return None;
        }
        match programs.controls(name) {
            Ok(controls) => {
                let refusal = |(control, value): &(String, String)| controls.refuse(control, value);
                let refused = settings.iter().find_map(refusal);
                refused.filter(|_| takes() == Ok(false)).and_then(wrong)
            }
            Err(what) => Some((what, BUILD)),
        }
    }
}

/// The faults of the commands in a page's code.
pub fn check(programs: &Programs, page: &str, code: &[Code]) -> Vec<Fault> {
    let chapter = programs.project.of_page(page);
    let mut faults = Vec::new();
    for code in code.iter().filter(|code| code.is_shell()) {
        let mut runs = runs(&code.text);
        // On a chapter's page, `--set "a=1"` in a sentence refers to its own program.
        if let Some(chapter) = chapter.filter(|_| code.text.starts_with("--set ")) {
            let arguments = shlex::split(&code.text).unwrap_or_default();
            runs.push((0, CommandLine { bin: Some(chapter.name.clone()), arguments }));
        }
        for (index, run) in runs {
            // A name in a sentence may be a placeholder.
            let placeholder = run.bin.as_deref().is_some_and(|bin| bin.contains(['N', '<', '…']));
            if !placeholder && let Some((what, remedy)) = run.wrong(programs) {
                faults.push(Fault::new(page, code.line + index, what, remedy));
            }
        }
    }
    faults
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_are_those_that_the_program_would_see() {
        let [(_, run)] =
            &runs("cargo run --bin a -- --set=x=1 --set 'a b=c=d' --compare 'm=1|2'")[..]
        else {
            panic!()
        };
        let pair = |a: &str, b: &str| (a.to_owned(), b.to_owned());
        assert_eq!(
            run.settings(),
            [pair("x", "1"), pair("a b", "c=d"), pair("m", "1"), pair("m", "2")]
        );
    }
}
