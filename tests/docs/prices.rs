//! `chapters prices`: the table of the page, with a column of this device.

use std::process::Command;

use ::run::program;

use crate::fixture::{Outcome, run};

fn prices(arguments: &[&str]) -> Outcome {
    run(Command::new(env!("CARGO_BIN_EXE_chapters")).arg("prices").args(arguments))
}

#[test]
fn a_row_has_what_is_stored_and_what_is_measured_here() {
    program("26_leaving_a_surface");
    let outcome = prices(&["--only", "against no step", "--rounds", "3"]);
    assert_eq!(outcome.code, 0, "{}{}", outcome.out, outcome.err);
    assert!(outcome.out.contains("No GPU with ray tracing hardware has been measured yet"));
    let row = outcome.out.lines().find(|line| line.contains("against no step")).expect("a row");
    let cells: Vec<&str> = row.split("  ").map(str::trim).filter(|cell| !cell.is_empty()).collect();
    let [_, software, h200, yours, middle] = cells[..] else { panic!("{row}") };
    let number = |cell: &str| -> f64 { cell.parse().expect("a number") };
    assert!(number(software) > 0.0 && number(h200) > 0.0, "{row}");
    let (low, high) = middle.split_once(" to ").expect("quartiles");
    assert!(number(low) <= number(yours) && number(yours) <= number(high), "{row}");
}

#[test]
fn wrong_arguments_are_one_line() {
    for (arguments, part) in [
        (&["--only", "no such row"][..], "no row has 'no such row'; there is: rays that start"),
        (&["--rounds", "2"], "rounds are a whole number from 3 to 1000"),
        (&["--only", ""], "a value is required for '--only <WORD>'"),
        (&["--picture", "a.jpg"], "the picture is a .png file"),
    ] {
        let outcome = prices(arguments);
        assert_eq!(outcome.code, 2, "{arguments:?}: {}", outcome.err);
        assert!(outcome.err.contains(part), "{arguments:?}: {}", outcome.err);
        assert_eq!(outcome.err.lines().count(), 1, "{arguments:?}: {}", outcome.err);
    }
}
