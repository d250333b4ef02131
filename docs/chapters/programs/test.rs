//! The tests of the project, read from their sources.

use manuscript::project::Project;

/// A test.
pub struct Test {
    /// Its name, as its program lists it.
    pub name: String,
    /// The reason why plain `cargo test` leaves it out; `None` if it does not.
    pub ignored: Option<String>,
    /// Its file and line.
    pub file: String,
    /// The line of its `#[test]`, from 1.
    pub line: usize,
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
