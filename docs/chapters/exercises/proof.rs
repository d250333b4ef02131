//! One step of the check that an exercise is solved: a run and its conditions.

use manuscript::fault::Fault;

use super::expectation::{Expectation, FORMS};
use crate::patches::patch::Field;

/// The size of pictures where a run gives none.
const SIZE: [&str; 2] = ["--size", "160x100"];

/// Arguments that the tool adds itself.
const GIVEN: [&str; 4] = ["--headless", "--validate", "--out", "--report"];

/// The program or the tests that a step runs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Run {
    /// The chapter's program with these arguments.
    Program(Vec<String>),
    /// The tests of a test program whose names contain a filter.
    Test(String, String),
}

/// A run and its conditions.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// The program or the tests to run.
    pub run: Run,
    /// The conditions on its outcome.
    pub expectations: Vec<Expectation>,
}

/// Parses the runs and the conditions of each.
pub fn steps(file: &str, fields: Vec<Field>) -> Result<Vec<Step>, Fault> {
    let mut steps: Vec<Step> = Vec::new();
    for Field { line, key, value } in fields {
        let wrong = |what: String, remedy: &str| Err(Fault::new(file, line, what, remedy));
        if key == "Run" {
            let Some(run) = run(&value) else {
                let remedy = "write the program's arguments as in a shell, or (test) NAME";
                return wrong(format!("'{value}' is no run"), remedy);
            };
            if let Run::Program(arguments) = &run
                && let Some(given) = arguments.iter().find(|word| GIVEN.contains(&word.as_str()))
            {
                return wrong(format!("{given} is added to every run"), "remove it");
            }
            steps.push(Step { run, expectations: Vec::new() });
            continue;
        }
        let Some(expectation) = Expectation::parse(&value) else {
            return wrong(format!("'{value}' is no expectation"), FORMS);
        };
        let Some(step) = steps.last_mut() else {
            return wrong("nothing is run above this".to_owned(), "write `Run: …` first");
        };
        if matches!(step.run, Run::Test(..)) != expectation.is_of_tests() {
            let what = format!("'{value}' does not belong to this run");
            return wrong(what, "of tests it is `passes` or `fails`, of programs anything else");
        }
        step.expectations.push(expectation);
    }
    Ok(steps)
}

fn run(text: &str) -> Option<Run> {
    let Some((program, filter)) = text.strip_prefix("(test").and_then(|rest| rest.split_once(')'))
    else {
        return arguments(text).map(Run::Program);
    };
    let (program, filter) = (program.trim(), filter.trim());
    let program = if program.is_empty() { "samples" } else { program };
    let word = |text: &str| !text.is_empty() && !text.contains(char::is_whitespace);
    (word(program) && word(filter)).then(|| Run::Test(program.to_owned(), filter.to_owned()))
}

/// The words of a run's arguments.
fn arguments(text: &str) -> Option<Vec<String>> {
    shlex::split(text).map(sized)
}

/// Adds the usual size to arguments that contain none.
pub fn sized(mut arguments: Vec<String>) -> Vec<String> {
    if !arguments.iter().any(|word| word == "--size" || word.starts_with("--size=")) {
        arguments.extend(SIZE.map(str::to_owned));
    }
    arguments
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_run_is_arguments_or_a_test() {
        let program =
            |words: &[&str]| Some(Run::Program(words.iter().map(|w| (*w).to_owned()).collect()));
        let test =
            |program: &str, filter: &str| Some(Run::Test(program.to_owned(), filter.to_owned()));
        for (text, expected) in [
            ("", program(&["--size", "160x100"])),
            ("--set \"a b=c\" --size 3x2", program(&["--set", "a b=c", "--size", "3x2"])),
            ("(test) basic::normals", test("samples", "basic::normals")),
            ("(test numerics) hard", test("numerics", "hard")),
            ("(test) two words", None),
            ("(test)", None),
            ("--set \"a", None),
        ] {
            assert_eq!(run(text), expected, "{text}");
        }
    }
}
