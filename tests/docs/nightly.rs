//! Tests that plain `cargo test` leaves out: each says how it is run, and `chapters nightly` runs those
//! marked for the night.

#[cfg(unix)]
use std::fs;
#[cfg(unix)]
use std::os::unix::fs::PermissionsExt;

use crate::fixture::Fixture;
#[cfg(unix)]
use crate::fixture::run;

const FILE: &str = "tests/samples/basic.rs";

/// A project with a quick test and one that is ignored for this reason.
fn project(why: &str) -> Fixture {
    let fixture = Fixture::new();
    let slow = format!("\n#[test]\n#[ignore = \"{why}\"]\nfn second() {{}}\n");
    fixture.write(FILE, &(fixture.read(FILE) + &slow));
    fixture
}

#[test]
fn a_test_that_is_left_out_says_how_it_is_run() {
    for why in [
        "nightly: minutes; quick: basic::first",
        "nightly only: minutes",
        "by hand: draws",
        "run by first",
    ] {
        assert_eq!(project(why).check(), "", "{why}");
    }
    for (why, line) in [
        (
            "slow",
            "'basic::second' is left out and does not say how it is run; begin with `nightly: `",
        ),
        ("nightly: minutes", "'basic::second' names no quick test; add `; quick: NAME`"),
        ("nightly: minutes; quick: basic::third", "no quick test 'basic::third'; correct its name"),
        (
            "nightly: minutes; quick: basic::second",
            "no quick test 'basic::second'; correct its name",
        ),
    ] {
        let found = project(why).check();
        let start = format!("{FILE}:6: {line}");
        assert!(found.starts_with(&start) && found.lines().count() == 1, "{why}: {found}");
    }
}

#[test]
fn what_runs_at_night_is_listed_by_program() {
    let fixture = project("nightly only: minutes");
    let outcome = fixture.run(&["nightly", "--list"]);
    let list = "samples basic::second\n    nightly only: minutes\n";
    assert_eq!((outcome.code, &*outcome.out), (0, list), "{}", outcome.err);
    let outcome = fixture.run(&["nightly", "docs"]);
    let line = "error: no group 'docs'; there is samples, verify\n";
    assert_eq!((outcome.code, &*outcome.err), (2, line));
    assert_eq!(project("by hand: draws").run(&["nightly", "--list"]).out, "");
}

/// A script stands in for Cargo.
#[cfg(unix)]
#[test]
fn a_night_runs_each_program_s_tests_and_fails_if_one_does() {
    let fixture = project("nightly only: minutes");
    let cargo = fixture.path("cargo");
    for (code, end) in
        [(0, "samples: 1 tests, 0 s: passed\n"), (1, "samples: 1 tests, 0 s: FAILED\n")]
    {
        fs::write(&cargo, format!("#!/bin/sh\necho \"$@\"\nexit {code}\n")).expect("a script");
        fs::set_permissions(&cargo, fs::Permissions::from_mode(0o755)).expect("it may be run");
        let outcome = run(fixture.command(&["nightly"]).env("CARGO", &cargo));
        let asked = "test --test samples -- --ignored --exact basic::second\n";
        assert_eq!(
            (outcome.code, &*outcome.out),
            (code, &*format!("{asked}{end}2 verified, no difference\n")),
            "{}",
            outcome.err
        );
    }
}
