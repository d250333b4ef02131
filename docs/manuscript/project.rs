//! The project: its root, the chapters described in `Cargo.toml`, and its files.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::{fmt, fs};

use anyhow::{Context, Result};
use serde::{Deserialize, Serialize};

use crate::fault::Fault;

/// One chapter, as described by `[package.metadata.chapters.NN_name]`.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Chapter {
    /// Its name, such as `02_basic`: the name of its program, folders, page, golden and picture.
    #[serde(default)]
    pub name: String,
    /// Its title, such as `Basic`.
    pub title: String,
    /// Its lesson, in one line.
    pub teaches: String,
    /// The title of its part of the book.
    #[serde(default)]
    pub part: String,
    /// The chapter that it builds on.
    pub from: Option<String>,
    /// Its requirements of the device beyond the baseline.
    #[serde(default)]
    pub needs: Vec<String>,
    /// The arguments of its golden picture, except for the size.
    #[serde(default, skip_serializing)]
    pub golden: Vec<String>,
    /// The size of its golden picture, if it differs from most chapters'.
    #[serde(default, skip_serializing)]
    pub golden_size: Option<String>,
    /// The effects that it adds to chapter 25's table, by name.
    #[serde(default)]
    pub effects: Vec<String>,
}

impl Chapter {
    /// The number, such as `02`.
    pub fn number(&self) -> &str {
        self.name.split('_').next().unwrap_or_default()
    }

    /// The name without the number, which is also the name of its tests' module.
    pub fn module(&self) -> &str {
        self.name.split_once('_').map_or("", |(_, module)| module)
    }

    /// Number and title, such as `02 · Basic`.
    pub fn heading(&self) -> String {
        format!("{} · {}", self.number(), self.title)
    }

    /// The size of its golden picture, such as `240x150`.
    pub fn golden_size(&self) -> &str {
        self.golden_size.as_deref().unwrap_or("240x150")
    }

    /// Its page.
    pub fn page(&self) -> String {
        format!("docs/{}.md", self.name)
    }

    /// The page of its further tables, which not every chapter has.
    pub fn measurements(&self) -> String {
        format!("docs/{MEASUREMENTS}/{}.md", self.name)
    }

    /// Its page's picture.
    pub fn picture(&self) -> String {
        format!("docs/images/{}.png", self.name)
    }
}

/// A way through the book.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Way {
    /// Its title, in a word.
    pub title: String,
    /// Its benefit, in one line.
    pub gives: String,
    /// The numbers of its chapters, in order.
    pub chapters: Vec<String>,
}

/// A `[[bin]]` or `[[test]]`.
#[derive(Clone, Debug, Deserialize)]
pub struct Target {
    /// Its name.
    pub name: String,
    /// Its root module, from the project's root.
    #[serde(default)]
    pub path: String,
}

/// A requested chapter that does not exist: a line that lists the existing ones.
#[derive(Debug)]
pub struct Unknown(pub String);

impl fmt::Display for Unknown {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Unknown {}

/// A project on disk. Paths are text, from the root, with `/` on every system.
pub struct Project {
    /// Its folder.
    pub root: PathBuf,
    /// The text of `Cargo.toml`.
    pub manifest: String,
    /// The chapters, by number.
    pub chapters: Vec<Chapter>,
    /// The titles of the parts, in order; none if the book has no parts.
    pub parts: Vec<String>,
    /// The ways through the book.
    pub ways: Vec<Way>,
    /// The root modules of other packages' libraries, from the project's root.
    pub libs: Vec<String>,
    /// The programs of all packages.
    pub bins: Vec<Target>,
    /// The test programs of all packages.
    pub tests: Vec<Target>,
    /// The program run by plain `cargo run`.
    pub default_run: Option<String>,
}

impl Project {
    /// Reads the project in the folder `root`.
    ///
    /// # Errors
    /// If a `Cargo.toml` is missing or invalid.
    pub fn open(root: &Path) -> Result<Self> {
        let manifest = read(&root.join("Cargo.toml")).with_context(|| {
            format!("'{}' is not the project's folder, which --root names", root.display())
        })?;
        let read: Manifest = toml::from_str(&manifest).map_err(|error| {
            let before = error.span().map_or("", |span| &manifest[..span.start]);
            let what = error.message().replace('\n', " ");
            Fault::new("Cargo.toml", before.matches('\n').count() + 1, what, "correct it").error()
        })?;
        let named = |(name, chapter)| Chapter { name, ..chapter };
        let Metadata { parts, ways, chapters } = read.package.metadata;
        let chapters: Vec<Chapter> = chapters.into_iter().map(named).collect();
        for Way { title, chapters: numbers, .. } in &ways {
            let known =
                |number: &&String| chapters.iter().any(|chapter| chapter.number() == **number);
            if let Some(number) = numbers.iter().find(|number| !known(number)) {
                let line = manifest.lines().position(|line| line.starts_with("ways")).unwrap_or(0);
                let what = format!("there is no chapter '{number}' on the way '{title}'");
                let remedy = "name chapters by their numbers, such as \"02\"";
                return Err(Fault::new("Cargo.toml", line + 1, what, remedy).error());
            }
        }
        let (mut libs, mut bins, mut tests) = (Vec::new(), read.bin, read.test);
        for member in read.workspace.members.iter().filter(|member| *member != ".") {
            let manifest = self::read(&root.join(member).join("Cargo.toml"))?;
            let targets: Targets =
                toml::from_str(&manifest).with_context(|| format!("{member}/Cargo.toml"))?;
            let placed = |target: Target| Target { path: below(member, &target.path), ..target };
            libs.extend(targets.lib.map(|lib| below(member, &lib.path)));
            bins.extend(targets.bin.into_iter().map(placed));
            tests.extend(targets.test.into_iter().map(placed));
        }
        Ok(Self {
            root: root.to_owned(),
            manifest,
            chapters,
            parts,
            ways,
            libs,
            bins,
            tests,
            default_run: read.package.default_run,
        })
    }

    /// The chapter a reader means by `02`, `2`, `basic` or `02_basic`.
    ///
    /// # Errors
    /// If there is none; the message lists the existing ones.
    pub fn chapter(&self, given: &str) -> Result<&Chapter, Unknown> {
        let number = |text: &str| text.parse::<u32>().ok();
        let meant = |chapter: &&Chapter| {
            [&*chapter.name, chapter.module()].contains(&given)
                || number(given).is_some_and(|n| number(chapter.number()) == Some(n))
        };
        self.chapters.iter().find(meant).ok_or_else(|| {
            let names: Vec<&str> = self.chapters.iter().map(|chapter| &*chapter.name).collect();
            Unknown(format!("no chapter '{given}'; there is {}", names.join(", ")))
        })
    }

    /// The chapter of this whole name.
    pub fn named(&self, name: &str) -> Option<&Chapter> {
        self.chapters.iter().find(|chapter| chapter.name == name)
    }

    /// The chapter whose page this is.
    pub fn of_page(&self, path: &str) -> Option<&Chapter> {
        self.chapters.iter().find(|chapter| chapter.page() == path)
    }

    /// Returns whether a chapter builds on another, directly or not.
    pub fn descends(&self, chapter: &Chapter, other: &Chapter) -> bool {
        let mut parent = chapter.from.as_deref();
        // A line of parents is no longer than the list of chapters, unless it is circular.
        for _ in &self.chapters {
            let Some(name) = parent else { return false };
            if name == other.name {
                return true;
            }
            parent = self.named(name).and_then(|chapter| chapter.from.as_deref());
        }
        false
    }

    /// The parts with their headings, such as `I · Make it`, and chapters. A book without parts is one part
    /// without a heading, and so are chapters without a part.
    pub fn parted(&self) -> Vec<(String, Vec<&Chapter>)> {
        let number = ["I", "II", "III", "IV", "V", "VI", "VII", "VIII", "IX", "X"];
        let heading = |(title, number): (&String, &str)| format!("{number} · {title}");
        let of = |title: &String| self.chapters.iter().filter(|c| c.part == *title).collect();
        let numbered = self.parts.iter().zip(number);
        let mut parts: Vec<(String, Vec<&Chapter>)> =
            numbered.map(|part| (heading(part), of(part.0))).collect();
        let others = self.chapters.iter().filter(|c| !self.parts.contains(&c.part)).collect();
        parts.push((String::new(), others));
        parts.retain(|(_, chapters)| !chapters.is_empty());
        parts
    }

    /// All chapters, each below the one it builds on, in the order of the book, with the number of its
    /// ancestors.
    pub fn tree(&self) -> Vec<(usize, &Chapter)> {
        let parted = self.parted();
        let ordered = || parted.iter().flat_map(|(_, chapters)| chapters).rev();
        let parent = |chapter: &Chapter| chapter.from.as_deref().and_then(|from| self.named(from));
        let roots = ordered().filter(|chapter| parent(chapter).is_none());
        let mut next: Vec<(usize, &Chapter)> = roots.map(|&chapter| (0, chapter)).collect();
        let mut tree = Vec::new();
        while let Some((depth, chapter)) = next.pop() {
            tree.push((depth, chapter));
            let children = ordered().filter(|child| parent(child) == Some(chapter));
            next.extend(children.map(|&child| (depth + 1, child)));
        }
        tree
    }

    /// The text of a file, with `\n` line endings.
    ///
    /// # Errors
    /// If it cannot be read, or is not UTF-8.
    pub fn read(&self, path: &str) -> Result<String> {
        read(&self.root.join(path))
    }

    /// Returns whether the file exists.
    pub fn has(&self, path: &str) -> bool {
        self.root.join(path).is_file()
    }

    /// All files below a folder, in order, without hidden ones. Empty if there is no folder.
    pub fn files(&self, folder: &str) -> Vec<String> {
        let Ok(entries) = fs::read_dir(self.root.join(folder)) else { return Vec::new() };
        let mut names: Vec<String> = entries
            .flatten()
            .map(|entry| entry.file_name().to_string_lossy().into_owned())
            .collect();
        names.retain(|name| !name.starts_with('.'));
        names.sort();
        let paths = names.into_iter().map(|name| format!("{folder}/{name}"));
        paths
            .flat_map(
                |path| {
                    if self.root.join(&path).is_dir() { self.files(&path) } else { vec![path] }
                },
            )
            .collect()
    }

    /// Adds the files of other chapters that a chapter's files borrow by `#[path = "…"]`.
    pub fn with_borrowed(&self, mut files: Vec<String>) -> Vec<String> {
        let mut next = 0;
        while let Some(file) = files.get(next).cloned() {
            let folder = file.rsplit_once('/').map_or("", |(folder, _)| folder);
            let text = self.read(&file).unwrap_or_default();
            let paths = text
                .lines()
                .filter_map(|line| line.trim().strip_prefix("#[path = \"../")?.strip_suffix("\"]"));
            for path in paths {
                let above = folder.rsplit_once('/').map_or("", |(above, _)| above);
                let borrowed = format!("{above}/{path}");
                if !files.contains(&borrowed) {
                    files.push(borrowed);
                }
            }
            next += 1;
        }
        files
    }

    /// All pages: the README and those in `docs/`, without the generated summary.
    pub fn pages(&self) -> Vec<String> {
        let mut pages = self.files("docs");
        let folders = ["docs", &format!("docs/{MEASUREMENTS}")];
        let folder =
            |path: &String| path.rsplit_once('/').map_or("", |(folder, _)| folder).to_owned();
        pages.retain(|path| path.ends_with(".md") && folders.contains(&&*folder(path)));
        pages.retain(|path| path != SUMMARY);
        if self.has(README) {
            pages.insert(0, README.to_owned());
        }
        pages
    }

    /// Returns whether a chapter is a separate package, with its own dependencies and test program.
    pub fn has_own_package(&self, chapter: &Chapter) -> bool {
        self.has(&format!("samples/{}/Cargo.toml", chapter.name))
    }

    /// The line of `Cargo.toml` that contains `text`, from 1; 1 if none does.
    pub fn manifest_line(&self, text: &str) -> usize {
        self.manifest.lines().position(|line| line.trim() == text).map_or(1, |index| index + 1)
    }

    /// The line of `Cargo.toml` on which a chapter's table begins.
    pub fn chapter_line(&self, chapter: &Chapter) -> usize {
        self.manifest_line(&format!("[package.metadata.chapters.{}]", chapter.name))
    }
}

/// The page that a code host shows first.
pub const README: &str = "README.md";

/// mdBook's table of contents.
pub const SUMMARY: &str = "docs/SUMMARY.md";
/// The folder below `docs` of the pages with chapters' further tables.
pub const MEASUREMENTS: &str = "measurements";

#[derive(Deserialize)]
struct Manifest {
    package: Package,
    #[serde(default)]
    workspace: Workspace,
    #[serde(default)]
    bin: Vec<Target>,
    #[serde(default)]
    test: Vec<Target>,
}

#[derive(Default, Deserialize)]
struct Workspace {
    #[serde(default)]
    members: Vec<String>,
}

/// The relevant parts of another package's manifest.
#[derive(Deserialize)]
struct Targets {
    lib: Option<Library>,
    #[serde(default)]
    bin: Vec<Target>,
    #[serde(default)]
    test: Vec<Target>,
}

/// A library, whose name is optional.
#[derive(Deserialize)]
struct Library {
    #[serde(default)]
    path: String,
}

/// The path `relative` to a folder, from the project's root.
fn below(folder: &str, relative: &str) -> String {
    let mut parts: Vec<&str> = folder.split('/').collect();
    for part in relative.split('/') {
        match part {
            ".." => drop(parts.pop()),
            part => parts.push(part),
        }
    }
    parts.join("/")
}

#[derive(Deserialize)]
#[serde(rename_all = "kebab-case")]
struct Package {
    default_run: Option<String>,
    #[serde(default)]
    metadata: Metadata,
}

#[derive(Default, Deserialize)]
struct Metadata {
    #[serde(default)]
    parts: Vec<String>,
    #[serde(default)]
    ways: Vec<Way>,
    #[serde(default)]
    chapters: BTreeMap<String, Chapter>,
}

fn read(path: &Path) -> Result<String> {
    let text =
        fs::read_to_string(path).with_context(|| format!("cannot read '{}'", path.display()))?;
    Ok(text.replace("\r\n", "\n"))
}
