//! Exercises renumbered when their chapter was split: `"exercise 08.5" = "42.2"` in `docs/moved.toml`.

use std::collections::BTreeMap;

use manuscript::fault::Fault;
use manuscript::project::Project;

use super::exercise::Exercise;

/// The file that lists them, together with the moved pages.
const FILE: &str = "docs/moved.toml";

/// The first word of an exercise's line; the other lines are moved pages.
const WORD: &str = "exercise ";

/// The new number of each moved exercise, by its old one.
pub struct Moved(BTreeMap<String, String>);

impl Moved {
    /// Reads the project's moved exercises; none if the file is missing. The website reports a damaged file.
    pub fn read(project: &Project) -> Self {
        Self::of(&project.read(FILE).unwrap_or_default())
    }

    fn of(text: &str) -> Self {
        let table: BTreeMap<String, String> = toml::from_str(text).unwrap_or_default();
        let own = table.into_iter();
        Self(own.filter_map(|(old, new)| Some((old.strip_prefix(WORD)?.to_owned(), new))).collect())
    }

    /// The new number of the exercise that once had this one.
    pub fn now(&self, old: &str) -> Option<&str> {
        self.0.get(old).map(String::as_str)
    }

    /// The faults of lines whose new number does not exist.
    pub fn check(&self, project: &Project, exercises: &[Exercise]) -> Vec<Fault> {
        let text = project.read(FILE).unwrap_or_default();
        let names: Vec<String> = exercises.iter().map(Exercise::to_string).collect();
        let lost = self.0.iter().filter(|(_, new)| !names.contains(new));
        let fault = |(old, new): (&String, &String)| {
            let start = format!("\"{WORD}{old}\"");
            let line = text.lines().position(|line| line.starts_with(&start)).unwrap_or_default();
            Fault::new(FILE, 1 + line, format!("there is no exercise {new}"), "correct it")
        };
        lost.map(fault).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_moved_exercise_has_its_new_number() {
        let text = "# so\n\"one.md#old\" = \"two.md#new\"\n\"exercise 08.5\" = \"42.2\"\n";
        let moved = Moved::of(text);
        assert_eq!(moved.now("08.5"), Some("42.2"));
        assert_eq!(moved.now("08.4"), None);
        assert_eq!(moved.now("one.md#old"), None);
        assert_eq!(Moved::of("").now("08.5"), None);
    }
}
