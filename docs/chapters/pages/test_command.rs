//! Checks each `cargo test` on a page: `cargo test --test TARGET FILTER` must find a test.

use manuscript::fault::Fault;
use manuscript::project::Project;

use super::markdown::Code;
use crate::programs::test;

/// The tests that a `cargo test` runs.
#[derive(Debug, Default, PartialEq, Eq)]
struct Asked {
    target: Option<String>,
    filter: Option<String>,
}

/// The faults of all `cargo test` commands in a page's code.
pub fn check(project: &Project, page: &str, code: &[Code]) -> Vec<Fault> {
    let mut faults = Vec::new();
    for code in code.iter().filter(|code| code.is_shell()) {
        for (index, command) in code.text.lines().enumerate() {
            let wrong = asked(command).and_then(|asked| wrong(project, &asked));
            let fault = |what| Fault::new(page, code.line + index, what, "correct the command");
            faults.extend(wrong.map(fault));
        }
    }
    faults
}

/// The target and the filter of a command, if it is a `cargo test` of this package.
fn asked(command: &str) -> Option<Asked> {
    let words = shlex::split(command)?;
    let start = words.windows(2).position(|pair| pair == ["cargo", "test"])?;
    let mut asked = Asked::default();
    let mut rest = words[start + 2..].iter();
    while let Some(word) = rest.next() {
        match &**word {
            "--" | "&&" | "|" | ";" | "#" => break,
            "-p" | "--package" => return None,
            "--test" => asked.target = rest.next().cloned(),
            word if word.starts_with('-') => {}
            filter => asked.filter = Some(filter.to_owned()),
        }
    }
    Some(asked)
}

/// The reason why a command runs no test, or `None` if it runs one.
fn wrong(project: &Project, asked: &Asked) -> Option<String> {
    let target = asked.target.as_ref()?;
    let tests = test::of(project, target);
    if tests.is_empty() {
        return Some(format!("there is no test program '{target}'"));
    }
    let filter = asked.filter.as_ref()?;
    let found = tests.iter().any(|test| test.name.contains(&**filter));
    (!found).then(|| format!("no test of '{target}' is called '{filter}'"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_command_names_a_target_and_a_filter() {
        let of = |command: &str| asked(command).map(|asked| (asked.target, asked.filter));
        let some = |text: &str| Some(text.to_owned());
        let cases = [
            ("cargo test", Some((None, None))),
            ("cargo test --test a b::c -- --ignored d", Some((some("a"), some("b::c")))),
            ("UPDATE=1 cargo test --release --test a", Some((some("a"), None))),
            ("./setup --tests && cargo test", Some((None, None))),
            ("cargo test -p raybook x", None),
            ("cargo run --bin a", None),
        ];
        for (command, expected) in cases {
            assert_eq!(of(command), expected, "{command}");
        }
    }

    #[test]
    fn ci_runs_the_test_command_of_the_readme() {
        let command = "\n./setup --tests && cargo test\n";
        for text in [include_str!("../../../README.md"), include_str!("../../../.ci/run")] {
            assert_eq!(text.matches(command).count(), 1, "{text}");
        }
    }
}
