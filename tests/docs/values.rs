//! Figures on pages: held to the measurements that gave them, which are renewed when their sources change.
//!
//! A script takes the place of `cargo`: what a test would give, it writes.

use std::fs;
use std::os::unix::fs::PermissionsExt;

use crate::fixture::{Fixture, Outcome, run};

const PAGE: &str = "docs/02_basic.md";
const FILE: &str = "docs/figures/02_basic/rows.json";

/// What follows.
const BELOW: &str = "<!-- diff 01_one";

/// What stands on the page: a paragraph, and a table.
const TEXT: &str = "<!-- measure rows -->
```sh
cargo test --test samples basic::first
```

Of 1,234 rays 3 are 5.5 % off, as 32 bits make them (llvmpipe, Mesa 25.0.7, 2026-11-22).
<!-- explains 32 -->
<!-- figures rows: all off part -->

| rows | all | off |
|---|---|---|
| 40 | 1,234 | 3 |
<!-- figures rows: all off -->
";

/// A project with figures, measured.
fn project() -> Fixture {
    let fixture = Fixture::new();
    fixture.replace(PAGE, BELOW, &format!("{TEXT}\n{BELOW}"));
    let outcome = measure(&fixture, &["02"], r#""all": 1234, "off": 3, "part": 0.0551"#);
    assert_eq!(outcome.code, 0, "{}{}", outcome.out, outcome.err);
    let date = fixture.read(FILE).split("\"date\": \"").nth(1).unwrap()[..10].to_owned();
    assert!(fixture.read(PAGE).contains(&format!("Mesa 25.0.7, {date})")), "the note has its day");
    assert_eq!(fixture.check(), "");
    fixture
}

/// Runs `measure` where the test would give these values.
fn measure(fixture: &Fixture, names: &[&str], values: &str) -> Outcome {
    let given = format!(
        r#"{{ "timed": false, "device": "llvmpipe (LLVM 15.0.6, 256 bits)", "driver": "Mesa 25.0.7-2", "values": {{ {values} }} }}"#
    );
    let script = format!(
        "#!/bin/sh\nmkdir -p $FIGURES/02_basic\ncat > $FIGURES/02_basic/rows.json << 'END'\n{given}\nEND\n"
    );
    let folder = tempfile::tempdir().expect("a temporary folder");
    let cargo = folder.path().join("cargo");
    fs::write(&cargo, script).expect("a script");
    fs::set_permissions(&cargo, fs::Permissions::from_mode(0o755)).expect("a script may be run");
    run(fixture.command(&[&["measure"], names].concat()).env("CARGO", &cargo))
}

/// One fault: how it is made, and the lines that `check` must give, each by its start and end.
type Case = (&'static str, fn(&Fixture), &'static [(&'static str, &'static str)]);

#[test]
fn what_is_no_longer_what_was_measured_is_named() {
    const SYNC: &str = "; run: cargo chapters sync";
    let cases: [Case; 6] = [
        (
            "a figure changed by hand",
            |f| f.replace(PAGE, "Of 1,234", "Of 1,243"),
            &[(
                "docs/02_basic.md:13: the figure 1,243 is 1,234 in docs/figures/02_basic/rows.json (all)",
                SYNC,
            )],
        ),
        (
            "a small one, in a table",
            |f| f.replace(PAGE, "| 1,234 | 3 |", "| 1,234 | 4 |"),
            &[("docs/02_basic.md:19: the figure 4 is 3 in", SYNC)],
        ),
        (
            "a part in hundredths",
            |f| f.replace(PAGE, "5.5 %", "5.6 %"),
            &[("docs/02_basic.md:13: the figure 5.6 is 5.5 in", SYNC)],
        ),
        (
            "a day changed by hand",
            |f| {
                let today = f.read(FILE).split("\"date\": \"").nth(1).unwrap()[..10].to_owned();
                f.replace(PAGE, &format!("25.0.7, {today}"), "25.0.7, 2025-01-02");
            },
            &[(
                "docs/02_basic.md:13: this note says 2025-01-02, docs/figures/02_basic/rows.json is of ",
                SYNC,
            )],
        ),
        (
            "a value that came out otherwise",
            |f| f.replace(FILE, "1234", "1235"),
            &[
                ("docs/02_basic.md:13: the figure 1,234 is 1,235 in", SYNC),
                ("docs/02_basic.md:19: the figure 1,234 is 1,235 in", SYNC),
            ],
        ),
        (
            "numbers that wander",
            |f| f.replace(FILE, "1234", "999.6"),
            &[
                ("docs/02_basic.md:13: the figure 1,234 is 1,000 in", SYNC),
                ("docs/02_basic.md:19: the figure 1,234 is 1,000 in", SYNC),
            ],
        ),
    ];
    for (name, break_it, lines) in cases {
        let fixture = project();
        break_it(&fixture);
        expect(name, &fixture, lines);
        assert_eq!(fixture.run(&["sync"]).code, 0, "{name}: sync");
        assert_eq!(fixture.check(), "", "{name}: not mended");
    }
}

/// A table with figures of two measurements on two devices, one of them a compiler without times.
const ROWS: &str = "
| rung | time | registers |
|---|---|---|
| S0 textbook | 1.00 | 32 |
| T0 device |  | 36 |
<!-- figures times: *.ratio; compiled: *.registers -->

> Measured: llvmpipe, Mesa 25.0.7, 2026-11-22. Estimated: RADV, Mesa 25.0.7, 2026-11-21.

";

/// A project with that table, and what it is of.
fn with_rows() -> Fixture {
    let fixture = project();
    fixture.replace(PAGE, BELOW, &format!("{ROWS}{BELOW}"));
    let marker = "<!-- measure times compiled: cargo test --test samples basic::first -->";
    fixture.replace(PAGE, "<!-- measure rows -->", &format!("{marker}\n\n<!-- measure rows -->"));
    let [head, tail] = [0, 1].map(|part| {
        let rows = fixture.read(FILE);
        rows.split("\"timed\"").nth(part).expect("a stored measurement").to_owned()
    });
    let sources = tail.split("\"sources\": ").nth(1).expect("sources").split(',').next().unwrap();
    let of = |device: &str, day: &str, values: &str| {
        format!(
            r#"{head}"timed": false, "device": "{device}", "driver": "Mesa 25.0.7-2", "date": "{day}", "sources": {sources}, "values": {{ {values} }} }}"#
        )
    };
    let file = |name: &str| FILE.replace("rows", name);
    let times = of("llvmpipe", "2026-11-22", r#""S0-textbook.ratio": 1.0"#);
    fixture.write(&file("times"), &times);
    let registers = r#""S0-textbook.registers": 32, "T0-device.registers": 36"#;
    fixture.write(&file("compiled"), &of("RADV", "2026-11-21", registers));
    fixture
}

#[test]
fn a_table_s_figures_are_named_once_for_all_rows() {
    let cases: [(&str, &str, &str, &str); 5] = [
        ("a figure changed by hand", "| 36 |", "| 63 |", "the figure 63 is 36 in"),
        ("a cell that should be empty", "|  | 36 |", "| 1.00 | 36 |", "3 names for 4 numbers"),
        ("a row by another name", "| T0 device |", "| T1 device |", "2 names for 3 numbers"),
        ("another compiler", "RADV, Mesa 25.0.7", "RADV, Mesa 26.0.1", "this note says 26.0.1"),
        ("no compiler", "RADV, Mesa 25.0.7", "its compiler, Mesa 25.0.7", "no note says which"),
    ];
    let whole = with_rows().check();
    assert_eq!(whole, "");
    for (name, from, to, what) in cases {
        let fixture = with_rows();
        fixture.replace(PAGE, from, to);
        let found = fixture.check();
        assert!(found.contains(what), "{name}: {found}");
    }
}

#[test]
fn what_only_an_author_can_mend_is_named() {
    let cases: [Case; 11] = [
        (
            "a figure without a measurement",
            |f| f.replace(PAGE, BELOW, &format!("It has 77 rows and 2 ms.\n\n{BELOW}")),
            &[("docs/02_basic.md:22: 77, 2 are bound to no measurement; add <!-- figures", "gave")],
        ),
        (
            "one that only explains",
            |f| {
                f.replace(PAGE, BELOW, &format!("It has 77 rows.\n<!-- explains 77 -->\n\n{BELOW}"))
            },
            &[],
        ),
        (
            "an explained number that has gone",
            |f| f.replace(PAGE, "as 32 bits", "as 16 bits"),
            &[("docs/02_basic.md:14: no number 32 stands above", "; take it out of the comment")],
        ),
        (
            "a value that is not there",
            |f| f.replace(PAGE, "rows: all off part", "rows: all off half"),
            &[(
                "docs/02_basic.md:13: docs/figures/02_basic/rows.json has no value 'half'",
                "; name one of all, off, part",
            )],
        ),
        (
            "a measurement that is not there",
            |f| f.replace(PAGE, "figures rows: all off -->", "figures lines: all off -->"),
            &[(
                "docs/02_basic.md:19: there is no docs/figures/02_basic/lines.json",
                "; run: cargo chapters measure 02_basic/lines",
            )],
        ),
        (
            "another device",
            |f| f.replace(PAGE, "(llvmpipe, Mesa 25.0.7", "(llvmpipe, Mesa 26.0.1"),
            &[(
                "docs/02_basic.md:13: this note says 26.0.1, docs/figures/02_basic/rows.json is of ll",
                "; correct it",
            )],
        ),
        (
            "times of two days",
            |f| {
                f.replace(PAGE, "measure rows", "measure rows more");
                f.replace(PAGE, "rows: all off part", "rows: all off; more: part");
                f.replace(FILE, "\"timed\": false", "\"timed\": true");
                let text = f.read(FILE);
                let (head, rest) = text.split_once("\"date\": \"").unwrap();
                let other = format!("{head}\"date\": \"2025-01-02{}", &rest[10..]);
                f.write("docs/figures/02_basic/more.json", &other);
            },
            &[(
                "docs/02_basic.md:13: this note is of times of several days: docs/figures/02_basic/more.json of 2025-01-02, ",
                "; give each day a note of its own",
            )],
        ),
        (
            "no device",
            |f| f.replace(PAGE, "(llvmpipe, Mesa 25.0.7, ", "(on "),
            &[(
                "docs/02_basic.md:13: no note says which device gave docs/figures/02_basic/rows.json",
                "below, or `<!-- stamp -->` and `<!-- /stamp -->` for the page",
            )],
        ),
        (
            "a damaged file",
            |f| f.write(FILE, "{ \"command\": \"cargo\",\n"),
            &[(
                "docs/figures/02_basic/rows.json:2: this is no measurement: EOF while parsing",
                "; run: cargo chapters measure 02_basic/rows",
            )],
        ),
        (
            "a file that no page makes",
            |f| f.write("docs/figures/02_basic/old.json", &f.read(FILE)),
            &[(
                "docs/figures/02_basic/old.json:1: stray file: no page makes this measurement",
                "to a page",
            )],
        ),
        (
            "a marker without a command",
            |f| f.replace(PAGE, "| rows |", "<!-- measure lines -->\n\n| rows |"),
            &[("docs/02_basic.md:17: no command follows this measurement", "```sh block")],
        ),
    ];
    for (name, break_it, lines) in cases {
        let fixture = project();
        break_it(&fixture);
        expect(name, &fixture, lines);
    }
}

#[test]
fn a_change_of_what_was_measured_asks_for_a_new_measurement_and_names_the_page() {
    let stale = "docs/02_basic.md:8: the measurement docs/figures/02_basic/rows.json is older than what \
                 it measures; run: cargo chapters measure 02_basic/rows";
    let changes: [(&str, &str, &str); 2] = [
        ("shaders/common/false_color.glsl", "/ 255.0", "/ 254.0"),
        ("tests/samples/basic.rs", "fn first() {}", "fn first() { assert!(true) }"),
    ];
    for (file, from, to) in changes {
        let fixture = project();
        fixture.replace(file, from, to);
        let found = fixture.check();
        assert!(found.lines().any(|line| line == stale), "{file}: {found}");
        let before = fixture.read(FILE);
        let outcome = measure(&fixture, &[], r#""all": 1234, "off": 4, "part": 0.0551"#);
        assert_eq!(outcome.out, format!("{FILE}: renewed\n{PAGE}: renewed\n"), "{}", outcome.err);
        assert_ne!(fixture.read(FILE), before);
        assert!(
            fixture.read(PAGE).contains("Of 1,234 rays 4 are 5.5 % off"),
            "{}",
            fixture.read(PAGE)
        );
        // The pictures are older, too; nothing else is.
        let found = fixture.check();
        assert!(found.lines().all(|line| line.contains("the picture")), "{found}");
    }
    // A comment more or less measures nothing else.
    let fixture = project();
    fixture.replace("shaders/common/false_color.glsl", "\n", "\n// A comment.\n\n");
    assert_eq!(fixture.check(), "");
}

#[test]
fn what_cannot_be_measured_is_named() {
    let fixture = project();
    fixture.replace(PAGE, "basic::first", "basic::fi");
    let asked = "the measurement docs/figures/02_basic/rows.json was made by another command";
    assert!(fixture.check().contains(asked), "{}", fixture.check());
    fixture.replace(PAGE, "measure rows", "measure lines");
    let outcome = measure(&fixture, &["02_basic/lines"], "");
    let line = "docs/02_basic.md:8: 02_basic/lines cannot be measured: its command gives no 02_basic/lines; \
                correct the command or the test";
    assert!(outcome.out.lines().any(|told| told == line), "{}", outcome.out);
    let outcome = measure(&fixture, &["rows"], "");
    assert_eq!(outcome.code, 2);
    assert_eq!(outcome.err, "error: nothing measures 'rows'; there is 02_basic/lines\n");
}

/// Holds that `check` gives these lines and no other.
fn expect(name: &str, fixture: &Fixture, lines: &[(&str, &str)]) {
    let found = fixture.check();
    for (start, end) in lines {
        let line = found.lines().any(|line| line.starts_with(start) && line.ends_with(end));
        assert!(line, "{name}: no line '{start} … {end}' in:\n{found}");
    }
    assert_eq!(found.lines().count(), lines.len(), "{name}: other lines:\n{found}");
}
