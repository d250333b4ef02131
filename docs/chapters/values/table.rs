//! Tables of measured values, written whole by `chapters sync`: `<!-- table NAME -->` on a page.
//!
//! The template is a section of `docs/values/PAGE.md`:
//!
//! ```markdown
//! ## modes
//! | mode | GPU ms | time / opaque |
//! |---|---|---|
//! | {opaque; all hits} | {modes.*.ms} | {modes.*.ratio:0.00} |
//! | opaque again (noise) | | {modes.noise.ratio:0.00} |
//! ```
//!
//! `{MEASUREMENT.VALUE:0.00}` is a stored value, formatted like the number after the colon; without one, with
//! as many digits as a reader needs; `{1/MEASUREMENT.VALUE}` is its inverse. A row whose head is `{A; B}`
//! stands for one row each: `*` is the head, with hyphens for blanks, and a value that is not stored leaves
//! its cell empty. `{*}` stands for all stored names.

use std::collections::BTreeSet;
use std::sync::LazyLock;

use manuscript::fault::Fault;
use manuscript::page::{Block, Kind, Page};
use manuscript::project::Project;
use regex_lite::Regex;

use super::binding::{value, whole_name};
use super::number;
use super::record::{FOLDER, Records};

/// A value in a template: measurement, value, and a number in the wanted format.
static VALUE: LazyLock<Regex> = LazyLock::new(|| {
    let pattern = r"\{(?:1/)?([\w-]+(?:/[\w-]+)?)\.([^{}|]+?)(?::([\d.,e-]+))?\}";
    Regex::new(pattern).expect("the pattern is right")
});

/// The head of a row that stands for several: `{*}`, or `{box; tent}`.
static HEADS: LazyLock<Regex> =
    LazyLock::new(|| Regex::new(r"^\| \{([^{}]+)\} \|").expect("the pattern is right"));

/// The file with a page's templates, from the project's root.
pub fn file(page: &Page) -> String {
    format!("{FOLDER}/{}.md", page.stem())
}

/// The templates of a page, by name, each with the line of its heading from 1.
fn templates(project: &Project, page: &Page) -> Vec<(usize, String, String)> {
    let text = project.read(&file(page)).unwrap_or_default();
    let mut found: Vec<(usize, String, String)> = Vec::new();
    for (index, line) in text.lines().enumerate() {
        if let Some(name) = line.strip_prefix("## ") {
            found.push((index + 1, name.trim().to_owned(), String::new()));
        } else if let Some((_, _, body)) = found.last_mut().filter(|_| !line.trim().is_empty()) {
            *body += &format!("{line}\n");
        }
    }
    found
}

/// The template of a page's table.
pub fn template(project: &Project, page: &Page, name: &str) -> Option<String> {
    let mut templates = templates(project, page).into_iter();
    templates.find(|(_, known, _)| known == name).map(|(.., template)| template)
}

/// The table of this name, for a marker on this line of a page.
///
/// # Errors
/// If there is no such template, or it contains a value that is not stored.
pub fn body(
    project: &Project,
    page: &Page,
    line: usize,
    name: &str,
    stored: &Records,
) -> Result<String, Fault> {
    let templates = templates(project, page);
    let Some((at, _, template)) = templates.iter().find(|(_, known, _)| known == name) else {
        let what = format!("{} has no table '{name}'", file(page));
        return Err(Fault::new(
            &*page.path,
            line,
            what,
            format!("write it there, below ## {name}"),
        ));
    };
    let fault = |(what, remedy): (String, String)| Fault::new(file(page), *at, what, remedy);
    let mut text = String::new();
    for row in template.lines() {
        let Some(heads) = HEADS.captures(row) else {
            text += &(written(page, row, stored, false).map_err(fault)? + "\n");
            continue;
        };
        let names = match &heads[1] {
            "*" => names(page, row, stored),
            heads => heads.split(';').map(|head| head.trim().replace(' ', "-")).collect(),
        };
        let shown: Vec<String> = match &heads[1] {
            "*" => names.iter().map(|name| name.replace('-', " ")).collect(),
            heads => heads.split(';').map(|head| head.trim().to_owned()).collect(),
        };
        if names.is_empty() {
            return Err(fault((format!("no stored value fits {row}"), "correct it".to_owned())));
        }
        for (name, shown) in names.iter().zip(shown) {
            let row =
                VALUE.replace_all(row, |value: &regex_lite::Captures| value[0].replace('*', name));
            let row =
                HEADS.replace(&row, regex_lite::NoExpand(&format!("| {shown} |"))).into_owned();
            text += &(written(page, &row, stored, true).map_err(fault)? + "\n");
        }
    }
    Ok(text)
}

/// The possible values of `*` in a row: the names that match its first value with one, in the order stored.
fn names(page: &Page, row: &str, stored: &Records) -> Vec<String> {
    let first = VALUE.captures_iter(row).find(|value| value[2].contains('*'));
    let Some(first) = first else { return Vec::new() };
    let Some((before, after)) = first[2].split_once('*') else { return Vec::new() };
    let record = stored.get(&whole_name(page, &first[1]));
    let keys = record.into_iter().flat_map(|record| record.values.keys());
    let name = |key: &String| {
        let name = key.strip_prefix(before)?.strip_suffix(after)?;
        (!name.is_empty() && (after.is_empty() || !name.contains('.'))).then(|| name.to_owned())
    };
    keys.filter_map(name).collect()
}

/// The format of a value, with no more digits than a reader needs.
fn format(value: f64) -> &'static str {
    match value.abs() {
        size if size == 0.0 || size.fract() == 0.0 || size >= 100.0 => "0",
        size if size < 0.01 => "0.0e0",
        size if size >= 10.0 => "0.0",
        _ => "0.00",
    }
}

/// A row with its values; if `may_lack`, a value that is not stored leaves its cell empty.
fn written(
    page: &Page,
    row: &str,
    stored: &Records,
    may_lack: bool,
) -> Result<String, (String, String)> {
    let (mut text, mut rest) = (String::new(), row);
    while let Some(found) = VALUE.captures(rest) {
        let all = found.get(0).map_or(0..0, |all| all.range());
        text.push_str(&rest[..all.start]);
        rest = &rest[all.end..];
        match value(stored, &whole_name(page, &found[1]), &found[2]) {
            Ok(value) => {
                let value = if found[0].starts_with("{1/") { 1.0 / value } else { value };
                let sample = found.get(3).map_or_else(|| format(value), |sample| sample.as_str());
                let shown = format!("{text}{sample}{rest}");
                let place = text.len()..text.len() + sample.len();
                let sample = number::found(&shown, place).pop();
                let wrong = || {
                    let what = format!("'{}' is not a format for a number", &found[0]);
                    (what, "write a number as it should look, such as 0.00".to_owned())
                };
                text.push_str(&sample.ok_or_else(wrong)?.like(value));
            }
            Err(_) if may_lack => {}
            Err(fault) => return Err(fault),
        }
    }
    let row = text + rest;
    // An empty cell is one blank wide.
    Ok(row.replace("|  |", "| |").replace("|  |", "| |"))
}

/// The measurements used in a page's tables, with their pages.
pub fn measurements(project: &Project, page: &Page) -> BTreeSet<String> {
    let shown = |name: &String| page.blocks.iter().any(|b| is_table(b) && b.words.contains(name));
    let templates = templates(project, page).into_iter().filter(|(_, name, _)| shown(name));
    let names = |(_, _, body): (usize, String, String)| -> Vec<String> {
        VALUE.captures_iter(&body).map(|value| whole_name(page, &value[1])).collect()
    };
    templates.flat_map(names).collect()
}

/// The templates that no page shows. A chapter's page and its page of measurements share a file.
pub fn strays(project: &Project, pages: &[Page]) -> Vec<Fault> {
    let stray = |page: &Page| {
        let own = pages.iter().filter(|other| other.stem() == page.stem());
        let blocks: Vec<&Block> =
            own.flat_map(|page| &page.blocks).filter(|b| is_table(b)).collect();
        let shown = |name: &String| blocks.iter().any(|block| block.words.contains(name));
        let strays = templates(project, page).into_iter().filter(|(_, name, _)| !shown(name));
        let fault = |(line, name, _): (usize, String, String)| {
            let remedy =
                format!("add <!-- table {name} --> and <!-- /table --> to it, or delete it");
            let what = format!("{} shows no table '{name}'", page.stem());
            Fault::new(file(page), line, what, remedy)
        };
        strays.map(fault).collect::<Vec<_>>()
    };
    let mut faults: Vec<Fault> = pages.iter().flat_map(stray).collect();
    faults.sort();
    faults.dedup();
    faults
}

fn is_table(block: &Block) -> bool {
    block.kind == Kind::Table
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::values::record::Record;

    fn stored() -> Records {
        let text = r#"{ "command": "", "timed": false, "device": "d", "driver": "e", "date": "2026-11-22",
            "values": { "a-b.ms": 1234.5, "c.ms": 0.25, "noise.ms": 7, "c.part": 0.5 } }"#;
        let record: Record = serde_json::from_str(text).unwrap();
        Records::from([("p/m".to_owned(), record)])
    }

    fn filled(row: &str) -> Result<String, (String, String)> {
        written(&Page::parse("docs/p.md", ""), row, &stored(), true)
    }

    #[test]
    fn a_value_is_written_like_its_format() {
        let cases = [
            ("| x | {m.c.ms:0.0} | {m.c.part:0} % |", "| x | 0.2 | 50 % |"),
            ("| {m.a-b.ms:0} | {m.a-b.ms:1000.0} |", "| 1,234 | 1234.5 |"),
            ("| {m.a-b.ms} | {m.c.ms} | {m.gone} |", "| 1,234 | 0.25 | |"),
        ];
        for (row, expected) in cases {
            assert_eq!(filled(row).unwrap(), expected);
        }
    }

    #[test]
    fn a_star_stands_for_the_stored_names() {
        let page = Page::parse("docs/p.md", "");
        assert_eq!(names(&page, "| {*} | {m.*.ms} |", &stored()), ["a-b", "c", "noise"]);
        assert_eq!(names(&page, "| {*} | {m.*.part} |", &stored()), ["c"]);
    }
}
