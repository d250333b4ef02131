//! A hint for an undeclared name: the file of `common/` that declares it.

use std::fs;

use super::folders;

/// The extension for tracing rays and querying hits.
const RAY_TRACING: &str = "GL_EXT_ray_tracing";

/// For a compiler's message about an unknown name, the missing part: the extension, or a file beside the shader or
/// in `common/` that declares the name and is not included before that line. `message` begins with
/// `file:line: `, and `path` is the shader's own.
pub fn hint(path: &str, message: &str, text: &str) -> Option<String> {
    let (place, what) = message.split_once(": ")?;
    // A missing member is in no other file: its structure has been found.
    if what.contains("no such field") {
        return None;
    }
    let named = what.split('\'').nth(1).filter(|name| !name.is_empty());
    let found = line(path, place, text);
    let names: Vec<&str> = match named {
        Some(name) => vec![name],
        // "syntax error, unexpected IDENTIFIER" does not say which.
        None => words(found?.1).collect(),
    };
    let before = found.map_or(text, |(before, _)| before);
    if !text.contains(RAY_TRACING) && names.iter().any(|name| name.ends_with("EXT")) {
        return Some(format!("the shader lacks the line `#extension {RAY_TRACING} : require`"));
    }
    let own = path.rsplit_once('/').map_or("", |(folder, _)| folder);
    let files: Vec<_> = [own, "common"].into_iter().flat_map(files_in).collect();
    // A name that the shader has declared before is not the missing one.
    let unknown = names.into_iter().filter(|name| !declares(before, name));
    let mut found = unknown.flat_map(|name| {
        let is_new = |file: &str| !before.contains(&format!("#line 1 \"{file}\""));
        let declares = |(file, text): &&(String, String)| is_new(file) && declares(text, name);
        files.iter().find(declares).map(|(file, _)| (name, file))
    });
    let (name, file) = found.next()?;
    Some(format!("{name} stands in {file}, which is not included before this line"))
}

/// The files of a folder below `shaders/` that are meant to be included, by path, with their text.
fn files_in(folder: &str) -> Vec<(String, String)> {
    let entries = folders().into_iter().filter_map(|above| fs::read_dir(above.join(folder)).ok());
    let mut files: Vec<_> = entries
        .flatten()
        .filter_map(|entry| {
            let entry = entry.ok()?;
            let file = format!("{folder}/{}", entry.file_name().to_str()?);
            file.ends_with(".glsl").then_some(())?;
            Some((file, fs::read_to_string(entry.path()).ok()?))
        })
        .collect();
    files.sort();
    files
}

/// The line of a shader's whole text at `file:line`, and the text before it.
fn line<'a>(path: &str, place: &str, text: &'a str) -> Option<(&'a str, &'a str)> {
    let (file, number) = place.rsplit_once(':')?;
    let number: usize = number.parse().ok()?;
    let (mut at, mut is_here) = (1, file == path);
    let mut begin = 0;
    for whole in text.split_inclusive('\n') {
        let (before, line) = (&text[..begin], whole.trim_end());
        begin += whole.len();
        if let Some(rest) = line.strip_prefix("#line ") {
            let (next, name) = rest.split_once(' ')?;
            (at, is_here) = (next.parse().ok()?, name.trim_matches('"') == file);
            continue;
        }
        if is_here && at == number {
            return Some((before, line));
        }
        at += 1;
    }
    None
}

fn words(line: &str) -> impl Iterator<Item = &str> {
    let code = line.split("//").next().unwrap_or_default();
    code.split(|c: char| !c.is_alphanumeric() && c != '_').filter(|word| !word.is_empty())
}

/// True if a file declares a structure, a buffer, a function, a macro or a constant of that name.
fn declares(text: &str, name: &str) -> bool {
    text.lines().any(|line| {
        let words: Vec<&str> = words(line).collect();
        let after = |word: &str| {
            words.iter().position(|w| *w == word).is_some_and(|at| words.get(at + 1) == Some(&name))
        };
        let is_function = !line.starts_with(' ')
            && words.get(1) == Some(&name)
            && line.contains(&format!("{name}("));
        after("struct")
            || after("buffer")
            || after("define")
            || is_function
            || line.starts_with("const ") && words.get(2) == Some(&name)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_member_is_sought_in_no_other_file() {
        let text = "#extension GL_EXT_ray_tracing : require\nuint r = push.random;\n";
        let message = |what: &str| format!("02_basic/camera.rgen:2: 'random' : {what}");
        let found = |what: &str| hint("02_basic/camera.rgen", &message(what), text);
        assert_eq!(found("no such field in structure 'push'"), None);
        assert!(found("undeclared identifier").is_some_and(|hint| hint.contains("random.glsl")));
    }

    #[test]
    fn a_line_is_found_behind_includes() {
        let text = "#version 460\n#line 2 \"a.rgen\"\nb\n#line 1 \"c.glsl\"\nd\n#line 3 \"a.rgen\"\ne\nf\n";
        let found = |place| line("a.rgen", place, text).map(|(_, line)| line);
        assert_eq!(found("a.rgen:4"), Some("f"));
        assert_eq!(found("c.glsl:1"), Some("d"));
        assert_eq!(found("c.glsl:9"), None);
        assert!(line("a.rgen", "a.rgen:4", text).unwrap().0.ends_with("e\n"));
    }

    #[test]
    fn a_declaration_is_no_use() {
        let text = "struct Hit {\n    vec3 position;\n};\nvec3 sky(vec3 d) {\n    return other(d);\n}\nconst float PI = 3.0;\n";
        assert_eq!(
            ["Hit", "sky", "PI", "position", "other"].map(|name| declares(text, name)),
            [true, true, true, false, false]
        );
    }
}
