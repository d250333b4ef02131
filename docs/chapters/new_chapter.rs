//! Makes a new chapter: a copy of its parent that compiles, runs and is tested.

use std::path::PathBuf;

use anyhow::Result;
use common::UsageError;
use common::files::{NewFolder, folder, write_all};
use manuscript::project::{Chapter, Project};
use manuscript::shader;

use crate::pages::placeholder::{OPENING, TEACHES};

/// The longest name, in letters: it heads columns and names files.
const NAME_LETTERS: usize = 40;

/// A chapter to be made.
pub struct NewChapter<'a> {
    project: &'a Project,
    from: &'a Chapter,
    chapter: Chapter,
}

impl<'a> NewChapter<'a> {
    /// A chapter with this number and name, a copy of `from`.
    ///
    /// # Errors
    /// If the number or name is invalid or taken, or the parent has a package of its own.
    pub fn plan(
        project: &'a Project,
        number: u32,
        name: &str,
        from: &'a Chapter,
    ) -> Result<Self, UsageError> {
        let refuse = |what: String| Err(UsageError(what));
        let letter = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
        if name.len() > NAME_LETTERS {
            return refuse(format!("a chapter's name has at most {NAME_LETTERS} letters"));
        }
        if !name.starts_with(|c: char| c.is_ascii_lowercase()) || !name.chars().all(letter) {
            return refuse(format!("'{name}' is no chapter's name: use a to z, 0 to 9 and _"));
        }
        if number == 0 || number > 99 {
            return refuse(format!("{number} is no chapter's number: use 1 to 99"));
        }
        let full = format!("{number:02}_{name}");
        let taken =
            |other: &&Chapter| other.number().parse() == Ok(number) || other.module() == name;
        if let Some(twin) = project.chapters.iter().find(taken) {
            return refuse(format!("'{full}' has the number or the name of '{}'", twin.name));
        }
        if project.has_own_package(from) {
            return refuse(format!(
                "'{}' is a package of its own: no chapter is made from it",
                from.name
            ));
        }
        for folder in ["samples", "shaders"] {
            if project.root.join(folder).join(&full).exists() {
                return refuse(format!("{folder}/{full} is there already"));
            }
        }
        let mut title = name.replace('_', " ");
        title[..1].make_ascii_uppercase();
        let chapter = Chapter {
            name: full,
            title,
            teaches: TEACHES.to_owned(),
            part: from.part.clone(),
            from: Some(from.name.clone()),
            needs: from.needs.clone(),
            ..Chapter::default()
        };
        Ok(Self { project, from, chapter })
    }

    /// Writes the chapter's files and entries, all or none; returns their paths.
    ///
    /// # Errors
    /// If a file cannot be read or written.
    pub fn write(&self) -> Result<Vec<String>> {
        let mut files = self.program()?;
        files.extend(self.shaders()?);
        files.push(("Cargo.toml".to_owned(), self.manifest()));
        let module = self.chapter.module();
        files.push((format!("tests/samples/{module}.rs"), self.test()));
        for (list, start, end) in [("main", "mod ", ";"), ("golden", "    ", ",")] {
            let path = format!("tests/samples/{list}.rs");
            let text = self.listed(&path, start, end)?;
            files.push((path, text));
        }
        files.push((self.chapter.page(), self.page()));
        files.push((format!("docs/exercises/{}.1.diff", self.chapter.number()), self.exercise()));
        let root = &self.project.root;
        let own = ["samples", "shaders"].map(|folder| format!("{folder}/{}/", self.chapter.name));
        let is_new = |own: &&String| files.iter().any(|(path, _)| path.starts_with(own.as_str()));
        let folders = own.iter().filter(is_new).map(|own| NewFolder::at(&root.join(own)));
        let folders = folders.collect::<Result<Vec<_>>>()?;
        let places: Vec<PathBuf> = files.iter().map(|(path, _)| root.join(path)).collect();
        for place in &places {
            folder::make(place.parent().unwrap_or(root))?;
        }
        let texts = files.iter().map(|(_, text)| text.as_bytes());
        let all: Vec<_> = places.iter().map(PathBuf::as_path).zip(texts).collect();
        write_all(&all, folders)?;
        Ok(files.into_iter().map(|(path, _)| path).collect())
    }

    /// The next steps.
    pub fn next(&self) -> String {
        let (name, module) = (&self.chapter.name, self.chapter.module());
        format!(
            "cargo run --bin {name}\nUPDATE=1 cargo test --test samples {module}\n\
             cargo chapters sync --pictures {name}\ncargo chapters check\n"
        )
    }

    fn own(&self, path: &str) -> String {
        path.replacen(&self.from.name, &self.chapter.name, 1)
    }

    fn program(&self) -> Result<Vec<(String, String)>> {
        let files = self.project.files(&format!("samples/{}", self.from.name));
        let copy = |path: String| {
            let text = self.project.read(&path)?;
            let text = if path.ends_with("/main.rs") { self.opened(&text) } else { text };
            Ok((self.own(&path), text))
        };
        files.into_iter().map(copy).collect()
    }

    /// The program with a new opening comment.
    fn opened(&self, text: &str) -> String {
        let rest = text.lines().skip_while(|line| line.starts_with("//!"));
        let rest: String = rest.flat_map(|line| [line, "\n"]).collect();
        let (heading, from) = (self.chapter.heading(), &self.from.name);
        let [teaches, new] = OPENING;
        format!("//! {heading}: {teaches}\n//!\n//! New since {from}: {new}\n{rest}")
    }

    /// The parent's own shaders. Shaders the parent shares with others are shared by the new chapter as well.
    fn shaders(&self) -> Result<Vec<(String, String)>> {
        let own = shader::own(self.project, self.from).into_iter();
        own.map(|path| Ok((self.own(&path), self.project.read(&path)?))).collect()
    }

    fn manifest(&self) -> String {
        let Chapter { name, title, teaches, part, needs, .. } = &self.chapter;
        let from = &self.from.name;
        let path = format!("samples/{name}/main.rs");
        let bin = format!("[[bin]]\nname = \"{name}\"\npath = \"{path}\"\ntest = false\n\n");
        let needs = needs.iter().map(|need| format!("{need:?}")).collect::<Vec<_>>().join(", ");
        let part = match &part[..] {
            "" => String::new(),
            part => format!("part = \"{part}\"\n"),
        };
        let table = format!(
            "[package.metadata.chapters.{name}]\ntitle = \"{title}\"\nteaches = \"{teaches}\"\n{part}\
             from = \"{from}\"\nneeds = [{needs}]\n\n"
        );
        // Each entry goes before the first chapter with a larger number, or at the end.
        let manifest = &self.project.manifest;
        let later: Vec<&Chapter> =
            self.project.chapters.iter().filter(|other| other.name > *name).collect();
        let place = |marks: Vec<String>, end: usize| {
            marks.iter().find_map(|mark| manifest.find(mark.as_str())).unwrap_or(end)
        };
        let bins =
            later.iter().map(|other| format!("[[bin]]\nname = \"{}\"", other.name)).collect();
        let bin_end = manifest.find("# Makes samples/assets").or(manifest.find("[[test]]"));
        let bin_at = place(bins, bin_end.unwrap_or(manifest.len()));
        let tables =
            later.iter().map(|other| format!("[package.metadata.chapters.{}]", other.name));
        let table_at = place(tables.collect(), manifest.len());
        let (head, rest) = manifest.split_at(bin_at);
        let (middle, tail) = rest.split_at(table_at - bin_at);
        let gap = if tail.is_empty() && !middle.ends_with("\n\n") { "\n" } else { "" };
        let text = format!("{head}{bin}{middle}{gap}{table}{tail}");
        text.trim_end().to_owned() + "\n"
    }

    /// A file that lists the modules of the tests, one per line and in order, with the chapter's among them.
    fn listed(&self, path: &str, start: &str, end: &str) -> Result<String> {
        let text = self.project.read(path)?;
        let own = format!("{start}{}{end}", self.chapter.module());
        let is_entry = |line: &&str| {
            let name = line.strip_prefix(start).and_then(|rest| rest.strip_suffix(end));
            name.is_some_and(|name| name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_'))
        };
        let mut lines: Vec<&str> = text.lines().collect();
        let later = lines.iter().position(|line| is_entry(line) && **line > *own);
        let after = lines.iter().rposition(is_entry).map_or(lines.len(), |last| last + 1);
        lines.insert(later.unwrap_or(after), &own);
        Ok(lines.join("\n") + "\n")
    }

    fn test(&self) -> String {
        let name = &self.chapter.name;
        format!(
            "//! {name}: what the chapter claims.\n\n\
             use run::{{Chapter, bits}};\n\n\
             const NAME: &str = \"{name}\";\n\n\
             #[test]\n\
             fn the_picture_repeats() {{\n    \
             let [first, second] = [0, 1].map(|_| Chapter::new(NAME).picture());\n    \
             assert_eq!(bits(&first), bits(&second));\n}}\n"
        )
    }

    /// A first exercise, valid until the chapter differs from its parent.
    fn exercise(&self) -> String {
        let from = &self.from.name;
        format!(
            "Compare it with its parent\n\nTakes: look\nMinutes: 2\nText: Render this chapter and {from} with the same \
             arguments. How many pixels differ?\nCheck: None: the pictures are the same to the bit.\nHint: The chapter \
             is still a copy. WRITE another exercise once it is not.\nRun:\nExpect: same as {from}\nAnswer: 0\n"
        )
    }

    /// A page with every section; `check` reports the placeholders.
    fn page(&self) -> String {
        let Chapter { name, .. } = &self.chapter;
        let (heading, from) = (self.chapter.heading(), &self.from.name);
        let parent = self.from.number();
        format!(
            "# {heading}\n\n![WRITE](images/{name}.png)\n\n<!-- picture -->\n```sh\n\
             cargo run --bin {name} -- --headless --size 960x600 --out docs/images/{name}.png\n```\n\n\
             ## What you will learn\n\nWRITE\n\n## What changed since {parent}\n\n\
             <!-- diff {from} {name} main.rs -->\n<!-- /diff -->\n\n## How it works\n\nWRITE\n\n\
             ## What accuracy costs here\n\n\
             > **Exact:** WRITE **Price:** WRITE **Without it:** WRITE\n\n\
             WRITE\n\n## Hard cases\n\nWRITE\n\n## Controls\n\n\
             <!-- controls {name} -->\n<!-- /controls -->\n\n## Try it\n\n\
             <!-- exercises {name} -->\n<!-- /exercises -->\n\n\
             <!-- stamp -->\n<!-- /stamp -->\n\n## Sources\n\nWRITE\n"
        )
    }
}
