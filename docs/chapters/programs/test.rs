//! The tests of the project, and those that commands on pages run: `cargo test --test TARGET FILTER` must find one.

use manuscript::fault::Fault;
use manuscript::project::Project;

use crate::pages::markdown::Code;

/// A test.
pub struct Test {
    /// Its name, as its program lists it.
    pub name: String,
    /// Why plain `cargo test` leaves it out, if it does.
    pub ignored: Option<String>,
    /// Where it stands.
    pub file: String,
    /// The line of its `#[test]`, from 1.
    pub line: usize,
}

/// What a `cargo test` asks for.
#[derive(Debug, Default, PartialEq, Eq)]
struct Asked {
    target: Option<String>,
    filter: Option<String>,
}

/// What is wrong with the `cargo test`s in a page's code.
pub fn check(project: &Project, page: &str, code: &[Code]) -> Vec<Fault> {
    let shell = |code: &&Code| ["sh", "bash", "console", "shell", ""].contains(&&*code.language);
    let mut faults = Vec::new();
    for code in code.iter().filter(shell) {
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

/// Why a command runs no test, if it runs none.
fn wrong(project: &Project, asked: &Asked) -> Option<String> {
    let target = asked.target.as_ref()?;
    let tests = of(project, target);
    if tests.is_empty() {
        return Some(format!("there is no test program '{target}'"));
    }
    let filter = asked.filter.as_ref()?;
    let found = tests.iter().any(|test| test.name.contains(&**filter));
    (!found).then(|| format!("no test of '{target}' is called '{filter}'"))
}

/// The tests of a test program.
pub fn of(project: &Project, program: &str) -> Vec<Test> {
    let known = project.tests.iter().find(|known| known.name == program);
    let folder = known.and_then(|known| known.path.rsplit_once('/'));
    let folder = folder.map_or_else(|| format!("tests/{program}"), |(folder, _)| folder.to_owned());
    let mut tests = Vec::new();
    for file in project.files(&folder).into_iter().filter(|file| file.ends_with(".rs")) {
        let module = file[folder.len() + 1..].trim_end_matches(".rs").replace('/', "::");
        let module = module.trim_end_matches("::mod");
        let module = if module == "main" { String::new() } else { format!("{module}::") };
        let text = project.read(&file).unwrap_or_default();
        for (head, body) in
            text.match_indices("#[test]").map(|(at, mark)| text.split_at(at + mark.len()))
        {
            let Some((attributes, rest)) = body.split_once("fn ") else { continue };
            let Some((name, _)) = rest.split_once('(') else { continue };
            let line = head.lines().count();
            let ignored =
                attributes.split_once("#[ignore = \"").and_then(|(_, why)| why.split_once('"'));
            let ignored = ignored.map(|(why, _)| why.to_owned());
            tests.push(Test { name: format!("{module}{name}"), ignored, file: file.clone(), line });
        }
    }
    tests
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
            ("./setup && cargo test", Some((None, None))),
            ("cargo test -p common x", None),
            ("cargo run --bin a", None),
        ];
        for (command, expected) in cases {
            assert_eq!(of(command), expected, "{command}");
        }
    }
}
