//! A crate made by `cargo chapters start`: its own shaders, with the book's as a fallback.

use std::path::Path;
use std::process::Command;
use std::time::Instant;

use image::Rgb;

use super::desk::{Desk, wait};
use super::{alone, ended_well, tells_error};

/// Makes the sky in the raygen shader of `folder` wrong, and then green; the window follows.
fn follows_an_edit(desk: Desk, folder: &Path) {
    let raygen = folder.join("camera.rgen");
    let good = std::fs::read_to_string(&raygen).expect("the raygen shader");
    let edit = |color: &str| {
        let text = good.replace("throughput * hit.color;", &format!("{color};"));
        assert_ne!(text, good);
        std::fs::write(&raygen, text).expect("an edit");
    };
    edit("nonsense");
    wait("the error", || tells_error(&desk).then_some(()));
    edit("vec3(0.0, 1.0, 0.0)");
    wait("a green sky", || {
        let shown = desk.shown();
        (shown.get_pixel(shown.width() - 1, 0) == &Rgb([0, 255, 0])).then_some(())
    });
    desk.close();
    ended_well(desk.end());
}

/// The crate uses the results of the book's build, and the book's programs are unchanged.
#[test]
#[ignore = "nightly: it compiles the framework for another crate; quick: docs start::a_crate_of_one_s_own_is_whole_and_pinned"]
fn a_started_crate_uses_what_the_book_has_compiled() {
    let above = tempfile::tempdir().expect("a temporary folder");
    let folder = above.path().join("glow");
    let started = Command::new(run::program("chapters")).arg("start").arg(&folder).output();
    assert!(started.expect("it starts").status.success());
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["build", "--offline"]).current_dir(&folder).env_remove("CARGO_TARGET_DIR");
    let start = Instant::now();
    let output = cargo.output().expect("cargo starts");
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{errors}");
    println!("built in {} s", start.elapsed().as_secs());
    let compiled = errors.lines().filter(|line| line.trim_start().starts_with("Compiling"));
    let compiled: Vec<&str> = compiled.collect();
    let name = |line: &&str| line.contains(" glow ") || line.contains(" raybook ");
    assert!(compiled.iter().any(name), "{errors}");
    assert!(!compiled.iter().any(|line| line.contains(" glslang")), "{compiled:#?}");
    let mut program = Command::new(folder.join("target/debug/glow"));
    let out = folder.join("glow.png");
    program.args(["--headless", "--size", "16x10", "--out"]).arg(&out);
    assert!(program.status().expect("it starts").success() && out.is_file());
}

/// The copy is all that `SHADERS` contains: files included from `common/` come from the book.
#[test]
fn a_program_outside_the_book_follows_edits_of_its_own_shaders() {
    let _alone = alone();
    let copy = tempfile::tempdir().expect("a temporary folder");
    run::copy(&run::root().join("docs/chapters/start/template/shaders"), copy.path());
    let environment = [("SHADERS", copy.path())];
    let desk = Desk::open("my_tracer", &["--validate", "--size", "640x420"], &environment);
    follows_an_edit(desk, &copy.path().join("my_tracer"));
}

/// An edit that compiles but reads beyond an array: the driver crashes with the window, and leaves one line.
#[test]
fn an_edit_that_crashes_the_driver_ends_the_window_in_a_line() {
    if !run::device::is_software() {
        return;
    }
    let _alone = alone();
    let copy = tempfile::tempdir().expect("a temporary folder");
    run::copy(&run::root().join("docs/chapters/start/template/shaders"), copy.path());
    let environment = [("SHADERS", copy.path())];
    let desk = Desk::open("my_tracer", &["--size", "640x420"], &environment);
    let (from, to) = (
        "report(push.scene, barycentrics);",
        "report(push.scene, barycentrics);\n    \
                       hit.color = push.scene.materials.at[hit.material + (1 << 25)].base_color;",
    );
    run::replace_line(copy.path(), "my_tracer/mesh.rchit", from, to);
    let (code, line) = run::refusal(desk.end());
    assert_eq!(code, 1, "{line}");
    assert!(
        line.contains("crashed (SIGSEGV) while the device worked: most likely a shader"),
        "{line}"
    );
}

#[test]
#[ignore = "nightly: it compiles the framework anew; quick: started::a_program_outside_the_book_follows_edits_of_its_own_shaders"]
fn a_started_crate_is_built_with_nothing_else_tested_and_edited_live() {
    let above = tempfile::tempdir().expect("a temporary folder");
    let (folder, home) = (above.path().join("glow"), above.path().join("home"));
    let started =
        Command::new(run::program("chapters")).arg("start").arg("--apart").arg(&folder).output();
    assert!(started.expect("it starts").status.success());
    let target = folder.join("target");
    let cargo = |arguments: &[&str]| {
        let output = Command::new(env!("CARGO"))
            .args(arguments)
            .arg("--offline")
            .current_dir(&folder)
            .env("CARGO_TARGET_DIR", &target)
            .env("XDG_CACHE_HOME", &home)
            .output()
            .expect("cargo starts");
        let errors = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success(), "{arguments:?}: {errors}");
        assert!(!errors.contains("warning"), "{arguments:?}: {errors}");
    };
    let start = Instant::now();
    cargo(&["build"]);
    println!("built in {} s", start.elapsed().as_secs());
    cargo(&["test", "--locked"]);
    // The steps of the page. With a hit record beyond the table, or of the other kind, the sphere would
    // silently disappear.
    let main = folder.join("src/main.rs");
    let apply = |step: &str| {
        let changed = run::root().join("docs/chapters/start").join(step);
        std::fs::copy(changed.join("src/main.rs"), &main).expect("a copy");
        for shader in changed.join("shaders/my_tracer").read_dir().expect("its shaders") {
            let shader = shader.expect("a shader");
            let copy = folder.join("shaders/glow").join(shader.file_name());
            std::fs::copy(shader.path(), copy).expect("a copy");
        }
        let text = std::fs::read_to_string(&main).expect("the program");
        std::fs::write(&main, text.replace("my_tracer", "glow")).expect("an edit");
        cargo(&["test"]);
    };
    apply("second_light");
    apply("sphere");
    let good = std::fs::read_to_string(&main).expect("the program");
    for (record, words) in [
        (2, "an instance of 'sphere' has the hit record 2"),
        (
            0,
            "an instance of boxes, 'sphere', has the hit record 0, which is a hit group for triangles",
        ),
    ] {
        let edited = good.replace("last, 1, &sphere", &format!("last, {record}, &sphere"));
        assert_ne!(edited, good);
        std::fs::write(&main, edited).expect("an edit");
        cargo(&["build"]);
        let mut wrong = Command::new(target.join("debug/glow"));
        let refused = wrong.args(["--headless", "--size", "8x8"]).output().expect("it starts");
        let (_, line) = run::refusal(refused);
        assert!(line.contains(words), "{line}");
    }
    std::fs::write(&main, good).expect("an edit");
    cargo(&["build"]);
    // None of it is in the book's folder.
    assert!(home.join("raybook/spirv").is_dir() && home.join("raybook/pipelines").is_dir());

    let _alone = alone();
    let mut program = Command::new("env");
    program.arg("--default-signal=INT,TERM,HUP").arg(target.join("debug/glow"));
    let environment = [("XDG_CACHE_HOME", &*home)];
    let desk = Desk::begin_by(program, &["--validate", "--size", "640x420"], &environment);
    desk.wait_for_a_picture();
    follows_an_edit(desk, &folder.join("shaders/glow"));
}
