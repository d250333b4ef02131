//! Syntax colours, computed when the site is built: no script has to run in the reader's browser, and GLSL is
//! supported.

/// The features of a language that are coloured.
struct Language {
    line_comments: &'static [&'static str],
    block_comments: bool,
    /// The keywords, separated by blanks.
    keywords: &'static str,
    /// True if a line that begins with `#` is a preprocessor directive.
    directives: bool,
    /// True if `'a` may be a lifetime, and `r#"…"#` a string.
    rust: bool,
    /// True if numbers and types have colours of their own.
    words: bool,
}

const RUST: Language = Language {
    line_comments: &["//"],
    block_comments: true,
    keywords: "as async await break const continue crate dyn else enum extern false fn for if impl \
        in let loop match mod move mut pub ref return self Self static struct super trait \
        true type unsafe use where while",
    directives: false,
    rust: true,
    words: true,
};

const GLSL: Language = Language {
    line_comments: &["//"],
    block_comments: true,
    keywords: "bool break buffer coherent const constant_id continue discard do double else false \
        flat float for hitAttributeEXT if in inout int layout out precise rayPayloadEXT \
        rayPayloadInEXT callableDataEXT callableDataInEXT readonly restrict return \
        shaderRecordEXT struct switch case default true uint uniform void while writeonly",
    directives: true,
    rust: false,
    words: true,
};

const SHELL: Language = Language {
    line_comments: &["#"],
    block_comments: false,
    keywords: "",
    directives: false,
    rust: false,
    words: false,
};

/// The lines of a text as HTML, coloured; no tag spans two lines.
pub fn lines(language: &str, text: &str) -> Vec<String> {
    match language {
        "rust" => by_word(&RUST, text),
        "glsl" => by_word(&GLSL, text),
        "sh" | "toml" => by_word(&SHELL, text),
        "diff" => text.lines().map(diff_line).collect(),
        _ => text.lines().map(escaped).collect(),
    }
}

/// A text escaped for HTML.
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

fn diff_line(line: &str) -> String {
    let class = match line.as_bytes().first() {
        _ if line.starts_with("+++") || line.starts_with("---") => "hljs-comment",
        Some(b'+') => "hljs-addition",
        Some(b'-') => "hljs-deletion",
        Some(b'@') => "hljs-comment",
        _ => return escaped(line),
    };
    painted(class, line)
}

fn painted(class: &str, text: &str) -> String {
    if class.is_empty() || text.trim().is_empty() {
        return escaped(text);
    }
    format!("<span class=\"{class}\">{}</span>", escaped(text))
}

fn by_word(language: &Language, text: &str) -> Vec<String> {
    let mut lines = vec![String::new()];
    let mut rest = text.trim_end_matches('\n');
    let mut begins = true; // nothing but blanks since the line's beginning
    while !rest.is_empty() {
        let (class, length) = token(language, rest, begins);
        let (token, after) = rest.split_at(length);
        for (index, piece) in token.split('\n').enumerate() {
            if index > 0 {
                lines.push(String::new());
            }
            let last = lines.len() - 1;
            lines[last].push_str(&painted(class, piece));
        }
        begins = if token.contains('\n') {
            token.ends_with(char::is_whitespace)
        } else {
            begins && token.trim().is_empty()
        };
        rest = after;
    }
    lines
}

/// The class and the length of the token at the start of a text.
fn token(language: &Language, text: &str, begins: bool) -> (&'static str, usize) {
    let first = text.chars().next().unwrap_or(' ');
    let to_end = |end: &str| text.find(end).unwrap_or(text.len());
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    if language.line_comments.iter().any(|mark| text.starts_with(mark)) && (first != '#' || begins)
    {
        return ("hljs-comment", to_end("\n"));
    }
    if language.block_comments && text.starts_with("/*") {
        let end = text[2..].find("*/").map_or(text.len(), |at| at + 4);
        return ("hljs-comment", end);
    }
    if begins && first == '#' && language.directives {
        let word = text[1..].find(|c: char| !is_word(c)).map_or(text.len(), |at| at + 1);
        return ("hljs-meta", word);
    }
    if first == '#' && language.rust && (text.starts_with("#[") || text.starts_with("#![")) {
        return ("hljs-meta", text.find("]\n").map_or_else(|| to_end("\n"), |at| at + 1));
    }
    if language.rust && text.starts_with("r#\"") {
        return ("hljs-string", text.find("\"#").map_or(text.len(), |at| at + 2));
    }
    if first == '"' {
        return ("hljs-string", string(text));
    }
    if language.rust && first == '\'' {
        let mut letters = text.char_indices().skip(1);
        if let Some((_, '\\')) = letters.next() {
            let end = letters.skip(1).find(|(_, c)| *c == '\'');
            return ("hljs-string", end.map_or(text.len(), |(at, _)| at + 1));
        }
        return match letters.next() {
            Some((at, '\'')) => ("hljs-string", at + 1),
            _ => ("", 1),
        };
    }
    if first.is_ascii_digit() && language.words {
        // A range or a method may follow a number: 0..5, 1.max(2).
        let mut end = text.find(|c: char| !is_word(c) && c != '.').unwrap_or(text.len());
        if let Some(range) = text[..end].find("..") {
            end = range;
        }
        return ("hljs-number", end);
    }
    if is_word(first) {
        let end = text.find(|c: char| !is_word(c)).unwrap_or(text.len());
        let word = &text[..end];
        let class = match word {
            _ if language.keywords.split(' ').any(|known| known == word) => "hljs-keyword",
            _ if !language.words => "",
            _ if first.is_uppercase() && word.chars().any(char::is_lowercase) => "hljs-type",
            _ if is_glsl_type(language, word) => "hljs-type",
            _ => "",
        };
        return (class, end);
    }
    let end = text.find(|c: char| is_word(c) || "\"'#/".contains(c)).unwrap_or(text.len());
    let end = text.find('\n').map_or(end, |line| end.min(line + 1));
    ("", end.max(first.len_utf8()))
}

/// True for `vec3`, `uvec2`, `mat4x3` and the like.
fn is_glsl_type(language: &Language, word: &str) -> bool {
    let stem = word.trim_end_matches(|c: char| c.is_ascii_digit() || c == 'x');
    language.directives
        && stem != word
        && ["vec", "ivec", "uvec", "bvec", "dvec", "u64vec", "mat", "f64vec", "dmat"]
            .contains(&stem)
}

/// The length of a string from its opening mark.
fn string(text: &str) -> usize {
    let mut escaped = false;
    for (at, c) in text.char_indices().skip(1) {
        match c {
            _ if escaped => escaped = false,
            '\\' => escaped = true,
            '"' => return at + 1,
            _ => {}
        }
    }
    text.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plain(html: &str) -> String {
        let mut text = String::new();
        let mut rest = html;
        while let Some((before, after)) = rest.split_once('<') {
            text.push_str(before);
            rest = after.split_once('>').map_or("", |(_, after)| after);
        }
        text.push_str(rest);
        let marks = [("&lt;", "<"), ("&gt;", ">"), ("&quot;", "\""), ("&amp;", "&")];
        marks.iter().fold(text, |text, (from, to)| text.replace(from, to))
    }

    #[test]
    fn nothing_is_lost_or_added() {
        let text = "#[derive(Debug)]\n/* a\n b */ fn f<'a>(x: &'a str) -> char { // \"c\"\n    '\\n' \
                    // é\n}\n\nlet s = r#\"a\"b\"#; let r = 0..5; \"a\\\"b\n c\"";
        let found = lines("rust", text);
        assert_eq!(found.iter().map(|line| plain(line)).collect::<Vec<_>>().join("\n"), text);
        assert!(found[1].contains("hljs-comment") && found[2].contains("hljs-comment"));
        assert!(found[2].contains("<span class=\"hljs-keyword\">fn</span>"));
    }

    #[test]
    fn glsl_has_directives_types_and_keywords() {
        let found = lines("glsl", "#include \"a.glsl\"\nprecise vec3 p = vec3(1.0);\n");
        assert!(found[0].starts_with("<span class=\"hljs-meta\">#include</span>"), "{}", found[0]);
        assert!(found[1].contains("<span class=\"hljs-type\">vec3</span>"), "{}", found[1]);
        assert!(found[1].contains("<span class=\"hljs-number\">1.0</span>"), "{}", found[1]);
    }

    #[test]
    fn a_shell_s_comment_begins_a_line() {
        let found = lines("sh", "# a\nrun x#y\n");
        assert!(found[0].contains("hljs-comment") && !found[1].contains("hljs-comment"));
    }
}
