//! Commands that pages print: taken out of the text, and held to what the programs accept.

use clap::CommandFactory;
use manuscript::fault::Fault;
use manuscript::project::Project;

use super::markdown::Code;
use crate::programs::program::{BUILD, Programs};

/// A `cargo run`, or a `cargo chapters`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Run {
    /// The program, where the command names one.
    pub bin: Option<String>,
    /// The program's arguments.
    pub arguments: Vec<String>,
}

/// Every `cargo run` in a shell text, with its line there, from 0.
pub fn runs(text: &str) -> Vec<(usize, Run)> {
    let mut found = Vec::new();
    let mut lines = text.lines().enumerate();
    while let Some((index, first)) = lines.next() {
        let mut command = first.trim().trim_start_matches("$ ").to_owned();
        while let Some(start) = command.strip_suffix('\\') {
            let next = lines.next().map_or("", |(_, line)| line.trim());
            command = format!("{} {next}", start.trim_end());
        }
        let words = shlex::split(&command).unwrap_or_default();
        let separate = |word: &String| ["&&", "||", "|", ";"].contains(&word.as_str());
        found.extend(words.split(separate).filter_map(run).map(|run| (index, run)));
    }
    found
}

fn run(words: &[String]) -> Option<Run> {
    let redirect = |word: &String| word.trim_start_matches(['1', '2', '&']).starts_with('>');
    let words = words.split(redirect).next().unwrap_or_default();
    // What stands before is the environment, `NAME=value`.
    let start = words.iter().position(|word| !word.contains('='))?;
    match words[start..].iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["cargo", "run", ..] => {}
        // The project's own command, `.cargo/config.toml`.
        ["cargo", "chapters", ..] => {
            let arguments = words[start + 2..].to_vec();
            return Some(Run { bin: Some("chapters".to_owned()), arguments });
        }
        _ => return None,
    }
    let words = &words[start + 2..];
    let dashes = words.iter().position(|word| word == "--").unwrap_or(words.len());
    let cargo = &words[..dashes];
    let after = cargo.iter().position(|word| word == "--bin").and_then(|i| cargo.get(i + 1));
    let joined = cargo.iter().find_map(|word| word.strip_prefix("--bin="));
    Some(Run {
        bin: after.map(String::as_str).or(joined).map(str::to_owned),
        arguments: words.get(dashes + 1..).unwrap_or_default().to_vec(),
    })
}

impl Run {
    /// The program that runs: the one named, else the project's default.
    pub fn program<'a>(&'a self, project: &'a Project) -> Option<&'a str> {
        self.bin.as_deref().or(project.default_run.as_deref())
    }

    /// The controls that it sets or compares, with every value that they are given.
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

    /// What is wrong if it compares chapters and one of them does not exist; `NN` may stand for any chapter.
    fn unknown_chapter(&self, project: &Project) -> Option<String> {
        let [command, chapters @ ..] = &self.arguments[..] else { return None };
        let tool = self.bin.as_deref() == Some("chapters") && command == "diff";
        let chapters = chapters.iter().take(2).filter(|given| tool && !given.contains("NN"));
        chapters.into_iter().find_map(|given| project.chapter(given).err()).map(|usage| usage.0)
    }

    /// What is wrong with it, and what to do.
    fn wrong(&self, project: &Project, programs: &Programs) -> Option<(String, &'static str)> {
        let wrong =
            |what: String| Some((format!("this command does not run: {what}"), "correct it"));
        let name = self.program(project)?;
        if !project.bins.iter().any(|bin| bin.name == name) {
            let names: Vec<&str> = project.bins.iter().map(|bin| &*bin.name).collect();
            return wrong(format!("there is no program '{name}', only {}", names.join(", ")));
        }
        let sample = project.chapters.iter().any(|chapter| chapter.name == name);
        let command = match name {
            _ if sample => instruments::command(),
            "chapters" => crate::Arguments::command(),
            _ => return None,
        };
        let parsed = command.no_binary_name(true).try_get_matches_from(&self.arguments);
        if let Err(error) = parsed
            && error.use_stderr()
            && !(sample && programs.takes(name, &self.arguments))
        {
            let text = error.to_string();
            let line = text.lines().next().unwrap_or_default().trim_start_matches("error: ");
            return wrong(format!("{name} does not take this: {line}"));
        }
        if let Some(unknown) = self.unknown_chapter(project) {
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
                refused.filter(|_| !programs.takes(name, &self.arguments)).and_then(wrong)
            }
            Err(what) => Some((what, BUILD)),
        }
    }
}

/// What is wrong with the commands in a page's code.
pub fn check(project: &Project, programs: &Programs, page: &str, code: &[Code]) -> Vec<Fault> {
    let shell = |code: &&Code| ["sh", "bash", "console", "shell", ""].contains(&&*code.language);
    let chapter = project.chapters.iter().find(|chapter| chapter.page() == page);
    let mut faults = Vec::new();
    for code in code.iter().filter(shell) {
        let mut runs = runs(&code.text);
        // On a chapter's page, `--set "a=1"` in a sentence is for its own program.
        if let Some(chapter) = chapter.filter(|_| code.text.starts_with("--set ")) {
            let arguments = shlex::split(&code.text).unwrap_or_default();
            runs.push((0, Run { bin: Some(chapter.name.clone()), arguments }));
        }
        for (index, run) in runs {
            // A name in a sentence may stand for any.
            let placeholder = run.bin.as_deref().is_some_and(|bin| bin.contains(['N', '<', '…']));
            if !placeholder && let Some((what, remedy)) = run.wrong(project, programs) {
                faults.push(Fault::new(page, code.line + index, what, remedy));
            }
        }
    }
    faults
}

/// Words as a shell takes them.
pub fn quoted(words: &[String]) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_=.,:/+".contains(c);
    let word = |word: &String| match word.chars().all(plain) {
        true => word.clone(),
        false => format!("\"{word}\""),
    };
    words.iter().map(word).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(text: &str) -> Vec<(usize, Option<String>, String)> {
        runs(text).into_iter().map(|(i, run)| (i, run.bin, run.arguments.join("|"))).collect()
    }

    #[test]
    fn runs_are_found_among_other_commands() {
        let text = "./setup && cargo run --bin 02_basic # as above\n\
                    $ A=1 cargo run --release --bin=x -- --set \"sun azimuth=3\" > file\n\
                    cargo run --bin y -- \\\n  --size 64x40 \\\n  --headless\n\
                    cargo test\ncargo run\ncargo chapters diff 02 03\n";
        let bin = |name: &str| Some(name.to_owned());
        let expected = [
            (0, bin("02_basic"), "".to_owned()),
            (1, bin("x"), "--set|sun azimuth=3".to_owned()),
            (2, bin("y"), "--size|64x40|--headless".to_owned()),
            (6, None, "".to_owned()),
            (7, bin("chapters"), "diff|02|03".to_owned()),
        ];
        assert_eq!(all(text), expected);
    }

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
