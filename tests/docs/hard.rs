//! `chapters hard`: a table of wrong answers, and the exit code, which depends on ours.

use std::path::Path;
use std::process::Command;

use ::run::{program, replace_line, shaders_with};

use crate::fixture::{Outcome, run};

/// By day llvmpipe compiles the shaders without LLVM's optimisation, which takes a third of the time for the same bits.
fn hard(arguments: &[&str], shaders: Option<&Path>) -> Outcome {
    run(command(arguments)
        .envs(shaders.map(|folder| ("SHADERS", folder)))
        .env("GALLIVM_PERF", "nopt"))
}

fn command(arguments: &[&str]) -> Command {
    program("24_accuracy");
    let mut command = Command::new(env!("CARGO_BIN_EXE_chapters"));
    command.arg("hard").args(arguments);
    command
}

/// The cells of the line that begins with a word, after a heading.
fn line(outcome: &Outcome, heading: &str, word: &str) -> Vec<String> {
    let mut lines = outcome.out.lines().skip_while(|line| !line.starts_with(heading));
    let found = lines.find(|line| line.starts_with(word)).expect("a line");
    found.split("  ").map(str::trim).filter(|cell| !cell.is_empty()).map(str::to_owned).collect()
}

#[test]
fn the_textbook_is_wrong_and_ours_is_not() {
    let outcome = hard(&["--seed", "7", "--rays", "40"], None);
    assert_eq!(outcome.code, 0, "{}{}", outcome.out, outcome.err);
    assert!(outcome.out.contains("random rays from seed 7"), "{}", outcome.out);
    let number = |cell: &str| -> u32 { cell.replace(',', "").parse().expect("a number") };
    for heading in ["hard cases", "random rays"] {
        let all = line(&outcome, heading, "all ");
        assert!(number(&all[2]) > 20, "{heading}: {all:?}");
        assert!(["0", "not offered"].contains(&&*all[3]), "{heading}: {all:?}");
    }
}

#[test]
#[ignore = "nightly: the whole table twice; quick: hard::the_textbook_is_wrong_and_ours_is_not"]
fn the_same_seed_draws_the_same_rays() {
    let textbook = || {
        let outcome = run(&mut command(&["--seed", "7", "--rays", "40"]));
        line(&outcome, "random rays", "all ")[2].clone()
    };
    assert_eq!(textbook(), textbook());
}

#[test]
fn one_wrong_digit_of_ours_fails() {
    // The product's rounding error is lost, both by fma() and by halves, so two floats are no better than
    // one.
    let file = "common/error_free.glsl";
    let shaders = shaders_with(file, "= fma_once(a, b, -product)", "= 0.0 * fma(a, b, -product)");
    replace_line(shaders.path(), file, "= ((x.x * y.x", "= 0.0 * ((x.x * y.x");
    let outcome = hard(&["--seed", "7", "--rays", "40"], Some(shaders.path()));
    assert_eq!(outcome.code, 1, "{}{}", outcome.out, outcome.err);
    assert!(outcome.err.starts_with("error: ours is wrong in "), "{}", outcome.err);
    assert_eq!(outcome.err.lines().count(), 1, "{}", outcome.err);
}

#[test]
fn wrong_arguments_are_one_line() {
    let cases = [
        (&["--seed", "0"][..], "a seed is a whole number from 1 to 4294967295"),
        (&["--rays", "x"], "rays are a whole number from 1 to 100000"),
        (&["--device", "no such device"], "no such device"),
    ];
    for (arguments, part) in cases {
        let outcome = hard(arguments, None);
        assert_eq!(outcome.code, 2, "{arguments:?}: {}", outcome.err);
        assert!(outcome.err.contains(part), "{arguments:?}: {}", outcome.err);
        assert_eq!(outcome.err.lines().count(), 1, "{arguments:?}: {}", outcome.err);
    }
}
