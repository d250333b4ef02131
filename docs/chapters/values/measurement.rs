//! Measurements: commands on pages that produce values, and running them.
//!
//! `<!-- measure NAME -->` comes before a shell block with the command; one name per command, or several for
//! one. A command that the page need not show is in the file of its stored values. [`super::given`] describes
//! the results.

use std::collections::BTreeMap;
use std::time::SystemTime;

use anyhow::Result;
use manuscript::fault::Fault;
use manuscript::page::Page;
use manuscript::project::Project;
use pulldown_cmark::{CodeBlockKind, Event, Parser, Tag};

use super::given::{self, Values};
use super::record::{self, Record, Records};
use crate::programs::command_line::in_a_line;
use crate::programs::program::Programs;

/// A command on a page that produces values.
pub struct Measurement {
    /// The page's path.
    pub page: String,
    /// The marker's line, from 1.
    pub line: usize,
    /// The page's name and its own, such as `05_shadow_miss/acne`.
    pub name: String,
    /// The command, in one line.
    pub command: String,
}

/// Every measurement of the pages, and the faults of their markers. If no page shows its command, a
/// measurement only appears in the file of the stored values.
pub fn all(pages: &[Page], stored: &Records) -> (Vec<Measurement>, Vec<Fault>) {
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
    for (name, Record { command, .. }) in stored {
        let page = name.split('/').next().unwrap_or_default();
        let page = pages.iter().find(|known| known.stem() == page).map(|page| page.path.clone());
        let Some(page) = page.filter(|_| !measurements.contains_key(name)) else { continue };
        let hidden = Measurement { page, line: 1, name: name.clone(), command: command.clone() };
        measurements.insert(name.clone(), hidden);
    }
    (measurements.into_values().collect(), faults)
}

/// The measurements of a page, and the faults of its markers.
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
                let names = html.trim().trim_start_matches("<!-- measure ").trim_end_matches("-->");
                open = Some((line, names.split_whitespace().map(str::to_owned).collect()));
                continue;
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
    /// The name of its page.
    pub fn page_name(&self) -> &str {
        self.name.split('/').next().unwrap_or_default()
    }

    /// The fault of its stored values, if they have one. This does not run the command.
    pub fn fault(&self, stored: Option<&Record>) -> Option<Fault> {
        let name = &self.name;
        let what = match stored {
            None => format!("the measurement {name} is missing"),
            Some(stored) if stored.command != self.command => {
                format!("the measurement {name} was made by another command")
            }
            Some(stored) if stored.date.is_empty() => format!("{name} is not measured yet"),
            Some(_) => return None,
        };
        Some(Fault::new(&*self.page, self.line, what, record::renew(name)))
    }
}

/// The faults of stored values that belong to no page.
pub fn strays(project: &Project) -> Vec<Fault> {
    let pages = project.pages();
    let stem = |file: &str| {
        let name = file.rsplit('/').next().unwrap_or_default();
        name.split('.').next().unwrap_or_default().to_owned()
    };
    let is_page = |file: &String| pages.iter().any(|page| stem(page) == stem(file));
    let lost = project.files(record::FOLDER).into_iter().filter(|file| !is_page(file));
    lost.map(|file| Fault::new(file, 1, "stray file: no page has its name", "delete it")).collect()
}

/// Runs the commands of measurements, each once, and writes their results.
///
/// # Errors
/// If a file cannot be written.
pub fn renew(
    programs: &Programs,
    measurements: &[&Measurement],
    before: &Records,
    mut done: impl FnMut(&str),
) -> Result<Vec<Fault>> {
    let mut faults = Vec::new();
    let mut given: BTreeMap<&str, Result<Values, String>> = BTreeMap::new();
    for measurement in measurements {
        let run =
            || given::run(programs, &measurement.command).map_err(|error| format!("{error:#}"));
        let given = given.entry(&measurement.command).or_insert_with(run);
        let values = given.as_ref().map_err(String::clone).and_then(|given| {
            let missing = || format!("its command gives no {}", measurement.name);
            given.get(&measurement.name).or(given.get("")).ok_or_else(missing)
        });
        let new = match values {
            Ok(values) => Record {
                command: measurement.command.clone(),
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
        // A value that has not changed keeps the date on which it was first measured.
        let same = before.get(&measurement.name).filter(|old| !new.timed && old.agrees(&new));
        let date = same.map_or(new.date.clone(), |old| old.date.clone());
        Record { date, ..new }.write(programs.project, &measurement.name)?;
        let became = if same.is_some() { "the same" } else { "renewed" };
        done(&format!("{}: {became}", measurement.name));
    }
    Ok(faults)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_marker_names_the_commands_below_it() {
        let text = "<!-- measure a b -->\n```sh\ncargo test --test samples \\\n  x\n# two\ncargo run\n```\n\n\
                    <!-- measure d -->\n\nText.\n";
        let (found, faults) = of(&Page::parse("docs/05_p.md", text));
        let found: Vec<(usize, &str, &str)> =
            found.iter().map(|m| (m.line, &*m.name, &*m.command)).collect();
        let expected = [(1, "05_p/a", "cargo test --test samples x"), (1, "05_p/b", "cargo run")];
        assert_eq!(found, expected);
        let [fault] = &faults[..] else { panic!("{faults:?}") };
        assert!(fault.to_string().starts_with("docs/05_p.md:9: no command follows"), "{fault}");
    }
}
