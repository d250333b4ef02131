//! The book as a website, made by mdBook from the pages in `docs/`.
//!
//! [`contents`] gives the order. [`page`] composes each page for mdBook ([`formula`], [`color`], [`slider`],
//! [`figure`], [`gallery`]; [`link`] resolves its links), and [`listing`] the pages of code. [`output`] puts
//! the site in its place when all of it is right. [`moved`] redirects from old addresses.

pub mod color;
pub mod contents;
pub mod figure;
pub mod formula;
pub mod gallery;
pub mod html;
pub mod link;
pub mod listing;
pub mod moved;
pub mod output;
pub mod page;
pub mod picture;
pub mod slider;

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::path::Path;
use std::{fmt, fs};

use anyhow::{Context, Result};
use manuscript::fault::Fault;
use manuscript::project::Project;
use mdbook_driver::MDBook;
use mdbook_driver::config::Config;

use contents::Entry;
use link::Wanted;

/// The counts of a site.
#[derive(Clone, Copy, Debug, Default)]
pub struct Counts {
    /// Pages of the book.
    pub pages: usize,
    /// Pages of code.
    pub code: usize,
    /// Pictures, including cut panels and thumbnails.
    pub pictures: usize,
    /// Formulas.
    pub formulas: usize,
    /// Sliders.
    pub sliders: usize,
    /// Interactive figures.
    pub figures: usize,
}

/// The faults of the pages, one line each.
#[derive(Debug)]
pub struct Faults(pub Vec<Fault>);

impl fmt::Display for Faults {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let lines: Vec<String> = self.0.iter().map(Fault::to_string).collect();
        f.write_str(&lines.join("\n"))
    }
}

impl std::error::Error for Faults {}

/// mdBook's settings.
const SETTINGS: &str = include_str!("book.toml");

/// The files added to mdBook's own pages.
const ADDED: [(&str, &str); 2] =
    [("site.css", include_str!("site.css")), ("site.js", include_str!("site.js"))];

/// The page a server shows for a missing page. mdBook's own page would need the site's address.
const LOST: &str = include_str!("404.html");

/// Builds the site of the project in `root`, in the folder `made`, which does not exist yet.
///
/// # Errors
/// If a file cannot be read or written; [`Faults`] if there are faults on the pages.
pub fn build(root: &Path, made: &Path) -> Result<Counts> {
    let project = Project::open(root)?;
    let entries = contents::read(&project)?;
    let beside = made.parent().context("a folder lies in a folder")?;
    let work = tempfile::tempdir_in(beside).context("cannot make a temporary folder")?;
    let source = work.path().join("src");
    fs::create_dir(&source)?;

    let mut counts = Counts { pages: entries.len(), ..Counts::default() };
    let (mut faults, mut wanted, mut pictures) = (Vec::new(), Vec::new(), BTreeSet::new());
    let (mut codes, mut scripts) = (BTreeMap::new(), BTreeSet::new());
    let mut texts = Vec::new();
    for entry in &entries {
        let text = project.read(&entry.file)?;
        let page = page::compose(&project, &entries, entry, &text);
        counts.formulas += page.formulas;
        counts.sliders += page.sliders;
        counts.figures += page.figures.len();
        scripts.extend(page.figures);
        faults.extend(page.faults);
        wanted.extend(page.wanted);
        pictures.extend(page.pictures);
        if let Some(code) = listing::compose(&project, entry, &page.files)? {
            codes.insert(entry.name.clone(), code);
        }
        texts.push((entry, page.markdown));
    }
    for (entry, text) in &texts {
        let code = codes.contains_key(&entry.name);
        let text = text.clone() + &around(&project, &entries, entry, code);
        fs::write(source.join(format!("{}.md", entry.name)), text)?;
    }
    for entry in &entries {
        if let Some(code) = codes.get(&entry.name) {
            let text = code.clone() + &behind(&entries, entry);
            fs::write(source.join(format!("{}.md", link::code_name(entry))), text)?;
        }
    }
    fs::write(source.join("SUMMARY.md"), summary(&project, &entries, &codes))?;
    for picture in &pictures {
        picture.write(root, &source)?;
    }
    for name in &scripts {
        fs::write(source.join(figure::FRAME.0), figure::bare(figure::FRAME.1))?;
        match figure::script(&project, name)? {
            Ok(script) => fs::write(source.join(figure::address(name)), script)?,
            Err(wrong) => faults.extend(wrong),
        }
    }
    (counts.code, counts.pictures) = (codes.len(), pictures.len());

    let mut settings = SETTINGS.to_owned();
    for name in codes.keys() {
        // A search should find the explanation.
        let _ =
            write!(settings, "\n[output.html.search.chapter.'{name}-code.md']\nenable = false\n");
    }
    let mut config: Config = settings.parse().context("docs/site/book.toml")?;
    config.set("book.src", "src")?;
    config.set("build.build-dir", made)?;
    let moved = moved::read(&project, &entries)?;
    config.set("output.html.redirect", moved::redirects(&moved))?;
    wanted.extend(moved::wanted(&moved));
    // Otherwise mdBook would use its own settings.
    config
        .html_config()
        .context("docs/site/book.toml: [output.html] has what mdBook does not know")?;
    for (name, text) in ADDED {
        fs::write(work.path().join(name), text)?;
    }
    let book =
        MDBook::load_with_config(work.path(), config).context("mdBook cannot read the pages")?;
    book.build().context("mdBook cannot make the site")?;
    fs::write(made.join("404.html"), LOST)?;

    faults.extend(broken(made, &wanted)?);
    for one in &moved {
        let page = made.join(one.old.split('#').next().unwrap_or_default());
        faults.extend(moved::still_there(one, &ids(&fs::read_to_string(page)?)));
    }
    if faults.is_empty() { Ok(counts) } else { Err(Faults(faults).into()) }
}

/// mdBook's table of contents: a page's code is an item below the page.
fn summary(project: &Project, entries: &[Entry], codes: &BTreeMap<String, String>) -> String {
    let (mut text, mut last) = (String::from("# Summary\n"), String::new());
    let mut part = None;
    for entry in entries {
        if entry.part != part {
            part.clone_from(&entry.part);
            let _ = writeln!(text, "\n# {}\n", part.as_deref().unwrap_or("To look up"));
        }
        // Before the first part mdBook accepts no lists, so the item comes last.
        let numbered = text.contains("\n# ");
        let item = format!("[{}]({}.md)", entry.title, entry.name);
        // Measurements are items of their chapter, as its code is.
        let indent = if entry.is_apart() { "  " } else { "" };
        let _ =
            if numbered { writeln!(text, "{indent}- {item}") } else { writeln!(text, "\n{item}") };
        if codes.contains_key(&entry.name) {
            let (title, name) = (link::code_title(project, entry), link::code_name(entry));
            let item = format!("- [{title}]({name}.md)\n");
            if numbered {
                let _ = write!(text, "{indent}  {item}");
            } else {
                last.push_str(&item);
            }
        }
    }
    text + &last
}

/// The links at the end of a page: to its code, to the previous and the next page.
fn around(project: &Project, entries: &[Entry], entry: &Entry, code: bool) -> String {
    let [before, after] = neighbours(entries, entry);
    let mut html = String::from("\n\n<nav class=\"pages\" aria-label=\"Next pages\">\n");
    if code {
        let title = if project.of_page(&entry.file).is_some() {
            "The whole code, beside that of the chapter before"
        } else {
            "The files that this page shows"
        };
        let name = link::code_name(entry);
        let _ = writeln!(html, "<a class=\"whole\" href=\"{name}.html\">{title}</a>");
    }
    html.push_str(&step("previous", before, entry));
    html.push_str(&step("next", after, entry));
    html + "</nav>\n"
}

/// The previous and the next page in reading order.
fn neighbours<'a>(entries: &'a [Entry], entry: &Entry) -> [Option<&'a Entry>; 2] {
    let at = entries.iter().position(|other| other == entry).unwrap_or(0);
    let is_read = |other: &&Entry| !other.is_apart();
    [entries[..at].iter().rfind(is_read), entries[at + 1..].iter().find(is_read)]
}

/// The links at the end of a page of code: back to its page, and to the next page.
fn behind(entries: &[Entry], entry: &Entry) -> String {
    let [_, after] = neighbours(entries, entry);
    let mut html = String::from("\n\n<nav class=\"pages\" aria-label=\"Next pages\">\n");
    html.push_str(&step("previous", Some(entry), entry));
    html.push_str(&step("next", after, entry));
    html + "</nav>\n"
}

fn step(class: &str, to: Option<&Entry>, from: &Entry) -> String {
    let Some(to) = to else { return String::new() };
    let part = match &to.part {
        Some(part) if to.part != from.part => format!("<small>{}</small>", color::escaped(part)),
        _ => String::new(),
    };
    let word = if class == "next" { "Next" } else { "Back" };
    format!(
        "<a class=\"{class}\" href=\"{}\"><small>{word}</small>{part}<span>{}</span></a>\n",
        to.address(),
        color::escaped(&to.title)
    )
}

/// The links without a target in the finished site.
fn broken(made: &Path, wanted: &[Wanted]) -> Result<Vec<Fault>> {
    let mut places: BTreeMap<&str, BTreeSet<String>> = BTreeMap::new();
    let mut faults = Vec::new();
    for Wanted { file, line, page, id } in wanted {
        if !places.contains_key(&**page) {
            let path = made.join(page);
            if !path.is_file() {
                let what = format!("the link leads to '{page}', which the site does not have");
                faults.push(Fault::new(&**file, *line, what, "correct it"));
                continue;
            }
            places.insert(page, ids(&fs::read_to_string(&path)?));
        }
        if let Some(id) = id.as_ref().filter(|id| !places[&**page].contains(*id)) {
            let what = format!("the link leads to '{page}#{id}', and there is no such place");
            faults.push(Fault::new(&**file, *line, what, "correct it"));
        }
    }
    Ok(faults)
}

/// The ids of a page.
fn ids(page: &str) -> BTreeSet<String> {
    let ids = html::attributes(page).into_iter().filter(|attribute| attribute.name == "id");
    ids.map(|attribute| attribute.value).collect()
}
