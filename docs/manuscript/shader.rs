//! Shader sources: the files a shader includes, and the shaders of a chapter.

use std::collections::{BTreeMap, BTreeSet};

use crate::project::{Chapter, Project};

/// The possible extensions of a shader file, in the order in which a ray meets the stages.
pub const EXTENSIONS: [&str; 10] =
    ["rgen", "rmiss", "rchit", "rahit", "rint", "rcall", "comp", "vert", "frag", "glsl"];

/// The files a shader includes directly, from the project's root.
///
/// They are found as by the compiler: next to the file, or else below `shaders/`. Missing files are left out;
/// the compiler reports them better.
pub fn includes(project: &Project, file: &str) -> Vec<String> {
    let text = project.read(file).unwrap_or_default();
    let found = text.lines().filter_map(|line| included(line, file, |path| project.has(path)));
    found.collect()
}

/// A shader's text as it is compiled: each included file once, in place of the line that includes it, with
/// `#line` directives. `read` returns the contents of a file, given from the project's root.
pub fn spliced(read: &dyn Fn(&str) -> Option<String>, file: &str) -> String {
    fn splice(
        read: &dyn Fn(&str) -> Option<String>,
        file: &str,
        known: &mut BTreeSet<String>,
        text: &mut String,
    ) {
        if !known.insert(file.to_owned()) {
            return;
        }
        for (number, line) in (1..).zip(read(file).unwrap_or_default().lines()) {
            match included(line, file, |path| read(path).is_some()) {
                Some(path) => {
                    text.push_str(&format!("#line 1 \"{path}\"\n"));
                    splice(read, &path, known, text);
                    text.push_str(&format!("#line {} \"{file}\"\n", number + 1));
                }
                None => {
                    text.push_str(line);
                    text.push('\n');
                }
            }
        }
    }
    let (mut known, mut text) = (BTreeSet::new(), String::new());
    splice(read, file, &mut known, &mut text);
    text
}

/// The file included by a line of `file`, if it includes one.
fn included(line: &str, file: &str, is_there: impl Fn(&str) -> bool) -> Option<String> {
    let name = line.trim_start().strip_prefix("#include")?.trim().trim_matches(['"', '<', '>']);
    let folder = file.rsplit_once('/').map_or("", |(folder, _)| folder);
    [format!("{folder}/{name}"), format!("shaders/{name}")].into_iter().find(|path| is_there(path))
}

/// A chapter's own shaders, in the order of the stages.
pub fn own(project: &Project, chapter: &Chapter) -> Vec<String> {
    let mut files = project.files(&format!("shaders/{}", chapter.name));
    files.sort_by_key(|file| {
        let extension = file.rsplit_once('.').map_or("", |(_, extension)| extension);
        EXTENSIONS.iter().position(|known| *known == extension)
    });
    files
}

/// The shaders a chapter uses from elsewhere, directly or not, each with a file that names or includes it.
pub fn shared(project: &Project, chapter: &Chapter) -> BTreeMap<String, String> {
    let own = own(project, chapter);
    let mut found = named(project, chapter);
    let mut open = own.clone();
    open.extend(found.keys().cloned());
    while let Some(file) = open.pop() {
        for included in includes(project, &file) {
            if !own.contains(&included) && !found.contains_key(&included) {
                found.insert(included.clone(), file.clone());
                open.push(included);
            }
        }
    }
    found
}

/// The stages of `shaders/common` used by a chapter's program, each with the source that names it.
fn named(project: &Project, chapter: &Chapter) -> BTreeMap<String, String> {
    let stages: Vec<String> = project
        .files("shaders/common")
        .into_iter()
        .filter(|file| !file.ends_with(".glsl"))
        .collect();
    let mut found = BTreeMap::new();
    for source in project.files(&format!("samples/{}", chapter.name)) {
        let text = project.read(&source).unwrap_or_default();
        let is_named = |stage: &&String| {
            text.contains(&format!("\"{}\"", stage.trim_start_matches("shaders/")))
        };
        found.extend(stages.iter().filter(is_named).map(|stage| (stage.clone(), source.clone())));
    }
    found
}

/// The language of a file, as written on fenced blocks.
pub fn language(path: &str) -> &'static str {
    match path.rsplit_once('.').map_or("", |(_, extension)| extension) {
        "rs" => "rust",
        "yml" => "yaml",
        "diff" => "diff",
        "toml" => "toml",
        "sbatch" | "sh" => "sh",
        "json" => "json",
        extension if EXTENSIONS.contains(&extension) => "glsl",
        _ => "text",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn languages_follow_extensions() {
        let files = ["a/main.rs", "a/x.rahit", "a/push.glsl", "Cargo.toml", "a/chess.obj"];
        assert_eq!(files.map(language), ["rust", "glsl", "glsl", "toml", "text"]);
    }
}
