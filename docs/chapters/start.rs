//! Makes a reader's own program: a crate outside the workspace that builds, runs and is tested.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use common::UsageError;
use common::files::{NewFolder, write_all};
use manuscript::project::Project;

use crate::programs::own_program::{NAME, TEMPLATE};
use crate::programs::program::Programs;

/// The files that make the template a member of the workspace; a separate crate has its own.
const OF_THE_MEMBER: [&str; 2] = ["Cargo.toml", "tests.rs"];

/// Cargo's settings for a folder and those below it.
const CONFIG: &str = ".cargo/config.toml";

/// Names reserved by Rust or Cargo, and that of the framework.
const TAKEN: &str = "abstract alloc as async await become box break build const continue core crate deps do \
     dyn else enum examples extern false final fn for gen if impl in incremental let loop macro match mod move mut \
     override priv proc_macro pub raybook ref return self static std struct super test trait true try type typeof \
     unsafe unsized use virtual where while yield";

/// A crate to be made.
pub struct Start<'a> {
    project: &'a Project,
    folder: PathBuf,
    name: String,
    /// The source of the framework: a Git repository, or else this checkout.
    git: Option<&'a str>,
    /// The folder of the book's build, if the crate shares it.
    shared: Option<PathBuf>,
}

impl<'a> Start<'a> {
    /// A crate in an empty or new folder, with the folder's name. Unless it is to be `apart`, it shares the
    /// build of this checkout.
    ///
    /// # Errors
    /// If the folder is in use or inside the project, or its name is not valid for a crate.
    pub fn plan(
        programs: &Programs<'a>,
        folder: &Path,
        git: Option<&'a str>,
        apart: bool,
    ) -> Result<Self> {
        let project = programs.project;
        let refuse = |what: &str| Err(UsageError(format!("'{}' {what}", folder.display())).into());
        let absolute = std::path::absolute(folder).context("the current folder is not known")?;
        let above = absolute.ancestors().find_map(|above| above.canonicalize().ok());
        if above.is_some_and(|above| above.starts_with(root(project))) {
            return refuse("lies in the book; name a folder outside, such as ../my_tracer");
        }
        let name = folder.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        let letter = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
        if !name.starts_with(|c: char| c.is_ascii_lowercase()) || !name.chars().all(letter) {
            return refuse(
                "does not end in a crate's name: that is a letter from a to z, then a to z, 0 to 9 and _",
            );
        }
        if TAKEN.split(' ').any(|taken| taken == name) {
            return refuse("ends in a name that Rust, Cargo or the book keeps; name it otherwise");
        }
        if absolute.read_dir().is_ok_and(|mut entries| entries.next().is_some()) {
            return refuse("is not empty; name a folder that is empty or new");
        }
        if absolute.exists() && !absolute.is_dir() {
            return refuse("is no folder; name one that is empty or new");
        }
        // Cargo keeps records of its results. A Git repository may have another version.
        let target = programs.target();
        let shared = !apart
            && git.is_none()
            && target.join(programs.profile()).join(".fingerprint").is_dir();
        let shared = shared.then(|| target.canonicalize()).transpose()?;
        Ok(Self { project, folder: absolute, name: name.to_owned(), git, shared })
    }

    /// Writes the crate's files, all or none; returns their paths relative to its folder.
    ///
    /// # Errors
    /// If a file cannot be read or written.
    pub fn write(&self) -> Result<Vec<String>> {
        let own = |text: &str| text.replace(NAME, &self.name);
        let mut files = vec![
            // Its settings contain folders of this machine.
            (".gitignore".to_owned(), "/target\n/.cargo\n".to_owned()),
            ("Cargo.lock".to_owned(), self.project.read("Cargo.lock")?),
            ("Cargo.toml".to_owned(), self.manifest()?),
        ];
        if let Some(shared) = &self.shared {
            files.push((CONFIG.to_owned(), self.config(shared)?));
        }
        for path in self.project.files(TEMPLATE) {
            let below = path.trim_start_matches(TEMPLATE).trim_start_matches('/');
            if !OF_THE_MEMBER.contains(&below) {
                files.push((own(below), own(&self.project.read(&path)?)));
            }
        }
        let folder = NewFolder::at(&self.folder)?;
        let places: Vec<PathBuf> = files.iter().map(|(path, _)| folder.path().join(path)).collect();
        for place in &places {
            common::files::folder::make(place.parent().unwrap_or(&self.folder))?;
        }
        let texts = files.iter().map(|(_, text)| text.as_bytes());
        let all: Vec<_> = places.iter().map(PathBuf::as_path).zip(texts).collect();
        write_all(&all, vec![folder])?;
        Ok(files.into_iter().map(|(path, _)| path).collect())
    }

    /// The manifest: one dependency, and the profile of the workspace for the packages that come with it.
    fn manifest(&self) -> Result<String> {
        let manifest: toml::Table = self.project.manifest.parse()?;
        let package = &manifest["workspace"]["package"];
        let from = match self.git {
            Some(url) => format!("git = {}", toml::Value::from(url)),
            None => {
                let path = plain(&root(self.project).join("common"));
                format!("path = {}", toml::Value::from(path))
            }
        };
        let known = self.packages()?;
        let at = self.project.manifest.find("[profile.dev]").context("no [profile.dev]")?;
        let profile = self.project.manifest[at..].lines().take_while(|line| *line != "[[bin]]");
        let fits = |line: &&str| match line.split_once(" = {") {
            Some((name, _)) => known.contains(name),
            None => true,
        };
        let mut profile: Vec<&str> = profile.filter(fits).collect();
        // A comment above the first [[bin]] belongs to it.
        while profile.pop_if(|last| last.is_empty() || last.starts_with('#')).is_some() {}
        Ok(format!(
            "[package]\nname = \"{}\"\nversion = \"0.1.0\"\nedition = {}\nrust-version = {}\npublish = false\n\n\
             [dependencies]\nraybook = {{ {from} }}\n\n\
             # This package is no member of a workspace that may lie above it.\n[workspace]\n\n\
             # As the book has it: without it frames take several times as long.\n{}\n",
            self.name,
            package["edition"],
            package["rust-version"],
            profile.join("\n")
        ))
    }

    /// Cargo's settings: the folder of the book's build, and the book's C++ compiler, without which glslang
    /// would be compiled again.
    fn config(&self, shared: &Path) -> Result<String> {
        let path = |path: &Path| toml::Value::from(plain(path)).to_string();
        let mut text = format!(
            "# What the book has compiled is used here, too; programs still go to `target`. `cargo clean` empties both\n\
             # folders. Without this file, everything is compiled again.\n[build]\nbuild-dir = {}\n",
            path(shared)
        );
        let root = root(self.project);
        let settings: toml::Table = self.project.read(CONFIG).unwrap_or_default().parse()?;
        let variables = settings.get("env").and_then(toml::Value::as_table).into_iter().flatten();
        let mut lines = variables.filter_map(|(name, setting)| {
            let value = setting.get("value")?.as_str()?;
            Some(format!("{name} = {}\n", path(&root.join(value))))
        });
        if let Some(first) = lines.next() {
            text.push_str(&format!("\n[env]\n{first}"));
            text.extend(lines);
        }
        Ok(text)
    }

    /// The packages that the framework is built with, by name.
    fn packages(&self) -> Result<BTreeSet<String>> {
        let lock: toml::Table = self.project.read("Cargo.lock")?.parse()?;
        let all = lock["package"].as_array().context("Cargo.lock has no packages")?;
        let (mut found, mut open) = (BTreeSet::new(), vec!["raybook".to_owned()]);
        while let Some(name) = open.pop() {
            let of_name = all.iter().filter(|package| package["name"].as_str() == Some(&name));
            for package in of_name {
                let needs = package.get("dependencies").and_then(toml::Value::as_array);
                let needs = needs.into_iter().flatten().filter_map(toml::Value::as_str);
                // The framework's tests need other members of the workspace; a crate outside does not.
                let outside = |need: &&str| {
                    let is = |other: &&toml::Value| other["name"].as_str() == Some(need);
                    all.iter().find(is).is_none_or(|other| other.get("source").is_some())
                };
                let needs = needs.filter_map(|need| need.split(' ').next()).filter(outside);
                open.extend(needs.map(str::to_owned).filter(|need| !found.contains(need)));
            }
            found.insert(name);
        }
        Ok(found)
    }

    /// The next steps.
    pub fn next(&self) -> String {
        let shared = match self.shared {
            Some(_) => format!(
                "\nIt uses what the book has compiled, so the first build takes a minute in place of many ({CONFIG}). \
                 With --apart it would compile everything by itself.\n"
            ),
            None => String::new(),
        };
        format!("cd {}\ncargo run\ncargo test\n{shared}", self.folder.display())
    }
}

/// A path in the form that Cargo understands, not Windows' longest one.
fn plain(path: &Path) -> String {
    path.display().to_string().trim_start_matches(r"\\?\").to_owned()
}

/// The project's folder in canonical form.
fn root(project: &Project) -> PathBuf {
    project.root.canonicalize().unwrap_or_else(|_| project.root.clone())
}
