//! Classic mistakes: each patch applies, and has the effect its file claims.

#[cfg(unix)]
use std::path::Path;
use std::process::Command;
#[cfg(unix)]
use std::process::Stdio;
#[cfg(unix)]
use std::time::Duration;

use crate::fixture::{Fixture, run};

/// The chapters that have mistakes in their shaders.
const PROGRAMS: [&str; 13] = [
    "02_basic",
    "03_any_hit",
    "04_jitter_camera",
    "05_shadow_miss",
    "06_reflection",
    "07_multi_closest_hit",
    "08_intersection",
    "09_instancing",
    "19_ray_cones",
    "22_solids",
    "23_motion_blur",
    "34_lights",
    "35_soft_shadows",
];

fn tool(arguments: &[&str]) -> (i32, String, String) {
    let outcome = run(Command::new(env!("CARGO_BIN_EXE_chapters")).arg("mistake").args(arguments));
    (outcome.code, outcome.out, outcome.err)
}

/// The chapters whose first mistake is run by day. `chapters check` makes sure that every patch applies.
const BY_DAY: [&str; 3] = ["02_basic", "05_shadow_miss", "22_solids"];

/// A few mistakes, and those edited since the last commit.
#[test]
fn mistakes_in_shaders_do_what_their_files_claim() {
    let (in_rust, changed) = (in_rust(), ::run::changed());
    let (code, list, err) = tool(&["--list"]);
    assert_eq!(code, 0, "{err}");
    let mut seen = Vec::new();
    for line in list.lines() {
        let mut words = line.split_whitespace();
        let (name, chapter) = (words.next().expect("a name"), words.next().expect("a chapter"));
        let own = [format!("docs/mistakes/{name}.diff"), format!("shaders/{chapter}/")];
        let edited = changed.iter().any(|file| own.iter().any(|own| file.starts_with(own)));
        let is_first_by_day = BY_DAY.contains(&chapter) && !seen.contains(&chapter);
        if in_rust.iter().any(|other| other == name) || !is_first_by_day && !edited {
            continue;
        }
        seen.push(chapter);
        ::run::program(chapter);
        let (code, out, err) = tool(&[name, "--check"]);
        assert_eq!(code, 0, "\n{out}{err}");
    }
    assert!(BY_DAY.iter().all(|program| seen.contains(program)), "{seen:?}");
}

#[test]
#[ignore = "nightly: all of them; quick: mistakes::mistakes_in_shaders_do_what_their_files_claim"]
fn every_mistake_in_shaders_does_what_its_file_claims() {
    for program in PROGRAMS {
        ::run::program(program);
    }
    let (code, out, err) = tool(&["--check"]);
    assert_eq!(code, 0, "\n{out}{err}");
    assert!(out.lines().count() >= 24, "{out}");
}

/// On a Radeon's own driver, without the card: only the correct program is run.
#[cfg(target_os = "linux")]
#[test]
fn what_is_undefined_is_not_tried_on_a_gpu() {
    let undefined = ["recursion_too_deep", "record_offset"];
    for program in ["06_reflection", "07_multi_closest_hit"] {
        ::run::program(program);
    }
    for name in undefined {
        let mut command = Command::new(env!("CARGO_BIN_EXE_chapters"));
        if !::run::cards::Card("navi31").found_by(&mut command, Some("1")) {
            return;
        }
        let outcome = run(command.args(["mistake", name, "--check"]));
        let start = format!("{name}: not tried on ");
        let is_told = outcome.out.starts_with(&start) && outcome.out.contains("NAVI31");
        assert!(outcome.code == 0 && is_told, "{}{}", outcome.out, outcome.err);
        assert_eq!(outcome.out.lines().count(), 1, "{}", outcome.out);
    }
}

/// Rebuilds the chapter for each patch.
#[test]
#[ignore = "nightly: builds patched copies; quick: mistakes::mistakes_in_shaders_do_what_their_files_claim"]
fn every_mistake_in_rust_does_what_its_file_claims() {
    let names = in_rust();
    assert!(names.len() >= 6, "{names:?}");
    for name in names {
        let (code, out, err) = tool(&[&name, "--check"]);
        assert_eq!(code, 0, "\n{out}{err}");
    }
}

/// The names of the mistakes that change more than shaders.
fn in_rust() -> Vec<String> {
    let (code, list, err) = tool(&["--list"]);
    assert_eq!(code, 0, "{err}");
    let names = list.lines().filter_map(|line| line.split_whitespace().next());
    let in_shaders = |name: &&str| {
        let patch = ::run::root().join(format!("docs/mistakes/{name}.diff"));
        let patch = std::fs::read_to_string(patch).expect("a patch");
        let mut files = patch.lines().filter_map(|line| line.strip_prefix("+++ "));
        files.all(|file| file.starts_with("shaders/"))
    };
    names.filter(|name| !in_shaders(name)).map(str::to_owned).collect()
}

#[test]
fn a_copy_of_the_rust_code_is_a_project_that_cargo_takes() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().join("copy");
    let out = out.to_str().expect("a path of letters");
    let (code, said, err) = tool(&["table_stride", "--out", out]);
    assert_eq!(code, 0, "{err}");
    // Undefined behaviour never runs on a GPU.
    let device = "-- --device llvmpipe";
    let command = format!("--manifest-path {out}/Cargo.toml --bin 07_multi_closest_hit {device}\n");
    assert!(said.ends_with(&command), "{said}");
    let patched =
        std::fs::read_to_string(format!("{out}/common/src/gpu/pipeline/sbt.rs")).expect("a copy");
    assert!(patched.contains(".min().unwrap_or(0);"), "{patched}");
    // Every member of the workspace must exist. Their dependencies need not: a machine has only downloaded
    // those it builds.
    let cargo = std::env::var_os("CARGO").expect("Cargo runs tests");
    let mut metadata = Command::new(cargo);
    metadata.args(["metadata", "--no-deps", "--offline", "--format-version", "1"]);
    let outcome = run(metadata.current_dir(out));
    assert_eq!(outcome.code, 0, "{}", outcome.err);
}

#[test]
fn a_copy_is_made_once_and_says_how_to_run_it() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().join("copy");
    let out = out.to_str().expect("a path of letters");
    let (code, said, err) = tool(&["cull_mask_0", "--out", out]);
    assert_eq!(code, 0, "{err}");
    assert!(said.ends_with(&format!("SHADERS={out} cargo run --bin 02_basic\n")), "{said}");
    let patched = std::fs::read_to_string(format!("{out}/02_basic/camera.rgen")).expect("a copy");
    assert!(patched.contains("0x00,"), "{patched}");
    let file = format!("{out}/02_basic/camera.rgen");
    let below = format!("{file}/copy");
    let a_file = "is a file, and the copy is a folder";
    for (out, path, what) in
        [(out, out, "is not empty"), (&file, &*file, a_file), (&below, &file, a_file)]
    {
        let (code, _, err) = tool(&["cull_mask_0", "--out", out]);
        let line = format!("error: '{path}' {what}; name another folder with --out\n");
        assert_eq!((code, err), (2, line));
    }
}

#[cfg(unix)]
#[test]
fn a_copy_that_a_signal_stops_is_not_left_half_made() {
    let name = &in_rust()[0];
    let work = tempfile::tempdir().expect("a temporary folder");
    let whole = work.path().join("whole");
    let (code, _, err) = tool(&[name, "--out", whole.to_str().expect("a path of letters")]);
    assert_eq!(code, 0, "{err}");
    let mut stopped = 0;
    for round in 0..10 {
        let out = work.path().join(round.to_string());
        let mut command = ::run::heeding("chapters");
        command.args(["mistake", name, "--out"]).arg(&out).stdout(Stdio::null());
        let mut child = command.spawn().expect("it starts");
        while !out.exists() && child.try_wait().expect("a child").is_none() {}
        std::thread::sleep(Duration::from_millis(2 * round));
        let kill = Command::new("kill").arg(child.id().to_string()).status();
        kill.expect("kill");
        let status = child.wait().expect("it ends");
        stopped += u32::from(!status.success());
        let is_whole = out.exists() && files(&out) == files(&whole);
        assert!(is_whole || !(out.exists() || status.success()), "{status}: round {round}");
    }
    assert!(stopped > 0, "no signal came in time");
}

/// The number of files below a folder.
#[cfg(unix)]
fn files(folder: &Path) -> usize {
    let entries = std::fs::read_dir(folder).expect("a folder").map(|entry| entry.unwrap().path());
    entries.map(|path| if path.is_dir() { files(&path) } else { 1 }).sum()
}

#[test]
fn a_wrong_name_gets_one_line_with_what_there_is() {
    for (arguments, start) in [
        (&["acme"][..], "error: no mistake 'acme'; there is acne, "),
        (&[], "error: no mistake is named; there is acne, "),
    ] {
        let (code, _, err) = tool(arguments);
        assert_eq!((code, err.lines().count()), (2, 1), "{err}");
        assert!(err.starts_with(start), "{err}");
    }
}

/// A mistake of a small project.
const PALE: &str = "Pale\n\nSymptom: Colours: white\nChapter: 02_basic\nOutcome: differs by 0.05\nValidation: nothing\n\
                    Cause: c\nFind: f\nCure: c\n\n\
                    --- shaders/02_basic/camera.rgen\n+++ shaders/02_basic/camera.rgen\n@@ -1 +1 @@\n\
                    -    imageStore(picture, ivec2(id), payload);\n\
                    +    imageStore(picture, ivec2(id), PAYLOAD);\n";

fn with(payload: &str) -> Fixture {
    let fixture = Fixture::new();
    fixture.write("docs/mistakes/pale.diff", &PALE.replace("PAYLOAD", payload));
    fixture
}

#[test]
fn a_mistake_that_is_none_is_refused() {
    let outcome = with("vec4(1.0)").run(&["mistake", "--check"]);
    assert_eq!(outcome.code, 0, "{}{}", outcome.out, outcome.err);
    let outcome = with("payload + 0.0").run(&["mistake", "--check"]);
    assert_eq!(outcome.code, 1);
    assert_eq!(outcome.out, "docs/mistakes/pale.diff: differs by 0.0000, not by 0.05\n");
    let silent = with("vec4(1.0)");
    silent.replace("docs/mistakes/pale.diff", "Validation: nothing", "Validation: SYNC-HAZARD");
    let outcome = silent.run(&["mistake", "--check"]);
    assert_eq!(
        outcome.out,
        "docs/mistakes/pale.diff: validation says nothing, not 'SYNC-HAZARD'\n"
    );
}

#[test]
fn a_picture_is_made_and_verified() {
    let fixture = with("vec4(1.0)");
    let missing = "docs/mistakes/pale.diff:1: the picture docs/images/mistakes/pale.png is missing; \
                   run: cargo chapters sync --pictures pale\n";
    assert_eq!(fixture.check(), missing);
    let outcome = fixture.run(&["sync", "--pictures"]);
    assert_eq!(outcome.code, 0, "{}{}", outcome.out, outcome.err);
    assert_eq!(fixture.check(), "");
    // The picture does not depend on the page's text.
    fixture.replace("docs/mistakes/pale.diff", "Cause: c", "Cause: d");
    assert_eq!(fixture.check(), "");
    // Another patch may make another picture; only a run can tell.
    fixture.replace("docs/mistakes/pale.diff", "vec4(1.0)", "vec4(0.5)");
    assert_eq!(fixture.check(), "");
    let outcome = fixture.run(&["verify", "pale"]);
    let line = "docs/images/mistakes/pale.png: ";
    assert!(outcome.code == 1 && outcome.out.starts_with(line), "{}{}", outcome.out, outcome.err);
}

#[test]
fn a_patch_that_does_not_fit_is_named_with_its_line() {
    let fixture = with("vec4(1.0)");
    fixture.run(&["sync", "--pictures"]);
    fixture.replace("docs/mistakes/pale.diff", "ivec2(id), payload", "ivec2(it), payload");
    let found = fixture.check();
    let line = "docs/mistakes/pale.diff:13: this hunk does not fit shaders/02_basic/camera.rgen; make \
                the patch again";
    assert!(found.lines().any(|found| found == line), "{found}");
    fixture.replace("docs/mistakes/pale.diff", "Outcome: differs by", "Outcome: is");
    assert!(fixture.check().contains("docs/mistakes/pale.diff:5: 'is 0.05' is no outcome; write "));
}

#[test]
fn a_patched_stage_that_does_not_compile_is_named_with_its_patch() {
    let camera = "shaders/02_basic/camera.rgen";
    let undeclared = with("white").check();
    let start =
        format!("docs/mistakes/pale.diff:1: with this patch {camera} does not compile: {camera}:");
    let named = |line: &str| {
        line.starts_with(&start) && line.ends_with("undeclared identifier; make the patch again")
    };
    assert!(undeclared.lines().any(named), "{undeclared}");
    // Its chapter compiles another file.
    let idle = with("vec4(1.0)");
    idle.replace("docs/mistakes/pale.diff", "Chapter: 02_basic", "Chapter: 01_one");
    let line =
        "docs/mistakes/pale.diff:1: this patch changes no stage of 01_one; make the patch again";
    assert!(idle.check().lines().any(|found| found == line), "{}", idle.check());
}
