//! The folder of a model. Nothing outside it is opened: a model from elsewhere must not access the user's other
//! files.

use std::cell::Cell;
use std::ffi::OsStr;
use std::fmt::Display;
use std::io::ErrorKind;
use std::path::{Component, Path, PathBuf};

use anyhow::{Result, anyhow};

use super::encoding::{is_foreign, path, path_letters, quoted, shown};
use super::text::name;

/// Listings of folders, to name a file that differs only in case; a model may name many missing files.
const LISTINGS: u32 = 100;

/// Entries read of such a listing.
const ENTRIES: usize = 10_000;

/// The longest part of a path that is looked for beside the model.
const TAIL: usize = 3;

/// The reason for not opening a file; scene files say "the scene file's".
const OUTSIDE: &str = "outside the OBJ file's folder";

/// The folder of a model or a scene.
pub struct Folder {
    given: PathBuf,
    root: PathBuf,
    listings: Cell<u32>,
}

/// The reason why a file is unavailable: missing, not text, not readable, or outside the model's folder.
/// A model may do without a file that it names.
#[derive(Debug)]
pub struct Unavailable(pub(super) String);

impl Display for Unavailable {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Unavailable {}

/// A file named by a model.
#[derive(Debug, Default)]
pub struct Named {
    /// Its path, links resolved.
    pub path: PathBuf,
    /// Its path relative to the OBJ file's folder, with `/` between the parts.
    pub name: String,
    /// Its path, as the model's own path was given.
    pub beside: PathBuf,
    /// The path as shown in error messages.
    pub shown: String,
    /// The message if it is not the file that was named, but one of that name beside the model.
    pub instead: Option<String>,
}

/// The place a path leads to.
enum Found {
    Inside(Named),
    /// The reason, to be followed by what helps.
    Missing(String),
    Outside,
}

impl Folder {
    /// The folder of a file.
    ///
    /// # Errors
    /// If there is no such folder.
    pub fn of(file: &Path) -> Result<Self> {
        let given = file.parent().unwrap_or(Path::new(""));
        let here = if given.as_os_str().is_empty() { Path::new(".") } else { given };
        let root = here.canonicalize().map_err(|error| match error.kind() {
            ErrorKind::NotFound => anyhow!("{}: there is no such file", shown(file)),
            _ => anyhow!("{}: cannot be read: {error}", shown(file)),
        })?;
        Ok(Self { given: given.to_owned(), root, listings: Cell::new(LISTINGS) })
    }

    /// Finds the file named by `keyword`. A relative path starts at the file `from`, or else at the OBJ file. If it
    /// leads nowhere, or out of the folder, a file of that name beside either of them is found instead.
    ///
    /// # Errors
    /// If there is no such file, or only one outside the folder, directly or through a symbolic link.
    pub fn find(
        &self,
        keyword: &str,
        named: &str,
        from: Option<&Named>,
    ) -> Result<Named, Unavailable> {
        if named.is_empty() {
            return Err(Unavailable(format!("{keyword} is not followed by a name")));
        }
        let name = name(keyword, named).map_err(|error| Unavailable(error.to_string()))?;
        let path = written(name);
        let near = from.and_then(|from| from.path.parent()).unwrap_or(&self.root);
        let mut starts = vec![near, self.root.as_path()];
        starts.dedup();
        let mut why = None;
        for start in &starts {
            match self.at(&led(start, &path)) {
                Found::Inside(file) => return Ok(file),
                Found::Outside => _ = why.get_or_insert(OUTSIDE.to_owned()),
                Found::Missing(what) => _ = why.get_or_insert(what),
            }
        }
        let why = format!("{keyword} names {}, {}", quoted(name), why.unwrap_or_default());
        for tail in tails(&path) {
            for start in &starts {
                if let Found::Inside(file) = self.at(&start.join(&tail)) {
                    let right = quoted(&path_letters(&tail).replace('\\', "/"));
                    let instead = Some(format!("{why}; write {right}"));
                    return Ok(Named { instead, ..file });
                }
            }
        }
        let hint = match starts.iter().find_map(|start| self.alike(&led(start, &path), start)) {
            Some(other) => format!("; {} differs only in case: write that", quoted(&other)),
            None if why.ends_with(OUTSIDE) => "; copy it into the folder".to_owned(),
            None if name.contains(is_foreign) => {
                "; its name is not UTF-8 here, and perhaps is there: save this file as UTF-8"
                    .to_owned()
            }
            None => String::new(),
        };
        Err(Unavailable(why + &hint))
    }

    /// The file at an absolute path without `..`.
    fn at(&self, path: &Path) -> Found {
        if !path.starts_with(&self.root) {
            return Found::Outside;
        }
        let path = match path.canonicalize() {
            Ok(path) => path,
            Err(error)
                if matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) =>
            {
                return Found::Missing("which is not there".to_owned());
            }
            Err(error) => return Found::Missing(format!("which cannot be read: {error}")),
        };
        let Ok(inside) = path.strip_prefix(&self.root) else { return Found::Outside };
        if !path.is_file() {
            let what = if path.is_dir() { "which is a folder" } else { "which is no file" };
            return Found::Missing(what.to_owned());
        }
        let parts: Vec<_> = inside.iter().map(|part| path_letters(Path::new(part))).collect();
        let beside = self.given.join(inside);
        let (name, shown) = (parts.join("/"), shown(&beside));
        Found::Inside(Named { name, shown, beside, path, instead: None })
    }

    /// The path of a file that differs from this one, and only in case, relative to `start` if it is below.
    fn alike(&self, path: &Path, start: &Path) -> Option<String> {
        let mut found = self.root.clone();
        for part in path.strip_prefix(&self.root).ok()? {
            let mut next = found.join(part);
            if !next.exists() {
                self.listings.set(self.listings.get().checked_sub(1)?);
                let lower = |name: &OsStr| name.to_string_lossy().to_lowercase();
                let entries = found.read_dir().ok()?.take(ENTRIES).flatten();
                let alike = entries.map(|entry| entry.file_name());
                next = found.join(alike.into_iter().find(|other| lower(other) == lower(part))?);
            }
            found = next;
        }
        if found == path {
            return None;
        }
        let relative = found.strip_prefix(start).or(found.strip_prefix(&self.root)).ok()?;
        Some(path_letters(relative).replace('\\', "/"))
    }
}

/// The path that a file names. Exporters on Windows write backslashes, some put the name in quotes.
fn written(name: &str) -> PathBuf {
    let bare = name.strip_prefix('"').and_then(|name| name.strip_suffix('"')).unwrap_or(name);
    path(&bare.replace('\\', "/"))
}

/// The target of a path from a folder, without following links. A drive's letter leads outside on any system.
fn led(start: &Path, path: &Path) -> PathBuf {
    let is_drive = |part: &OsStr| part.as_encoded_bytes().get(1) == Some(&b':');
    let mut led = start.to_owned();
    for (number, part) in path.components().enumerate() {
        match part {
            Component::Normal(part) if number == 0 && is_drive(part) => {
                led = Path::new("/").join(part)
            }
            Component::Normal(part) => led.push(part),
            Component::CurDir => {}
            Component::ParentDir => _ = led.pop(),
            Component::RootDir | Component::Prefix(_) => led.push(part.as_os_str()),
        }
    }
    led
}

/// The last parts of a path, the longest first.
fn tails(path: &Path) -> impl Iterator<Item = PathBuf> {
    let parts = path.components().rev().take(TAIL);
    let parts = parts.map_while(|part| match part {
        Component::Normal(part) => Some(part.to_owned()),
        _ => None,
    });
    let parts: Vec<_> = parts.collect();
    (1..=parts.len()).rev().map(move |length| parts[..length].iter().rev().collect())
}

#[cfg(test)]
mod tests;
