//! Names on a page must exist: chapters, files, lines, anchors, tests, exercises and their checks.

use crate::fixture::Fixture;
use crate::{Case, expect};

#[test]
fn placeholders_are_named_with_file_and_line() {
    let cases: [Case; 2] = [
        (
            "a line that is a word of capitals",
            |f| f.replace("docs/01_one.md", "Its call:", "ERRORTABLE"),
            "docs/01_one.md:11: 'ERRORTABLE' holds a place for something",
            "; write what belongs here",
        ),
        (
            "a cell that is an X",
            |f| f.replace("docs/01_one.md", "| a ULP | half |", "| a ULP | X |"),
            "docs/01_one.md:29: 'X' holds a place for something",
            "; write what belongs here",
        ),
    ];
    expect(&cases, &[]);
}

#[test]
fn chapters_that_are_not_there_are_named_with_file_and_line() {
    let remedy = "; correct it, or write `chapter 05 (planned)`";
    let cases: [Case; 5] = [
        (
            "a chapter that is not there",
            |f| f.replace("docs/01_one.md", "Its call:", "As chapter 05 shows:"),
            "docs/01_one.md:11: there is no chapter 05",
            remedy,
        ),
        (
            "a number alone, in a list, in a table",
            |f| f.replace("docs/01_one.md", "| a ULP |", "| as in 02 and 05 |"),
            "docs/01_one.md:29: there is no chapter 05",
            remedy,
        ),
        (
            "one of several",
            |f| f.replace("README.md", "# Fixture", "# Fixture\n\nSee chapters 01, 02 and 17.\n"),
            "README.md:3: there is no chapter 17",
            "; correct it, or write `chapter 17 (planned)`",
        ),
        (
            "a chapter that is there, called planned",
            |f| f.replace("docs/01_one.md", "Chapter 02 goes", "Chapter 02 (planned) goes"),
            "docs/01_one.md:24: chapter 02 is there",
            "; do not call it planned",
        ),
        (
            "a chapter by a name that it has not",
            |f| f.replace("docs/01_one.md", "or `02_basic`.", "or `02_basics`."),
            "docs/01_one.md:25: there is no chapter '02_basics'",
            "; correct its name",
        ),
    ];
    expect(&cases, &[]);
}

#[test]
fn files_lines_and_anchors_that_are_not_there_are_named_with_file_and_line() {
    let cases: [Case; 11] = [
        (
            "a file that is nowhere",
            |f| f.replace("docs/01_one.md", "`main.rs` calls", "`mean.rs` calls"),
            "docs/01_one.md:24: there is no file 'mean.rs'",
            "; correct it",
        ),
        (
            "another chapter's shader",
            |f| {
                f.replace("docs/exercises/01.1.diff", "Change `one.rgen`", "Change `camera.rgen`");
                f.run(&["sync"]);
            },
            "docs/exercises/01.1.diff:4: 'camera.rgen' is none of this chapter's files, but shaders/02_",
            "; correct it",
        ),
        (
            "a path that is not there",
            |f| f.replace("docs/01_one.md", "01_one/one.rgen:2", "01_one/won.rgen:2"),
            "docs/01_one.md:24: there is no 'shaders/01_one/won.rgen'",
            "; correct it",
        ),
        (
            "a line that is not there",
            |f| f.replace("docs/01_one.md", "one.rgen:2", "one.rgen:20"),
            "docs/01_one.md:24: 'shaders/01_one/one.rgen' has no line 20, but 6",
            "; correct it",
        ),
        (
            "an anchor of a source file that is not there",
            |f| f.replace("docs/01_one.md", "one.rgen#only` shows", "one.rgen#lonely` shows"),
            "docs/01_one.md:25: 'shaders/01_one/one.rgen' has no part 'lonely'",
            "; correct it",
        ),
        (
            "a heading that is not there",
            |f| f.replace("docs/01_one.md", "](#notes)", "](#note)"),
            "docs/01_one.md:25: 'docs/01_one.md' has no heading '#note'",
            "; correct it",
        ),
        (
            "a heading of another page that is not there",
            |f| f.replace("README.md", "# Fixture", "# Fixture\n\n[one](docs/01_one.md#tries)\n"),
            "README.md:3: 'docs/01_one.md' has no heading '#tries'",
            "; correct it",
        ),
        (
            "a module of the framework that is not there",
            |f| f.replace("docs/01_one.md", "`main.rs` calls", "`common::moon::Rock` calls"),
            "docs/01_one.md:24: there is no module `common::moon`",
            "; correct it",
        ),
        (
            "a command that compares a chapter that is not there",
            |f| f.replace("docs/02_basic.md", "diff 01 02`", "diff 01 07`"),
            "docs/02_basic.md:",
            "does not run: no chapter '07'; there is 01_one, 02_basic; correct it",
        ),
        (
            "a command that reads a file that is not there",
            |f| {
                let command = "# Fixture\n\n```sh\ncargo run -- --scene samples/moon.obj\n```\n";
                f.replace("README.md", "# Fixture\n", command);
            },
            "README.md:4: there is no 'samples/moon.obj'",
            "; correct it",
        ),
        (
            "a command that runs no test",
            |f| {
                f.replace(
                    "docs/exercises/01.1.diff",
                    "samples basic::first",
                    "samples basic::last",
                );
                f.run(&["sync"]);
            },
            "docs/exercises/01.1.diff:5: no test of 'samples' is called 'basic::last'",
            "; correct the command",
        ),
    ];
    expect(&cases, &[]);
}

#[test]
fn exercises_without_a_list_or_a_definition_are_named_with_file_and_line() {
    let cases: [Case; 8] = [
        (
            "no exercises at all",
            |f| f.replace("docs/02_basic.md", "## Try it", "## Tried"),
            "docs/02_basic.md:1: the page has no section `## Try it`",
            "; add it, with exercises",
        ),
        (
            "no list of them",
            |f| {
                let page = f.read("docs/02_basic.md");
                let list = page.find("<!-- exercises 02_basic -->").expect("a list");
                f.write("docs/02_basic.md", &page[..list]);
            },
            "docs/02_basic.md:",
            "; add <!-- exercises 02_basic --> and <!-- /exercises --> below it",
        ),
        (
            "an exercise that only the page knows",
            |f| f.replace("docs/02_basic.md", "<!-- exercises", "7. Run it.\n\n<!-- exercises"),
            "docs/02_basic.md:",
            "; move it to docs/exercises/02.7.diff; `chapters sync` lists it here",
        ),
        (
            "a chapter without an exercise",
            |f| {
                for file in ["01.1", "01.2"] {
                    f.remove(&format!("docs/exercises/{file}.diff"));
                }
                f.run(&["sync"]);
            },
            "docs/01_one.md:31: the chapter has no exercise",
            "; write docs/exercises/01.1.diff",
        ),
        (
            "an exercise left out",
            |f| {
                f.remove("docs/exercises/02.2.diff");
                f.run(&["sync"]);
            },
            "docs/exercises/02.3.diff:1: there is no exercise 2 before this one",
            "; count from 1",
        ),
        (
            "an exercise that is not there",
            |f| {
                f.replace("docs/exercises/01.2.diff", "after exercise 1", "after exercise 3");
                f.run(&["sync"]);
            },
            "docs/exercises/01.2.diff:4: there is no exercise 3, only 2",
            "; correct the number",
        ),
        (
            "a run that sets what is not there",
            |f| f.replace("docs/exercises/02.2.diff", "Run: --set show", "Run: --set shew"),
            "docs/exercises/02.2.diff:7: this command does not run: there is no control 'shew', only ",
            "; correct it",
        ),
        (
            "a solution that does not fit",
            |f| f.replace("docs/exercises/01.1.diff", "-    // first", "-    // the first"),
            "docs/exercises/01.1.diff:13: this hunk does not fit shaders/01_one/one.rgen",
            "; make the patch again",
        ),
    ];
    expect(&cases, &[]);
}

#[test]
fn shared_shaders_say_who_teaches_them() {
    const FILE: &str = "shaders/common/false_color.glsl";
    let forms = "`// Of no chapter: …`";
    let cases: [Case; 4] = [
        (
            "no word of it",
            |f| f.replace(FILE, "// Of no chapter: what views are painted with.\n", "// Paint.\n"),
            "shaders/common/false_color.glsl:1: it does not say which chapter teaches it",
            forms,
        ),
        (
            "a chapter that is not there",
            |f| f.replace(FILE, "// Of no chapter: what", "// Like b.glsl in 07_paint, but what"),
            "shaders/common/false_color.glsl:1: there is no chapter '07_paint'",
            forms,
        ),
        (
            "a chapter that does without",
            |f| {
                f.replace(
                    FILE,
                    "// Of no chapter: what views are painted with.",
                    "// Taught by 01_one.",
                )
            },
            "shaders/common/false_color.glsl:1: 01_one teaches it and does not include it",
            "include it there",
        ),
        (
            "a page that is silent",
            |f| {
                f.replace(
                    FILE,
                    "// Of no chapter: what views are painted with.",
                    "// Taught by 02_basic.",
                )
            },
            "shaders/common/false_color.glsl:1: docs/02_basic.md neither shows nor names it",
            "`<!-- snippet FILE#ANCHOR -->`",
        ),
    ];
    expect(&cases, &[]);
}

#[test]
fn one_text_stands_once() {
    let fixture = Fixture::new();
    fixture.write("shaders/common/paint.glsl", &fixture.read("shaders/common/false_color.glsl"));
    let line = "shaders/common/paint.glsl:1: it is the same as shaders/common/false_color.glsl; ";
    let found = fixture.check();
    assert!(found.contains(line), "{found}");
}
