//! The whole book: checks it, and regenerates its generated parts.

use std::collections::BTreeSet;

use anyhow::Result;
use common::UsageError;
use manuscript::anchor::anchors;
use manuscript::fault::Fault;
use manuscript::link::local;
use manuscript::page::{Kind, Page};
use manuscript::project::{Chapter, README, SUMMARY};

use super::block::body;
use super::glossary::Glossary;
use super::markdown::Markdown;
use super::reference::Files;
use super::{
    breath, chapter_files, exercise_list, gallery, map, placeholder, price, shared_shader,
    stray_file, text,
};
use crate::exercises::exercise;
use crate::mistakes::mistake::Mistake;
use crate::mistakes::reproduction::Reproduction;
use crate::mistakes::stages;
use crate::nightly;
use crate::pictures::picture::Picture;
use crate::pictures::stamp::Maker;
use crate::pictures::tour;
use crate::programs::change;
use crate::programs::program::{BUILD, Programs};
use crate::survey::card;
use crate::values::measurement::{self, Measurement};
use crate::values::record::Record;
use crate::values::{self, binding};

/// The book of a project.
pub struct Book<'a> {
    /// The chapters' programs.
    pub programs: &'a Programs<'a>,
    /// Its pages.
    pub pages: Vec<Page>,
}

impl<'a> Book<'a> {
    /// Reads every page.
    ///
    /// # Errors
    /// If one cannot be read.
    pub fn open(programs: &'a Programs<'a>) -> Result<Self> {
        let project = programs.project;
        let page = |path: String| Ok(Page::parse(&path, &project.read(&path)?));
        let pages = project.pages().into_iter().map(page).collect::<Result<_>>()?;
        Ok(Self { programs, pages })
    }

    /// Everything that is wrong, in the order of files and lines.
    ///
    /// # Errors
    /// If a program cannot be started.
    pub fn check(&self) -> Result<Vec<Fault>> {
        let project = self.programs.project;
        let mut faults = chapter_files::check(project);
        // A chapter's own picture also appears in the gallery, whether or not its command is right.
        let mut linked: BTreeSet<String> =
            project.chapters.iter().map(|chapter| chapter.picture()).collect();
        self.ask_programs()?;
        let files = Files::of(project);
        let glossary = Glossary::of(project);
        for page in &self.pages {
            faults.extend(page.faults.iter().cloned());
            faults.extend(self.stale_blocks(page));
            faults.extend(exercise_list::check(project, page));
            let written = Markdown::parse(&page.written());
            faults.extend(text::check(self.programs, &files, page, &written));
            faults.extend(self.title(page, &written));
            faults.extend(glossary.check(page));
            faults.extend(price::check(project, page));
            faults.extend(breath::check(project, page));
            linked.extend(written.links.iter().filter_map(|link| local(&page.path, &link.target)));
        }
        let (pictures, wrong) = Picture::all(project, &self.pages);
        faults.extend(wrong);
        for picture in &pictures {
            faults.extend(picture.fault(project));
            linked.insert(picture.file());
        }
        let (mistakes, wrong) = Mistake::all(project);
        faults.extend(wrong);
        for mistake in &mistakes {
            faults.extend(stages::check(project, mistake));
            faults.extend(mistake.fault(project));
            linked.insert(mistake.picture());
        }
        faults.extend(exercise::check(project));
        faults.extend(text::check_exercises(self.programs, &files));
        faults.extend(values::check(project, &self.pages));
        faults.extend(tour::check(project));
        linked.insert(tour::FILE.to_owned());
        faults.extend(self.without_picture(&pictures));
        faults.extend(self.without_gallery());
        let summary = gallery::summary(project);
        let found = project.read(SUMMARY).unwrap_or_default();
        if let Some(line) = first_difference(&found, &summary) {
            faults.push(Fault::stale(
                SUMMARY,
                line,
                "the table of contents is not that of Cargo.toml",
            ));
        }
        if let Some(drawn) = map::drawing(project, &self.pages)
            && project.read(map::FILE).unwrap_or_default() != drawn
        {
            faults.push(Fault::stale(map::FILE, 1, "the map is not that of Cargo.toml"));
        }
        faults.extend(self.wrong_anchors());
        faults.extend(placeholder::check_files(project));
        faults.extend(stray_file::check(project, &linked));
        faults.extend(nightly::check(project));
        faults.extend(card::all(project).1);
        faults.extend(shared_shader::check(project, &self.pages));
        faults.sort();
        faults.dedup();
        Ok(told_once(faults))
    }

    /// Fills every generated part; returns the changes, and the faults that remain.
    ///
    /// # Errors
    /// If a file cannot be written, or a program cannot be started.
    pub fn sync(&self) -> Result<(Vec<String>, Vec<Fault>)> {
        let project = self.programs.project;
        let (mut changed, mut faults) = (Vec::new(), Vec::new());
        let mut write = |path: &str, old: &str, new: &str| {
            if old != new {
                common::files::write_whole(&project.root.join(path), new.as_bytes())?;
                changed.push(path.to_owned());
            }
            anyhow::Ok(())
        };
        self.ask_programs()?;
        let (stored, _) = Record::all(project);
        let glossary = Glossary::of(project);
        for page in &self.pages {
            faults.extend(page.faults.iter().cloned());
            let old = page.with_bodies(&[]);
            let page = &glossary.linked(&binding::filled(page, &stored));
            let bodies: Vec<Option<String>> = page
                .blocks
                .iter()
                .map(|block| match body(self.programs, page, block) {
                    Ok((text, _)) => Some(text),
                    Err(fault) => {
                        faults.push(fault);
                        None
                    }
                })
                .collect();
            write(&page.path, &old, &page.with_bodies(&bodies))?;
        }
        let summary = project.read(SUMMARY).unwrap_or_default();
        if project.root.join("docs").is_dir() {
            write(SUMMARY, &summary, &gallery::summary(project))?;
        }
        if let Some(drawn) = map::drawing(project, &self.pages) {
            write(map::FILE, &project.read(map::FILE).unwrap_or_default(), &drawn)?;
        }
        faults.sort();
        faults.dedup();
        Ok((changed, told_once(faults)))
    }

    /// Repeats the measurements of these pages and names; without any, those that are missing or whose
    /// command has changed.
    ///
    /// # Errors
    /// If a name is unknown.
    pub fn measure(&self, names: &[String], done: impl FnMut(&str)) -> Result<Vec<Fault>> {
        let project = self.programs.project;
        let (stored, _) = Record::all(project);
        let (measurements, mut faults) = measurement::all(&self.pages, &stored);
        let names: Vec<&str> = names
            .iter()
            .map(|name| project.chapter(name).map_or(name.as_str(), |chapter| &chapter.name))
            .collect();
        let is_of = |measurement: &Measurement, name: &&str| {
            measurement.name == *name || measurement.page_name() == *name
        };
        if let Some(name) = names.iter().find(|name| !measurements.iter().any(|m| is_of(m, name))) {
            let there: Vec<&str> = measurements.iter().map(|m| &*m.name).collect();
            let what = format!("nothing measures '{name}'; there is {}", there.join(", "));
            return Err(UsageError(what).into());
        }
        let was_made = |measurement: &Measurement| {
            stored.get(&measurement.name).is_some_and(|record| record.commit.is_some())
        };
        let can_be_made = measurements.iter().filter(|measurement| !was_made(measurement));
        let wanted = |measurement: &&Measurement| match names[..] {
            [] => measurement.fault(stored.get(&measurement.name)).is_some(),
            _ => names.iter().any(|name| is_of(measurement, name)),
        };
        let wanted: Vec<&Measurement> = can_be_made.filter(|m| wanted(m)).collect();
        faults.extend(measurement::renew(self.programs, &wanted, &stored, done)?);
        Ok(faults)
    }

    /// Numbers that may be measured but are not bound, in lines edited since the last commit.
    pub fn warnings(&self) -> Vec<Fault> {
        let edited = change::lines(&self.programs.project.root);
        let warning = |page: &Page| {
            let lines = edited.get(&page.path)?;
            let mut numbers = binding::unbound(page);
            numbers.retain(|(line, _)| lines.contains(line));
            let (line, _) = numbers.first()?;
            let list: Vec<&str> = numbers.iter().map(|(_, number)| &**number).collect();
            let what = format!("bound to no measurement: {}", list.join(", "));
            let remedy = "a measured one is written NUMBER<!-- MEASUREMENT.VALUE -->";
            Some(Fault::new(&*page.path, *line, what, remedy))
        };
        self.pages.iter().filter_map(warning).collect()
    }

    fn ask_programs(&self) -> Result<()> {
        let blocks = self.pages.iter().flat_map(|page| &page.blocks);
        let controls = blocks.filter(|block| block.kind == Kind::Controls);
        let names: BTreeSet<&str> =
            controls.filter_map(|block| block.words.first()).map(String::as_str).collect();
        let known = self.programs.project.chapters.iter().map(|chapter| &*chapter.name);
        self.programs.ask(&known.filter(|name| names.contains(name)).collect::<Vec<_>>())
    }

    fn stale_blocks(&self, page: &Page) -> Vec<Fault> {
        let mut faults = Vec::new();
        for block in &page.blocks {
            match body(self.programs, page, block) {
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

    /// Checks that a chapter's page is headed by its number and title.
    fn title(&self, page: &Page, written: &Markdown) -> Option<Fault> {
        let project = self.programs.project;
        let heading = match project.of_page(&page.path) {
            Some(chapter) => chapter.heading(),
            None => {
                let tables = |chapter: &&Chapter| chapter.measurements() == page.path;
                gallery::measurements(project.chapters.iter().find(tables)?)
            }
        };
        let (line, title) = written.title.clone().unwrap_or((1, String::new()));
        let what = "the heading does not name the chapter";
        let remedy = format!("write `# {heading}`");
        (title != heading).then(|| Fault::new(&*page.path, line, what, remedy))
    }

    fn without_picture(&self, pictures: &[Picture]) -> Vec<Fault> {
        let mut faults = Vec::new();
        for chapter in &self.programs.project.chapters {
            let page = self.pages.iter().find(|page| page.path == chapter.page());
            let made = pictures.iter().any(|picture| picture.name == chapter.name);
            // A wrong marker has already been reported.
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

    /// The faults of anchors, including those that no page shows.
    fn wrong_anchors(&self) -> Vec<Fault> {
        let project = self.programs.project;
        let files = ["common/src", "samples", "shaders"].map(|folder| project.files(folder));
        let text = |file: &String| project.read(file).ok();
        let source = |file: &String| !file.ends_with(".obj");
        let files = files.into_iter().flatten().filter(source);
        files.filter_map(|file| anchors(&file, &text(&file)?).err()).collect()
    }

    /// Fails if no page and no mistake makes one of these pictures.
    ///
    /// # Errors
    /// If there is none; the message has the name.
    pub fn check_pictures(&self, names: &[String]) -> Result<(), UsageError> {
        let project = self.programs.project;
        let pictures = Picture::all(project, &self.pages).0.into_iter().map(|picture| picture.name);
        let mistakes = Mistake::all(project).0.into_iter().map(|mistake| mistake.name);
        let there: Vec<String> = pictures.chain(mistakes).collect();
        match names.iter().find(|name| !there.contains(name)) {
            Some(name) => {
                let there = there.join(", ");
                Err(UsageError(format!("no page makes a picture '{name}'; there is {there}")))
            }
            None => Ok(()),
        }
    }

    /// Renders the pictures of these names; without any, those that are missing or whose command has changed.
    /// `done` receives each file and the result.
    ///
    /// # Errors
    /// If a name is unknown, or a command fails.
    pub fn render(&self, names: &[String], mut done: impl FnMut(&str, &str)) -> Result<Vec<Fault>> {
        let project = self.programs.project;
        self.check_pictures(names)?;
        let (pictures, mut faults) = Picture::all(project, &self.pages);
        let (mistakes, wrong) = Mistake::all(project);
        faults.extend(wrong);
        type Made = Result<(Maker, bool)>;
        let mut rendered = |file: String, made: Made, place: (String, usize), remedy| {
            let fault = |error| {
                let what = format!("{file} cannot be rendered: {error:#}");
                Fault::new(place.0, place.1, what, remedy)
            };
            let told = |(maker, changed): (Maker, bool)| {
                if changed {
                    done(&file, &format!("rendered on {}", maker.device))
                } else {
                    done(&file, "the same")
                }
            };
            faults.extend(made.map(told).map_err(fault).err());
        };
        for picture in &pictures {
            let wanted = match names {
                [] => picture.fault(project).is_some(),
                _ => names.contains(&picture.name),
            };
            if wanted {
                let made = picture.render(self.programs);
                let place = (picture.page.clone(), picture.line);
                rendered(picture.file(), made, place, "correct the command or the sample");
            }
        }
        for mistake in &mistakes {
            let wanted = match names {
                [] => mistake.fault(project).is_some(),
                _ => names.contains(&mistake.name),
            };
            if wanted {
                let made = Reproduction::new(self.programs, mistake).render();
                let place = (mistake.file(), 1);
                rendered(mistake.picture(), made, place, "correct the patch or what it claims");
            }
        }
        Ok(faults)
    }
}

/// Merges the faults that a single build fixes: they report missing programs, not lines of pages.
fn told_once(faults: Vec<Fault>) -> Vec<Fault> {
    let (unbuilt, mut faults): (Vec<_>, Vec<_>) =
        faults.into_iter().partition(|fault| fault.remedy == BUILD);
    let programs: BTreeSet<&String> = unbuilt.iter().map(|fault| &fault.what).collect();
    let others = match programs.len().saturating_sub(1) {
        0 => String::new(),
        1 => ", and another cannot be asked either".to_owned(),
        others => format!(", and {others} others cannot be asked either"),
    };
    if let Some(first) = programs.first() {
        faults.insert(0, Fault::new("Cargo.toml", 1, format!("{first}{others}"), BUILD));
    }
    faults
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
