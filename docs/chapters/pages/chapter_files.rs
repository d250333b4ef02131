//! Checks that every file of a chapter exists and has the right name.

use manuscript::fault::Fault;
use manuscript::project::{Chapter, Project, README};

use super::placeholder;

/// The disagreements between `Cargo.toml` and the files.
pub fn check(project: &Project) -> Vec<Fault> {
    let mut faults = Vec::new();
    for (index, chapter) in project.chapters.iter().enumerate() {
        faults.extend(metadata(project, chapter, index));
        faults.extend(parts(project, chapter));
    }
    faults.extend(bins(project));
    faults.extend(folders(project));
    if !project.has(README) {
        faults.push(Fault::new(README, 1, "there is no README", "write it, with <!-- gallery -->"));
    }
    faults
}

fn metadata(project: &Project, chapter: &Chapter, index: usize) -> Vec<Fault> {
    let line = project.chapter_line(chapter);
    let fault = |what: String, remedy: &str| Fault::new("Cargo.toml", line, what, remedy);
    let mut faults = Vec::new();
    let name = &chapter.name;
    let digits =
        chapter.number().len() == 2 && chapter.number().bytes().all(|b| b.is_ascii_digit());
    if !digits || chapter.module().is_empty() {
        faults.push(fault(format!("'{name}' is no chapter's name"), "call it such as 02_basic"));
    }
    let before = &project.chapters[..index];
    if let Some(twin) = before.iter().find(|other| other.number() == chapter.number()) {
        faults.push(fault(format!("'{name}' has the number of '{}'", twin.name), "renumber one"));
    }
    for (key, text) in [("title", &chapter.title), ("teaches", &chapter.teaches)] {
        if text.trim().is_empty() {
            faults.push(fault(format!("'{name}' has no {key}"), "write it"));
        }
    }
    if chapter.teaches == placeholder::TEACHES {
        faults.push(placeholder::fault("Cargo.toml", line, placeholder::TEACHES));
    }
    if !project.parts.is_empty() && !project.parts.contains(&chapter.part) {
        let what =
            format!("'{name}' belongs to no part of the book: its `part` is '{}'", chapter.part);
        let titles = format!("make it one of {}", project.parts.join(", "));
        faults.push(fault(what, &titles));
    }
    if let Some(from) = &chapter.from
        && !leads_to_a_first(project, chapter)
    {
        let what = format!("'{name}' builds on '{from}', which is no chapter or builds on it");
        faults.push(fault(what, "correct its `from`"));
    }
    faults
}

/// Checks that each chapter's line of parents ends at one without a parent. A parent may have the larger
/// number.
fn leads_to_a_first(project: &Project, chapter: &Chapter) -> bool {
    let mut at = Some(chapter);
    for _ in &project.chapters {
        let Some(Chapter { from: Some(from), .. }) = at else { break };
        at = project.chapters.iter().find(|other| other.name == *from);
    }
    at.is_some_and(|first| first.from.is_none())
}

/// Checks the program, its folder, shaders, page, test and golden picture.
fn parts(project: &Project, chapter: &Chapter) -> Vec<Fault> {
    let name = &chapter.name;
    let line = project.chapter_line(chapter);
    let [main, test] =
        [format!("samples/{name}/main.rs"), format!("tests/samples/{}.rs", chapter.module())];
    let (page, golden) = (chapter.page(), format!("tests/golden/{name}.png"));
    let manifest = project.read(&format!("samples/{name}/Cargo.toml")).ok();
    // Cargo builds a package's programs only if the package has test programs.
    let is_built = manifest.as_ref().is_none_or(|manifest| manifest.contains("[[test]]"));
    let write = || "write it".to_owned();
    let parts = [
        (
            project.bins.iter().any(|bin| bin.name == *name && bin.path == main),
            "has no program".to_owned(),
            format!("add [[bin]] name = \"{name}\", path = \"{main}\""),
        ),
        (
            !project.files(&format!("shaders/{name}")).is_empty(),
            "has no shaders".to_owned(),
            format!("write them in shaders/{name}"),
        ),
        (project.has(&main), format!("has no {main}"), write()),
        (project.has(&page), format!("has no page {page}"), write()),
        (manifest.is_some() || project.has(&test), format!("has no test {test}"), write()),
        (
            is_built,
            "is a package without a test program: `cargo test` would not build it".to_owned(),
            format!("add [[test]] to samples/{name}/Cargo.toml"),
        ),
        (
            project.has(&golden),
            format!("has no golden {golden}"),
            "run: UPDATE=1 cargo test --test samples".to_owned(),
        ),
    ];
    let missing = parts.into_iter().filter(|(there, ..)| !there);
    let fault = |what| format!("'{name}' {what}");
    let missing =
        missing.map(|(_, what, to_do)| Fault::new("Cargo.toml", line, fault(what), to_do));
    let mut faults: Vec<Fault> = missing.collect();
    faults.extend(opening(project, chapter, &main));
    let modules = project.read("tests/samples/main.rs").unwrap_or_default();
    let declared = format!("mod {};", chapter.module());
    if project.has(&test) && !modules.lines().any(|line| line.trim() == declared) {
        let what = format!("the tests of '{name}' never run");
        faults.push(Fault::new("tests/samples/main.rs", 1, what, format!("add `{declared}`")));
    }
    faults
}

/// Checks that a chapter's program opens with its number and title and a description.
fn opening(project: &Project, chapter: &Chapter, main: &str) -> Vec<Fault> {
    let Ok(text) = project.read(main) else { return Vec::new() };
    let opening = format!("//! {}: ", chapter.heading());
    let lines = text.lines().take_while(|line| line.starts_with("//!")).enumerate();
    let held = lines.filter_map(|(index, line)| {
        let words = placeholder::OPENING.into_iter().find(|words| line.ends_with(words))?;
        Some(placeholder::fault(main, index + 1, words))
    });
    let mut faults: Vec<Fault> = held.collect();
    if !text.starts_with(&opening) {
        let what = "the first line does not name the chapter".to_owned();
        faults.push(Fault::new(main, 1, what, format!("begin it with `{}…`", opening)));
    }
    faults
}

fn bins(project: &Project) -> Vec<Fault> {
    let mut faults = Vec::new();
    for bin in project.bins.iter().chain(&project.tests) {
        let line = project.manifest_line(&format!("name = \"{}\"", bin.name));
        let numbered = bin.name.starts_with(|c: char| c.is_ascii_digit());
        if !bin.path.is_empty() && !project.has(&bin.path) {
            let what = format!("'{}' has no {}", bin.name, bin.path);
            faults.push(Fault::new("Cargo.toml", line, what, "write it or remove the target"));
        }
        if numbered && project.named(&bin.name).is_none() {
            let what = format!("the program '{}' is no chapter", bin.name);
            let remedy = format!("add [package.metadata.chapters.{}]", bin.name);
            faults.push(Fault::new("Cargo.toml", line, what, remedy));
        }
    }
    faults
}

/// Checks that every numbered folder belongs to a chapter.
fn folders(project: &Project) -> Vec<Fault> {
    let mut faults = Vec::new();
    for folder in ["samples", "shaders"] {
        let files = project.files(folder);
        let mut names: Vec<&str> = files.iter().filter_map(|path| path.split('/').nth(1)).collect();
        names.dedup();
        names.retain(|name| name.starts_with(|c: char| c.is_ascii_digit()));
        names.retain(|name| project.named(name).is_none());
        for name in names {
            let what = format!("the folder {folder}/{name} belongs to no chapter");
            let remedy = format!("add [package.metadata.chapters.{name}] or delete it");
            faults.push(Fault::new(format!("{folder}/{name}"), 1, what, remedy));
        }
    }
    faults
}
