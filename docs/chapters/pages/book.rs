//! The whole book: what its generated parts should say, what is wrong, and mending what can be mended.

use std::collections::{BTreeMap, BTreeSet};

use anyhow::Result;
use common::usage::Usage;
use manuscript::anchor::anchors;
use manuscript::fault::Fault;
use manuscript::link::local;
use manuscript::page::{Kind, Page};
use manuscript::project::{Project, README, SUMMARY};

use super::block::body;
use super::glossary::Glossary;
use super::markdown::Markdown;
use super::reference::Files;
use super::{chapter_files, exercise_list, gallery, shared_shader, stray_file, text};
use crate::exercises::exercise;
use crate::figures::figure;
use crate::figures::measurement::{self, Measurement};
use crate::figures::record::{self, Record};
use crate::mistakes::mistake::Mistake;
use crate::mistakes::reproduction::Reproduction;
use crate::nightly;
use crate::pictures::picture::Picture;
use crate::programs::program::Programs;
use crate::sources::hash::Sources;
use crate::survey::card;

/// The book of a project.
pub struct Book<'a> {
    project: &'a Project,
    programs: &'a Programs,
    pages: Vec<Page>,
}

impl<'a> Book<'a> {
    /// Reads every page.
    ///
    /// # Errors
    /// If one cannot be read.
    pub fn open(project: &'a Project, programs: &'a Programs) -> Result<Self> {
        let page = |path: String| Ok(Page::parse(&path, &project.read(&path)?));
        let pages = project.pages().into_iter().map(page).collect::<Result<_>>()?;
        Ok(Self { project, programs, pages })
    }

    /// Everything that is wrong, in the order of files and lines.
    pub fn check(&self) -> Vec<Fault> {
        let mut faults = chapter_files::check(self.project);
        // A chapter's own picture is the gallery's too, whether or not its command is right.
        let mut linked: BTreeSet<String> =
            self.project.chapters.iter().map(|chapter| chapter.picture()).collect();
        self.ask_programs();
        let files = Files::of(self.project);
        let glossary = Glossary::of(self.project);
        for page in &self.pages {
            faults.extend(page.faults.iter().cloned());
            faults.extend(self.stale_blocks(page));
            faults.extend(exercise_list::check(self.project, page));
            let written = Markdown::parse(&page.written());
            faults.extend(text::check(self.project, self.programs, &files, page, &written));
            faults.extend(self.title(page, &written));
            faults.extend(glossary.check(page));
            linked.extend(written.links.iter().filter_map(|link| local(&page.path, &link.target)));
        }
        let (pictures, wrong) = self.pictures();
        faults.extend(wrong);
        let mut sources = Sources::default();
        for picture in &pictures {
            let stale = picture.stale(self.project, &mut sources);
            faults.extend(stale.map(|what| picture.fault(what)));
            linked.insert(picture.file());
        }
        let (mistakes, wrong) = Mistake::all(self.project);
        faults.extend(wrong);
        for mistake in &mistakes {
            faults.extend(mistake.patched(self.project).err());
            faults.extend(mistake.stale(self.project));
            linked.insert(mistake.picture());
        }
        faults.extend(exercise::check(self.project));
        faults.extend(text::check_exercises(self.project, self.programs, &files));
        faults.extend(self.wrong_figures(&mut sources));
        faults.extend(self.without_picture(&pictures));
        faults.extend(self.without_gallery());
        let summary = gallery::summary(self.project);
        let found = self.project.read(SUMMARY).unwrap_or_default();
        if let Some(line) = first_difference(&found, &summary) {
            faults.push(Fault::stale(
                SUMMARY,
                line,
                "the table of contents is not that of Cargo.toml",
            ));
        }
        faults.extend(self.wrong_anchors());
        faults.extend(stray_file::check(self.project, &linked));
        faults.extend(nightly::check(self.project));
        faults.extend(card::all(self.project).1);
        faults.extend(shared_shader::check(self.project, &self.pages));
        faults.sort();
        faults.dedup();
        faults
    }

    /// Fills every generated part; returns what it changed, and what it could not.
    ///
    /// # Errors
    /// If a file cannot be written.
    pub fn sync(&self) -> Result<(Vec<String>, Vec<Fault>)> {
        let (mut changed, mut faults) = (Vec::new(), Vec::new());
        let mut write = |path: &str, old: &str, new: &str| {
            if old != new {
                common::files::write_whole(&self.project.root.join(path), new.as_bytes())?;
                changed.push(path.to_owned());
            }
            anyhow::Ok(())
        };
        self.ask_programs();
        let (stored, _) = Record::all(self.project);
        let glossary = Glossary::of(self.project);
        for page in &self.pages {
            faults.extend(page.faults.iter().cloned());
            let old = page.with_bodies(&[]);
            let page = &glossary.linked(&figure::filled(page, &stored));
            let bodies: Vec<Option<String>> = page
                .blocks
                .iter()
                .map(|block| match body(self.project, self.programs, page, block) {
                    Ok((text, _)) => Some(text),
                    Err(fault) => {
                        faults.push(fault);
                        None
                    }
                })
                .collect();
            write(&page.path, &old, &page.with_bodies(&bodies))?;
        }
        let summary = self.project.read(SUMMARY).unwrap_or_default();
        if self.project.root.join("docs").is_dir() {
            write(SUMMARY, &summary, &gallery::summary(self.project))?;
        }
        faults.sort();
        faults.dedup();
        Ok((changed, faults))
    }

    /// Every picture that a page makes, and what is wrong with their markers.
    pub fn pictures(&self) -> (Vec<Picture>, Vec<Fault>) {
        let (mut pictures, mut faults) = (Vec::<Picture>::new(), Vec::new());
        for page in &self.pages {
            for mark in &page.pictures {
                match Picture::of(self.project, page, mark) {
                    Ok(picture) => match pictures.iter().find(|other| other.name == picture.name) {
                        Some(other) => {
                            let first = format!("{}:{}", other.page, other.line);
                            let what = format!("{} is already made at {first}", picture.file());
                            let remedy = "give this one a name: <!-- picture NAME -->";
                            faults.push(Fault::new(picture.page, picture.line, what, remedy));
                        }
                        None => pictures.push(picture),
                    },
                    Err(fault) => faults.push(fault),
                }
            }
        }
        (pictures, faults)
    }

    /// Figures that are not what was measured, and measurements that are out of date.
    fn wrong_figures(&self, sources: &mut Sources) -> Vec<Fault> {
        let (stored, mut faults) = Record::all(self.project);
        // If a page's stored file is damaged, its figures cannot be checked.
        let is_known = |page: &&Page| {
            let folder = format!("{}/{}/", record::FOLDER, page.stem());
            !faults.iter().any(|fault| fault.file.starts_with(&folder))
        };
        let pages: Vec<&Page> = self.pages.iter().filter(is_known).collect();
        let (measurements, wrong) = self.measurements();
        faults.extend(wrong);
        for measurement in &measurements {
            let known = stored.get(&measurement.name);
            // A file that is damaged has been told as that.
            if known.is_some() || !self.project.has(&measurement.file()) {
                faults.extend(measurement.stale(self.project, known, sources));
            }
        }
        faults.extend(measurement::strays(&measurements, &stored));
        let unbound = record::unbound(self.project);
        for path in unbound.iter().filter(|path| !self.pages.iter().any(|page| page.path == **path))
        {
            let what = format!("there is no page '{path}'");
            faults.push(Fault::new(record::UNBOUND, 1, what, "take it out"));
        }
        faults.extend(pages.into_iter().flat_map(|page| figure::check(page, &stored, &unbound)));
        faults
    }

    /// Every measurement that a page makes, and what is wrong with their markers.
    fn measurements(&self) -> (Vec<Measurement>, Vec<Fault>) {
        let (mut measurements, mut faults) = (BTreeMap::<String, Measurement>::new(), Vec::new());
        for page in &self.pages {
            let (found, wrong) = measurement::of(page);
            faults.extend(wrong);
            for measurement in found {
                if let Some(other) = measurements.get(&measurement.name) {
                    let what =
                        format!("{} is already made in line {}", measurement.name, other.line);
                    faults.push(Fault::new(&*page.path, measurement.line, what, "rename one"));
                } else {
                    measurements.insert(measurement.name.clone(), measurement);
                }
            }
        }
        (measurements.into_values().collect(), faults)
    }

    /// Renews the measurements of these pages and names, or with none those that are out of date.
    ///
    /// # Errors
    /// If a name is unknown.
    pub fn measure(&self, names: &[String], done: impl FnMut(&str)) -> Result<Vec<Fault>> {
        let (stored, _) = Record::all(self.project);
        let (measurements, mut faults) = self.measurements();
        let mut sources = Sources::default();
        let names: Vec<&str> = names
            .iter()
            .map(|name| self.project.chapter(name).map_or(name.as_str(), |chapter| &chapter.name))
            .collect();
        let is_of = |measurement: &Measurement, name: &&str| {
            measurement.name == *name || measurement.page_name() == *name
        };
        if let Some(name) = names.iter().find(|name| !measurements.iter().any(|m| is_of(m, name))) {
            let there: Vec<&str> = measurements.iter().map(|m| &*m.name).collect();
            let what = format!("nothing measures '{name}'; there is {}", there.join(", "));
            return Err(Usage(what).into());
        }
        let mut wanted = |measurement: &&Measurement| match names[..] {
            [] => {
                let known = stored.get(&measurement.name);
                measurement.stale(self.project, known, &mut sources).is_some()
            }
            _ => names.iter().any(|name| is_of(measurement, name)),
        };
        let wanted: Vec<&Measurement> = measurements.iter().filter(|m| wanted(m)).collect();
        faults.extend(measurement::renew(self.project, self.programs, &wanted, &stored, done)?);
        Ok(faults)
    }

    fn ask_programs(&self) {
        let blocks = self.pages.iter().flat_map(|page| &page.blocks);
        let controls = blocks.filter(|block| block.kind == Kind::Controls);
        let names: BTreeSet<&str> =
            controls.filter_map(|block| block.words.first()).map(String::as_str).collect();
        let known = self.project.chapters.iter().map(|chapter| &*chapter.name);
        self.programs.ask(&known.filter(|name| names.contains(name)).collect::<Vec<_>>());
    }

    fn stale_blocks(&self, page: &Page) -> Vec<Fault> {
        let mut faults = Vec::new();
        for block in &page.blocks {
            match body(self.project, self.programs, page, block) {
                Ok((should, source)) => {
                    let lines = page.lines[block.body.clone()].iter();
                    let found: String = lines.map(|line| format!("{line}\n")).collect();
                    if let Some(line) = first_difference(&found, &should) {
                        let line = (block.line + line).min(block.body.end + 1);
                        let what = format!("this {} is not what {source} says", block.kind.noun());
                        faults.push(Fault::stale(&*page.path, line, what));
                    }
                }
                Err(fault) => faults.push(fault),
            }
        }
        faults
    }

    /// A chapter's page is headed by its number and title.
    fn title(&self, page: &Page, written: &Markdown) -> Option<Fault> {
        let chapter = self.project.of_page(&page.path)?;
        let (line, title) = written.title.clone().unwrap_or((1, String::new()));
        let what = "the heading does not name the chapter";
        let remedy = format!("write `# {}`", chapter.heading());
        (title != chapter.heading()).then(|| Fault::new(&*page.path, line, what, remedy))
    }

    fn without_picture(&self, pictures: &[Picture]) -> Vec<Fault> {
        let mut faults = Vec::new();
        for chapter in &self.project.chapters {
            let page = self.pages.iter().find(|page| page.path == chapter.page());
            let made = pictures.iter().any(|picture| picture.name == chapter.name);
            // A marker that is wrong has been told as that.
            if let Some(page) = page.filter(|page| !made && page.faults.is_empty()) {
                let what = format!("no command makes {}", chapter.picture());
                let remedy = "add <!-- picture --> on the line before the ```sh block with it";
                faults.push(Fault::new(&*page.path, 1, what, remedy));
            }
        }
        faults
    }

    fn without_gallery(&self) -> Option<Fault> {
        let readme = self.pages.iter().find(|page| page.path == README)?;
        let shown = readme.blocks.iter().any(|block| block.kind == Kind::Gallery);
        let remedy = "add <!-- gallery --> and <!-- /gallery -->";
        (!shown).then(|| Fault::new(README, 1, "the README has no gallery", remedy))
    }

    /// Anchors are held to their form even where no page shows them yet.
    fn wrong_anchors(&self) -> Vec<Fault> {
        let files = ["common/src", "samples", "shaders"].map(|folder| self.project.files(folder));
        let text = |file: &String| self.project.read(file).ok();
        let source = |file: &String| !file.ends_with(".obj");
        let files = files.into_iter().flatten().filter(source);
        files.filter_map(|file| anchors(&file, &text(&file)?).err()).collect()
    }

    /// Fails if no page and no mistake makes one of these pictures.
    ///
    /// # Errors
    /// With its name.
    pub fn check_pictures(&self, names: &[String]) -> Result<(), Usage> {
        let pictures = self.pictures().0.into_iter().map(|picture| picture.name);
        let mistakes = Mistake::all(self.project).0.into_iter().map(|mistake| mistake.name);
        let there: Vec<String> = pictures.chain(mistakes).collect();
        match names.iter().find(|name| !there.contains(name)) {
            Some(name) => {
                let there = there.join(", ");
                Err(Usage(format!("no page makes a picture '{name}'; there is {there}")))
            }
            None => Ok(()),
        }
    }

    /// Renders the pictures of these names, or with none those that are out of date.
    ///
    /// # Errors
    /// If a name is unknown, or a command fails.
    pub fn render(&self, names: &[String], mut done: impl FnMut(&str, &str)) -> Result<Vec<Fault>> {
        self.check_pictures(names)?;
        let (pictures, mut faults) = self.pictures();
        let (mistakes, wrong) = Mistake::all(self.project);
        faults.extend(wrong);
        let mut sources = Sources::default();
        for picture in &pictures {
            let wanted = match names {
                [] => picture.stale(self.project, &mut sources).is_some(),
                _ => names.contains(&picture.name),
            };
            if wanted {
                match picture.render(self.project, self.programs, &mut sources) {
                    Ok(device) => done(&picture.file(), &device),
                    Err(error) => faults.push(Fault::new(
                        &*picture.page,
                        picture.line,
                        format!("{} cannot be rendered: {error:#}", picture.file()),
                        "correct the command or the sample",
                    )),
                }
            }
        }
        for mistake in &mistakes {
            let wanted = match names {
                [] => mistake.stale(self.project).is_some(),
                _ => names.contains(&mistake.name),
            };
            if wanted {
                match Reproduction::new(self.project, self.programs, mistake).render() {
                    Ok(device) => done(&mistake.picture(), &device),
                    Err(error) => faults.push(Fault::new(
                        mistake.file(),
                        1,
                        format!("{} cannot be rendered: {error:#}", mistake.picture()),
                        "correct the patch or what it claims",
                    )),
                }
            }
        }
        Ok(faults)
    }
}

/// The first line, from 1, in which two texts differ.
fn first_difference(a: &str, b: &str) -> Option<usize> {
    let (mut left, mut right) = (a.lines(), b.lines());
    (1..).find_map(|line| match (left.next(), right.next()) {
        (None, None) => Some(None),
        (a, b) if a == b => None,
        _ => Some(Some(line)),
    })?
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_difference_is_a_line() {
        assert_eq!(first_difference("a\nb\n", "a\nb\n"), None);
        assert_eq!(first_difference("a\nb\n", "a\nc\n"), Some(2));
        assert_eq!(first_difference("a\n", "a\nb\n"), Some(2));
        assert_eq!(first_difference("", ""), None);
    }
}
