//! Checks the files, lines and anchors that a page mentions: in inline code, in commands and in links.

use std::collections::BTreeSet;

use manuscript::anchor::parts;
use manuscript::fault::Fault;
use manuscript::link::local;
use manuscript::page::Page;
use manuscript::project::{Chapter, Project};
use manuscript::shader;

use super::markdown::{Code, Link, Markdown};
use super::mention::{chapters, codes};

/// The folders whose files a page may mention.
const FOLDERS: [&str; 5] = ["common", "docs", "samples", "shaders", "tests"];
/// The extensions of files that a page may mention without their folder, besides shaders.
const EXTENSIONS: [&str; 5] = ["rs", "toml", "obj", "mtl", "md"];
/// The words before a file that the reader writes.
const WRITES: [&str; 3] = ["Write `", "write `", "` to `"];
/// Arguments that name a file to be written.
const OUTPUTS: [&str; 4] = ["--out", "--report", "--save", "--measure"];

/// The names that the pages of a project may use.
pub struct Files<'a> {
    project: &'a Project,
    all: Vec<String>,
}

impl<'a> Files<'a> {
    /// Finds every file.
    pub fn of(project: &'a Project) -> Self {
        let all = FOLDERS.into_iter().flat_map(|folder| project.files(folder)).collect();
        Self { project, all }
    }

    /// The faults of the files, lines and anchors that a page mentions.
    pub fn check(&self, page: &Page, written: &Markdown) -> Vec<Fault> {
        let fault = |line: usize, what: String| Fault::new(&*page.path, line, what, "correct it");
        let mut faults = Vec::new();
        let mut new = BTreeSet::new();
        for (line, text) in page.prose() {
            for (start, code) in codes(text) {
                if WRITES.iter().any(|writes| text[..start].ends_with(writes)) {
                    new.insert(code);
                }
                let wrong = (!new.contains(code)).then(|| self.wrong(page, text, code)).flatten();
                faults.extend(wrong.map(|what| fault(line, what)));
            }
        }
        let block = |code: &&Code| code.is_shell() && !code.language.is_empty();
        for code in written.code.iter().filter(block) {
            for (index, command) in code.text.lines().enumerate() {
                let wrong = self.wrong_input(command);
                faults.extend(wrong.map(|what| fault(code.line + index, what)));
            }
        }
        let wrong = |link: &Link| Some(fault(link.line, self.wrong_fragment(page, link)?));
        faults.extend(written.links.iter().filter_map(wrong));
        faults
    }

    /// The reason why inline code that looks like a file name is not one.
    fn wrong(&self, page: &Page, text: &str, code: &str) -> Option<String> {
        let (name, place) = split(code);
        if code.contains(|c: char| c.is_whitespace() || "<>*…(){}\"'=|".contains(c)) {
            return None;
        }
        if let Some(module) = code.strip_prefix("common::") {
            let module = module.split("::").next().unwrap_or_default();
            let mut paths =
                [".rs", "/mod.rs"].map(|end| format!("common/src/{module}{end}")).into_iter();
            let missing = !paths.any(|path| self.project.has(&path));
            return missing.then(|| format!("there is no module `common::{module}`"));
        }
        let (folder, rest) = name.split_once('/').unwrap_or(("", name));
        if FOLDERS.contains(&folder) {
            // Shaders include files by their path below `shaders/`.
            let found = [name.to_owned(), format!("shaders/{name}")]
                .into_iter()
                .find_map(|path| self.path(path.trim_end_matches('/')));
            let Some(path) = found else { return Some(format!("there is no '{name}'")) };
            return self.wrong_place(&path, place);
        }
        if self.project.named(folder).is_some() {
            let mut paths =
                ["shaders", "samples"].map(|above| format!("{above}/{name}")).into_iter();
            let Some(path) = paths.find_map(|path| self.path(&path)) else {
                return Some(format!("there is no '{name}' in shaders or samples"));
            };
            return self.wrong_place(&path, place);
        }
        let extension = rest.rsplit_once('.').filter(|(stem, _)| !stem.is_empty())?.1;
        let known = EXTENSIONS.contains(&extension) || shader::EXTENSIONS.contains(&extension);
        if !folder.is_empty() || name.contains('/') || !known {
            return None;
        }
        let called = |path: &&String| path.rsplit('/').next() == Some(name);
        let called: Vec<&String> = self.all.iter().filter(called).collect();
        let near = called.iter().find(|path| self.is_near(page, text, path));
        match (near, called.first()) {
            (Some(path), _) => self.wrong_place(path, place),
            (None, Some(far)) => {
                Some(format!("'{name}' is none of this chapter's files, but {far}"))
            }
            (None, None) => Some(format!("there is no file '{name}'")),
        }
    }

    /// The path of an existing file or folder; a name that stands for any chapter resolves to the first.
    fn path(&self, path: &str) -> Option<String> {
        let for_chapter = |chapter: &Chapter| {
            let module = format!("/{}.", chapter.module());
            path.replace("NN_name", &chapter.name).replace("/name.", &module)
        };
        let there = |path: &String| self.project.root.join(path).exists();
        let mut paths = self.project.chapters.iter().map(for_chapter);
        Some(path.to_owned()).filter(there).or_else(|| paths.find(there))
    }

    /// Returns whether a page may mention a file without its folder: the file is shared, or belongs to this
    /// chapter or one it builds on, or the line mentions the file's chapter.
    fn is_near(&self, page: &Page, text: &str, path: &str) -> bool {
        let mut parts = path.split('/');
        let above = parts.next();
        let of = parts.next().and_then(|folder| self.project.named(folder));
        let Some(of) = of.filter(|_| matches!(above, Some("samples" | "shaders"))) else {
            return true;
        };
        let Some(own) = self.project.of_page(&page.path) else { return true };
        own.name == of.name
            || self.project.descends(own, of)
            || chapters(text).iter().any(|mention| mention.number == of.number())
    }

    /// The reason why a line or an anchor is not in a file, or `None` if it is.
    fn wrong_place(&self, path: &str, place: Place) -> Option<String> {
        let text = || self.project.read(path).unwrap_or_default();
        match place {
            Place::Whole => None,
            Place::Line(line) => {
                let count = text().lines().count();
                (line == 0 || line > count)
                    .then(|| format!("'{path}' has no line {line}, but {count}"))
            }
            Place::Anchor(anchor) => {
                let found = parts(path, &text()).unwrap_or_default();
                let missing = !found.iter().any(|found| found.name == anchor);
                missing.then(|| format!("'{path}' has no part '{anchor}'"))
            }
        }
    }

    /// The reason why a file that a command reads is missing, or `None` if it exists.
    fn wrong_input(&self, command: &str) -> Option<String> {
        let mut words = command.split_whitespace().map(|word| word.trim_matches(['"', '\'', '\\']));
        let mut last = "";
        words.find_map(|word| {
            let input = !OUTPUTS.contains(&std::mem::replace(&mut last, word));
            let (folder, _) = word.split_once('/')?;
            let missing =
                FOLDERS.contains(&folder) && self.path(word.trim_end_matches('/')).is_none();
            (input && missing).then(|| format!("there is no '{word}'"))
        })
    }

    /// The reason why a link's heading or line is missing from its file, or `None` if it exists.
    fn wrong_fragment(&self, page: &Page, link: &Link) -> Option<String> {
        let (file, fragment) = link.target.split_once('#')?;
        let path = match file {
            "" => page.path.clone(),
            _ => local(&page.path, file).filter(|path| self.project.has(path))?,
        };
        let text = self.project.read(&path).ok()?;
        let line = fragment.strip_prefix('L').and_then(|number| number.parse().ok());
        if let Some(line) = line.filter(|_| !path.ends_with(".md")) {
            return self.wrong_place(&path, Place::Line(line));
        }
        let found = slugs(&Markdown::parse(&Page::parse(&path, &text).written()).headings);
        let missing = !found.iter().any(|slug| slug == fragment);
        missing.then(|| format!("'{path}' has no heading '#{fragment}'"))
    }
}

/// A place in a file.
#[derive(Debug, PartialEq, Eq)]
enum Place<'a> {
    Whole,
    Line(usize),
    Anchor(&'a str),
}

/// A file's name, and the place in the file that follows it.
fn split(code: &str) -> (&str, Place<'_>) {
    if let Some((name, anchor)) = code.split_once('#') {
        return (name, Place::Anchor(anchor));
    }
    let line = code.rsplit_once(':').and_then(|(name, line)| Some((name, line.parse().ok()?)));
    line.map_or((code, Place::Whole), |(name, line)| (name, Place::Line(line)))
}

/// The name of a heading in links, as mdBook and code hosts construct it.
pub fn slug(heading: &str) -> String {
    let kept = heading.trim().chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c));
    kept.collect::<String>().to_lowercase().replace(' ', "-")
}

/// The names of a page's headings; repeated names are numbered.
fn slugs(headings: &[String]) -> Vec<String> {
    let mut found: Vec<String> = Vec::new();
    for heading in headings {
        let slug = slug(heading);
        let again = headings[..found.len()].iter().filter(|other| *other == heading).count();
        found.push(if again == 0 { slug } else { format!("{slug}-{again}") });
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_follows_the_name() {
        assert_eq!(split("a/b.rs"), ("a/b.rs", Place::Whole));
        assert_eq!(split("a/b.rs:12"), ("a/b.rs", Place::Line(12)));
        assert_eq!(split("b.rs#c"), ("b.rs", Place::Anchor("c")));
        assert_eq!(split("a::b"), ("a::b", Place::Whole));
    }

    #[test]
    fn headings_are_called_as_in_links() {
        let headings = ["O3 and O4: up by floats", "Notes", "Notes"].map(str::to_owned);
        assert_eq!(slugs(&headings), ["o3-and-o4-up-by-floats", "notes", "notes-1"]);
    }
}
