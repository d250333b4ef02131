//! What of a source file has an effect: neither comments nor blanks, nor what only tests see.

use proc_macro2::{Delimiter, TokenStream, TokenTree};

/// The part of a file that can change a picture or a figure; the extension says what is in it.
pub fn of(path: &str, text: &str) -> String {
    match path.rsplit_once('.').map_or("", |(_, extension)| extension) {
        "rs" => rust(text),
        "obj" | "mtl" => lines(text, |line| line.split('#').next().unwrap_or_default()),
        "json" => text.to_owned(),
        "toml" => shader(&without_packages(text)),
        _ => shader(text),
    }
}

/// A manifest without what its dependencies are called elsewhere: the code of this package does not know it.
fn without_packages(text: &str) -> String {
    let own = |line: &str| match line.split_once("{ package = \"") {
        Some((name, rest)) => match rest.split_once("\", ") {
            Some((_, rest)) => format!("{name}{{ {rest}\n"),
            None => format!("{line}\n"),
        },
        None => format!("{line}\n"),
    };
    text.lines().map(own).collect()
}

/// GLSL without comments and `#line`, each line's blanks made one.
pub fn shader(text: &str) -> String {
    let mut code = String::new();
    let mut rest = text;
    while let Some((before, comment)) = rest.split_once("/*") {
        // In a line's own comment it begins none.
        let line = before.rsplit('\n').next().unwrap_or_default();
        code.push_str(before);
        rest = match line.contains("//") {
            true => comment,
            false => comment.split_once("*/").map_or("", |(_, rest)| rest),
        };
    }
    code.push_str(rest);
    lines(&code, |line| match line.starts_with("#line ") {
        true => "",
        false => line.split("//").next().unwrap_or_default(),
    })
}

fn lines(text: &str, effect: impl Fn(&str) -> &str) -> String {
    let words = |line: &str| effect(line).split_whitespace().collect::<Vec<_>>().join(" ");
    let lines = text.lines().map(words).filter(|line| !line.is_empty());
    lines.map(|line| line + "\n").collect()
}

/// Rust's tokens without those of comments, of `#[ignore]` and of what `#[cfg(test)]` stands before; the
/// text itself, if it is no Rust.
fn rust(text: &str) -> String {
    let tokens = text.parse().map(tokens);
    tokens.map_or_else(|_| text.to_owned(), |tokens| tokens.join(" "))
}

fn tokens(stream: TokenStream) -> Vec<String> {
    let mut found = Vec::new();
    let mut rest = stream.into_iter().peekable();
    while let Some(token) = rest.next() {
        let group = match token {
            TokenTree::Punct(mark) if mark.as_char() == '#' => {
                let is_inner = |token: &TokenTree| matches!(token, TokenTree::Punct(mark) if mark.as_char() == '!');
                let inner = rest.next_if(is_inner);
                match rest.next() {
                    Some(TokenTree::Group(group)) => match attribute(&group.stream()) {
                        Attribute::Effect => {
                            found.push("#".to_owned());
                            found.extend(inner.map(|mark| mark.to_string()));
                            group
                        }
                        Attribute::None => continue,
                        Attribute::Test => {
                            // The item ends with its braces, or with a semicolon.
                            let is_end = |token: &TokenTree| match token {
                                TokenTree::Group(group) => group.delimiter() == Delimiter::Brace,
                                TokenTree::Punct(mark) => mark.as_char() == ';',
                                _ => false,
                            };
                            rest.find(is_end);
                            continue;
                        }
                    },
                    // In a macro's pattern it begins no attribute.
                    other => {
                        found.push("#".to_owned());
                        found.extend(inner.into_iter().chain(other).map(|token| token.to_string()));
                        continue;
                    }
                }
            }
            TokenTree::Group(group) => group,
            other => {
                found.push(other.to_string());
                continue;
            }
        };
        let (open, close) = match group.delimiter() {
            Delimiter::Parenthesis => ("(", ")"),
            Delimiter::Brace => ("{", "}"),
            Delimiter::Bracket => ("[", "]"),
            Delimiter::None => ("", ""),
        };
        found.push(open.to_owned());
        found.extend(tokens(group.stream()));
        found.push(close.to_owned());
    }
    found
}

/// What an attribute does.
enum Attribute {
    /// It changes what the program does, or may.
    Effect,
    /// It is a comment, or says when a test runs.
    None,
    /// It leaves what follows to tests.
    Test,
}

fn attribute(words: &TokenStream) -> Attribute {
    match words.to_string().split([' ', '=', '(']).next() {
        Some("doc" | "ignore") => Attribute::None,
        Some("cfg") if words.to_string().replace(' ', "") == "cfg(test)" => Attribute::Test,
        _ => Attribute::Effect,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_dependency_is_called_elsewhere_has_no_effect() {
        let of = |dependency: &str| of("Cargo.toml", &format!("[dependencies]\n{dependency}\n"));
        let plain = of("common = { path = \"../common\" }");
        assert_eq!(of("common = { package = \"raybook\", path = \"../common\" }"), plain);
        assert_ne!(of("common = { package = \"raybook\", path = \"../other\" }"), plain);
    }

    #[test]
    fn comments_blanks_and_tests_have_no_effect_in_rust() {
        let short = "use a::b;\n#[test]\nfn f() { g(\"// no comment\", 'a'); }";
        let long = "//! A.\nuse a::b; // c\n\n/// D.\n#[test]\n#[ignore = \"slow\"]\nfn f() {\n    /* e */ \
                    g(\n        \"// no comment\", 'a');\n}\n#[cfg(test)]\nmod tests {\n    use x;\n}\n";
        assert_eq!(rust(short), rust(long));
        for other in ["// x", "//  no comment", "no comment"] {
            assert_ne!(rust(short), rust(&short.replace("// no comment", other)));
        }
        assert_ne!(rust(short), rust(&short.replace("#[test]", "#[inline]")));
        assert_ne!(rust("a(b)"), rust("a[b]"));
    }

    #[test]
    fn comments_and_blanks_have_no_effect_in_a_shader() {
        let short = "#version 460\nfloat a = 1.0 / 2.0;\n#line 7 \"b.glsl\"\nint b;\n";
        let long =
            "// A.\n#version 460\n\n  float  a = 1.0 / 2.0; // a /* half\n/* two\nlines */int b;\n";
        assert_eq!(shader(short), shader(long));
        assert_ne!(shader(short), shader(&short.replace("1.0 /", "1.0 *")));
    }
}
