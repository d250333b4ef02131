//! Measurements: commands on pages that give figures, and running them.
//!
//! `<!-- measure NAME -->` stands above a shell block with the command; a name for each command, or several
//! for one. Where the page need not show it: `<!-- measure NAME: COMMAND -->`. A `cargo run` gives what its
//! report holds of `--compare`, `--compile-for` or its times. A `cargo test` gives what the test holds with
//! `figures::hold`, and writes that to the folder that the environment variable `FIGURES` names.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::SystemTime;

use anyhow::{Context, Result, anyhow, bail, ensure};
use pulldown_cmark::{CodeBlockKind, Event, Parser, Tag};
use serde_json::{Map, Value, json};

use crate::command;
use crate::fault::Fault;
use crate::laboratory;
use crate::page::Page;
use crate::picture::{self, Sources};
use crate::program::{BUILD, Programs};
use crate::project::{Chapter, Project};
use crate::stored::{self, Stored};

/// What makes the worst arithmetic that conforms; commands that use it have `worst` in them.
const ARITHMETIC: &str = "common/src/gpu/arithmetic";

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

/// The measurements of a page, and what is wrong with its markers.
pub fn of(page: &Page) -> (Vec<Measurement>, Vec<Fault>) {
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
    let words = |line: &str| line.split_whitespace().collect::<Vec<_>>().join(" ");
    joined.lines().map(words).filter(|line| !line.is_empty() && !line.starts_with('#')).collect()
}

impl Measurement {
    /// Its file, from the project's root.
    pub fn file(&self) -> String {
        stored::file(&self.name)
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
            .or_else(|| chapters().find(|chapter| chapter.page() == self.page))
            .or_else(|| chapters().find(|chapter| laboratory::is_asked(&chapter.name, target)));
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
        let test = picture::of_files(project, &files);
        picture::hash([chapter.as_bytes(), test.as_bytes()])
    }

    /// Why it is to be renewed, if it is.
    pub fn stale(
        &self,
        project: &Project,
        stored: Option<&Stored>,
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
        Some(Fault::new(&*self.page, self.line, what, stored::renew(&self.name)))
    }
}

/// Files that no page makes.
pub fn strays(measurements: &[Measurement], stored: &BTreeMap<String, Stored>) -> Vec<Fault> {
    let made = |name: &&String| measurements.iter().any(|measurement| measurement.name == **name);
    let stray = |name: &String| {
        let what = "stray file: no page makes this measurement";
        Fault::new(stored::file(name), 1, what, "delete it, or add <!-- measure NAME --> to a page")
    };
    stored.keys().filter(|name| !made(name)).map(stray).collect()
}

/// Runs the commands of measurements, each once, and writes what they gave.
///
/// # Errors
/// If a file cannot be written.
pub fn renew(
    project: &Project,
    programs: &Programs,
    measurements: &[&Measurement],
    before: &BTreeMap<String, Stored>,
    mut done: impl FnMut(&str),
) -> Result<Vec<Fault>> {
    let (mut faults, mut sources) = (Vec::new(), Sources::default());
    let mut given: BTreeMap<&str, Result<Given, String>> = BTreeMap::new();
    for measurement in measurements {
        let run =
            || run(project, programs, &measurement.command).map_err(|error| format!("{error:#}"));
        let given = given.entry(&measurement.command).or_insert_with(run);
        let values = given.as_ref().map_err(String::clone).and_then(|given| {
            let missing = || format!("its command gives no {}", measurement.name);
            given.get(&measurement.name).or(given.get("")).ok_or_else(missing)
        });
        let new = match values {
            Ok(values) => Stored {
                command: measurement.command.clone(),
                sources: measurement.sources(project, &mut sources),
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
        Stored { date, ..new }.write(project, &measurement.name)?;
        done(&format!(
            "{}: {}",
            measurement.file(),
            if same.is_some() { "the same" } else { "renewed" }
        ));
    }
    Ok(faults)
}

/// What a command gave: measurements by name, or a single one without.
type Given = BTreeMap<String, Stored>;

fn run(project: &Project, programs: &Programs, command: &str) -> Result<Given> {
    let folder = tempfile::tempdir().context("cannot make a temporary folder")?;
    let words = shlex::split(command).unwrap_or_default();
    // What stands before is the environment, `NAME=value`.
    let start = words.iter().take_while(|word| word.contains('=')).count();
    let (environment, words) = words.split_at(start);
    if words.iter().map(String::as_str).take(2).eq(["cargo", "test"]) {
        let mut test = Command::new("cargo");
        test.args(&words[1..]).current_dir(&project.root).env("FIGURES", folder.path());
        test.envs(environment.iter().filter_map(|word| word.split_once('=')));
        finish(&mut test)?;
        return held(folder.path());
    }
    let runs = command::runs(command);
    let [(_, run)] = &runs[..] else { bail!("it is neither a `cargo run` nor a `cargo test`") };
    let program = run.program(project).context("it runs no program")?;
    let file = folder.path().join("report.json");
    let mut arguments = run.arguments.clone();
    // A picture that the page's command would leave in the reader's folder is nobody's here.
    if let Some(out) = arguments.iter().position(|word| word == "--out") {
        arguments.drain(out..arguments.len().min(out + 2));
        arguments.push("--out".to_owned());
        arguments.push(folder.path().join("out.png").to_string_lossy().into_owned());
    }
    let mut sample = programs.command(program).map_err(|what| anyhow!("{what}; {BUILD}"))?;
    finish(sample.args(&arguments).arg("--report").arg(&file))?;
    let report: Value = serde_json::from_slice(&fs::read(&file)?)?;
    Ok(BTreeMap::from([(String::new(), reported(&report)?)]))
}

fn finish(command: &mut Command) -> Result<()> {
    let output = command.output().context("it does not start")?;
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    let told = String::from_utf8_lossy(&output.stdout).into_owned();
    let line = |text: &str| {
        text.lines()
            .find(|line| line.contains("error") || line.contains("panicked"))
            .map(str::to_owned)
    };
    let why = line(&said).or_else(|| line(&told)).unwrap_or_else(|| output.status.to_string());
    ensure!(output.status.success(), "{why}");
    Ok(())
}

/// What a test has left in a folder: `PAGE/NAME.json` each.
fn held(folder: &Path) -> Result<Given> {
    let mut found = BTreeMap::new();
    for page in fs::read_dir(folder)?.flatten() {
        for file in fs::read_dir(page.path())?.flatten() {
            let (page, file) = (page.file_name(), file.path());
            let stem = file.file_stem().unwrap_or_default().to_string_lossy();
            let given: Value = serde_json::from_slice(&fs::read(&file)?)?;
            let text = |key: &str| given[key].as_str().unwrap_or_default().to_owned();
            let values = given["values"].as_object().context("a test holds no values")?.clone();
            let timed = given["timed"] == true;
            found.insert(
                format!("{}/{stem}", page.to_string_lossy()),
                measured(timed, (text("device"), text("driver")), values),
            );
        }
    }
    Ok(found)
}

fn measured(timed: bool, (device, driver): (String, String), values: Map<String, Value>) -> Stored {
    let [command, date, sources] = [const { String::new() }; 3];
    Stored { command, timed, device, driver, date, sources, values }
}

/// What a sample's report has: of `--compare`, of `--compile-for`, else how long it took.
fn reported(report: &Value) -> Result<Stored> {
    let text = |key: &str| report[key].as_str().unwrap_or_default().to_owned();
    let device = (text("device"), text("driver"));
    let mut values = Map::new();
    if let Some(rows) = report["comparison"]["values"].as_array() {
        let middle = |values: &mut Map<String, Value>, name: &str, ratio: &Value| {
            for (key, part) in [("ratio", "median"), ("low", "low"), ("high", "high")] {
                values.insert(format!("{name}.{key}"), ratio[part].clone());
            }
        };
        for row in rows {
            let name = row["value"].as_str().context("a value has a name")?.replace(' ', "-");
            values.insert(format!("{name}.ms"), row["milliseconds"].clone());
            middle(&mut values, &name, &row["ratio"]);
        }
        middle(&mut values, "noise", &report["comparison"]["noise"]);
        return Ok(measured(true, device, values));
    }
    let rows = report["compiled_for"].as_array().map_or(&[][..], Vec::as_slice);
    if let Some(first) = rows.first() {
        let mut families: Vec<&str> =
            rows.iter().filter_map(|row| row["family"].as_str()).collect();
        families.dedup();
        for family in &families {
            let each = |key: &'static str| {
                rows.iter()
                    .filter(move |row| row["family"] == **family)
                    .filter_map(move |row| row[key].as_u64())
            };
            let figures = [
                ("programs", Some(each("registers").count() as u64)),
                ("instructions", Some(each("instructions").sum())),
                ("registers", each("registers").max()),
                ("spilled_registers", Some(each("spilled_registers").sum())),
                ("scratch_bytes", each("scratch_bytes").max()),
                ("waves", each("waves").min()),
            ];
            let prefix = if families.len() == 1 { String::new() } else { format!("{family}.") };
            values.extend(figures.map(|(name, value)| (format!("{prefix}{name}"), json!(value))));
            // Of several programs each by itself, too, in the compiler's order.
            let programs = rows.iter().filter(|row| row["family"] == **family);
            for (number, row) in (1..).zip(programs.filter(|_| figures[0].1 != Some(1))) {
                let own = figures[1..].iter();
                values.extend(
                    own.map(|(name, _)| (format!("{prefix}{number}.{name}"), row[name].clone())),
                );
            }
        }
        let generation = |family: &&str| match *family {
            "navi21" => "RDNA2",
            "navi31" => "RDNA3",
            "gfx1201" => "RDNA4",
            _ => "",
        };
        let generations: Vec<&str> = families.iter().map(generation).collect();
        let compiler = first["compiler"].as_str().unwrap_or_default();
        let driver = format!("{compiler}, {}", generations.join(", "));
        return Ok(measured(false, ("RADV".to_owned(), driver), values));
    }
    for (name, key) in [("ms", "gpu_milliseconds"), ("band", "band_milliseconds")] {
        for part in ["min", "median", "max"] {
            values.insert(format!("{name}.{part}"), report[key][part].clone());
        }
    }
    for name in ["primary_rays_per_second", "acceleration_structure_bytes"] {
        values.insert(name.to_owned(), report[name].clone());
    }
    let first = report["first_frame_milliseconds"].as_f64().unwrap_or_default();
    values.insert("first_frame_seconds".to_owned(), (first / 1e3).into());
    Ok(measured(true, device, values))
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

    #[test]
    fn a_comparison_gives_its_table_row_by_row() {
        let ratio = |median: f64| json!({ "low": 1.0, "median": median, "high": 2.0 });
        let report = json!({ "device": "d", "driver": "e", "comparison": { "noise": ratio(1.1), "values": [
            { "value": "first hit", "milliseconds": 5.0, "ratio": ratio(1.5) } ] } });
        let stored = reported(&report).unwrap();
        let names: Vec<&String> = stored.values.keys().collect();
        let row = ["first-hit.ms", "first-hit.ratio", "first-hit.low", "first-hit.high"];
        assert_eq!(names, [&row[..], &["noise.ratio", "noise.low", "noise.high"]].concat());
        assert!(stored.timed && stored.value("first-hit.ratio") == Some(1.5));
    }
}
