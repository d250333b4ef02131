//! Measurements: commands on pages that give figures, and running them.
//!
//! `<!-- measure NAME -->` stands above a shell block with the command; a name for each command, or several
//! for one. Where the page need not show it: `<!-- measure NAME: COMMAND -->`. What it gives tells
//! [`super::values`].

use std::collections::BTreeMap;
use std::time::SystemTime;

use anyhow::Result;
use manuscript::fault::Fault;
use manuscript::page::Page;
use manuscript::project::{Chapter, Project};
use pulldown_cmark::{CodeBlockKind, Event, Parser, Tag};

use super::record::{self, Record};
use super::values::{self, Values};
use crate::programs::command_line::in_a_line;
use crate::programs::program::Programs;
use crate::sources::hash::{self, Sources};

/// What makes the worst arithmetic that conforms; commands that use it have `worst` in them.
const ARITHMETIC: &str = "common/instruments/src/arithmetic";

/// The chapter that its tests ask, on whatever page their figures are.
const LABORATORY: (&str, &str) = ("24_accuracy", "numerics");

/// A command on a page that gives figures.
pub struct Measurement {
    /// The page's path.
    pub page: String,
    /// The marker's line, from 1.
    pub line: usize,
    /// The page's name and its own: `05_shadow_miss/acne`.
    pub name: String,
    /// The command, in one line.
    pub command: String,
}

/// Every measurement that a page makes, and what is wrong with their markers.
pub fn all(pages: &[Page]) -> (Vec<Measurement>, Vec<Fault>) {
    let (mut measurements, mut faults) = (BTreeMap::<String, Measurement>::new(), Vec::new());
    for page in pages {
        let (found, wrong) = of(page);
        faults.extend(wrong);
        for measurement in found {
            let Measurement { name, line, .. } = &measurement;
            if let Some(other) = measurements.get(name) {
                let what = format!("{name} is already made in line {}", other.line);
                faults.push(Fault::new(&*page.path, *line, what, "rename one"));
            } else {
                measurements.insert(name.clone(), measurement);
            }
        }
    }
    (measurements.into_values().collect(), faults)
}

/// The measurements of a page, and what is wrong with its markers.
fn of(page: &Page) -> (Vec<Measurement>, Vec<Fault>) {
    let text = page.written();
    let (mut found, mut faults) = (Vec::new(), Vec::new());
    let mut open: Option<(usize, Vec<String>)> = None;
    let mut in_block = false;
    for (event, span) in Parser::new(&text).into_offset_iter() {
        let line = 1 + text[..span.start].matches('\n').count();
        let commands = match event {
            Event::Start(Tag::HtmlBlock) | Event::End(_) => continue,
            Event::Html(html) | Event::InlineHtml(html)
                if html.trim().starts_with("<!-- measure ") =>
            {
                let says = html.trim().trim_start_matches("<!-- measure ").trim_end_matches("-->");
                let (names, command) =
                    says.split_once(':').map_or((says, None), |(n, c)| (n, Some(c)));
                open = Some((line, names.split_whitespace().map(str::to_owned).collect()));
                let Some(command) = command else { continue };
                vec![command.trim().to_owned()]
            }
            Event::Start(Tag::CodeBlock(CodeBlockKind::Fenced(word))) if &*word == "sh" => {
                in_block = true;
                continue;
            }
            Event::Text(block) if in_block => {
                in_block = false;
                lines(&block)
            }
            _ => Vec::new(),
        };
        let Some((line, names)) = open.take() else { continue };
        let mut fault =
            |what: &str, remedy: &str| faults.push(Fault::new(&*page.path, line, what, remedy));
        if commands.is_empty() {
            fault(
                "no command follows this measurement",
                "put it on the line before the ```sh block",
            );
        } else if commands.len() != 1 && commands.len() != names.len() {
            fault(
                "a measurement is made by one command",
                "give each command below a name, in order",
            );
        }
        let each = names.iter().enumerate();
        found.extend(each.filter_map(|(index, name)| {
            let command = commands.get(index).or(commands.last())?.clone();
            Some(Measurement {
                page: page.path.clone(),
                line,
                name: format!("{}/{name}", page.stem()),
                command,
            })
        }));
    }
    (found, faults)
}

/// The commands of a shell text, each in one line.
fn lines(text: &str) -> Vec<String> {
    let joined = text.replace("\\\n", " ");
    let lines = joined.lines().map(in_a_line);
    lines.filter(|line| !line.is_empty() && !line.starts_with('#')).collect()
}

impl Measurement {
    /// Its file, from the project's root.
    pub fn file(&self) -> String {
        record::file(&self.name)
    }

    /// The name of its page.
    pub fn page_name(&self) -> &str {
        self.name.split('/').next().unwrap_or_default()
    }

    /// A hash of what its command is made from: a chapter, and the files of a test.
    fn sources(&self, project: &Project, sources: &mut Sources) -> String {
        let words = shlex::split(&self.command).unwrap_or_default();
        let after = |option: &str| {
            words.iter().position(|word| word == option).and_then(|at| words.get(at + 1..))
        };
        let filter = after("--test").and_then(|rest| rest.get(1)).map(String::as_str);
        let module = filter.and_then(|filter| filter.split("::").next()).unwrap_or_default();
        let bin = after("--bin").and_then(|rest| rest.first()).map(String::as_str);
        let is_meant = |name: &str, of: &str| bin == Some(name) || !of.is_empty() && of == module;
        let chapters = || project.chapters.iter();
        let target = after("--test").and_then(|rest| rest.first()).map(String::as_str);
        let chapter = chapters()
            .find(|chapter| is_meant(&chapter.name, chapter.module()))
            .or_else(|| chapters().find(|chapter| chapter.name == self.page_name()))
            .or_else(|| {
                chapters()
                    .find(|chapter| LABORATORY == (&*chapter.name, target.unwrap_or_default()))
            });
        let target = project.tests.iter().find(|test| Some(&*test.name) == target);
        let folder = target.and_then(|test| test.path.rsplit_once('/')).map(|(folder, _)| folder);
        let mut files = folder.map_or(Vec::new(), |folder| {
            let mut files = project.files(folder);
            // The test's module is named, or is the chapter's; else it may be any.
            let modules = [Some(module), chapter.map(Chapter::module)];
            let own = |module| [format!("{folder}/{module}.rs"), format!("{folder}/{module}/")];
            let own = modules.into_iter().flatten().map(own).find(|own| files.contains(&own[0]));
            if let Some(own) = own {
                files.retain(|file| *file == own[0] || file.starts_with(&own[1]));
            }
            files
        });
        if words.iter().any(|word| word.contains("worst")) {
            files.extend(project.files(ARITHMETIC));
        }
        let chapter = chapter.map_or(String::new(), |chapter| sources.of(project, &chapter.name));
        let test = hash::of_files(project, &files);
        hash::hash([chapter.as_bytes(), test.as_bytes()])
    }

    /// Why it is to be renewed, if it is.
    pub fn stale(
        &self,
        project: &Project,
        stored: Option<&Record>,
        sources: &mut Sources,
    ) -> Option<Fault> {
        let file = self.file();
        let what = match stored {
            None => format!("the measurement {file} is missing"),
            Some(stored) if stored.command != self.command => {
                format!("the measurement {file} was made by another command")
            }
            // A time is right for its day; whether the machine is quiet enough, a program cannot tell.
            Some(stored) if stored.timed => return None,
            Some(stored) if stored.sources == self.sources(project, sources) => return None,
            Some(_) => format!("the measurement {file} is older than what it measures"),
        };
        Some(Fault::new(&*self.page, self.line, what, record::renew(&self.name)))
    }
}

/// Files that no page makes.
pub fn strays(measurements: &[Measurement], stored: &BTreeMap<String, Record>) -> Vec<Fault> {
    let made = |name: &&String| measurements.iter().any(|measurement| measurement.name == **name);
    let stray = |name: &String| {
        let what = "stray file: no page makes this measurement";
        Fault::new(record::file(name), 1, what, "delete it, or add <!-- measure NAME --> to a page")
    };
    stored.keys().filter(|name| !made(name)).map(stray).collect()
}

/// Runs the commands of measurements, each once, and writes what they gave.
///
/// # Errors
/// If a file cannot be written.
pub fn renew(
    programs: &Programs,
    measurements: &[&Measurement],
    before: &BTreeMap<String, Record>,
    mut done: impl FnMut(&str),
) -> Result<Vec<Fault>> {
    let (mut faults, mut sources) = (Vec::new(), Sources::default());
    let mut given: BTreeMap<&str, Result<Values, String>> = BTreeMap::new();
    for measurement in measurements {
        let run =
            || values::run(programs, &measurement.command).map_err(|error| format!("{error:#}"));
        let given = given.entry(&measurement.command).or_insert_with(run);
        let values = given.as_ref().map_err(String::clone).and_then(|given| {
            let missing = || format!("its command gives no {}", measurement.name);
            given.get(&measurement.name).or(given.get("")).ok_or_else(missing)
        });
        let new = match values {
            Ok(values) => Record {
                command: measurement.command.clone(),
                sources: measurement.sources(programs.project, &mut sources),
                date: humantime::format_rfc3339_seconds(SystemTime::now()).to_string()[..10]
                    .to_owned(),
                ..values.clone()
            },
            Err(what) => {
                let what = format!("{} cannot be measured: {what}", measurement.name);
                let remedy = "correct the command or the test";
                faults.push(Fault::new(&*measurement.page, measurement.line, what, remedy));
                continue;
            }
        };
        // What comes out again as it was is still of the day on which it first did.
        let same = before.get(&measurement.name).filter(|old| !new.timed && old.agrees(&new));
        let date = same.map_or(new.date.clone(), |old| old.date.clone());
        Record { date, ..new }.write(programs.project, &measurement.name)?;
        done(&format!(
            "{}: {}",
            measurement.file(),
            if same.is_some() { "the same" } else { "renewed" }
        ));
    }
    Ok(faults)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_marker_names_the_commands_below_it() {
        let text = "<!-- measure a b -->\n```sh\ncargo test --test samples \\\n  x\n# two\ncargo run\n```\n\n\
                    Text.\n<!-- measure c: cargo test y -->\n\n<!-- measure d -->\n\nText.\n";
        let (found, faults) = of(&Page::parse("docs/05_p.md", text));
        let found: Vec<(usize, &str, &str)> =
            found.iter().map(|m| (m.line, &*m.name, &*m.command)).collect();
        let expected = [
            (1, "05_p/a", "cargo test --test samples x"),
            (1, "05_p/b", "cargo run"),
            (10, "05_p/c", "cargo test y"),
        ];
        assert_eq!(found, expected);
        let [fault] = &faults[..] else { panic!("{faults:?}") };
        assert!(fault.to_string().starts_with("docs/05_p.md:12: no command follows"), "{fault}");
    }
}
