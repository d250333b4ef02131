//! The project: its root, what `Cargo.toml` says of the chapters, and its files.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::{fmt, fs};

use anyhow::{Context, Result};
use serde::{Deserialize, Serialize};

use crate::fault::Fault;

/// One chapter, as `[package.metadata.chapters.NN_name]` describes it.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Chapter {
    /// Its name, such as `02_basic`: the name of its program, folders, page, golden and picture.
    #[serde(default)]
    pub name: String,
    /// Its title, such as `Basic`.
    pub title: String,
    /// What it teaches, in a line.
    pub teaches: String,
    /// The part of the book that it belongs to, by title.
    #[serde(default)]
    pub part: String,
    /// The chapter that it builds on.
    pub from: Option<String>,
    /// What it needs of the device beyond the baseline.
    #[serde(default)]
    pub needs: Vec<String>,
    /// The arguments of its golden picture, the size apart.
    #[serde(default, skip_serializing)]
    pub golden: Vec<String>,
    /// The size of its golden picture, where that is another than most chapters'.
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

    /// The name without the number, which is what its tests' module is called.
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
    /// What it gives, in a line.
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

/// A chapter that is asked for and is not there: a line that lists those that are.
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
    /// Where it lies.
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
    /// What `cargo run` alone runs.
    pub default_run: Option<String>,
}

impl Project {
    /// Reads the project in the folder `root`.
    ///
    /// # Errors
    /// If a `Cargo.toml` is missing, or says what it should not.
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

    /// The chapter that a reader means by `02`, `2`, `basic` or `02_basic`.
    ///
    /// # Errors
    /// If there is none; the line lists those that there are.
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

    /// Whether a chapter builds on another, directly or not.
    pub fn descends(&self, chapter: &Chapter, other: &Chapter) -> bool {
        let mut parent = chapter.from.as_deref();
        // No line of parents is longer than the list of chapters, unless it is a circle.
        for _ in &self.chapters {
            let Some(name) = parent else { return false };
            if name == other.name {
                return true;
            }
            parent = self.named(name).and_then(|chapter| chapter.from.as_deref());
        }
        false
    }

    /// The parts with their headings, such as `I · Make it`, and chapters; a book without parts is one
    /// part with no heading, and so are chapters of no part.
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

    /// Every chapter below the one that it builds on, in the order of the book, each with the number of those that
    /// it descends from.
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

    /// The text of a file, its lines ended by `\n` alone.
    ///
    /// # Errors
    /// If it cannot be read, or is not UTF-8.
    pub fn read(&self, path: &str) -> Result<String> {
        read(&self.root.join(path))
    }

    /// Whether there is such a file.
    pub fn has(&self, path: &str) -> bool {
        self.root.join(path).is_file()
    }

    /// Every file below a folder, in order; hidden ones are nobody's business. None if there is no folder.
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

    /// Files of a chapter and those of other chapters that it takes by `#[path = "…"]`.
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

    /// Every page: the README and what lies in `docs/`, but not the generated summary.
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

    /// Whether a chapter is a package of its own, with dependencies and a test program that no other needs.
    pub fn has_own_package(&self, chapter: &Chapter) -> bool {
        self.has(&format!("samples/{}/Cargo.toml", chapter.name))
    }

    /// The line of `Cargo.toml` on which `text` stands, from 1; 1 if it does not.
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
/// The folder below `docs` of the pages that hold chapters' further tables.
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

/// What the manifest of another package of the project says.
#[derive(Deserialize)]
struct Targets {
    lib: Option<Library>,
    #[serde(default)]
    bin: Vec<Target>,
    #[serde(default)]
    test: Vec<Target>,
}

/// A library, which needs no name of its own.
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
