//! A picture of a page, made by the commands printed on the page.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use common::files::NewFolder;
use image::RgbImage;
use manuscript::fault::Fault;
use manuscript::page::{Page, PictureMark};
use manuscript::project::Project;
use panels::{Panel, sheet};

use super::rendering::Rendering;
use super::stamp::{self, Maker};
use crate::programs::command_line::in_a_line;
use crate::programs::program::Programs;

/// The largest width of a row of panels, without the gaps, in pixels.
const ROW: u32 = 960;

/// A picture made by a page's command, or by several commands, one for each panel.
pub struct Picture {
    /// The page.
    pub page: String,
    /// The marker's line there, from 1.
    pub line: usize,
    /// Its name: that of the file, without folder and extension.
    pub name: String,
    /// The commands and their labels, in one line.
    pub command: String,
    /// One run, or several of one chapter, each with a label.
    renderings: Vec<Rendering>,
}

impl Picture {
    /// Every picture made by a page, and the faults of their markers.
    pub fn all(project: &Project, pages: &[Page]) -> (Vec<Self>, Vec<Fault>) {
        let (mut pictures, mut faults) = (Vec::<Self>::new(), Vec::new());
        let marks =
            pages.iter().flat_map(|page| page.pictures.iter().map(move |mark| (page, mark)));
        for (page, mark) in marks {
            let picture = match Self::of(project, page, mark) {
                Ok(picture) => picture,
                Err(fault) => {
                    faults.push(fault);
                    continue;
                }
            };
            match pictures.iter().find(|other| other.name == picture.name) {
                Some(other) => {
                    let first = format!("{}:{}", other.page, other.line);
                    let what = format!("{} is already made at {first}", picture.file());
                    let remedy = "give this one a name: <!-- picture NAME -->";
                    faults.push(Fault::new(picture.page, picture.line, what, remedy));
                }
                None => pictures.push(picture),
            }
        }
        (pictures, faults)
    }

    /// The picture of a marker on a page.
    ///
    /// # Errors
    /// If there is no run of a chapter below it, or several that do not each have a label.
    fn of(project: &Project, page: &Page, mark: &PictureMark) -> Result<Self, Fault> {
        let wrong = |what: &str, remedy: &str| Fault::new(&*page.path, mark.line + 2, what, remedy);
        let renderings = Rendering::all(project, &mark.command, mark.step.as_deref());
        let renderings = renderings.map_err(|(what, remedy)| wrong(&what, remedy))?;
        let Some(first) = renderings.first() else {
            return Err(wrong("a picture is made by a `cargo run`", "write one"));
        };
        if renderings.iter().any(|rendering| rendering.chapter != first.chapter) {
            let remedy = "move the other commands to a block of their own";
            return Err(wrong("the panels of a picture are of one chapter", remedy));
        }
        if renderings.len() > 1 && renderings.iter().any(|rendering| rendering.label.is_none()) {
            let remedy = "write `# LABEL` on the line above its command";
            return Err(wrong("a panel has no label", remedy));
        }
        let stem = page.path.trim_start_matches("docs/").trim_end_matches(".md");
        Ok(Self {
            page: page.path.clone(),
            line: mark.line,
            name: mark.name.clone().unwrap_or_else(|| stem.to_owned()),
            command: in_a_line(&mark.command),
            renderings,
        })
    }

    /// Its file, from the project's root.
    pub fn file(&self) -> String {
        format!("docs/images/{}.png", self.name)
    }

    /// The chapter of the program that makes it.
    pub fn chapter(&self) -> &str {
        &self.renderings[0].chapter
    }

    /// The fault of its file, if it is missing or another command made it.
    pub fn fault(&self, project: &Project) -> Option<Fault> {
        let what = stamp::fault(project, &self.file(), &self.command)?;
        Some(Fault::new(&*self.page, self.line, what, self.remedy()))
    }

    /// The command that renders it again.
    pub fn remedy(&self) -> String {
        format!("run: cargo chapters sync --pictures {}", self.name)
    }

    /// Renders it into its file, unless the file already has the same pixels; returns its maker, and whether
    /// the file has changed.
    ///
    /// # Errors
    /// As [`Picture::make`], or if the file cannot be written.
    pub fn render(&self, programs: &Programs) -> Result<(Maker, bool)> {
        let folder = NewFolder::temporary()?;
        let (made, maker) = self.make(programs, folder.path())?;
        let changed = stamp::store(programs.project, &self.file(), &made, &self.command, &maker)?;
        Ok((maker, changed))
    }

    /// Renders it into a file of a folder, and returns that file and its maker.
    ///
    /// # Errors
    /// If the program is missing or fails, or panels differ in size or are narrower than their labels.
    pub fn make(&self, programs: &Programs, folder: &Path) -> Result<(PathBuf, Maker)> {
        let failed = || format!("{}:{}: {} is not made", self.page, self.line, self.file());
        let mut files = Vec::new();
        let mut maker = Maker::default();
        for (index, rendering) in self.renderings.iter().enumerate() {
            files.push(folder.join(format!("{index}.png")));
            maker = rendering.make(programs, &files[index]).with_context(failed)?;
        }
        if files.len() > 1 {
            let open = |file| Ok(image::open(file)?.to_rgb8());
            let pictures = files.iter().map(open).collect::<Result<Vec<_>>>()?;
            self.side_by_side(pictures).with_context(failed)?.save(&files[0])?;
        }
        Ok((files.swap_remove(0), maker))
    }

    /// Its panels under their labels, as many in a row as fit on a page.
    fn side_by_side(&self, pictures: Vec<RgbImage>) -> Result<RgbImage> {
        let size = pictures[0].dimensions();
        ensure!(pictures.iter().all(|one| one.dimensions() == size), "its panels differ in size");
        let labels =
            self.renderings.iter().map(|rendering| rendering.label.clone().unwrap_or_default());
        let mut panels = labels.zip(pictures.into_iter().map(Panel::Picture));
        let columns = (ROW / size.0).max(1) as usize;
        let rows =
            self.renderings.chunks(columns).map(|row| panels.by_ref().take(row.len()).collect());
        sheet(size, &rows.collect::<Vec<_>>())
    }
}
