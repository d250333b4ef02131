//! The reader's complaints in words of our own, which say what to write. The TOML reader's speak of its insides.

/// The keys outside of all tables.
const ABOVE: [&str; 4] = ["version", "model", "position", "sky"];

/// The tables of which there is one, and those of which there may be several.
pub(super) const ONCE: [&str; 4] = ["picture", "camera", "plane", "heightfield"];
const SEVERAL: [&str; 8] =
    ["light", "material", "piece", "sphere", "box", "solid", "strand", "torus"];

const LINE: &str = "a line is `key = value`, `[table]` or `[[table]]`; a comment begins with `#`";
const LIST: &str = "a list is [0, 1, 5], with commas between its values and a `]` at its end";
const INLINE: &str = "a table within a line is { diameter = 0.1, focus = 2 }";
const NUMBER: &str = "a number is 7, 0.5 or 1e6, with a digit on either side of the point";
const TEXT: &str = "a text ends on its line, in the quote that it began with: \"red\"";

/// The message about a line of a file that is not TOML; `fault` is the parser's own.
pub(super) fn syntax(line: &str, fault: &str) -> String {
    let value = line.split_once('=').map_or("", |(_, value)| value);
    let value = value.split('#').next().unwrap_or_default().trim();
    let has = |words: &[&str]| words.iter().any(|word| fault.contains(word));
    if has(&["escape", "unicode"]) {
        return "a `\\` in a text begins an escape; write `/` between folders".to_owned();
    }
    if let Some(number) = decimal(value) {
        return format!("a number has a point, not a comma: write {number}");
    }
    let what = match () {
        () if has(&["duplicate"]) => {
            return format!("`{}` is here for the second time; take one of them out", key(line));
        }
        () if has(&["must be quoted", "missing value"]) => return unquoted(value),
        () if has(&["boolean"]) => "write true or false, in small letters",
        () if has(&["array table", "unclosed table"]) => {
            "a table's name stands in brackets: [camera], or [[light]] where there may be several"
        }
        () if has(&["inline", "key-value pairs"]) && value.contains('{') => INLINE,
        () if has(&["array"]) => LIST,
        () if has(&["unexpected key or value"]) && value.starts_with('(') => LIST,
        () if has(&["unexpected key or value"]) => "more follows the value; begin a line for it",
        () if has(&["carriage return"]) => "its lines end in CR alone; save it with LF or CR LF",
        () if has(&["comment character"]) => "a control character in a comment; take it out",
        () if has(&["string"]) => TEXT,
        () if has(&NUMBERS) => NUMBER,
        () => LINE,
    };
    what.to_owned()
}

/// Words of the parser's messages about numbers.
const NUMBERS: [&str; 9] = [
    "mantissa",
    "fraction",
    "exponent",
    "leading zero",
    "digits",
    "sign",
    "radix",
    "integer",
    "float",
];

/// The number that is written as `1,5` in many countries.
fn decimal(value: &str) -> Option<String> {
    let (whole, fraction) = value.split_once(',')?;
    let digits = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    let unsigned = whole.trim_start_matches(['-', '+']);
    (digits(unsigned) && digits(fraction)).then(|| format!("{whole}.{fraction}"))
}

/// The key or the table of a line.
fn key(line: &str) -> &str {
    let name = line.split(['=', '#']).next().unwrap_or_default();
    name.trim_matches(|c: char| c.is_whitespace() || matches!(c, '[' | ']'))
}

/// The remedy for a value that is not valid TOML.
fn unquoted(value: &str) -> String {
    let what = match value.chars().next() {
        None => "the value is missing; write it after the `=`, on the same line",
        Some('[') => LIST,
        Some('“' | '”' | '„' | '‘' | '’' | '«') => {
            "write straight quotes around a text: \"red\""
        }
        Some('T' | 'F') if matches!(value, "True" | "False" | "TRUE" | "FALSE") => {
            "write true or false, in small letters"
        }
        Some(c) if c.is_ascii_digit() || matches!(c, '-' | '+' | '.') => {
            "this is no number; a number is 7, 0.5 or 1e6, without a unit"
        }
        Some(_) => "a text stands in quotes: \"red\"",
    };
    what.to_owned()
}

/// The message about a value or a key of a file that is valid TOML. Our own complaints pass unchanged.
pub(super) fn value(fault: &str) -> String {
    let names = |list: &str| list.replace('`', "");
    if let Some((name, rest)) = named(fault, "unknown field `") {
        if ABOVE.contains(&name) {
            return format!(
                "`{name}` is a key of the whole file; write it above the first [table]"
            );
        }
        if ONCE.contains(&name) {
            return format!("`{name}` is a table of its own; write it as [{name}]");
        }
        if SEVERAL.contains(&name) {
            return format!("`{name}` is a table of its own; write it as [[{name}]]");
        }
        let known = rest.strip_prefix(", expected ").unwrap_or(rest);
        let known = names(known.strip_prefix("one of ").unwrap_or(known));
        return format!("there is no key `{name}` here; there is {known}");
    }
    if let Some((name, _)) = named(fault, "missing field `") {
        return if ONCE.contains(&name) {
            format!("the table [{name}] is missing")
        } else {
            format!("the key `{name}` is missing in this table")
        };
    }
    match fault.strip_prefix("invalid type: ").and_then(|rest| rest.split_once(", expected ")) {
        Some((_, "a string")) => "write a text in quotes here".to_owned(),
        Some((_, "a boolean")) => "write true or false here".to_owned(),
        Some((_, "a sequence")) => {
            "there may be several of these tables: write each under [[its name]]".to_owned()
        }
        Some((is, _)) if is.starts_with("integer") && is.contains(" as ") => {
            "the number has too many digits".to_owned()
        }
        Some((_, right)) => match right.split_once(", ") {
            Some((table, example)) => format!("write {table} here: {example}"),
            None => format!("write {right} here"),
        },
        None if fault.starts_with("invalid") || fault.starts_with("duplicate") => LINE.to_owned(),
        None => fault.to_owned(),
    }
}

/// The name in a message that begins so, and the rest.
fn named<'a>(fault: &'a str, start: &str) -> Option<(&'a str, &'a str)> {
    fault.strip_prefix(start)?.split_once('`')
}
