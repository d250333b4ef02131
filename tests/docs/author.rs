//! Faults that only an author can fix: reported with file, line and remedy.

use crate::fixture::Fixture;
use crate::{Case, expect};

#[test]
fn wrong_markers_and_anchors_are_named_with_file_and_line() {
    let cases: [Case; 7] = [
        (
            "an anchor renamed",
            |f| {
                f.replace("samples/01_one/main.rs", "ANCHOR: call", "ANCHOR: tell");
                f.replace("samples/01_one/main.rs", "ANCHOR_END: call", "ANCHOR_END: tell");
            },
            "docs/01_one.md:13: samples/01_one/main.rs has no part 'call'",
            " or add // ANCHOR: call to it",
        ),
        (
            "an anchor not closed",
            |f| f.replace("samples/01_one/main.rs", "    // ANCHOR_END: call\n", ""),
            "samples/01_one/main.rs:4: anchor 'call' does not end",
            "; add // ANCHOR_END: call",
        ),
        (
            "an anchor twice",
            |f| f.replace("samples/01_one/main.rs", "// Names", "// ANCHOR: call\n// Names"),
            "samples/01_one/main.rs:9: anchor 'call' begins a second time",
            "; rename it or the one in line 4",
        ),
        (
            "a snippet of no file",
            |f| f.replace("docs/01_one.md", "snippet samples", "snippet sample"),
            "docs/01_one.md:13: there is no text file 'sample/01_one/main.rs'",
            "; correct the marker",
        ),
        (
            "a marker not closed",
            |f| f.replace("docs/01_one.md", "<!-- /snippet -->\n", ""),
            "docs/01_one.md:13: <!-- snippet samples/01_one/main.rs#call --> is never closed",
            "; add <!-- /snippet --> on a line of its own",
        ),
        (
            "a marker that closes nothing",
            |f| f.replace("docs/01_one.md", "Its call:", "<!-- /controls -->"),
            "docs/01_one.md:11: <!-- /controls --> closes nothing",
            "above",
        ),
        (
            "a picture's marker without its command",
            |f| f.replace("docs/02_basic.md", "-->\n```sh", "-->\n\n```sh"),
            "docs/02_basic.md:3: no command follows <!-- picture -->",
            "; put it on the line before the ```sh block",
        ),
    ];
    expect(&cases, &[]);
}

#[test]
fn what_is_still_to_be_written_is_named_wherever_it_stands() {
    let cases: [Case; 6] = [
        (
            "an alt text",
            |f| f.replace("docs/01_one.md", "![The picture]", "![WRITE]"),
            "docs/01_one.md:3: 'WRITE' holds a place for something",
            "; write what belongs here",
        ),
        (
            "a sentence",
            |f| f.replace("docs/01_one.md", "costs nothing.", "costs WRITE."),
            "docs/01_one.md:2: 'WRITE' holds a place for something",
            "; write what belongs here",
        ),
        (
            "an exercise's hint, which no page shows",
            |f| f.replace("docs/exercises/02.1.diff", "Hint: White", "Hint: WRITE. White"),
            "docs/exercises/02.1.diff:6: 'WRITE' holds a place for something",
            "; write what belongs here",
        ),
        (
            "a test's comment",
            |f| {
                let ask = "// Say here which device set the tolerance.\nconst GOLDEN";
                f.replace("tests/samples/one.rs", "const GOLDEN", ask);
            },
            "tests/samples/one.rs:1: 'Say here which device set the tolerance.' holds a place",
            "; write what belongs here",
        ),
        (
            "the figures of a compiler that was not asked",
            |f| {
                let text = r#"{ "Mesa 1": { "03_gone": {} }, "Mesa 2": { "02_basic": {} } }"#;
                f.write("tests/gpus/budgets.json", text);
            },
            "tests/gpus/budgets.json:1: '03_gone' is no chapter any more",
            "; run: UPDATE=1 cargo test --test gpus",
        ),
        (
            "a chapter of which nothing is recorded",
            |f| f.write("tests/gpus/budgets.json", r#"{ "Mesa 1": {} }"#),
            "tests/gpus/budgets.json:1: nothing is recorded of '02_basic'",
            "; run: UPDATE=1 cargo test --test gpus",
        ),
    ];
    expect(&cases, &[]);
}

#[test]
fn stray_files_are_named() {
    let cases: [Case; 6] = [
        (
            "a stray shader",
            |f| f.write("shaders/common/old.glsl", "// Of no chapter: old.\n#version 460\n"),
            "shaders/common/old.glsl:1: stray file: no shader includes it",
            "; use it or delete it",
        ),
        (
            "a stray module",
            |f| f.write("docs/chapters/helper.rs", "fn help() {}\n"),
            "docs/chapters/helper.rs:1: stray file: no [[bin]] and no `mod` names it",
            "; use it or delete it",
        ),
        (
            "a stray page",
            |f| f.write("docs/notes.md", "# Notes\n"),
            "docs/notes.md:1: stray file: it is no chapter's page",
            "; use it or delete it",
        ),
        (
            "a stray picture",
            |f| f.write("docs/images/old.svg", "<svg/>"),
            "docs/images/old.svg:1: stray file: no page shows it",
            "; use it or delete it",
        ),
        (
            "a stray golden",
            |f| f.write("tests/golden/old.png", ""),
            "tests/golden/old.png:1: stray file: no test compares with it",
            "; use it or delete it",
        ),
        (
            "a stray of no kind",
            |f| f.write("samples/junk.txt", ""),
            "samples/junk.txt:1: stray file: nothing mentions it",
            "; use it or delete it",
        ),
    ];
    expect(&cases, &[]);
}

#[test]
fn a_package_that_cargo_test_leaves_out_is_named_beside_what_it_makes_stale() {
    let fixture = Fixture::new();
    fixture.write("samples/02_basic/Cargo.toml", "[package]\nname = \"basic\"\n");
    let found = fixture.check();
    let line = "Cargo.toml:25: '02_basic' is a package without a test program: `cargo test` would not \
                build it; add [[test]] to samples/02_basic/Cargo.toml";
    assert!(found.lines().any(|found| found == line), "{found}");
    // The chapter has one more file, so everything generated from the chapter is stale as well.
    let beside = ["docs/02_basic.md:", "samples/02_basic/Cargo.toml:1: stray file: "];
    let expected =
        |found: &str| found == line || beside.iter().any(|start| found.starts_with(start));
    assert!(found.lines().all(expected), "{found}");
}

#[test]
fn parts_of_a_chapter_that_do_not_agree_are_named() {
    let cases: [Case; 6] = [
        (
            "a golden lost",
            |f| f.remove("tests/golden/02_basic.png"),
            "Cargo.toml:25: '02_basic' has no golden tests/golden/02_basic.png",
            "; run: UPDATE=1 cargo test --test samples",
        ),
        (
            "a test lost",
            |f| {
                f.remove("tests/samples/one.rs");
                f.write("tests/samples/names.rs", "const ALSO: &str = \"01_one\";\n");
                f.replace("tests/samples/main.rs", "mod one;", "mod names;");
            },
            "Cargo.toml:21: '01_one' has no test tests/samples/one.rs",
            "; write it",
        ),
        (
            "a chapter on none",
            |f| f.replace("Cargo.toml", "from = \"01_one\"", "from = \"03_three\""),
            "Cargo.toml:25: '02_basic' builds on '03_three', which is no chapter or builds on it",
            "; correct its `from`",
        ),
        (
            "a chapter on itself",
            |f| f.replace("Cargo.toml", "from = \"01_one\"", "from = \"02_basic\""),
            "Cargo.toml:25: '02_basic' builds on '02_basic', which is no chapter or builds on it",
            "; correct its `from`",
        ),
        (
            "parts of which one chapter has none",
            |f| {
                let table = "[package.metadata.chapters.01_one]";
                f.replace(
                    "Cargo.toml",
                    table,
                    &format!("[package.metadata]\nparts = [\"All\"]\n{table}"),
                );
                f.replace("Cargo.toml", "the first thing\"", "the first thing\"\npart = \"All\"");
                assert_eq!(f.run(&["sync"]).code, 0);
            },
            "Cargo.toml:28: '02_basic' belongs to no part of the book: its `part` is ''",
            "; make it one of All",
        ),
        (
            "a title changed in one place",
            |f| f.replace("docs/02_basic.md", "# 02 · Basic", "# 02 · Basics"),
            "docs/02_basic.md:1: the heading does not name the chapter",
            "; write `# 02 · Basic`",
        ),
    ];
    expect(&cases, &[]);
}

#[test]
fn links_and_commands_that_do_not_work_are_named_with_file_and_line() {
    let cases: [Case; 6] = [
        (
            "a link to nowhere",
            |f| f.replace("docs/01_one.md", "(02_basic.md)", "(03_next.md)"),
            "docs/01_one.md:20: the link leads to 'docs/03_next.md', which does not exist",
            "; correct it",
        ),
        (
            "a command of no program",
            |f| f.replace("docs/02_basic.md", "cargo run --bin NN_name", "cargo run --bin 3_x"),
            "docs/02_basic.md:",
            "there is no program '3_x', only 01_one, 02_basic, chapters; correct it",
        ),
        (
            "a setting in a sentence",
            |f| f.replace("docs/02_basic.md", "Compare them", "Try `--set show=all`. Compare them"),
            "docs/02_basic.md:",
            "'show' cannot be 'all': it takes picture, normal, triangle, hit, ray direction; correct it",
        ),
        (
            "a command with an unknown option",
            |f| f.replace("README.md", "# Fixture", "`cargo run -- --shiny`"),
            "README.md:1: this command does not run: 02_basic does not take this: unexpected",
            "; correct it",
        ),
        (
            "a command that sets no control",
            |f| f.replace("README.md", "# Fixture", "`cargo run -- --set \"moon=1\"`"),
            "README.md:1: this command does not run: there is no control 'moon', only ",
            "; correct it",
        ),
        (
            "a control that cannot be that",
            |f| f.replace("README.md", "# Fixture", "`cargo run -- --set \"sun elevation=91\"`"),
            "README.md:1: this command does not run: 'sun elevation' cannot be '91'",
            "; correct it",
        ),
    ];
    expect(&cases, &[]);
}
