//! Checks the files of `shaders/common`, each used by several chapters. The first line of each names the
//! chapter that teaches it; that chapter includes the file, and its page shows it.

use std::collections::BTreeMap;

use manuscript::fault::Fault;
use manuscript::page::{Block, Kind, Page};
use manuscript::project::{Chapter, Project};
use manuscript::shader;

/// The forms of a shared file's first line.
const FORMS: &str = "begin it with `// Taught by NN_name.`, `// Like NAME in NN_name, but …` or `// Of no chapter: …`";

/// The faults of the shared files, and of files that should be shared.
pub fn check(project: &Project, pages: &[Page]) -> Vec<Fault> {
    let files = project.files("shaders/common");
    let mut faults: Vec<Fault> =
        files.iter().filter_map(|file| wrong(project, pages, file)).collect();
    faults.extend(twins(project));
    faults
}

/// The faults of a shared file.
fn wrong(project: &Project, pages: &[Page], file: &str) -> Option<Fault> {
    let text = project.read(file).unwrap_or_default();
    // A stage must begin with its version.
    let first = text.lines().find(|line| !line.starts_with("#version")).unwrap_or_default();
    if first.starts_with("// Of no chapter: ") {
        return None;
    }
    let fault = |what: String, remedy: &str| Some(Fault::new(file, 1, what, remedy));
    let chapter = |name: &str| project.named(name);
    let no_chapter = |name: &str| fault(format!("there is no chapter '{name}'"), FORMS);
    if let Some(rest) = first.strip_prefix("// Like ") {
        let like = rest.split_once(" in ").map(|(_, rest)| rest);
        let name = like.and_then(|rest| rest.split_once(", but ")).map_or("", |(name, _)| name);
        return if chapter(name).is_none() { no_chapter(name) } else { None };
    }
    let Some(name) = first.strip_prefix("// Taught by ") else {
        return fault("it does not say which chapter teaches it".to_owned(), FORMS);
    };
    let name = name.trim_end_matches('.');
    let Some(chapter) = chapter(name) else { return no_chapter(name) };
    if !shader::shared(project, chapter).contains_key(file) {
        return fault(format!("{name} teaches it and does not include it"), "include it there");
    }
    if !is_shown(pages, chapter, file) {
        let what = format!("{} neither shows nor names it", chapter.page());
        return fault(what, "show a part of it there, with `<!-- snippet FILE#ANCHOR -->`");
    }
    None
}

/// Returns whether a chapter's page shows a part of a file, or its author mentions the file there.
fn is_shown(pages: &[Page], chapter: &Chapter, file: &str) -> bool {
    let mut of = pages.iter().filter(|page| page.path == chapter.page());
    let name = file.rsplit('/').next().unwrap_or_default();
    let snippet = |block: &Block| {
        let shown = block.words.first().map_or("", String::as_str);
        block.kind == Kind::Snippet && shown.split('#').next() == Some(file)
    };
    of.any(|page| page.written().contains(name) || page.blocks.iter().any(snippet))
}

/// Files with the same text. Stages and push constants are exempt, because they belong to their pipeline.
fn twins(project: &Project) -> Vec<Fault> {
    let mut first: BTreeMap<String, String> = BTreeMap::new();
    let mut faults = Vec::new();
    let is_text = |file: &String| file.ends_with(".glsl") && !file.ends_with("/push.glsl");
    for file in project.files("shaders").into_iter().filter(is_text) {
        let text = project.read(&file).unwrap_or_default();
        match first.get(&text) {
            Some(twin) => {
                let remedy = "move one to shaders/common and delete the other";
                faults.push(Fault::new(&*file, 1, format!("it is the same as {twin}"), remedy));
            }
            None => drop(first.insert(text, file)),
        }
    }
    faults
}
