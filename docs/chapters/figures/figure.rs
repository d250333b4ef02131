//! Figures: the numbers in a page's sentences and tables, each bound to the measurement that gave it.
//!
//! ````markdown
//! <!-- measure acne -->
//! ```sh
//! cargo test --test samples shadow_miss::acne
//! ```
//!
//! Of 59,050 lit pixels 26,950 go dark, with 24 bits (llvmpipe, Mesa 25.0.7, 2026-11-22).
//! <!-- explains 24 -->
//! <!-- figures acne: lit dark -->
//! ````
//!
//! The comments stand below the paragraph, table, quotation or item. `explains` lists the numbers that no
//! run gave; `figures` names, in order, the values of those that are left: all of them, or all but whole
//! numbers up to 12 in a sentence. Without names it is every value of the measurement.
//!
//! ````markdown
//! | rung | time | error |
//! |---|---|---|
//! | S0 textbook | 1.00 | 51 |
//! | S5 64 bits | 1.08 | 0.49 |
//! <!-- figures times: *.ratio; errors: *.p99 -->
//! ````
//!
//! In a table `*` is the head of a row, with hyphens: the names are those of one row, `S0-textbook.ratio`
//! and `S0-textbook.p99`, and count for each. A value that is not there belongs to an empty cell.

use std::collections::BTreeSet;
use std::ops::Range;

use manuscript::fault::{Fault, SYNC};
use manuscript::page::Page;

use super::binding::{Records, names};
use super::device_note;
use super::number::Number;
use super::passage::{self, Comment, Passage, line};
use super::record::{self, Record};
use super::stamp;

/// A number on a page and what it should be.
struct Bound {
    number: Number,
    value: f64,
    /// The measurement.
    name: String,
    /// The value's name.
    key: String,
}

/// Where a page says which device gave figures, and when.
struct Note {
    /// The whole note, in bytes of the page's text.
    span: Range<usize>,
    /// The measurements that it belongs to: all whose figures stand between the note before and this one.
    names: BTreeSet<String>,
}

/// What a page's comments come to.
#[derive(Default)]
struct Found {
    bound: Vec<Bound>,
    notes: Vec<Note>,
    faults: Vec<Fault>,
    /// Measurements that have no note yet.
    open: BTreeSet<String>,
    /// Measurements that have one.
    told: BTreeSet<String>,
}

/// What is wrong with a page's figures.
pub fn check(page: &Page, stored: &Records) -> Vec<Fault> {
    let text = page.written();
    let mut found = Found::of(page, &text, stored);
    let fault = |at: usize, what: String, remedy: &str| {
        Fault::new(&*page.path, line(&text, at), what, remedy)
    };
    for Bound { number, value, name, key } in &found.bound {
        let (written, should) = (&number.written, number.like(*value));
        if *written != should {
            let what =
                format!("the figure {written} is {should} in {} ({key})", record::file(name));
            found.faults.push(fault(number.span.start, what, SYNC));
        }
    }
    if stamp::is_on(page) {
        // One place says it for the whole page.
        for Note { span, .. } in &found.notes {
            let what = format!("the page's stamp says it: {}", &text[span.clone()]);
            found.faults.push(fault(span.start, what, "remove it"));
        }
        return found.faults;
    }
    for Note { span, names } in &found.notes {
        let note = &text[span.clone()];
        let Some(day) = day(names, stored) else {
            let timed = names.iter().filter(|name| stored[*name].timed);
            let told = |name: &String| format!("{} of {}", record::file(name), stored[name].date);
            let told: Vec<String> = timed.map(told).collect();
            let what = format!("this note is of times of several days: {}", told.join(", "));
            found.faults.push(fault(span.start, what, "give each day a note of its own"));
            continue;
        };
        for name in names {
            let of_day = Record { date: day.to_owned(), ..stored[name].clone() };
            let Some(word) = device_note::unknown_word(note, &of_day) else { continue };
            let told = device_note::told(&of_day);
            let what = format!("this note says {word}, {} is of {told}", record::file(name));
            let remedy = if note.ends_with(word) { SYNC } else { "correct it" };
            found.faults.push(fault(span.start, what, remedy));
        }
    }
    for Bound { number, name, .. } in &found.bound {
        if found.open.remove(name) {
            let what = format!("no note says which device gave {}, and when", record::file(name));
            let remedy = format!(
                "write `{}` below, or `<!-- stamp -->` and `<!-- /stamp -->` for the page",
                device_note::told(&stored[name])
            );
            found.faults.push(fault(number.span.start, what, &remedy));
        }
    }
    found.faults
}

/// The measurements whose figures a page has.
pub fn measurements(page: &Page, stored: &Records) -> BTreeSet<String> {
    let passages = passage::all(&page.written());
    let names = passages.iter().flat_map(|passage| names(page, passage, stored));
    names.map(|(name, _)| name).collect()
}

/// The page with every bound figure, and the day in every note, as they are stored.
pub fn filled(page: &Page, stored: &Records) -> Page {
    let text = page.written();
    let found = Found::of(page, &text, stored);
    let figure = |bound: &Bound| (bound.number.span.clone(), bound.number.like(bound.value));
    let mut changes: Vec<(Range<usize>, String)> = found.bound.iter().map(figure).collect();
    let notes = if stamp::is_on(page) { Vec::new() } else { found.notes };
    changes.extend(notes.iter().filter_map(|Note { span, names }| {
        let day = day(names, stored).filter(|_| !names.is_empty())?;
        Some((span.end - device_note::DAY..span.end, day.to_owned()))
    }));
    page.edited(changes)
}

impl Found {
    fn of(page: &Page, text: &str, stored: &Records) -> Self {
        let mut found = Self::default();
        let devices = stored.values().filter(|stored| stored.device != record::HOST);
        let devices: BTreeSet<&str> =
            devices.filter_map(|stored| stored.device.split(' ').next()).collect();
        let devices: Vec<&str> = devices.into_iter().collect();
        for passage in passage::all(text) {
            let notes = device_note::found(text, &passage.text, &devices);
            let names = names(page, &passage, stored);
            if let Some(numbers) = found.without_explained(page, text, &passage, &notes) {
                found.bind(page, text, &passage, numbers, &names, stored);
            }
            for (name, _) in names {
                let device = stored.get(&name).is_some_and(|stored| stored.device != record::HOST);
                if device && (!found.told.contains(&name) || !notes.is_empty()) {
                    found.open.insert(name);
                }
            }
            for span in notes {
                let names = found.open_of(&text[span.clone()], stored);
                found.told.extend(names.iter().cloned());
                found.notes.push(Note { span, names });
            }
        }
        found
    }

    /// Takes the open measurements that a note is of: its first word is their device's.
    fn open_of(&mut self, note: &str, stored: &Records) -> BTreeSet<String> {
        let device = |device: &str| device.split(' ').next().unwrap_or_default().to_owned();
        let is_of = |name: &String| note.starts_with(&device(&stored[name].device));
        let (names, open) = std::mem::take(&mut self.open).into_iter().partition(is_of);
        self.open = open;
        names
    }

    /// A passage's numbers without those that only explain. None if one of the latter is not there: then it is
    /// unknown which number is which.
    fn without_explained(
        &mut self,
        page: &Page,
        text: &str,
        passage: &Passage,
        notes: &[Range<usize>],
    ) -> Option<Vec<Number>> {
        let mut numbers = passage.numbers(text, notes);
        let mut whole = true;
        for (line, comment) in &passage.comments {
            let Comment::Explains(words) = comment else { continue };
            for word in words {
                let before = numbers.len();
                numbers.retain(|number| number.written != *word);
                if numbers.len() == before {
                    whole = false;
                    let what = format!("no number {word} stands above");
                    let remedy = "take it out of the comment";
                    self.faults.push(Fault::new(&*page.path, *line, what, remedy));
                }
            }
        }
        whole.then_some(numbers)
    }

    /// Gives each number the value that is named for it.
    fn bind(
        &mut self,
        page: &Page,
        text: &str,
        passage: &Passage,
        numbers: Vec<Number>,
        names: &[(String, String)],
        stored: &Records,
    ) {
        let mut fault = |at: usize, what: String, remedy: &str| {
            self.faults.push(Fault::new(&*page.path, line(text, at), what, remedy));
        };
        if let Some((name, _)) = names.iter().find(|(name, _)| !stored.contains_key(name)) {
            let at = passage.text.first().map_or(0, |part| part.start);
            fault(at, format!("there is no {}", record::file(name)), &record::renew(name));
            return;
        }
        let all = numbers.len() == names.len();
        let needed = |number: &Number| all || passage.counts_small || !number.small;
        let numbers: Vec<Number> = numbers.into_iter().filter(needed).collect();
        let list: Vec<&str> = numbers.iter().map(|number| &*number.written).collect();
        let (count, list) = (list.len(), list.join(", "));
        let first = numbers.first().map(|number| number.span.start);
        match (first, names) {
            (None, []) => {}
            (Some(at), []) => {
                let verb = if count == 1 { "is" } else { "are" };
                let remedy = "add <!-- figures NAME: VALUE … --> below, or <!-- explains NUMBER … --> \
                              for what no run gave";
                fault(at, format!("{list} {verb} bound to no measurement"), remedy);
            }
            (at, names) if names.len() != count => {
                let at = at.or(passage.text.first().map(|part| part.start)).unwrap_or(0);
                let what = format!("below stand {} names for {count} numbers: {list}", names.len());
                fault(at, what, "name a value of a measurement for each, in order");
            }
            _ => {
                for (number, (name, key)) in numbers.into_iter().zip(names) {
                    let at = number.span.start;
                    let known = &stored[name];
                    match known.value(key) {
                        Some(value) => {
                            let (name, key) = (name.clone(), key.clone());
                            self.bound.push(Bound { number, value, name, key });
                        }
                        None => {
                            let there: Vec<&str> =
                                known.values.keys().map(String::as_str).collect();
                            let what = format!("{} has no value '{key}'", record::file(name));
                            fault(at, what, &format!("name one of {}", there.join(", ")));
                        }
                    }
                }
            }
        }
    }
}

/// The day for a note of these measurements. If there are times among them, it is their day, which must be
/// the same for all. Else it is the last day: a figure that is no time comes out the same on any day.
fn day<'a>(names: &BTreeSet<String>, stored: &'a Records) -> Option<&'a str> {
    let days = |timed: bool| -> BTreeSet<&'a str> {
        let of = names.iter().filter_map(|name| stored.get(name));
        of.filter(|stored| stored.timed == timed).map(|stored| &*stored.date).collect()
    };
    let timed = days(true);
    match timed.len() {
        0 => Some(days(false).last().copied().unwrap_or_default()),
        1 => timed.first().copied(),
        _ => None,
    }
}
