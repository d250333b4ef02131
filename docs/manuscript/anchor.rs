//! Named parts of a source file: its items, and the parts between the comment lines `// ANCHOR: name` and `//
//! ANCHOR_END: name`.
//!
//! A function, structure or `impl` is found by its name, so an anchor is only needed for a part of one. The
//! form is mdBook's; unlike in mdBook, a missing anchor is an error.

use std::ops::Range;

use crate::fault::Fault;

/// A named part.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Anchor {
    /// Its name.
    pub name: String,
    /// Its lines, from 0, without the two comments.
    pub lines: Range<usize>,
}

enum Mark<'a> {
    Start(&'a str),
    End(&'a str),
}

fn mark(line: &str) -> Option<Mark<'_>> {
    let line = line.trim();
    let comment = line.strip_prefix("//").or_else(|| line.strip_prefix('#'))?.trim_start();
    let start = comment.strip_prefix("ANCHOR:").map(|name| Mark::Start(name.trim()));
    start.or_else(|| comment.strip_prefix("ANCHOR_END:").map(|name| Mark::End(name.trim())))
}

/// True if the line only marks the beginning or end of an anchor.
pub fn is_mark(line: &str) -> bool {
    mark(line).is_some()
}

/// All anchors of a file, in the order of their beginnings.
///
/// # Errors
/// If a name is used twice, or one of the two comments is missing.
pub fn anchors(file: &str, text: &str) -> Result<Vec<Anchor>, Fault> {
    let mut found: Vec<Anchor> = Vec::new();
    let mut open: Vec<usize> = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let fault = |what: String, remedy: &str| Err(Fault::new(file, index + 1, what, remedy));
        match mark(line) {
            Some(Mark::Start(name)) => {
                if let Some(first) = found.iter().find(|anchor| anchor.name == name) {
                    let what = format!("anchor '{name}' begins a second time");
                    return fault(
                        what,
                        &format!("rename it or the one in line {}", first.lines.start),
                    );
                }
                open.push(found.len());
                found.push(Anchor { name: name.to_owned(), lines: index + 1..index + 1 });
            }
            Some(Mark::End(name)) => {
                let Some(at) = open.iter().position(|&i| found[i].name == name) else {
                    let what = format!("anchor '{name}' ends but is not open");
                    return fault(what, "add its ANCHOR line or remove this one");
                };
                found[open.remove(at)].lines.end = index;
            }
            None => {}
        }
    }
    if let Some(&first) = open.first() {
        let Anchor { name, lines } = &found[first];
        let what = format!("anchor '{name}' does not end");
        return Err(Fault::new(file, lines.start, what, format!("add // ANCHOR_END: {name}")));
    }
    Ok(found)
}

/// All parts of a file: its anchors, and the items without an anchor of the same name, the first of each
/// name.
///
/// # Errors
/// As [`anchors`].
pub fn parts(file: &str, text: &str) -> Result<Vec<Anchor>, Fault> {
    let mut found = anchors(file, text)?;
    let lines: Vec<&str> = text.lines().collect();
    for (index, line) in lines.iter().enumerate() {
        let name = if file.ends_with(".rs") { rust_item(line) } else { glsl_item(line) };
        let Some(name) = name.filter(|name| found.iter().all(|part| part.name != *name)) else {
            continue;
        };
        let indent = line.len() - line.trim_start().len();
        let is_beside = |line: &&&str| line.len() - line.trim_start().len() == indent;
        let above = lines[..index].iter().rev().take_while(|line| {
            let text = line.trim_start();
            is_beside(line) && (text.starts_with("//") || text.starts_with("#[")) && !is_mark(line)
        });
        let closes = |line: &&str| {
            let text = line.trim_start();
            is_beside(&line)
                && (text.starts_with('}') || text.starts_with([')', ']']) && text.ends_with(';'))
        };
        let whole = line.ends_with([';', '}']);
        let below = lines[index + 1..].iter().position(closes).filter(|_| !whole);
        let end = below.map_or(index + 1, |below| index + below + 2);
        found.push(Anchor { name: name.to_owned(), lines: index - above.count()..end });
    }
    Ok(found)
}

/// The name of the item that begins on a line of Rust: the trait's name for its `impl`, otherwise the type's.
fn rust_item(line: &str) -> Option<&str> {
    let mut rest = line.trim_start();
    if let Some(visible) = rest.strip_prefix("pub") {
        rest =
            visible.strip_prefix('(').and_then(|r| Some(r.split_once(')')?.1)).unwrap_or(visible);
        rest = rest.trim_start();
    }
    for word in ["const fn ", "unsafe fn ", "async fn "] {
        rest = rest.strip_prefix(word).map_or(rest, |_| &rest[word.len() - 3..]);
    }
    let kinds = [
        "fn ",
        "struct ",
        "enum ",
        "trait ",
        "mod ",
        "type ",
        "const ",
        "static ",
        "macro_rules! ",
    ];
    if let Some(rest) = kinds.iter().find_map(|kind| rest.strip_prefix(kind)) {
        return word(rest);
    }
    let rest = rest.strip_prefix("impl")?;
    let rest = match rest.strip_prefix('<') {
        Some(generics) => generics.split_once("> ")?.1,
        None => rest.strip_prefix(' ')?,
    };
    word(rest)
}

/// The name of the function or structure that begins on a line of GLSL.
fn glsl_item(line: &str) -> Option<&str> {
    if let Some(rest) = line.strip_prefix("struct ") {
        return word(rest);
    }
    let (head, _) = line.split_once('(')?;
    let (kind, name) = head.rsplit_once(' ')?;
    let is_type = kind.split(' ').all(|word| word.chars().all(|c| c.is_alphanumeric() || c == '_'));
    let is_call = kind.is_empty() || line.ends_with(';') || kind == "return";
    (is_type && !is_call && line.starts_with(char::is_alphabetic)).then(|| word(name)).flatten()
}

/// The identifier at the beginning of a text.
fn word(text: &str) -> Option<&str> {
    let end = text.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(text.len());
    Some(&text[..end]).filter(|word| !word.is_empty())
}

/// The text of a part, or of the whole file, without marks and common indentation.
pub fn part(text: &str, lines: Option<Range<usize>>) -> String {
    let all: Vec<&str> = text.lines().collect();
    let lines = &all[lines.unwrap_or(0..all.len())];
    let kept: Vec<&str> = lines.iter().copied().filter(|line| !is_mark(line)).collect();
    let blank = |line: &&&str| line.trim().is_empty();
    let first = kept.iter().take_while(blank).count();
    let last = kept.len() - kept[first..].iter().rev().take_while(blank).count();
    let kept = &kept[first..last];
    let indent = |line: &&str| line.len() - line.trim_start_matches(' ').len();
    let shared = kept.iter().filter(|line| !blank(line)).map(indent).min().unwrap_or(0);
    kept.iter().map(|line| line.get(shared..).unwrap_or("").to_owned() + "\n").collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "\
a
    // ANCHOR: outer
    b

      // ANCHOR: inner
      ä ← wide
      // ANCHOR_END: inner
    // ANCHOR_END: outer
c
";

    #[test]
    fn parts_are_dedented_and_lose_inner_marks() {
        let found = anchors("f", TEXT).unwrap();
        assert_eq!(part(TEXT, Some(found[0].lines.clone())), "b\n\n  ä ← wide\n");
        assert_eq!(part(TEXT, Some(found[1].lines.clone())), "ä ← wide\n");
        assert_eq!(part("\n\nx\n\n", None), "x\n");
        assert_eq!(part("", None), "");
    }

    #[test]
    fn items_are_found_by_their_names() {
        let of = |file: &str, text: &str, name: &str| {
            let found = parts(file, text).unwrap();
            let found = found.iter().find(|part| part.name == name);
            found.map(|found| part(text, Some(found.lines.clone())))
        };
        let rust = "/// A.\n#[x]\npub struct A {\n    a: u32,\n}\n\nimpl B for A {\n    // C.\n    \
                    pub const fn c(\n        self,\n    ) {\n        d();\n    }\n}\n\nconst E: u32 = 1;\n";
        assert_eq!(
            of("a.rs", rust, "A").unwrap(),
            "/// A.\n#[x]\npub struct A {\n    a: u32,\n}\n"
        );
        assert_eq!(
            of("a.rs", rust, "c").unwrap(),
            "// C.\npub const fn c(\n    self,\n) {\n    d();\n}\n"
        );
        assert_eq!(of("a.rs", rust, "B").unwrap().lines().count(), 8);
        assert_eq!(of("a.rs", rust, "E").unwrap(), "const E: u32 = 1;\n");
        assert_eq!(of("a.rs", rust, "d"), None);
        let glsl = "// F.\nvec2 f(float a,\n       float b) {\n    return g(a);\n}\nstruct G {\n    float x;\n};\n";
        assert_eq!(of("a.glsl", glsl, "f").unwrap().lines().count(), 5);
        assert_eq!(of("a.glsl", glsl, "G").unwrap(), "struct G {\n    float x;\n};\n");
        assert_eq!(of("a.glsl", glsl, "g"), None);
        // An anchor takes precedence over an item of the same name.
        let both = format!("// ANCHOR: f\n1\n// ANCHOR_END: f\n{glsl}");
        assert_eq!(of("a.glsl", &both, "f").unwrap(), "1\n");
    }

    #[test]
    fn anchors_may_overlap_and_stand_in_other_comments() {
        let text = "# ANCHOR: a\n1\n# ANCHOR: b\n2\n# ANCHOR_END: a\n3\n# ANCHOR_END: b\n";
        let found = anchors("f", text).unwrap();
        let texts: Vec<String> =
            found.iter().map(|anchor| part(text, Some(anchor.lines.clone()))).collect();
        assert_eq!(texts, ["1\n2\n", "2\n3\n"]);
    }

    #[test]
    fn wrong_marks_are_named_with_their_line() {
        let cases = [
            ("x\n// ANCHOR: a\n", "f:2: anchor 'a' does not end; add // ANCHOR_END: a"),
            ("// ANCHOR_END: a\n", "f:1: anchor 'a' ends but is not open"),
            ("// ANCHOR: a\n// ANCHOR_END: a\n// ANCHOR: a\n", "f:3: anchor 'a' begins a second"),
        ];
        for (text, expected) in cases {
            let fault = anchors("f", text).unwrap_err().to_string();
            assert!(fault.starts_with(expected), "{fault}");
        }
    }
}
