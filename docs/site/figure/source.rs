//! A shader as tokens: with all included files, without comments, its directives evaluated.

use std::collections::BTreeSet;

use manuscript::anchor::parts;
use manuscript::fault::Fault;
use manuscript::shader::spliced;

/// Operators of several characters, longer ones first.
const SIGNS: [&str; 20] = [
    "<<=", ">>=", "==", "!=", "<=", ">=", "+=", "-=", "*=", "/=", "%=", "&=", "|=", "^=", "<<",
    ">>", "++", "--", "&&", "||",
];

/// A word, a number or an operator, and its line.
#[derive(Clone, Debug)]
pub struct Token {
    /// Its text.
    pub text: String,
    /// The position of its line in the spliced text.
    pub line: usize,
}

/// A tokenized shader.
#[derive(Default)]
pub struct Source {
    /// The origin of each line of the spliced text.
    places: Vec<(String, usize)>,
    /// Its tokens; a definition is one token.
    pub tokens: Vec<Token>,
    /// Its faults.
    pub faults: Vec<Fault>,
}

impl Source {
    /// Reads `file` and the files it includes, from the project's root.
    pub fn of(read: &dyn Fn(&str) -> Option<String>, file: &str) -> Self {
        let mut source = Self::default();
        source.lines(file, &spliced(&|path| cut(read, path), file));
        source
    }

    /// Tokenizes the text: evaluates directives, and skips comments.
    fn lines(&mut self, file: &str, text: &str) {
        let (mut file, mut number) = (file.to_owned(), 0);
        let mut defined = BTreeSet::new();
        // For each open condition, true if its lines count.
        let mut conditions: Vec<bool> = Vec::new();
        for (line, text) in text.lines().enumerate() {
            number += 1;
            self.places.push((file.split('#').next().unwrap_or_default().to_owned(), number));
            let text = text.split("//").next().unwrap_or_default().trim();
            let Some(directive) = text.strip_prefix('#') else {
                if conditions.iter().all(|counts| *counts) {
                    self.tokens.extend(tokens(text, line));
                }
                continue;
            };
            let (word, rest) = directive.trim().split_once(' ').unwrap_or((directive.trim(), ""));
            let counts = conditions.iter().all(|counts| *counts);
            match word {
                "line" => {
                    let (next, name) = rest.split_once(' ').unwrap_or((rest, ""));
                    number = next.parse::<usize>().unwrap_or(1) - 1;
                    file = name.trim_matches('"').to_owned();
                }
                "ifdef" => conditions.push(defined.contains(rest.trim())),
                "ifndef" => conditions.push(!defined.contains(rest.trim())),
                "else" => {
                    if let Some(last) = conditions.last_mut() {
                        *last = !*last;
                    }
                }
                "endif" => drop(conditions.pop()),
                _ if !counts => {}
                "define" => {
                    defined.insert(rest.split([' ', '(']).next().unwrap_or_default().to_owned());
                    self.tokens.push(Token { text: format!("\n{text}\n"), line });
                }
                "include" => {
                    let what = format!("there is no file or no anchor {}", rest.trim());
                    self.fault(line, what, "correct it");
                }
                _ => self.unfit(line, &format!("#{word}")),
            }
        }
    }

    /// Adds a fault in a line.
    pub fn fault(&mut self, line: usize, what: impl Into<String>, remedy: &str) {
        let (file, number) = self.places[line].clone();
        self.faults.push(Fault::new(file, number, what, remedy));
    }

    /// Adds a fault for something WebGL 2 lacks.
    pub fn unfit(&mut self, line: usize, what: &str) {
        let what = format!("a figure includes this, and WebGL 2 has no equivalent of {what}");
        self.fault(line, what, "cut the figure's shader at another anchor");
    }
}

/// A file, or the part at its anchor, with line numbers preserved.
fn cut(read: &dyn Fn(&str) -> Option<String>, path: &str) -> Option<String> {
    let Some((file, name)) = path.split_once('#') else { return read(path) };
    let text = read(file)?;
    let anchor = parts(file, &text).ok()?.into_iter().find(|anchor| anchor.name == name)?;
    let kept = |(index, line)| if anchor.lines.contains(&index) { line } else { "" };
    Some(text.lines().enumerate().map(kept).collect::<Vec<_>>().join("\n"))
}

/// The end of the statement that begins here; `None` if it declares several variables.
pub fn end(tokens: &[Token]) -> Option<usize> {
    let mut depth = 0;
    for (at, token) in tokens.iter().enumerate() {
        match &*token.text {
            "(" | "[" => depth += 1,
            ")" | "]" => depth -= 1,
            "," if depth == 0 => return None,
            ";" if depth == 0 => return Some(at),
            _ => {}
        }
    }
    None
}

/// The tokens of a line.
fn tokens(text: &str, line: usize) -> Vec<Token> {
    let mut found = Vec::new();
    let mut rest = text.trim_start();
    while let Some(first) = rest.chars().next() {
        let part = |c: char| c.is_alphanumeric() || c == '_' || c == '.';
        let number = first.is_ascii_digit()
            || first == '.' && rest[1..].starts_with(|c: char| c.is_ascii_digit());
        let length = if number {
            // The sign of an exponent belongs to its number.
            let mut last = ' ';
            let ends = |c: char| {
                let exponent = ['e', 'E'].contains(&last) && ['+', '-'].contains(&c);
                last = c;
                !(part(c) || exponent)
            };
            rest.find(ends).unwrap_or(rest.len())
        } else if first.is_alphabetic() || first == '_' {
            rest.find(|c| !part(c) || c == '.').unwrap_or(rest.len())
        } else {
            let sign = SIGNS.iter().find(|sign| rest.starts_with(**sign));
            sign.map(|sign| sign.len()).unwrap_or(first.len_utf8())
        };
        found.push(Token { text: rest[..length].to_owned(), line });
        rest = rest[length..].trim_start();
    }
    found
}
