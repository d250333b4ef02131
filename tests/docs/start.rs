//! A crate of a reader's own, made by the tool: whole, and pinned to what the book is tested with. That it is built
//! with nothing else and runs, a nightly test of `tests/window` holds; that its program draws, the template's own.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::Command;

use common::app::Picture;

use crate::fixture::{Outcome, run};

fn start(arguments: &[&str], folder: &Path) -> Outcome {
    let mut command = Command::new(env!("CARGO_BIN_EXE_chapters"));
    run(command.arg("start").args(arguments).arg(folder))
}

fn table(file: &Path) -> toml::Table {
    fs::read_to_string(file).expect("a file").parse().expect("it is TOML")
}

/// The packages of a lock file: name, version, and where each comes from.
fn locked(file: &Path) -> BTreeSet<[String; 3]> {
    let lock = table(file);
    let text = |package: &toml::Value, key: &str| {
        package.get(key).map_or(String::new(), |value| value.as_str().expect("text").to_owned())
    };
    let packages = lock["package"].as_array().expect("packages").iter();
    packages.map(|package| ["name", "version", "source"].map(|key| text(package, key))).collect()
}

#[test]
fn a_crate_of_one_s_own_is_whole_and_pinned() {
    let above = tempfile::tempdir().expect("a temporary folder");
    let folder = above.path().join("deep/glow");
    let outcome = start(&[], &folder);
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    for line in ["src/main.rs", "shaders/glow/sphere.rint", "tests/picture.rs", "cargo run"] {
        assert!(outcome.out.lines().any(|told| told == line), "{}", outcome.out);
    }
    for file in outcome.out.lines().take_while(|line| !line.is_empty()) {
        let text = fs::read_to_string(folder.join(file)).expect("what is told is there");
        assert!(file == "Cargo.lock" || !text.contains("my_tracer"), "{file}");
    }
    // Cargo takes from the lock file what it needs, asks no registry, and takes nothing else.
    let cargo = Command::new(env!("CARGO"))
        .args(["update", "--workspace", "--offline", "--quiet"])
        .current_dir(&folder)
        .output()
        .expect("cargo starts");
    assert!(cargo.status.success(), "{}", String::from_utf8_lossy(&cargo.stderr));
    let (own, book) =
        (locked(&folder.join("Cargo.lock")), locked(&::run::root().join("Cargo.lock")));
    let new: Vec<_> = own.difference(&book).map(|[name, ..]| name.as_str()).collect();
    assert_eq!(new, ["glow"]);
    // What the profile names is there: Cargo would warn of the rest.
    let manifest = table(&folder.join("Cargo.toml"));
    let profile = &manifest["profile"]["dev"];
    assert_eq!(*profile, {
        let mut whole = table(&::run::root().join("Cargo.toml"))["profile"]["dev"].clone();
        let packages = whole["package"].as_table_mut().expect("packages");
        packages.retain(|name, _| name == "*" || own.iter().any(|[of, ..]| of == name));
        whole
    });
    assert_eq!(profile["package"]["raybook"]["opt-level"].as_integer(), Some(2));
}

#[test]
fn the_framework_may_come_from_a_git_repository() {
    let above = tempfile::tempdir().expect("a temporary folder");
    let folder = above.path().join("glow");
    // A folder that is empty will do, and stays.
    fs::create_dir(&folder).expect("a folder");
    let outcome = start(&["--git", "https://example.org/a\"b"], &folder);
    assert_eq!(outcome.code, 0, "{}", outcome.err);
    let manifest = table(&folder.join("Cargo.toml"));
    let dependency = &manifest["dependencies"]["raybook"];
    assert_eq!(dependency["git"].as_str(), Some("https://example.org/a\"b"));
    assert!(dependency.get("path").is_none());
}

#[test]
fn the_bowl_of_the_page_is_the_lower_half_of_the_ball() {
    let shaders = tempfile::tempdir().expect("a temporary folder");
    let start = ::run::root().join("docs/chapters/start");
    ::run::copy(&start.join("template/shaders"), shaders.path());
    let out = shaders.path().join("out.exr");
    // Whether the pixel is red, in the upper and in the lower half of the ball.
    let red = || {
        let outcome = run(::run::command("my_tracer")
            .env("SHADERS", shaders.path())
            .args(["--headless", "--validate", "--size", "60x60", "--set", "field of view=30"])
            .args(["--set", "camera eye=0,1,6", "--set", "camera target=0,1,0", "--out"])
            .arg(&out));
        assert_eq!((outcome.code, &*outcome.err), (0, ""));
        let picture = Picture::open_exr(&out).expect("a picture");
        [20, 40].map(|y| picture.pixels[y * 60 + 30]).map(|[red, green, ..]| red > 2.0 * green)
    };
    assert_eq!(red(), [true, true]);
    fs::copy(start.join("bowl.rint"), shaders.path().join("my_tracer/sphere.rint"))
        .expect("a copy");
    assert_eq!(red(), [false, true]);
}

#[test]
fn a_crate_that_cannot_be_is_refused_and_nothing_is_written() {
    let above = tempfile::tempdir().expect("a temporary folder");
    let used = above.path().join("used");
    fs::create_dir(&used).expect("a folder");
    fs::write(used.join("notes"), "mine").expect("a file");
    for (folder, words) in [
        (used.clone(), "is not empty; name a folder that is empty or new"),
        (used.join("notes"), "is no folder; name one that is empty or new"),
        (above.path().join("Glow"), "a letter from a to z, then a to z, 0 to 9 and _"),
        (above.path().join("9glow"), "a letter from a to z, then a to z, 0 to 9 and _"),
        (above.path().join("glow-worm"), "a letter from a to z, then a to z, 0 to 9 and _"),
        (above.path().join("match"), "ends in a name that Rust, Cargo or the book keeps"),
        (above.path().join("raybook"), "ends in a name that Rust, Cargo or the book keeps"),
        (::run::root().join("docs/glow"), "lies in the book; name a folder outside"),
        (used.join("../../").join(::run::root()).join("samples/../glow"), "lies in the book"),
    ] {
        let outcome = start(&[], &folder);
        assert_eq!((outcome.code, &*outcome.out), (2, ""), "{folder:?}: {}", outcome.err);
        assert!(outcome.err.contains(words), "{folder:?}: {}", outcome.err);
        assert_eq!(outcome.err.lines().count(), 1, "{}", outcome.err);
    }
    // A file is in the way of the folder above.
    let outcome = start(&[], &used.join("notes/glow"));
    assert_eq!((outcome.code, &*outcome.out), (1, ""), "{}", outcome.err);
    let names = |folder: &Path| -> Vec<_> {
        folder
            .read_dir()
            .expect("a folder")
            .map(|entry| entry.expect("an entry").file_name())
            .collect()
    };
    assert_eq!((names(above.path()), names(&used)), (vec!["used".into()], vec!["notes".into()]));
    assert!(!::run::root().join("glow").exists() && !::run::root().join("docs/glow").exists());
}
