//! A chapter made by the tool: complete except for its pictures and the text to be written.

#[cfg(unix)]
use std::collections::BTreeMap;
use std::fs;
#[cfg(unix)]
use std::path::PathBuf;
use std::process::Command;
#[cfg(unix)]
use std::process::Stdio;
#[cfg(unix)]
use std::time::Duration;

use ::run::{copy, root};
use tempfile::TempDir;

use crate::fixture::{Fixture, run};

#[test]
fn a_new_chapter_lacks_only_what_its_author_must_make() {
    let fixture = Fixture::new();
    let outcome = fixture.run(&["new", "7", "soft_light", "--from", "02"]);
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    for line in ["cargo run --bin 07_soft_light", "cargo chapters sync --pictures 07_soft_light"] {
        assert!(outcome.out.lines().any(|told| told == line), "{}", outcome.out);
    }
    let main = fixture.read("samples/07_soft_light/main.rs");
    assert!(main.starts_with("//! 07 · Soft light: "), "{main}");
    assert!(fixture.read("tests/samples/main.rs").contains("mod soft_light;\n"));
    let golden = fixture.read("tests/samples/golden.rs");
    assert_eq!(golden, "golden! {\n    basic,\n    one,\n    soft_light,\n}\n");
    let exercise = fixture.read("docs/exercises/07.1.diff");
    assert!(exercise.contains("Expect: same as 02_basic\n"), "{exercise}");
    assert!(fixture.read("docs/07_soft_light.md").contains("<!-- exercises 07_soft_light -->\n"));
    // The copied shaders are identical to the parent's.
    let shader = |chapter: &str| fixture.read(&format!("shaders/{chapter}/shade.rchit"));
    assert_eq!(shader("07_soft_light"), shader("02_basic"));
    let found = fixture.check();
    let known = [
        "holds a place for something",
        "has no golden",
        "is missing",
        "is not what",
        "is not built",
        "no test compares with it",
        "the table of contents",
        "which does not exist",
        "the gallery",
        "this diff",
        "this table",
        "this snippet",
        "this list of exercises",
    ];
    for line in found.lines() {
        assert!(known.iter().any(|words| line.contains(words)), "unexpected: {line}");
    }
    for (file, words) in [
        ("Cargo.toml", "say here, in a line, what it teaches"),
        ("samples/07_soft_light/main.rs", "what it teaches, in a line."),
        ("samples/07_soft_light/main.rs", "what is new."),
    ] {
        let end = format!(": '{words}' holds a place for something; write what belongs here");
        let is_told = |line: &str| line.starts_with(file) && line.ends_with(&end);
        assert!(found.lines().any(is_told), "{file}: '{words}' is not told:\n{found}");
    }
    let written = found.lines().filter(|line| line.contains("'WRITE' holds a place")).count();
    assert!(written >= 5, "the page does not say where to write:\n{found}");
}

/// A copy of the project's code in which each chosen chapter that can be a parent has a child.
fn with_a_child_of_each(is_chosen: impl Fn(&str) -> bool) -> (TempDir, Vec<[String; 2]>) {
    let project = tempfile::tempdir().expect("a temporary folder");
    let (from, to) = (root(), project.path());
    for folder in ["common", "docs", "samples", "shaders", "tests"] {
        copy(&from.join(folder), &to.join(folder));
    }
    for file in ["Cargo.toml", "Cargo.lock"] {
        fs::copy(from.join(file), to.join(file)).expect("a file is copied");
    }
    let mut parents = ::run::chapters();
    parents.retain(|name| {
        is_chosen(name) && !from.join("samples").join(name).join("Cargo.toml").is_file()
    });
    let taken: Vec<usize> =
        ::run::chapters().iter().filter_map(|name| name[..2].parse().ok()).collect();
    let free: Vec<usize> = (1..100).rev().filter(|number| !taken.contains(number)).collect();
    assert!(free.len() >= parents.len(), "there are no numbers left for children");
    let children = parents.into_iter().zip(free).map(|(parent, number)| {
        let name = format!("child_of_{}", &parent[..2]);
        let mut command = Command::new(::run::program("chapters"));
        command.args(["new", &number.to_string(), &name, "--from", &parent]);
        let outcome = run(command.arg("--root").arg(to));
        assert_eq!(outcome.code, 0, "{parent}: {}", outcome.err);
        [parent, format!("{number:02}_{name}")]
    });
    let children = children.collect();
    (project, children)
}

/// By day there are three parents: a plain one, one with callable shaders, and one that draws.
#[test]
fn a_child_has_all_that_its_parent_renders_with() {
    let by_day = ["02_basic", "13_callable_shader", "17_ray_query_raster"];
    children_have_all(|parent| by_day.contains(&parent));
}

#[test]
#[ignore = "nightly: every chapter; quick: new::a_child_has_all_that_its_parent_renders_with"]
fn a_child_of_any_chapter_has_all_that_its_parent_renders_with() {
    children_have_all(|_| true);
}

fn children_have_all(is_chosen: impl Fn(&str) -> bool) {
    let (project, children) = with_a_child_of_each(is_chosen);
    let shaders = project.path().join("shaders");
    for [parent, child] in children {
        let read = |path: &str| fs::read_to_string(project.path().join(path)).expect("a program");
        let code = |name: &str| {
            let text = read(&format!("samples/{name}/main.rs"));
            text.lines().skip_while(|line| line.starts_with("//!")).collect::<Vec<_>>().join("\n")
        };
        assert_eq!(code(&parent), code(&child));
        // The parent's program with the child's shaders.
        let before = ::run::render(&parent, "16x10", &[]).picture;
        fs::remove_dir_all(shaders.join(&parent)).expect("a folder");
        fs::rename(shaders.join(&child), shaders.join(&parent)).expect("a folder");
        let mut command = ::run::command(&parent);
        let after = ::run::render_by(command.env("SHADERS", &shaders), "16x10", &[]).picture;
        assert_eq!(::run::bits(&before), ::run::bits(&after), "{parent}");
    }
}

#[test]
#[ignore = "nightly: it compiles all chapters anew; quick: new::a_child_has_all_that_its_parent_renders_with"]
fn a_child_of_any_chapter_is_built_and_renders_what_its_parent_does() {
    let (project, children) = with_a_child_of_each(|_| true);
    let target = project.path().join("target");
    let built = Command::new(env!("CARGO"))
        .args(["build", "--quiet", "--bins", "--package", "ray-tracing-in-vulkan"])
        .current_dir(project.path())
        .env("CARGO_TARGET_DIR", &target)
        .status();
    assert!(built.expect("cargo starts").success(), "they do not build");
    for [parent, child] in children {
        let mut command = Command::new(target.join("debug").join(&child));
        let theirs = ::run::render_by(command.current_dir(project.path()), "16x10", &[]).picture;
        let before = ::run::render(&parent, "16x10", &[]).picture;
        assert_eq!(::run::bits(&before), ::run::bits(&theirs), "{child}");
    }
}

#[test]
fn parts_of_the_book_head_the_list_the_gallery_and_the_contents() {
    let fixture = Fixture::new();
    let first = "[package.metadata.chapters.01_one]";
    let parts = format!("[package.metadata]\nparts = [\"Make it\", \"Break it\"]\n\n{first}");
    fixture.replace("Cargo.toml", first, &parts);
    fixture.replace("Cargo.toml", "the first thing\"", "the first thing\"\npart = \"Make it\"");
    fixture.replace("Cargo.toml", "the second thing\"", "the second thing\"\npart = \"Break it\"");
    assert_eq!(fixture.run(&["sync"]).code, 0);
    assert_eq!(fixture.check(), "");
    let list = fixture.run(&["list"]).out;
    assert!(list.starts_with("I · Make it\n01_one "), "{list}");
    assert!(list.contains("\n\nII · Break it\n02_basic "), "{list}");
    assert!(fixture.read("README.md").contains("\n### II · Break it\n\n| [![02 · Basic]"));
    let summary = fixture.read("docs/SUMMARY.md");
    assert!(summary.contains("# I · Make it\n\n- [01 · One](01_one.md)\n\n# II"), "{summary}");
    // A new chapter goes to the same part as its parent.
    assert_eq!(fixture.run(&["new", "7", "soft_light", "--from", "02"]).code, 0);
    assert!(fixture.run(&["list"]).out.ends_with("say here, in a line, what it teaches\n"));
    let found = fixture.check();
    assert!(!found.contains("belongs to no part"), "{found}");
}

#[test]
fn the_map_has_every_chapter_below_its_parent_and_the_ways() {
    let fixture = Fixture::new();
    let first = "[package.metadata.chapters.01_one]";
    let way = |number: &str| {
        format!("[{{ title = \"Far\", gives = \"much\", chapters = [\"02\", \"{number}\"] }}]")
    };
    let metadata = format!("[package.metadata]\nways = {}\n\n{first}", way("09"));
    fixture.replace("Cargo.toml", first, &metadata);
    let refused = "Cargo.toml:22: there is no chapter '09' on the way 'Far'; name chapters by";
    let outcome = fixture.run(&["check"]);
    assert!(outcome.code > 0 && outcome.err.contains(refused), "{}", outcome.err);
    fixture.replace("Cargo.toml", &way("09"), &way("01"));
    let map = "# Map\n\n<!-- map ways -->\n<!-- /map -->\n\n<!-- map chapters -->\n<!-- /map -->\n";
    fixture.write("docs/map.md", map);
    fixture.replace("README.md", "# Fixture\n", "# Fixture\n\n![The map](docs/images/map.svg)\n");
    assert!(
        fixture.check().contains("docs/map.md:4: this part of the map is not what Cargo.toml says")
    );
    let drawn =
        "docs/images/map.svg:1: the map is not that of Cargo.toml; run: cargo chapters sync";
    assert!(fixture.check().lines().any(|line| line == drawn), "{}", fixture.check());
    assert_eq!(fixture.run(&["sync"]).code, 0);
    let svg = fixture.read("docs/images/map.svg");
    assert!(svg.contains("02 · Basic") && svg.contains(">program<"), "{svg}");
    assert!(!fixture.check().contains("map"), "{}", fixture.check());
    let (one, two) = ("[01 · One](01_one.md)", "[02 · Basic](02_basic.md)");
    let map = fixture.read("docs/map.md");
    assert!(map.contains(&format!("| **Far** | {two}, {one} | much |\n")), "{map}");
    let tree = format!("- {one}: the first thing\n  - {two}: the second thing\n<!-- /map -->");
    assert!(map.contains(&tree), "{map}");
}

#[test]
fn a_chapter_that_cannot_be_is_refused_and_nothing_is_written() {
    let fixture = Fixture::new();
    for (arguments, words) in [
        (["2", "x", "--from", "01"], "has the number or the name of '02_basic'"),
        (["9", "basic", "--from", "01"], "has the number or the name of '02_basic'"),
        (["9", "../x", "--from", "01"], "use a to z, 0 to 9 and _"),
        (["9", &"x".repeat(41), "--from", "01"], "a chapter's name has at most 40 letters"),
        (["100", "x", "--from", "01"], "use 1 to 99"),
        (["9", "x", "--from", "08"], "no chapter '08'"),
    ] {
        let outcome = fixture.run(&[&["new"], &arguments[..]].concat());
        assert_eq!(outcome.code, 2, "{arguments:?}: {}", outcome.err);
        assert!(outcome.err.contains(words), "{arguments:?}: {}", outcome.err);
    }
    assert_eq!(fixture.check(), "");
}

#[test]
fn a_chapter_of_which_a_file_cannot_be_written_is_not_begun() {
    let fixture = Fixture::new();
    let page = fixture.path("docs/07_soft_light.md");
    fs::create_dir(&page).unwrap();
    let outcome = fixture.run(&["new", "7", "soft_light", "--from", "02"]);
    assert_eq!(outcome.code, 1, "{}", outcome.out);
    assert!(outcome.err.contains("07_soft_light.md': it is a folder"), "{}", outcome.err);
    fs::remove_dir(&page).unwrap();
    assert_eq!(fixture.check(), "");
    for folder in ["samples", "shaders"] {
        assert!(!fixture.path(folder).join("07_soft_light").exists(), "{folder}");
    }
    assert_eq!(fixture.run(&["new", "7", "soft_light", "--from", "02"]).code, 0);
}

#[cfg(unix)]
#[test]
fn a_chapter_that_a_signal_stops_is_whole_or_not_begun() {
    let whole = Fixture::new();
    assert_eq!(whole.run(&["new", "7", "soft_light", "--from", "02"]).code, 0);
    let none = Fixture::new();
    let mut counts = [0, 0];
    for round in 0..30 {
        let fixture = Fixture::new();
        let mut command = ::run::heeding("chapters");
        command.args(["new", "7", "soft_light", "--from", "02", "--root"]).arg(fixture.path(""));
        let mut child = command.stdout(Stdio::null()).spawn().unwrap();
        std::thread::sleep(Duration::from_micros(500 * round));
        Command::new("kill").arg(child.id().to_string()).status().unwrap();
        child.wait().unwrap();
        let found = files(&fixture);
        assert!(found == files(&whole) || found == files(&none), "round {round}: {found:?}");
        counts[usize::from(found == files(&whole))] += 1;
    }
    println!("{counts:?}: not begun, whole");
}

/// The files of a project, and their contents.
#[cfg(unix)]
fn files(fixture: &Fixture) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut open = vec![PathBuf::new()];
    while let Some(folder) = open.pop() {
        for entry in fs::read_dir(fixture.path("").join(&folder)).unwrap() {
            let name = folder.join(entry.unwrap().file_name());
            let path = fixture.path("").join(&name);
            if path.is_dir() {
                open.push(name);
            } else {
                found.insert(name, fs::read(path).unwrap());
            }
        }
    }
    found
}
