//! A patch with a heading: a title, fields `Key: value`, and a unified diff, which any tool applies.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};

use crate::fault::Fault;
use crate::project::Project;

/// The folders of which a copy that can be built and tested is made, and the files beside them.
const FOLDERS: [&str; 5] = ["common", "docs/chapters", "samples", "shaders", "tests"];
const FILES: [&str; 2] = ["Cargo.toml", "Cargo.lock"];

/// A field.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Field {
    /// Its line, from 1.
    pub line: usize,
    /// What stands before the colon.
    pub key: String,
    /// What stands behind it.
    pub value: String,
}

/// Lines of a file, and what stands there instead.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Hunk {
    /// Its line in the diff, from 1.
    line: usize,
    file: String,
    /// Whether there is no such file before.
    new_file: bool,
    /// Where its lines stood when the patch was made, from 0.
    at: usize,
    old: Vec<String>,
    new: Vec<String>,
}

impl Hunk {
    /// Where its old lines stand, from 0: where they stand once, or else where they stood.
    fn place(&self, lines: &[String]) -> Option<usize> {
        let old = self.old.len();
        let mut found = (0..(lines.len() + 1).saturating_sub(old))
            .filter(|&at| lines[at..at + old] == self.old[..]);
        let first = found.next()?;
        match found.next() {
            None => Some(first),
            Some(second) => [first, second].into_iter().chain(found).find(|at| *at == self.at),
        }
    }
}

/// A patch.
#[derive(Clone, Debug)]
pub struct Patch {
    /// Its file, from the project's root.
    pub file: String,
    /// The first line.
    pub title: String,
    /// The whole file.
    pub text: String,
    form: &'static str,
    fields: Vec<Field>,
    hunks: Vec<Hunk>,
}

impl Patch {
    /// Reads a file whose `form` a fault tells.
    ///
    /// # Errors
    /// If a line of the heading is no field, or the diff is none.
    pub fn parse(file: &str, text: &str, form: &'static str) -> Result<Self, Fault> {
        let end = text.lines().position(|line| line.starts_with("--- "));
        let head: Vec<&str> = text.lines().take(end.unwrap_or(usize::MAX)).collect();
        let title = head.first().map_or("", |line| line.trim()).to_owned();
        if title.is_empty() {
            return Err(Fault::new(file, 1, "there is no title", form));
        }
        let mut fields = Vec::new();
        for (index, line) in head.iter().enumerate().skip(1).filter(|(_, line)| !line.is_empty()) {
            let field = line.split_once(':').filter(|(key, _)| {
                !key.is_empty() && key.bytes().all(|byte| byte.is_ascii_alphabetic())
            });
            let Some((key, value)) = field else {
                return Err(Fault::new(file, index + 1, format!("'{line}' is no field"), form));
            };
            let (key, value) = (key.to_owned(), value.trim().to_owned());
            fields.push(Field { line: index + 1, key, value });
        }
        let hunks = hunks(text).map_err(|(line, what)| Fault::new(file, line, what, form))?;
        if let (Some(line), true) = (end, hunks.is_empty()) {
            return Err(Fault::new(file, line + 1, "the diff changes nothing", form));
        }
        let (file, text) = (file.to_owned(), text.to_owned());
        Ok(Self { file, title, text, form, fields, hunks })
    }

    /// Takes out the field of a key that must stand there once.
    ///
    /// # Errors
    /// If it does not.
    pub fn field(&mut self, key: &str) -> Result<Field, Fault> {
        let missing =
            || Fault::new(&*self.file, 1, format!("there is no field '{key}'"), self.form);
        let missing = missing();
        self.field_if_any(key)?.ok_or(missing)
    }

    /// Takes out the field of a key that stands there at most once.
    ///
    /// # Errors
    /// If it stands there twice.
    pub fn field_if_any(&mut self, key: &str) -> Result<Option<Field>, Fault> {
        let mut found = self.fields_of(&[key]).into_iter();
        let first = found.next();
        match found.next() {
            Some(second) => {
                let what = format!("the field '{key}' stands here a second time");
                Err(Fault::new(&*self.file, second.line, what, "remove one"))
            }
            None => Ok(first),
        }
    }

    /// Takes out all fields of several keys, in their order.
    pub fn fields_of(&mut self, keys: &[&str]) -> Vec<Field> {
        self.fields.extract_if(.., |field| keys.contains(&&*field.key)).collect()
    }

    /// Holds that every field has been taken out.
    ///
    /// # Errors
    /// If one has not: it is none of `of`.
    pub fn no_other_field(&self, of: &str) -> Result<(), Fault> {
        let wrong = |Field { line, key, .. }: &Field| {
            Fault::new(&*self.file, *line, format!("'{key}' is no field of {of}"), self.form)
        };
        self.fields.first().map_or(Ok(()), |field| Err(wrong(field)))
    }

    /// Whether it changes nothing.
    pub fn is_empty(&self) -> bool {
        self.hunks.is_empty()
    }

    /// Whether it changes shaders alone: then the built program shows it.
    pub fn is_in_shaders(&self) -> bool {
        self.hunks.iter().all(|hunk| hunk.file.starts_with("shaders/"))
    }

    /// The files that it changes, each with the item in which each change stands; a new file has none.
    pub fn places(&self, project: &Project) -> Vec<(String, Vec<String>)> {
        let mut places: Vec<(String, Vec<String>)> = Vec::new();
        for hunk in &self.hunks {
            let text = project.read(&hunk.file).unwrap_or_default();
            if places.last().is_none_or(|(file, _)| *file != hunk.file) {
                places.push((hunk.file.clone(), Vec::new()));
            }
            if let (Some((_, items)), Some(item)) = (places.last_mut(), item(&text, hunk))
                && !items.contains(&item)
            {
                items.push(item);
            }
        }
        places
    }

    /// The diff, as the file has it.
    pub fn diff(&self) -> &str {
        let start = if self.text.starts_with("--- ") { Some(0) } else { self.text.find("\n--- ") };
        start.map_or("", |start| self.text[start..].trim_start())
    }

    /// What the patched files hold; `read` tells what they hold before, `None` where there is no file.
    ///
    /// # Errors
    /// If a hunk's lines do not stand in its file, or stand there twice and not where the hunk says.
    pub fn patched(
        &self,
        read: impl Fn(&str) -> Option<String>,
    ) -> Result<BTreeMap<String, String>, Fault> {
        let mut files: BTreeMap<String, Vec<String>> = BTreeMap::new();
        for hunk in &self.hunks {
            let misfit =
                |what: String| Fault::new(&*self.file, hunk.line, what, "make the patch again");
            if !files.contains_key(&hunk.file) {
                let text = read(&hunk.file);
                if hunk.new_file && text.is_some() {
                    return Err(misfit(format!("the new file {} is there already", hunk.file)));
                }
                let lines = text.unwrap_or_default().lines().map(str::to_owned).collect();
                files.insert(hunk.file.clone(), lines);
            }
            let lines = files.entry(hunk.file.clone()).or_default();
            let (at, old) = (hunk.place(lines), hunk.old.len());
            let Some(at) = at else {
                return Err(misfit(format!("this hunk does not fit {}", hunk.file)));
            };
            lines.splice(at..at + old, hunk.new.iter().cloned());
        }
        let joined = |lines: Vec<String>| lines.iter().map(|line| format!("{line}\n")).collect();
        Ok(files.into_iter().map(|(file, lines)| (file, joined(lines))).collect())
    }

    /// What the patched files of a project hold.
    ///
    /// # Errors
    /// As [`Patch::patched`].
    pub fn patched_in(&self, project: &Project) -> Result<BTreeMap<String, String>, Fault> {
        self.patched(|file| project.has(file).then(|| project.read(file).ok()).flatten())
    }

    /// Makes a folder a patched copy of the shaders, or of all that a build needs.
    ///
    /// # Errors
    /// If the patch does not fit, or the folder cannot be written.
    pub fn copy_to(&self, project: &Project, folder: &Path) -> Result<()> {
        let patched = self.patched_in(project).map_err(Fault::error)?;
        match self.is_in_shaders() {
            true => copy(project, folder, &patched, (&["shaders"], &[]), "shaders/"),
            false => copy(project, folder, &patched, (&FOLDERS, &FILES), ""),
        }
    }
}

/// Makes a folder a copy of the shaders.
///
/// # Errors
/// If it cannot be written.
pub fn copy_shaders(project: &Project, folder: &Path) -> Result<()> {
    copy(project, folder, &BTreeMap::new(), (&["shaders"], &[]), "shaders/")
}

/// Makes a folder a copy of some folders and files, of which `patched` replaces some.
///
/// A file that is right already is left alone, so that Cargo builds only what has changed; one that the
/// copy has too many is removed.
fn copy(
    project: &Project,
    folder: &Path,
    patched: &BTreeMap<String, String>,
    (folders, beside): (&[&str], &[&str]),
    without: &str,
) -> Result<()> {
    let mut files: BTreeMap<String, Option<&String>> = BTreeMap::new();
    let found = folders.iter().flat_map(|part| project.files(part));
    let found = found.chain(beside.iter().map(|file| (*file).to_owned()));
    files.extend(found.map(|file| (file, None)));
    files.extend(patched.iter().map(|(file, text)| (file.clone(), Some(text))));
    let place = |file: &str| folder.join(file.trim_start_matches(without));
    let kept: BTreeSet<PathBuf> = files.keys().map(|file| place(file)).collect();
    for old in files_below(folder).iter().filter(|old| !kept.contains(*old)) {
        fs::remove_file(old).with_context(|| format!("cannot remove '{}'", old.display()))?;
    }
    for (file, text) in files {
        let to = place(&file);
        let bytes = match text {
            Some(text) => text.clone().into_bytes(),
            None => fs::read(project.root.join(&file))?,
        };
        if fs::read(&to).is_ok_and(|there| there == bytes) {
            continue;
        }
        let parent = to.parent().context("a file lies in a folder")?;
        fs::create_dir_all(parent)
            .with_context(|| format!("cannot make '{}'", parent.display()))?;
        fs::write(&to, bytes).with_context(|| format!("cannot write '{}'", to.display()))?;
    }
    Ok(())
}

/// Every file below a folder.
pub fn files_below(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    entries.flat_map(|path| if path.is_dir() { files_below(&path) } else { vec![path] }).collect()
}

/// The item of a text in which a hunk's first change stands, as its first line names it.
fn item(text: &str, hunk: &Hunk) -> Option<String> {
    let lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let same = hunk.old.iter().zip(&hunk.new).take_while(|(old, new)| old == new).count();
    let words = ["fn ", "struct ", "enum ", "impl ", "const ", "static "];
    let item = |line: &&String| {
        let line = line.trim_start().trim_start_matches("pub ");
        let in_shader =
            line.ends_with(") {") && line.starts_with(|c: char| c.is_ascii_alphabetic());
        let control = CONTROL.iter().any(|word| line.starts_with(word));
        words.iter().any(|word| line.starts_with(word)) || in_shader && !control
    };
    let end = (hunk.place(&lines)? + same + 1).min(lines.len());
    let found = lines[..end].iter().rev().find(item)?;
    Some(found.trim().split(['(', '{', '=', ':']).next().unwrap_or_default().trim().to_owned())
}

/// What begins a line of a shader that looks like a function and is none.
const CONTROL: [&str; 4] = ["if ", "for ", "while ", "switch "];

/// The hunks of a unified diff, or the line with what is wrong in it.
fn hunks(text: &str) -> Result<Vec<Hunk>, (usize, String)> {
    let mut hunks: Vec<Hunk> = Vec::new();
    let (mut file, mut new_file) = (None, false);
    for (index, line) in text.lines().enumerate() {
        if let Some(path) = line.strip_prefix("+++ ") {
            let path = path.split('\t').next().unwrap_or_default().trim().to_owned();
            if path == "/dev/null" {
                return Err((index + 1, "a patch removes no file".to_owned()));
            }
            file = Some(path);
        } else if let Some(path) = line.strip_prefix("--- ") {
            (file, new_file) = (None, path.trim() == "/dev/null");
        } else if let (true, Some(file)) = (line.starts_with("@@"), &file) {
            // The numbers behind `+` count the lines that earlier hunks have added.
            let start = line.split_once('+').map_or("", |(_, rest)| rest);
            let digits = start.bytes().take_while(u8::is_ascii_digit).count();
            let Ok(start) = start[..digits].parse::<usize>() else {
                return Err((index + 1, format!("'{line}' does not begin a hunk")));
            };
            let (file, at) = (file.clone(), start.saturating_sub(1));
            hunks.push(Hunk { line: index + 1, file, new_file, at, old: vec![], new: vec![] });
        } else if let (Some(_), Some(hunk)) = (&file, hunks.last_mut()) {
            let (sign, rest) = line.split_at_checked(1).unwrap_or((" ", ""));
            match sign {
                "+" => hunk.new.push(rest.to_owned()),
                "-" => hunk.old.push(rest.to_owned()),
                " " => {
                    hunk.old.push(rest.to_owned());
                    hunk.new.push(rest.to_owned());
                }
                // `\ No newline at end of file`
                "\\" => {}
                _ => return Err((index + 1, format!("'{line}' is no line of a diff"))),
            }
        }
    }
    Ok(hunks)
}

#[cfg(test)]
mod tests {
    use super::*;

    const FORM: &str = "write it";

    fn lines(lines: &[&str]) -> Vec<String> {
        lines.iter().map(|line| (*line).to_owned()).collect()
    }

    #[test]
    fn hunks_hold_what_was_and_what_is() {
        let text =
            "T\n\nCause: -x\n\n--- a\n+++ b/c\n@@ -1,2 +1,2 @@\n x\n-y\n+z\n@@ -9 +9 @@\n+w\n";
        let hunk = |line, at, old: &[&str], new: &[&str]| Hunk {
            line,
            file: "b/c".to_owned(),
            new_file: false,
            at,
            old: lines(old),
            new: lines(new),
        };
        let expected = [hunk(7, 0, &["x", "y"], &["x", "z"]), hunk(11, 8, &[], &["w"])];
        assert_eq!(hunks(text).unwrap(), expected);
        let patch = Patch::parse("p.diff", text, FORM).unwrap();
        assert!(patch.diff().starts_with("--- a\n+++ b/c\n"));
        let text = "pub fn f(z) {\n    if a(b) {\nx\ny\n";
        assert_eq!(item(text, &expected[0]).unwrap(), "pub fn f");
        assert_eq!(item("void main() {\nx\ny\n", &expected[0]).unwrap(), "void main");
    }

    #[test]
    fn fields_are_taken_by_key_and_in_order() {
        let mut patch = Patch::parse("p.diff", "T\n\nA: 1\nB:\nA: 2: x\nC: 3\n", FORM).unwrap();
        let of: Vec<_> =
            patch.fields_of(&["A", "B"]).into_iter().map(|f| (f.line, f.value)).collect();
        assert_eq!(of, [(3, "1".to_owned()), (4, String::new()), (5, "2: x".to_owned())]);
        assert!(
            patch.no_other_field("it").unwrap_err().to_string().starts_with("p.diff:6: 'C' is no")
        );
        assert_eq!(patch.field("C").unwrap().value, "3");
        let missing = patch.field("C").unwrap_err().to_string();
        assert_eq!(missing, "p.diff:1: there is no field 'C'; write it");
    }

    #[test]
    fn what_is_no_patch_is_named_with_its_line() {
        for (text, start) in [
            ("", "p.diff:1: there is no title"),
            ("T\n\nno field\n", "p.diff:3: 'no field' is no field"),
            ("T\n\nA: 1\n\n--- a\n", "p.diff:5: the diff changes nothing"),
            ("T\n\n--- a\n+++ b\n@@ x\n", "p.diff:5: '@@ x' does not begin a hunk"),
            ("T\n\n--- a\n+++ b\n@@ -1 +1 @@\nx\n", "p.diff:6: 'x' is no line of a diff"),
            ("T\n\n--- a\n+++ /dev/null\n", "p.diff:4: a patch removes no file"),
        ] {
            let fault = Patch::parse("p.diff", text, FORM).unwrap_err().to_string();
            assert!(fault.starts_with(start), "{fault}");
        }
    }

    #[test]
    fn lines_that_stand_twice_are_told_apart_by_their_number() {
        let at = |line: usize| {
            let text = format!("T\n\n--- f\n+++ f\n@@ -{line} +{line} @@\n-x\n+y\n");
            let patch = Patch::parse("p.diff", &text, FORM).unwrap();
            patch.patched(|_| Some("x\na\nx\n".to_owned())).map(|files| files["f"].clone())
        };
        assert_eq!(at(1).unwrap(), "y\na\nx\n");
        assert_eq!(at(3).unwrap(), "x\na\ny\n");
        let fault = at(2).unwrap_err().to_string();
        assert_eq!(fault, "p.diff:5: this hunk does not fit f; make the patch again");
    }

    #[test]
    fn a_new_file_replaces_none() {
        let text = "T\n\n--- /dev/null\n+++ f\n@@ -0,0 +1 @@\n+y\n";
        let patch = Patch::parse("p.diff", text, FORM).unwrap();
        assert_eq!(patch.patched(|_| None).unwrap()["f"], "y\n");
        let fault = patch.patched(|_| Some(String::new())).unwrap_err().to_string();
        assert!(fault.starts_with("p.diff:5: the new file f is there already"), "{fault}");
    }
}
