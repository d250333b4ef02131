//! Bindings: the comment after a number that names its stored value.
//!
//! `59,050<!-- acne.lit -->` is the value `lit` of the page's own measurement `acne`, and `<!--
//! 05_shadow_miss/acne.lit -->` that of another page. The number's digits determine how the value is rounded.

use std::collections::BTreeSet;
use std::ops::Range;
use std::sync::LazyLock;

use manuscript::fault::Fault;
use manuscript::page::Page;
use manuscript::project::Project;
use regex_lite::Regex;

use super::number::{self, Number};
use super::passage::{self, line as line_of};
use super::record::{self, Records};
use super::{stamp, table};

/// A comment that consists of a measurement, a dot and a value's name.
static COMMENT: LazyLock<Regex> = LazyLock::new(|| {
    Regex::new(r"<!-- ?([\w-]+(?:/[\w-]+)?)\.([^>\n]+?) ?-->").expect("the pattern is right")
});

/// A number on a page, and its value.
struct Bound {
    number: Number,
    value: f64,
    /// The measurement's name, with its page.
    name: String,
    /// The value's name.
    key: String,
}

/// A measurement's name with its page, which defaults to this one.
pub fn whole_name(page: &Page, name: &str) -> String {
    if name.contains('/') { name.to_owned() } else { format!("{}/{name}", page.stem()) }
}

/// The value of this name in a measurement given with its page; otherwise the fault and the remedy.
pub fn value(stored: &Records, name: &str, key: &str) -> Result<f64, (String, String)> {
    let Some(record) = stored.get(name) else {
        return Err((format!("there is no measurement {name}"), record::renew(name)));
    };
    record.value(key).ok_or_else(|| {
        let mut there: Vec<&str> = record.values.keys().map(String::as_str).collect();
        // A table has hundreds: show those that share the longest prefix with the requested name.
        let shared = |name: &str| name.bytes().zip(key.bytes()).take_while(|(a, b)| a == b).count();
        there.sort_by_key(|name| std::cmp::Reverse(shared(name)));
        let (count, shown) = (there.len(), there[..there.len().min(8)].join(", "));
        let such = if count > 8 {
            format!("one of its {count}, such as {shown}")
        } else {
            format!("one of {shown}")
        };
        (format!("{name} has no value '{key}'"), format!("name {such}"))
    })
}

/// The bound numbers of a page with known values, and the faults of the others.
fn all(page: &Page, text: &str, stored: &Records) -> (Vec<Bound>, Vec<Fault>) {
    let (mut bound, mut faults) = (Vec::new(), Vec::new());
    for comment in COMMENT.captures_iter(text) {
        let (span, name) = (comment.get(0).map_or(0..0, |all| all.range()), &comment[1]);
        if is_code(text, span.start) {
            continue;
        }
        let mut fault = |what: String, remedy: &str| {
            faults.push(Fault::new(&*page.path, line_of(text, span.start), what, remedy));
        };
        let line = text[..span.start].rfind('\n').map_or(0, |at| at + 1);
        let last = number::found(text, line..span.start).pop();
        let Some(number) = last.filter(|number| number.span.end == span.start) else {
            let what = format!("no number stands directly before {}", &comment[0]);
            fault(what, "put the comment behind its number, without a blank");
            continue;
        };
        let (name, key) = (whole_name(page, name), comment[2].to_owned());
        match value(stored, &name, &key) {
            Ok(value) => bound.push(Bound { number, value, name, key }),
            Err((what, remedy)) => fault(what, &remedy),
        }
    }
    (bound, faults)
}

/// True inside a fenced block or between backticks, where a comment is only an example.
fn is_code(text: &str, at: usize) -> bool {
    let before = &text[..at];
    let fences = before.lines().filter(|line| line.trim_start().starts_with("```")).count();
    let line = before.rsplit('\n').next().unwrap_or_default();
    fences % 2 == 1 || line.matches('`').count() % 2 == 1
}

/// Bound numbers that differ from the stored values, and pages that do not name the device of their values.
pub fn check(page: &Page, stored: &Records) -> Vec<Fault> {
    let text = page.written();
    let (bound, mut faults) = all(page, &text, stored);
    for Bound { number, value, name, key } in &bound {
        let (written, should) = (&number.written, number.like(*value));
        if *written != should {
            let what = format!("{written} is {should} in {name} ({key})");
            let line = line_of(&text, number.span.start);
            faults.push(Fault::stale(&*page.path, line, what));
        }
    }
    // The README has no room for it; every page it links to has one.
    let first = bound.iter().find(|bound| stored[&bound.name].device != record::HOST);
    if let Some(first) = first.filter(|_| page.path.starts_with("docs/") && !stamp::is_on(page)) {
        let what = "this page does not say which device gave its values, and when";
        let remedy = "add <!-- stamp --> and <!-- /stamp --> at its end";
        faults.push(Fault::new(&*page.path, line_of(&text, first.number.span.start), what, remedy));
    }
    faults
}

/// The measurements used on a page, with their pages.
pub fn measurements(project: &Project, page: &Page) -> BTreeSet<String> {
    let text = page.written();
    let named = COMMENT.captures_iter(&text);
    let named =
        named.filter(|comment| !is_code(&text, comment.get(0).map_or(0, |all| all.start())));
    let mut names: BTreeSet<String> = named.map(|comment| whole_name(page, &comment[1])).collect();
    names.extend(table::measurements(project, page));
    names
}

/// The page with every bound number replaced by its stored value.
pub fn filled(page: &Page, stored: &Records) -> Page {
    let bound = all(page, &page.written(), stored).0;
    let change = |bound: &Bound| (bound.number.span.clone(), bound.number.like(bound.value));
    page.edited(bound.iter().map(change).collect())
}

/// Unbound numbers of three or more digits, with their lines. They may be measured and should then be bound.
///
/// Round numbers, sizes, powers of two, years, versions and numbers in code are left out.
pub fn unbound(page: &Page) -> Vec<(usize, String)> {
    let text = page.written();
    let parts = passage::all(&text).into_iter().flat_map(|passage| passage.text);
    let numbers = parts.flat_map(|part: Range<usize>| number::found(&text, part));
    // Measured values are rarely round.
    let is_long = |number: &Number| {
        let digits = number.written.split('e').next().unwrap_or_default();
        let digits: String = digits.chars().filter(char::is_ascii_digit).collect();
        let is_size = digits.parse().is_ok_and(u64::is_power_of_two);
        digits.trim_matches('0').len() >= 3 && !is_size && !number.is_year()
    };
    let is_free = |number: &Number| {
        let rest = &text[number.span.end..];
        COMMENT.find(rest).is_none_or(|comment| comment.start() != 0)
    };
    let long = numbers.filter(|number| is_long(number) && is_free(number));
    long.map(|number| (line_of(&text, number.span.start), number.written)).collect()
}

/// A text without the comments that bind its numbers.
pub fn stripped(text: &str) -> String {
    COMMENT.replace_all(text, "").into_owned()
}
