//! Checks that the book agrees with the code, and that every fault in a small book is found.

mod author;
mod exercises;
mod features;
mod fixture;
mod hard;
mod merge;
mod mistakes;
mod named;
mod new;
mod nightly;
mod prices;
mod stale;
mod start;
mod survey;
#[cfg(unix)]
mod values;
mod variants;

use std::fs;
use std::path::Path;
use std::process::Command;

use fixture::{Fixture, run};

/// The real project's pages, pictures, tables, tests and files agree.
#[test]
fn the_book_is_current() {
    let outcome = run(Command::new(env!("CARGO_BIN_EXE_chapters")).arg("check"));
    assert_eq!(outcome.code, 0, "\n{}{}", outcome.out, outcome.err);
}

/// The pictures of chapters edited since the last commit are those their commands make; all others are
/// compared at night, by `cargo chapters verify`.
#[test]
fn pictures_of_edited_chapters_are_what_their_commands_give() {
    let outcome = run(Command::new(env!("CARGO_BIN_EXE_chapters")).args(["verify", "--changed"]));
    assert_eq!(outcome.code, 0, "\n{}{}", outcome.out, outcome.err);
}

#[test]
fn a_whole_project_has_no_faults_and_nothing_to_renew() {
    let fixture = Fixture::new();
    assert_eq!(fixture.check(), "");
    let outcome = fixture.run(&["sync", "--pictures"]);
    assert_eq!((outcome.code, &*outcome.out, &*outcome.err), (0, "", ""));
}

/// One fault: a function that makes it, and the start and end of the line that `check` must print.
type Case = (&'static str, fn(&Fixture), &'static str, &'static str);

/// Checks that each fault is found, and no other; if it is in `mended`, that `sync` fixes it.
fn expect(cases: &[Case], mended: &[&str]) {
    for (name, break_it, start, end) in cases {
        let fixture = Fixture::new();
        break_it(&fixture);
        let found = fixture.check();
        let line = found.lines().find(|line| line.starts_with(start) && line.ends_with(end));
        assert!(line.is_some(), "{name}: no line '{start} … {end}' in:\n{found}");
        assert_eq!(found.lines().count(), 1, "{name}: more than one line:\n{found}");
        if !mended.is_empty() {
            let outcome = fixture.run(mended);
            assert_eq!(outcome.code, 0, "{name}: {}{}", outcome.out, outcome.err);
            assert_eq!(fixture.check(), "", "{name}: not mended");
        }
    }
}

#[test]
fn a_stray_in_a_chapter_is_told_beside_what_it_makes_stale() {
    let fixture = Fixture::new();
    fixture.write("shaders/02_basic/old.rmiss", "#version 460\n");
    let found = fixture.check();
    let stray =
        "shaders/02_basic/old.rmiss:1: stray file: no program names it; use it or delete it";
    assert!(found.lines().any(|line| line == stray), "{found}");
}

#[test]
fn sync_mends_what_it_can_and_names_the_rest() {
    let fixture = Fixture::new();
    fixture.replace("docs/01_one.md", "#call -->", "#gone -->");
    fixture.replace("docs/02_basic.md", "| `sun elevation` |", "| `sun height` |");
    let outcome = fixture.run(&["sync"]);
    assert_eq!(outcome.code, 1);
    assert!(
        outcome.out.starts_with("docs/02_basic.md: renewed\ndocs/01_one.md:13: "),
        "{}",
        outcome.out
    );
    assert_eq!(outcome.err, "error: 1 fault in the book\n");
}

#[test]
fn files_of_windows_are_the_same_book() {
    let fixture = Fixture::new();
    for path in ["docs/01_one.md", "docs/02_basic.md", "samples/01_one/main.rs", "Cargo.toml"] {
        fixture.write(path, &fixture.read(path).replace('\n', "\r\n"));
    }
    assert_eq!(fixture.check(), "");
}

#[test]
fn a_program_that_is_not_built_is_named_with_its_cure() {
    let fixture = Fixture::new();
    // Linked, not copied: while another test starts a program, a newly written file may be busy.
    let tool = Path::new(env!("CARGO_BIN_EXE_chapters"));
    let apart =
        tempfile::tempdir_in(tool.parent().expect("its folder")).expect("a folder beside it");
    let lonely = apart.path().join("alone").with_extension(std::env::consts::EXE_EXTENSION);
    fs::hard_link(tool, &lonely).expect("another name of the tool");
    let run = || run(Command::new(&lonely).arg("check").arg("--root").arg(fixture.path("")));
    let check = || {
        let outcome = run();
        assert_eq!(outcome.code, 1, "{}", outcome.err);
        outcome.out
    };
    let (unbuilt, build) = ("the program '02_basic' is not built", "run: cargo build --bins");
    assert_eq!(check(), format!("Cargo.toml:1: {unbuilt}; {build}\n"));
    // Only the program knows its own arguments; all missing programs are reported in one line.
    fixture.replace("docs/01_one.md", "Its call:", "`cargo run --bin 01_one -- --own`:");
    let unbuilt = "the program '01_one' is not built, and another cannot be asked either";
    assert_eq!(check(), format!("Cargo.toml:1: {unbuilt}; {build}\n"));
    // A system that cannot start programs is not a fault of the book.
    if cfg!(unix) {
        fs::write(apart.path().join("02_basic"), "nobody may run this").expect("a file");
        let (outcome, line) =
            (run(), "error: 02_basic does not start: Permission denied (os error 13)\n");
        assert_eq!((outcome.code, &*outcome.out, &*outcome.err), (1, "", line));
    }
}

#[test]
fn a_comparison_is_plain_when_piped() {
    let fixture = Fixture::new();
    let outcome = fixture.run(&["diff", "1", "basic", "--code"]);
    assert_eq!(outcome.code, 0);
    assert!(!outcome.out.contains('\u{1b}'));
    assert!(outcome.out.starts_with("01 · One → 02 · Basic\nBasic: the second thing\n"));
    assert!(outcome.out.contains("run(name); // ünïcode → 漢字"), "{}", outcome.out);
    assert!(!outcome.out.contains("ANCHOR"), "{}", outcome.out);
    let shaders = fixture.run(&["diff", "01", "02", "--shaders"]).out;
    assert!(shaders.contains("shaders/01_one/one.rgen, gone"), "{shaders}");
    let new = "shaders/common/false_color.glsl, new: included by shaders/02_basic/push.glsl";
    assert!(shaders.contains(new), "{shaders}");
    assert_eq!(fixture.run(&["diff", "01", "01"]).out.lines().last(), Some("Nothing differs."));
    for wrong in ["-1", "few", "65536"] {
        let refused = fixture.run(&["diff", "01", "02", "--context", wrong]);
        assert_eq!((refused.code, refused.err.lines().count()), (2, 1), "{}", refused.err);
        assert!(
            refused.err.contains("lines are a whole number from 0 to 65535"),
            "{}",
            refused.err
        );
    }
    // A chapter's parent is the older one, whichever is named first; pages are only compared on request.
    let both = fixture.run(&["diff", "01", "02"]).out;
    assert_eq!(fixture.run(&["diff", "02", "01"]).out, both);
    assert!(both.contains("\nRead these first: main.rs, "), "{both}");
    let page = |arguments: &[&str]| fixture.run(arguments).out.contains("docs/02_basic.md");
    assert!(!page(&["diff", "01", "02"]) && page(&["diff", "01", "02", "--page"]));
}

#[test]
fn a_file_with_another_name_is_one_comparison() {
    let fixture = Fixture::new();
    fixture.write(
        "samples/01_one/spot.rs",
        &(0..20).map(|i| format!("line({i});\n")).collect::<String>(),
    );
    let moved = fixture.read("samples/01_one/spot.rs").replace("line(7)", "line(70)");
    fixture.write("samples/02_basic/light.rs", &moved);
    let outcome = fixture.run(&["diff", "1", "2", "--code"]);
    let line = "samples/01_one/spot.rs → samples/02_basic/light.rs     +1    −1";
    assert!(outcome.out.contains(line), "{}", outcome.out);
    assert!(!outcome.out.contains("line(2)"), "{}", outcome.out);
}

#[test]
fn wrong_arguments_are_one_line_and_exit_code_2() {
    let fixture = Fixture::new();
    let cases: [(&[&str], &str); 5] = [
        (
            &["diff", "1", "2", "--context", "18446744073709551615"],
            "error: invalid value '18446744073709551615' for '--context <N>'",
        ),
        (&["diff", "1", "9"], "error: no chapter '9'; there is 01_one, 02_basic"),
        (
            &["diff", "1"],
            "error: the following required arguments were not provided: <NEW>; --help",
        ),
        (&["mend"], "error: unrecognized subcommand 'mend'"),
        (&["sync", "--pictures", "x"], "error: no page makes a picture 'x'; there is 01_one, 02"),
    ];
    for (arguments, start) in cases {
        let outcome = fixture.run(arguments);
        assert_eq!(outcome.code, 2, "{arguments:?}: {}", outcome.err);
        assert!(outcome.err.starts_with(start), "{}", outcome.err);
        assert_eq!(outcome.err.lines().count(), 1, "{}", outcome.err);
    }
}

#[test]
fn the_list_has_a_line_a_chapter() {
    let fixture = Fixture::new();
    let list = fixture.run(&["list"]).out;
    assert_eq!(
        list,
        "01_one    One    from –   the first thing\n02_basic  Basic  from 01  the second thing\n"
    );
    let json: serde_json::Value =
        serde_json::from_str(&fixture.run(&["list", "--json"]).out).expect("JSON");
    assert_eq!((&json[1]["name"], &json[1]["from"]), (&"02_basic".into(), &"01_one".into()));
}
