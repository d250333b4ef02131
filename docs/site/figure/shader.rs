//! Translates shaders of the chapters to GLSL ES 3.00, for WebGL 2.
//!
//! A figure's shader includes files of `shaders/`, whole or only the part at an anchor:
//! `#include "common/sphere.glsl#sphere_stable"`. [`HEAD`], [`LACKS`] and [`Translator`] contain the
//! differences between the languages. Everything else is a fault with its file and line.

use std::collections::{BTreeMap, BTreeSet};

use manuscript::fault::Fault;

use super::source::{Source, Token, end};

/// The text before each shader. GLSL ES has no `precise` and no `fma`. `keep` replaces `precise`: a compiler
/// that does not know that `kept` is 0 cannot move an operation across it. The shaders use `fma` only if
/// FUSED is not 0, and it is 0 here.
const HEAD: &str = "\
#version 300 es
precision highp float;
precision highp int;
uniform uint kept;
#define fma(a, b, c) ((a) * (b) + (c))
float keep(float a) { return uintBitsToFloat(floatBitsToUint(a) ^ kept); }
vec2 keep(vec2 a) { return uintBitsToFloat(floatBitsToUint(a) ^ kept); }
vec3 keep(vec3 a) { return uintBitsToFloat(floatBitsToUint(a) ^ kept); }
vec4 keep(vec4 a) { return uintBitsToFloat(floatBitsToUint(a) ^ kept); }
";

/// The types supported by `keep`.
const KEPT: [&str; 4] = ["float", "vec2", "vec3", "vec4"];

/// Words without an equivalent in GLSL ES, and their meaning.
const LACKS: [(&str, &str); 21] = [
    ("bitCount", "a function of later versions"),
    ("bitfieldExtract", "a function of later versions"),
    ("bitfieldInsert", "a function of later versions"),
    ("bitfieldReverse", "a function of later versions"),
    ("buffer", "a buffer"),
    ("buffer_reference", "an address"),
    ("constant_id", "a specialization constant"),
    ("double", "a float of 64 bits"),
    ("dvec2", "floats of 64 bits"),
    ("dvec3", "floats of 64 bits"),
    ("dvec4", "floats of 64 bits"),
    ("findLSB", "a function of later versions"),
    ("findMSB", "a function of later versions"),
    ("frexp", "a function of later versions"),
    ("imulExtended", "a function of later versions"),
    ("ldexp", "a function of later versions"),
    ("shared", "memory of a work group"),
    ("uaddCarry", "a function of later versions"),
    ("umulExtended", "a function of later versions"),
    ("usubBorrow", "a function of later versions"),
    ("push_constant", "push constants"),
];

/// Operators that give a whole number the type of their other operand.
const OPERATORS: [&str; 18] = [
    "=", "==", "!=", "<", ">", "<=", ">=", "+", "-", "*", "/", "%", "&", "|", "^", "+=", "-=", "*=",
];

/// The shader `file` with everything it includes. `read` returns the contents of a file, given from the
/// project's root.
///
/// # Errors
/// The parts without an equivalent, each with its file and line.
pub fn translated(read: &dyn Fn(&str) -> Option<String>, file: &str) -> Result<String, Vec<Fault>> {
    let mut translator = Translator { source: Source::of(read, file), made: HEAD.to_owned() };
    let tokens = translator.keep();
    translator.write(&tokens);
    if translator.source.faults.is_empty() {
        Ok(translator.made)
    } else {
        Err(translator.source.faults)
    }
}

struct Translator {
    source: Source,
    made: String,
}

impl Translator {
    /// Checks all words, and replaces `precise` by `keep`.
    fn keep(&mut self) -> Vec<Token> {
        let tokens = std::mem::take(&mut self.source.tokens);
        let mut made = Vec::new();
        let text = |at: usize| tokens.get(at).map_or("", |token: &Token| &*token.text);
        // The variables to keep, each with the depth of braces of its scope.
        let mut kept: BTreeMap<&str, usize> = BTreeMap::new();
        let (mut depth, mut at) = (0, 0);
        // The end of a kept statement, and the brackets open there.
        let mut closes = (0, "");
        while at < tokens.len() {
            let (word, line) = (text(at), tokens[at].line);
            if let Some((_, what)) = LACKS.iter().find(|(lacked, _)| *lacked == word) {
                self.source.unfit(line, &format!("'{word}', {what}"));
            } else if word.ends_with("EXT") || word == "layout" {
                self.source.unfit(line, &format!("'{word}'"));
            }
            match word {
                "{" => depth += 1,
                "}" => {
                    depth = depth.max(1) - 1;
                    kept.retain(|_, lives| *lives <= depth);
                }
                _ => {}
            }
            let mut say = |text: &str| made.push(Token { text: text.to_owned(), line });
            let before = at.checked_sub(1).map_or(";", text);
            let begins = [";", "{", "}", ")", "else"].contains(&before);
            if word == "precise" {
                let fits = KEPT.contains(&text(at + 1)) && text(at + 3) == "=";
                let Some(end) = end(&tokens[at..]).filter(|_| fits) else {
                    self.source.unfit(line, "this form of 'precise'");
                    at += 1;
                    continue;
                };
                [text(at + 1), text(at + 2), "=", "keep", "("].into_iter().for_each(say);
                kept.insert(text(at + 2), depth);
                closes = (at + end, ")");
                at += 4;
            } else if begins && kept.contains_key(word) {
                let operator = text(at + 1)
                    .strip_suffix('=')
                    .filter(|sign| ["", "+", "-", "*", "/"].contains(sign));
                let Some((operator, end)) = operator.zip(end(&tokens[at..])) else {
                    self.source
                        .unfit(line, &format!("this change of '{word}', which is 'precise'"));
                    at += 1;
                    continue;
                };
                [word, "=", "keep", "("].into_iter().for_each(&mut say);
                if !operator.is_empty() {
                    [word, operator, "("].into_iter().for_each(say);
                }
                closes = (at + end, if operator.is_empty() { ")" } else { "))" });
                at += 2;
            } else {
                if at == closes.0 {
                    say(closes.1);
                }
                say(word);
                at += 1;
            }
        }
        made
    }

    /// Writes the tokens, with `u` after whole numbers that must be unsigned.
    fn write(&mut self, tokens: &[Token]) {
        let text = |at: Option<usize>| {
            at.and_then(|at| tokens.get(at)).map_or("", |token: &Token| &*token.text)
        };
        let mut unsigned: BTreeSet<&str> = BTreeSet::new();
        // True while an unsigned variable is being declared; the values it is chosen from are also unsigned.
        let mut declares = false;
        // The place of the last unsigned number: in `i % 8 == 7` the 8 makes the 7 unsigned.
        let mut number = None;
        for (at, Token { text: word, .. }) in tokens.iter().enumerate() {
            let [last, next] = [at.checked_sub(1), Some(at + 1)].map(text);
            match &**word {
                "uint" => {
                    unsigned.insert(next);
                    declares = text(Some(at + 2)) == "=";
                }
                ";" => declares = false,
                "int" => drop(unsigned.remove(next)),
                _ => {}
            }
            // `a - -b` must not become `a--b`.
            let joins = |c: char| c.is_alphanumeric() || c == '_';
            let sign = |c: char| "+-*/<>=!&|^%".contains(c);
            if let (Some(end), Some(start)) = (self.made.chars().last(), word.chars().next())
                && (joins(end) && joins(start) || sign(end) && sign(start))
            {
                self.made.push(' ');
            }
            self.made.push_str(word);
            let whole = word.starts_with("0x") || word.chars().all(|c| c.is_ascii_digit());
            let second = at.checked_sub(2);
            let behind = unsigned.contains(text(second)) || second.is_some() && second == number;
            let left = OPERATORS.contains(&last) && behind;
            let right = OPERATORS.contains(&next) && unsigned.contains(text(Some(at + 2)));
            let chosen = declares && ["?", ":"].contains(&last);
            if whole && !word.ends_with('u') && (left || right || chosen) {
                self.made.push('u');
                number = Some(at);
            }
            if [";", "{", "}"].contains(&&**word) {
                self.made.push('\n');
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &str) -> Result<String, String> {
        let read = |path: &str| {
            let files = [
                ("docs/f.frag", text),
                ("shaders/a.glsl", "float no;\n// ANCHOR: b\nfloat b; // so\n// ANCHOR_END: b\n"),
                ("shaders/c.glsl", "\n\ndouble wide;\n"),
            ];
            Some(files.iter().find(|(file, _)| *file == path)?.1.to_owned())
        };
        let lines =
            |faults: Vec<Fault>| faults.iter().map(Fault::to_string).collect::<Vec<_>>().join("\n");
        let made = translated(&read, "docs/f.frag").map_err(lines)?;
        Ok(made.strip_prefix(HEAD).unwrap().replace('\n', ""))
    }

    #[test]
    fn precise_is_kept_where_it_stands_and_where_its_variable_changes() {
        let text = "float f(float a) {\n precise float s = a\n + 1.0e-5;\n s += a - -a;\n\
                    for (int i = 0; i < 3; i++) { s = g(s, a); }\n return s; }\n\
                    void g() { s = 1.0; }";
        let made = "float f(float a){float s=keep(a+1.0e-5);s=keep(s+(a- -a));\
                    for(int i=0;i<3;i++){s=keep(g(s,a));}return s;}void g(){s=1.0;}";
        assert_eq!(of(text).unwrap(), made);
    }

    #[test]
    fn whole_numbers_beside_unsigned_ones_are_unsigned() {
        let text = "const uint A = 0; for (uint i = 0; i < 3; i += 2) { b = i % 2 == 0 || 7 != i; }\
                    int i = 0; i = i + 1; uint h = 0x10; uint c = x == y ? 0 : z ? 1 : 2; int d = x ? 0 : 1;";
        let made = "const uint A=0u;for(uint i=0u;i<3u;i+=2u){b=i%2u==0u||7u!=i;}\
                    int i=0;i=i+1;uint h=0x10u;uint c=x==y?0u:z?1u:2u;int d=x?0:1;";
        assert_eq!(of(text).unwrap(), made);
    }

    #[test]
    fn files_are_cut_at_anchors_and_conditions_followed() {
        let text = "#include \"a.glsl#b\"\n#ifndef X\n#define X 0\n#endif\n#ifdef Y\n#extension y\n\
                    double y;\n#else\nint z;\n#endif\n";
        assert_eq!(of(text).unwrap(), "float b;#define X 0int z;");
    }

    #[test]
    fn what_does_not_fit_is_named_with_file_and_line() {
        let lacked = |what: &str| {
            format!("a figure includes this, and WebGL 2 has no equivalent of {what}; ")
        };
        let cases = [
            (
                "\n#include \"c.glsl\"\n",
                "shaders/c.glsl:3: ",
                lacked("'double', a float of 64 bits"),
            ),
            (
                "\nuint a = uaddCarry(b, c, d);",
                "docs/f.frag:2: ",
                lacked("'uaddCarry', a function"),
            ),
            ("layout(set = 0) x", "docs/f.frag:1: ", lacked("'layout'")),
            ("precise float a;", "docs/f.frag:1: ", lacked("this form of 'precise'")),
            (
                "precise float a = 1.0, b = 2.0;",
                "docs/f.frag:1: ",
                lacked("this form of 'precise'"),
            ),
            ("precise mat3 a = b;", "docs/f.frag:1: ", lacked("this form of 'precise'")),
            (
                "precise vec2 a = b;\na.x = 1.0;",
                "docs/f.frag:2: ",
                lacked("this change of 'a', which"),
            ),
            ("\n\n#version 460", "docs/f.frag:3: ", lacked("#version")),
            (
                "#include \"a.glsl#c\"",
                "docs/f.frag:1: ",
                "there is no file or no anchor \"a".to_owned(),
            ),
        ];
        for (text, place, what) in cases {
            let found = of(text).unwrap_err();
            let expected = format!("{place}{what}");
            let expected = expected.trim_end_matches("; ");
            assert!(
                found.starts_with(expected) && found.lines().count() == 1,
                "{expected}: {found}"
            );
        }
    }
}
