//! A patch with a heading: a title, fields `Key: value`, and a unified diff that any tool can apply.

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::Result;
use manuscript::fault::Fault;
use manuscript::project::Project;

use super::copy::{copy_code, copy_shaders};
use super::hunk::{Hunk, hunks};

/// A field.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Field {
    /// Its line, from 1.
    pub line: usize,
    /// The text before the colon.
    pub key: String,
    /// The text after the colon.
    pub value: String,
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

/// The patches of a folder, and the faults of its files.
pub fn all<T>(
    project: &Project,
    folder: &str,
    parse: impl Fn(&str, &str) -> Result<T, Fault>,
) -> (Vec<T>, Vec<Fault>) {
    let (mut found, mut faults) = (Vec::new(), Vec::new());
    for file in project.files(folder) {
        match parse(&file, &project.read(&file).unwrap_or_default()) {
            Ok(one) => found.push(one),
            Err(fault) => faults.push(fault),
        }
    }
    (found, faults)
}

/// All of them, unless something is wrong.
///
/// # Errors
/// If a file is wrong.
pub fn whole<T>((found, faults): (Vec<T>, Vec<Fault>)) -> Result<Vec<T>> {
    faults.into_iter().next().map_or(Ok(found), |fault| Err(fault.error()))
}

impl Patch {
    /// Reads a file; `form` describes its form in error messages.
    ///
    /// # Errors
    /// If a line of the heading is not a field, or the diff is invalid.
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

    /// Removes and returns the field of a key that must occur once.
    ///
    /// # Errors
    /// If it does not.
    pub fn field(&mut self, key: &str) -> Result<Field, Fault> {
        let missing =
            || Fault::new(&*self.file, 1, format!("there is no field '{key}'"), self.form);
        let missing = missing();
        self.field_if_any(key)?.ok_or(missing)
    }

    /// Removes and returns the field of a key that may occur once.
    ///
    /// # Errors
    /// If it occurs twice.
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

    /// Removes and returns all fields of several keys, in their order.
    pub fn fields_of(&mut self, keys: &[&str]) -> Vec<Field> {
        self.fields.extract_if(.., |field| keys.contains(&&*field.key)).collect()
    }

    /// Checks that no field is left.
    ///
    /// # Errors
    /// If one is left; the message says that it is not a field of `of`.
    pub fn no_other_field(&self, of: &str) -> Result<(), Fault> {
        let wrong = |Field { line, key, .. }: &Field| {
            Fault::new(&*self.file, *line, format!("'{key}' is no field of {of}"), self.form)
        };
        self.fields.first().map_or(Ok(()), |field| Err(wrong(field)))
    }

    /// Returns whether it changes nothing.
    pub fn is_empty(&self) -> bool {
        self.hunks.is_empty()
    }

    /// Returns whether it changes only shaders; then the built program can show it.
    pub fn is_in_shaders(&self) -> bool {
        self.hunks.iter().all(|hunk| hunk.file.starts_with("shaders/"))
    }

    /// Returns whether it changes Rust code.
    pub fn is_in_rust(&self) -> bool {
        self.hunks.iter().any(|hunk| hunk.file.ends_with(".rs"))
    }

    /// The files it changes, each once, in order.
    pub fn files(&self) -> Vec<&str> {
        let mut files: Vec<&str> = self.hunks.iter().map(|hunk| &*hunk.file).collect();
        files.dedup();
        files
    }

    /// The files it changes, each with the items that contain the changes; none for a new file.
    pub fn places(&self, project: &Project) -> Vec<(String, Vec<String>)> {
        let mut places: Vec<(String, Vec<String>)> = Vec::new();
        for hunk in &self.hunks {
            let text = project.read(&hunk.file).unwrap_or_default();
            if places.last().is_none_or(|(file, _)| *file != hunk.file) {
                places.push((hunk.file.clone(), Vec::new()));
            }
            if let (Some((_, items)), Some(item)) = (places.last_mut(), hunk.item(&text))
                && !items.contains(&item)
            {
                items.push(item);
            }
        }
        places
    }

    /// The diff as in the file.
    pub fn diff(&self) -> &str {
        let start = if self.text.starts_with("--- ") { Some(0) } else { self.text.find("\n--- ") };
        start.map_or("", |start| self.text[start..].trim_start())
    }

    /// The contents of the patched files; `read` returns the contents before, or `None` if there is no file.
    ///
    /// # Errors
    /// If a hunk's lines are not in its file, or occur twice and not at the hunk's line number.
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

    /// The contents of a project's patched files.
    ///
    /// # Errors
    /// As [`Patch::patched`].
    pub fn patched_in(&self, project: &Project) -> Result<BTreeMap<String, String>, Fault> {
        self.patched(|file| project.has(file).then(|| project.read(file).ok()).flatten())
    }

    /// Makes a folder a patched copy of the shaders, or of everything a build needs.
    ///
    /// # Errors
    /// If the patch does not apply, or the folder cannot be written.
    pub fn copy_to(&self, project: &Project, folder: &Path) -> Result<()> {
        let patched = self.patched_in(project).map_err(Fault::error)?;
        if self.is_in_shaders() {
            copy_shaders(project, folder, &patched)
        } else {
            copy_code(project, folder, &patched)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FORM: &str = "write it";

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
