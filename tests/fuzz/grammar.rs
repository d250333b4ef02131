//! Generates texts by a grammar: rules in text form, one line for each alternative.
//!
//! ```text
//! file: <line*>
//! line: v <number> <number> <number>\n
//! line: f <corner> <corner> <corner>\n
//! corner: <whole>/<whole>
//! ```
//!
//! A text begins with the first rule. `<rule>` is one instance, `<rule*>` none to many; `\n` ends a line of
//! the text. `<number>`, `<whole>` and `<word>` are built in: mostly plain ones, and some that nobody would
//! write.

use std::collections::BTreeMap;

use reference::random::Random;

/// Rules, each with its alternatives.
pub struct Grammar {
    first: String,
    rules: BTreeMap<String, Vec<Vec<Term>>>,
}

enum Term {
    Text(String),
    Rule(String),
    Many(String),
}

/// Maximum nesting of rules; below it, each takes its first alternative, and `*` is empty.
const DEEP: usize = 24;

/// Numbers that are hard to parse or to process.
pub const ODD_NUMBERS: &[&str] = &[
    "0",
    "-0",
    "1",
    "-1",
    "2147483647",
    "2147483648",
    "-2147483649",
    "4294967295",
    "4294967296",
    "9223372036854775807",
    "9223372036854775808",
    "-9223372036854775809",
    "18446744073709551616",
    "340282366920938463463374607431768211456",
    "1e38",
    "3.4028235e38",
    "3.5e38",
    "-1e39",
    "1e300",
    "1e308",
    "1e309",
    "1e99999",
    "1e-38",
    "1e-45",
    "1e-46",
    "5e-324",
    "1e-99999",
    "nan",
    "NaN",
    "-nan",
    "inf",
    "-inf",
    "infinity",
    "+1",
    "+-1",
    "1.",
    ".1",
    ".",
    "-",
    "1e",
    "1e+",
    "0x10",
    "0b1",
    "0o7",
    "1_000",
    "1,5",
    "1/3",
    "00000000000000000000001",
    "1.0000000000000000000000000000001",
    "0.1f",
    "1u",
    "\u{661}",
    "\u{ff11}",
    "1\u{a0}",
    "1000000",
    "1000001",
    "-1000000",
    "16777217",
];

/// Words that are hard to print, or that are paths to other places.
pub const ODD_WORDS: &[&str] = &[
    "",
    " ",
    "\t",
    "\\",
    "\\\n",
    "\r",
    "\r\n",
    "\u{0}",
    "\u{1b}[31m",
    "\u{7f}",
    "\u{85}",
    "\u{2028}",
    "\u{202e}",
    "\u{feff}",
    "\u{ffff}",
    "\u{10ffff}",
    "e\u{301}",
    "\u{1f468}\u{200d}\u{1f469}",
    "../a",
    "/etc/passwd",
    "/dev/zero",
    "C:\\a",
    "a/../../b",
    ".",
    "..",
    "~",
    "a b",
    "\"",
    "'",
    "\"\"\"",
    "#",
    "//",
    "/*",
    "*/",
    "%s%n",
    "$(a)",
    "${a}",
    "{}",
    "<a>",
    "&a;",
    "--",
    "-",
    "=",
    "|",
];

impl Grammar {
    /// Parses rules.
    ///
    /// # Panics
    /// If a line is not a rule, or refers to a missing one: the rules are ours.
    pub fn new(text: &str) -> Self {
        let mut rules = BTreeMap::<String, Vec<Vec<Term>>>::new();
        let mut first = None;
        for line in text.lines().filter(|line| !line.is_empty() && !line.starts_with("# ")) {
            let (name, way) = line.split_once(": ").unwrap_or_else(|| panic!("no rule: {line}"));
            first.get_or_insert_with(|| name.to_owned());
            rules.entry(name.to_owned()).or_default().push(terms(way));
        }
        let grammar = Self { first: first.expect("a grammar has rules"), rules };
        for term in grammar.rules.values().flatten().flatten() {
            if let Term::Rule(name) | Term::Many(name) = term {
                let known = matches!(name.as_str(), "number" | "whole" | "word");
                assert!(known || grammar.rules.contains_key(name), "there is no rule {name}");
            }
        }
        grammar
    }

    /// A text of about this many bytes at most.
    pub fn text(&self, random: &mut Random, most: usize) -> String {
        let mut text = String::new();
        self.expand(&self.first, random, &mut text, most, 0);
        text
    }

    /// The words that occur in the grammar's texts.
    pub fn words(&self) -> impl Iterator<Item = &str> {
        self.rules.values().flatten().flatten().filter_map(|term| match term {
            Term::Text(text) => Some(text.as_str()),
            _ => None,
        })
    }

    fn expand(&self, rule: &str, random: &mut Random, to: &mut String, most: usize, depth: usize) {
        match rule {
            "number" => return to.push_str(&number(random)),
            "whole" => return to.push_str(&whole(random)),
            "word" => return to.push_str(&word(random)),
            _ => {}
        }
        let ways = &self.rules[rule];
        let is_deep = depth > DEEP || to.len() > most;
        let way = &ways[if is_deep { 0 } else { random.below(ways.len()) }];
        for term in way {
            match term {
                Term::Text(text) => to.push_str(text),
                Term::Rule(name) => self.expand(name, random, to, most, depth + 1),
                Term::Many(name) => {
                    let count = if is_deep { 0 } else { many(random) };
                    for _ in 0..count {
                        if to.len() <= most {
                            self.expand(name, random, to, most, depth + 1);
                        }
                    }
                }
            }
        }
    }
}

fn terms(way: &str) -> Vec<Term> {
    let mut terms = Vec::new();
    let mut rest = way;
    while let Some((text, after)) = rest.split_once('<') {
        let (name, after) = after.split_once('>').unwrap_or_else(|| panic!("no > in {way}"));
        terms.push(Term::Text(text.replace("\\n", "\n")));
        terms.push(match name.strip_suffix('*') {
            Some(name) => Term::Many(name.to_owned()),
            None => Term::Rule(name.to_owned()),
        });
        rest = after;
    }
    terms.push(Term::Text(rest.replace("\\n", "\n")));
    terms
}

/// A count: usually small, sometimes large.
fn many(random: &mut Random) -> usize {
    match random.below(12) {
        0 => random.below(200),
        1..4 => random.below(20),
        _ => random.below(5),
    }
}

fn one<'a>(random: &mut Random, list: &[&'a str]) -> &'a str {
    list[random.below(list.len())]
}

/// A number as a text.
pub fn number(random: &mut Random) -> String {
    match random.below(16) {
        0 => one(random, ODD_NUMBERS).to_owned(),
        1..6 => whole(random),
        6 => format!("{:e}", random.scale(1e-45, 1e39)),
        _ => format!("{:.3}", random.between(-2.0, 2.0)),
    }
}

/// A whole number as a text, usually small.
pub fn whole(random: &mut Random) -> String {
    match random.below(24) {
        0 => one(random, ODD_NUMBERS).to_owned(),
        1..4 => format!("-{}", random.below(5)),
        4 => random.below(100_000).to_string(),
        _ => random.below(9).to_string(),
    }
}

/// A name as a text, usually one of a few, so that names coincide.
pub fn word(random: &mut Random) -> String {
    match random.below(16) {
        0 => one(random, ODD_WORDS).to_owned(),
        1 => "x".repeat(random.below(3000)),
        _ => one(random, &["a", "b", "c", "white", "black", "pawn"]).to_owned(),
    }
}
