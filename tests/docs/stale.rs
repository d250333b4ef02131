//! Generated text that no longer matches the code: found, and fixed by `sync`.

use std::fs;

use crate::fixture::Fixture;
use crate::{Case, expect};

const SYNC: &str = "; run: cargo chapters sync";

#[test]
fn what_is_generated_is_found_stale_and_mended() {
    let cases: [Case; 10] = [
        (
            "a word of a snippet edited",
            |f| f.replace("docs/01_one.md", "run(name)", "run(game)"),
            "docs/01_one.md:16: this snippet is not what samples/01_one/main.rs#call says",
            SYNC,
        ),
        (
            "a snippet's fence lost",
            |f| f.replace("docs/01_one.md", "漢字\n```", "漢字"),
            "docs/01_one.md:17: this snippet is not",
            SYNC,
        ),
        (
            "a line of a diff edited",
            |f| f.replace("docs/02_basic.md", "\n-fn main() {", "\n-fn main(){"),
            "docs/02_basic.md:",
            SYNC,
        ),
        (
            "a control changed",
            |f| f.replace("docs/02_basic.md", "| `sun elevation` |", "| `sun height` |"),
            "docs/02_basic.md:",
            SYNC,
        ),
        (
            "a control's row lost",
            |f| f.replace("docs/02_basic.md", "| `field of view` |", "\n\n| "),
            "docs/02_basic.md:",
            SYNC,
        ),
        (
            "the gallery edited",
            |f| f.replace("README.md", "the second thing", "a second thing"),
            "README.md:6: this gallery is not what Cargo.toml says",
            SYNC,
        ),
        (
            "an exercise edited on its page",
            |f| f.replace("docs/02_basic.md", "**Make it white**", "**Make it pale**"),
            "docs/02_basic.md:",
            "this list of exercises is not what docs/exercises says; run: cargo chapters sync",
        ),
        (
            "the contents edited",
            |f| f.replace("docs/SUMMARY.md", "02 · Basic", "02 · Basics"),
            "docs/SUMMARY.md:4: the table of contents is not that of Cargo.toml",
            SYNC,
        ),
        (
            "the contents lost",
            |f| f.remove("docs/SUMMARY.md"),
            "docs/SUMMARY.md:1: the table of contents",
            SYNC,
        ),
        (
            "a new page beside the chapters",
            |f| f.write("docs/reading.md", "# How to read this book\n"),
            "docs/SUMMARY.md:3: the table of contents",
            SYNC,
        ),
    ];
    expect(&cases, &["sync"]);
}

#[test]
fn code_that_changes_makes_stale_what_shows_it() {
    let fixture = Fixture::new();
    fixture.replace("samples/01_one/main.rs", "run(name)", "run(\"name\")");
    let found = fixture.check();
    let shown = |start: &str| found.lines().any(|line| line.starts_with(start));
    assert!(shown("docs/01_one.md:16: this snippet"), "{found}");
    assert!(shown("docs/02_basic.md:"), "{found}");
    assert_eq!(fixture.run(&["sync"]).code, 0);
    assert_eq!(fixture.check(), "");
}

#[test]
fn pictures_of_other_commands_are_found_and_rendered_again() {
    let remedy = "; run: cargo chapters sync --pictures 02_basic";
    let cases: [Case; 4] = [
        (
            "the command changed",
            |f| f.replace("docs/02_basic.md", "32x20", "32x21"),
            "docs/02_basic.md:3: the picture docs/images/02_basic.png was made by another command",
            remedy,
        ),
        (
            "the picture lost",
            |f| f.remove("docs/images/02_basic.png"),
            "docs/02_basic.md:3: the picture docs/images/02_basic.png is missing",
            remedy,
        ),
        (
            "a picture from elsewhere",
            |f| {
                fs::copy(golden(), f.path("docs/images/02_basic.png")).expect("a file");
            },
            "docs/02_basic.md:3: the picture docs/images/02_basic.png does not say what made it",
            remedy,
        ),
        (
            "no picture at all",
            |f| f.write("docs/images/02_basic.png", "nonsense"),
            "docs/02_basic.md:3: the picture docs/images/02_basic.png is no PNG",
            remedy,
        ),
    ];
    expect(&cases, &["sync", "--pictures", "02_basic"]);
}

#[test]
fn a_picture_that_is_rendered_larger_is_shown_smaller_and_smooth() {
    let fixture = Fixture::new();
    let of = |size: &str| {
        let page = fixture.read("docs/02_basic.md");
        let (start, rest) = page.split_once("--size ").expect("a size");
        let (_, end) = rest.split_once(' ').expect("an end");
        fixture.write("docs/02_basic.md", &format!("{start}--size {size} {end}"));
        let outcome = fixture.run(&["sync", "--pictures", "02_basic"]);
        assert_eq!(outcome.code, 0, "{}{}", outcome.out, outcome.err);
        assert_eq!(fixture.check(), "");
        image::open(fixture.path("docs/images/02_basic.png")).expect("a picture").to_rgb8()
    };
    let (plain, smooth) = (of("960x60"), of("1920x120"));
    assert_eq!(smooth.dimensions(), plain.dimensions());
    // Antialiased edges differ; the rest of the picture is the same.
    let differ = plain
        .pixels()
        .zip(smooth.pixels())
        .filter(|(a, b)| a.0.iter().zip(b.0).any(|(a, b)| a.abs_diff(b) > 20));
    let part = differ.count() as f64 / f64::from(plain.width() * plain.height());
    assert!((0.001..0.1).contains(&part), "{part}");
}

/// A picture of two panels.
const TWO: &str = "\n![b](images/two.png)\n\n<!-- picture two -->\n```sh\n# the left\n\
                   cargo run --bin 02_basic -- --headless --size 96x60 --out a.png\n# the right\n\
                   cargo run --bin 02_basic -- --headless --size 96x60 --set show=normal --out b.png\n```\n";

#[test]
fn several_commands_make_panels_with_their_labels() {
    let fixture = Fixture::new();
    fixture.write("docs/02_basic.md", &(fixture.read("docs/02_basic.md") + TWO));
    let outcome = fixture.run(&["sync", "--pictures"]);
    assert_eq!(
        (outcome.code, outcome.out.lines().count()),
        (0, 1),
        "{}{}",
        outcome.out,
        outcome.err
    );
    assert_eq!(fixture.check(), "");
    let two = image::open(fixture.path("docs/images/two.png")).expect("a picture").to_rgb8();
    // Side by side under labels of the same height, and not the same picture twice.
    assert_eq!(two.dimensions(), (2 * 96 + 6, 60 + 22));
    assert!((0..96).any(|x| two.get_pixel(x, 50) != two.get_pixel(x + 102, 50)));
    let inked =
        |left: u32| (left..left + 60).any(|x| (0..22).any(|y| two.get_pixel(x, y)[0] < 128));
    assert!(inked(0) && inked(102));
    // Another label makes another picture.
    fixture.replace("docs/02_basic.md", "# the left", "# it");
    assert!(fixture.check().contains("two.png was made by another command"), "{}", fixture.check());
    fixture.replace("docs/02_basic.md", "# it\n", "");
    assert!(
        fixture.check().contains(": a panel has no label; write `# LABEL` on"),
        "{}",
        fixture.check()
    );
}

fn golden() -> std::path::PathBuf {
    run::root().join("tests/golden/02_basic.png")
}
