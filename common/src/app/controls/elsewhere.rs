//! Controls of other chapters, for a reader who looks for one in the wrong chapter.

use std::fs;

use crate::paths;

/// At most so many chapters are named.
const MOST: usize = 5;

/// The chapters of the book whose page lists a control, in the words of an error: `, which 42_distant_spheres has`.
/// Empty if there is none, or for a program of another crate.
pub fn chapters_with(name: &str) -> String {
    if paths::folder().is_some() {
        return String::new();
    }
    // A page has a table of its chapter's controls.
    let row = format!("| `{name}` | ");
    let pages = fs::read_dir(paths::book().join("docs")).into_iter().flatten().flatten();
    let pages = pages.filter_map(|entry| {
        let file = entry.file_name().into_string().ok()?;
        let chapter = file.strip_suffix(".md")?;
        let numbered = chapter.starts_with(|letter: char| letter.is_ascii_digit());
        let text = numbered.then(|| fs::read_to_string(entry.path()).ok())??;
        text.lines().any(|line| line.starts_with(&row)).then(|| chapter.to_owned())
    });
    let mut chapters: Vec<String> = pages.collect();
    chapters.sort();
    match &chapters[..] {
        [] => String::new(),
        [_, ..] if chapters.len() > MOST => String::new(),
        [one] => format!(", which {one} has"),
        [others @ .., last] => format!(", which {} and {last} have", others.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_control_is_found_where_it_moved_to() {
        assert_eq!(chapters_with("sphere rung"), ", which 42_distant_spheres has");
        assert_eq!(chapters_with("bogus"), "");
        // Every chapter has this one: to list them helps nobody.
        assert_eq!(chapters_with("field of view"), "");
    }
}
