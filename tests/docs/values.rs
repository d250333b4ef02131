//! Measured values on pages: compared with the stored ones, which `measure` renews and `verify` compares
//! again.
//!
//! A script stands in for `cargo` and writes the values a test would give.

use std::fs;
use std::os::unix::fs::PermissionsExt;

use crate::fixture::{Fixture, Outcome, run};

const PAGE: &str = "docs/02_basic.md";
const FILE: &str = "docs/values/02_basic.json";
const TABLES: &str = "docs/values/02_basic.md";

/// The first line after the text.
const BELOW: &str = "<!-- diff 01_one";

/// A paragraph, a table and a stamp.
const TEXT: &str = "<!-- measure rows -->
```sh
cargo test --test samples basic::first
```

Of 1,234<!-- rows.all --> rays 3<!-- rows.off --> are 5.5<!-- rows.part --> % off, as 32 bits make them.

<!-- table rows -->
<!-- /table -->

<!-- stamp -->
<!-- /stamp -->
";

/// The table's template.
const TABLE: &str = "## rows
| rows | all | off |
|---|---|---|
| 40 | {rows.all:0} | {rows.off:0} |
| {tent; two floats; box} | {rows.*.ms:0.0} | {rows.*.ratio} |
";

const VALUES: &str = r#""all": 1234, "off": 3, "part": 0.0551, "tent.ms": 2.34, "tent.ratio": 0.25,
    "two-floats.ms": 12.3"#;

/// A project with measured values.
fn project() -> Fixture {
    let fixture = Fixture::new();
    fixture.replace(PAGE, BELOW, &format!("{TEXT}\n{BELOW}"));
    fixture.write(TABLES, &TABLE.replace("; box", ""));
    let outcome = with_cargo(&fixture, &["measure", "02"], VALUES);
    assert_eq!(outcome.code, 0, "{}{}", outcome.out, outcome.err);
    let table = "| 40 | 1,234 | 3 |\n| tent | 2.3 | 0.25 |\n| two floats | 12.3 | |\n";
    let page = fixture.read(PAGE);
    assert!(page.contains(table), "{page}");
    assert!(
        page.contains("> Measured on llvmpipe (LLVM 15.0.6, 256 bits), Mesa 25.0.7, 20"),
        "{page}"
    );
    assert_eq!(fixture.check(), "");
    fixture
}

/// Runs the tool with a test that gives these values.
fn with_cargo(fixture: &Fixture, arguments: &[&str], values: &str) -> Outcome {
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
    run(fixture.command(arguments).env("CARGO", &cargo))
}

/// One fault: a function that makes it, and the lines that `check` must print, each by its start and end.
type Case = (&'static str, fn(&Fixture), &'static [(&'static str, &'static str)]);

#[test]
fn a_number_that_is_not_the_stored_one_is_named_and_filled_in() {
    const SYNC: &str = "; run: cargo chapters sync";
    let cases: [Case; 5] = [
        (
            "a bound number edited by hand",
            |f| f.replace(PAGE, "Of 1,234<", "Of 1,243<"),
            &[("docs/02_basic.md:13: 1,243 is 1,234 in 02_basic/rows (all)", SYNC)],
        ),
        (
            "a part in hundredths",
            |f| f.replace(PAGE, "5.5<", "5.6<"),
            &[("docs/02_basic.md:13: 5.6 is 5.5 in 02_basic/rows (part)", SYNC)],
        ),
        (
            "a cell of a table edited by hand",
            |f| f.replace(PAGE, "| 1,234 | 3 |", "| 1,234 | 4 |"),
            &[(
                "docs/02_basic.md:18: this table of values is not what docs/values/02_basic.md says",
                SYNC,
            )],
        ),
        (
            "another heading in the template",
            |f| f.replace(TABLES, "| off |", "| missed |"),
            &[("docs/02_basic.md:16: this table of values is not what", SYNC)],
        ),
        (
            "a stored value edited by hand",
            |f| f.replace(FILE, "1234", "1235"),
            &[
                ("docs/02_basic.md:13: 1,234 is 1,235 in 02_basic/rows (all)", SYNC),
                ("docs/02_basic.md:18: this table of values is not what", SYNC),
            ],
        ),
    ];
    for (name, break_it, lines) in cases {
        let fixture = project();
        break_it(&fixture);
        expect(name, &fixture, lines);
        assert_eq!(fixture.run(&["sync"]).code, 0, "{name}: sync");
        assert_eq!(fixture.check(), "", "{name}: not filled in");
    }
}

#[test]
fn what_only_an_author_can_correct_is_named() {
    let cases: [Case; 10] = [
        (
            "an unknown value",
            |f| f.replace(PAGE, "rows.off -->", "rows.half -->"),
            &[(
                "docs/02_basic.md:13: 02_basic/rows has no value 'half'",
                "; name one of all, off, part, tent.ms, tent.ratio, two-floats.ms",
            )],
        ),
        (
            "an unknown measurement",
            |f| f.replace(PAGE, "rows.off -->", "lines.off -->"),
            &[(
                "docs/02_basic.md:13: there is no measurement 02_basic/lines",
                "; run: cargo chapters measure 02_basic/lines",
            )],
        ),
        (
            "a binding without a number",
            |f| f.replace(PAGE, "3<!-- rows.off", "three<!-- rows.off"),
            &[("docs/02_basic.md:13: no number stands directly before <!-- rows.off -->", "blank")],
        ),
        (
            "an unknown value in a table",
            |f| f.replace(TABLES, "{rows.off:0}", "{rows.half:0}"),
            &[("docs/values/02_basic.md:1: 02_basic/rows has no value 'half'", "two-floats.ms")],
        ),
        (
            "a table without a template",
            |f| f.replace(PAGE, "<!-- table rows -->", "<!-- table lines -->"),
            &[
                (
                    "docs/02_basic.md:15: docs/values/02_basic.md has no table 'lines'",
                    "; write it there, below ## lines",
                ),
                ("docs/values/02_basic.md:1: 02_basic shows no table 'rows'", "or delete it"),
            ],
        ),
        (
            "no device",
            |f| {
                let page = f.read(PAGE);
                let (head, rest) = page.split_once("<!-- stamp -->").unwrap();
                let (_, rest) = rest.split_once("<!-- /stamp -->").unwrap();
                f.write(PAGE, &format!("{head}{rest}"));
            },
            &[(
                "docs/02_basic.md:13: this page does not say which device gave its values",
                "; add <!-- stamp --> and <!-- /stamp --> at its end",
            )],
        ),
        (
            "a damaged file",
            |f| f.write(FILE, "{ \"rows\": {\n"),
            &[
                ("docs/02_basic.md:24: this stamp is not what docs/values says", ""),
                ("docs/values/02_basic.md:1: there is no measurement 02_basic/rows", ""),
                (
                    "docs/values/02_basic.json:2: these are no stored values: EOF while parsing",
                    "; run: cargo chapters measure 02_basic",
                ),
            ],
        ),
        (
            "a measurement of the file alone, not yet made",
            |f| {
                f.replace(
                    FILE,
                    "{\n  \"rows\"",
                    "{\n  \"lines\": { \"command\": \"cargo test x\" },\n  \"rows\"",
                )
            },
            &[("docs/02_basic.md:1: 02_basic/lines is not measured yet", "measure 02_basic/lines")],
        ),
        (
            "values of no page",
            |f| f.write("docs/values/03_gone.json", "{}\n"),
            &[("docs/values/03_gone.json:1: stray file: no page has its name", "; delete it")],
        ),
        (
            "a marker without a command",
            |f| f.replace(PAGE, "Of 1,234", "<!-- measure lines -->\n\nOf 1,234"),
            &[("docs/02_basic.md:13: no command follows this measurement", "```sh block")],
        ),
    ];
    for (name, break_it, lines) in cases {
        let fixture = project();
        break_it(&fixture);
        expect(name, &fixture, lines);
    }
}

#[test]
fn an_unbound_number_is_prose_and_only_warned_of() {
    let fixture = project();
    for arguments in [&["init", "-q"][..], &["add", "."], &["commit", "-qm", "All"]] {
        let mut git = std::process::Command::new("git");
        git.args(["-c", "user.name=a", "-c", "user.email=b@c"]).args(arguments);
        assert!(git.current_dir(fixture.path("")).status().expect("git").success());
    }
    let numbers = "Of 98,765 rays, 1234 at 480×300 in 2026 and 1,024 threads, 10,000 hit `4321`.";
    fixture.replace(PAGE, BELOW, &format!("{numbers}\n\n{BELOW}"));
    let outcome = fixture.run(&["check"]);
    assert_eq!((outcome.code, &*outcome.out), (0, ""), "{}", outcome.err);
    let line = "warning: docs/02_basic.md:27: bound to no measurement: 98,765, 1234; a measured one is \
                written NUMBER<!-- MEASUREMENT.VALUE -->\n";
    assert_eq!(outcome.err, line);
}

#[test]
fn verify_runs_the_commands_again_and_names_what_differs() {
    let fixture = project();
    let verify = |values: &str| with_cargo(&fixture, &["verify"], values);
    let outcome = verify(VALUES);
    assert_eq!(outcome.code, 0, "{}{}", outcome.out, outcome.err);
    assert!(outcome.out.ends_with("verified, no difference\n"), "{}", outcome.out);
    // Another value, and another picture.
    fixture.replace(
        "shaders/02_basic/camera.rgen",
        "ivec2(id), payload)",
        "ivec2(id), 0.5 * payload)",
    );
    let outcome = verify(&VALUES.replace("\"off\": 3", "\"off\": 4"));
    assert_eq!(outcome.code, 1, "{}", outcome.out);
    let differ = |start: &str, end: &str| {
        outcome.out.lines().any(|line| line.starts_with(start) && line.ends_with(end))
    };
    let picture = "; run: cargo chapters sync --pictures 02_basic";
    assert!(differ("docs/images/02_basic.png: ", picture), "{}", outcome.out);
    let value = "02_basic/rows: off was 3, is 4; run: cargo chapters measure 02_basic/rows";
    assert!(differ(value, ""), "{}", outcome.out);
    assert!(outcome.err.ends_with(" differ\n"), "{}", outcome.err);
    // A change of text makes no other picture, and unchanged values are not written again.
    fixture.replace(
        "shaders/02_basic/camera.rgen",
        "ivec2(id), 0.5 * payload)",
        "ivec2(id), /* as it is */ payload)",
    );
    let before =
        fs::metadata(fixture.path("docs/images/02_basic.png")).unwrap().modified().unwrap();
    let outcome = fixture.run(&["sync", "--pictures", "02_basic"]);
    assert!(outcome.out.ends_with("docs/images/02_basic.png: the same\n"), "{}", outcome.out);
    let after = fs::metadata(fixture.path("docs/images/02_basic.png")).unwrap().modified().unwrap();
    assert_eq!(before, after);
    let outcome = with_cargo(&fixture, &["verify", "02"], VALUES);
    assert_eq!(outcome.code, 0, "{}{}", outcome.out, outcome.err);
    let outcome = fixture.run(&["verify", "09"]);
    let line = "error: nothing of the book is called '09'\n";
    assert_eq!((outcome.code, &*outcome.err), (2, line));
}

#[test]
fn a_new_measurement_fills_the_page() {
    let fixture = project();
    let values = VALUES.replace("\"off\": 3", "\"off\": 4");
    let outcome = with_cargo(&fixture, &["measure", "02_basic/rows"], &values);
    assert_eq!(
        outcome.out,
        format!("02_basic/rows: renewed\n{PAGE}: renewed\n"),
        "{}",
        outcome.err
    );
    let page = fixture.read(PAGE);
    assert!(page.contains(" rays 4<!-- rows.off --> are 5.5<!-- rows.part --> % off"), "{page}");
    assert_eq!(fixture.check(), "");
    let outcome = with_cargo(&fixture, &["measure", "02_basic/rows"], &values);
    assert_eq!(outcome.out, "02_basic/rows: the same\n", "{}", outcome.err);
}

#[test]
fn what_cannot_be_measured_is_named() {
    let fixture = project();
    fixture.replace(PAGE, "basic::first", "basic::fi");
    let asked = "the measurement 02_basic/rows was made by another command";
    assert!(fixture.check().contains(asked), "{}", fixture.check());
    fixture.replace(PAGE, "measure rows", "measure rows lines");
    let outcome = with_cargo(&fixture, &["measure", "02_basic/lines"], "");
    let line = "docs/02_basic.md:8: 02_basic/lines cannot be measured: its command gives no 02_basic/lines; \
                correct the command or the test";
    assert!(outcome.out.lines().any(|told| told == line), "{}", outcome.out);
    let outcome = with_cargo(&fixture, &["measure", "rows"], "");
    assert_eq!(outcome.code, 2);
    assert_eq!(
        outcome.err,
        "error: nothing measures 'rows'; there is 02_basic/lines, 02_basic/rows\n"
    );
}

/// Asserts that `check` prints exactly these lines.
fn expect(name: &str, fixture: &Fixture, lines: &[(&str, &str)]) {
    let found = fixture.check();
    for (start, end) in lines {
        let line = found.lines().any(|line| line.starts_with(start) && line.ends_with(end));
        assert!(line, "{name}: no line '{start} … {end}' in:\n{found}");
    }
    assert_eq!(found.lines().count(), lines.len(), "{name}: other lines:\n{found}");
}
