//! The pages' pictures: made by the commands that the pages print, and each saying what it was made from.
//!
//! A PNG carries its command, a hash of its sources and the device in tEXt chunks, so that a picture
//! that the code would no longer make is known without rendering it.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{BufReader, BufWriter, Write};
use std::path::Path;

use anyhow::{Context, Result, ensure};
use common::files::Folder;
use image::RgbImage;
use manuscript::fault::Fault;
use manuscript::page::{Page, PictureMark};
use manuscript::project::Project;
use panels::{Panel, sheet};

use super::render::Shot;
use crate::programs::program::Programs;
use crate::sources::hash::Sources;

const COMMAND: &str = "Command";
const SOURCES: &str = "Sources";
const DEVICE: &str = "Device";

/// How wide a row of panels may be, without the gaps, in pixels.
const ROW: u32 = 960;

/// A picture that a page's command makes, or several commands, each a panel of it.
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
    shots: Vec<Shot>,
}

impl Picture {
    /// The picture of a marker on a page.
    ///
    /// # Errors
    /// If there is no run of a chapter below it, or several and not each has a label.
    pub fn of(project: &Project, page: &Page, mark: &PictureMark) -> Result<Self, Fault> {
        let wrong = |what: &str, remedy: &str| Fault::new(&*page.path, mark.line + 2, what, remedy);
        let shots = Shot::all(project, &mark.command);
        let shots = shots.map_err(|(what, remedy)| wrong(&what, remedy))?;
        let Some(first) = shots.first() else {
            return Err(wrong("a picture is made by a `cargo run`", "write one"));
        };
        if shots.iter().any(|shot| shot.chapter != first.chapter) {
            let remedy = "move the other commands to a block of their own";
            return Err(wrong("the panels of a picture are of one chapter", remedy));
        }
        if shots.len() > 1 && shots.iter().any(|shot| shot.label.is_none()) {
            let remedy = "write `# LABEL` on the line above its command";
            return Err(wrong("a panel has no label", remedy));
        }
        let stem = page.path.trim_start_matches("docs/").trim_end_matches(".md");
        Ok(Self {
            page: page.path.clone(),
            line: mark.line,
            name: mark.name.clone().unwrap_or_else(|| stem.to_owned()),
            command: mark
                .command
                .replace('\\', " ")
                .split_whitespace()
                .collect::<Vec<_>>()
                .join(" "),
            shots,
        })
    }

    /// Its file, from the project's root.
    pub fn file(&self) -> String {
        format!("docs/images/{}.png", self.name)
    }

    /// What is out of date about it, if anything is.
    pub fn stale(&self, project: &Project, sources: &mut Sources) -> Option<String> {
        let chapter = &self.shots[0].chapter;
        let (hash, maker) = (sources.of(project, chapter), format!("what {chapter} renders"));
        stale(project, &self.file(), &self.command, &hash, &maker)
    }

    /// The fault that says that it is out of date.
    pub fn fault(&self, what: String) -> Fault {
        let remedy = format!("run: cargo chapters sync --pictures {}", self.name);
        Fault::new(&*self.page, self.line, what, remedy)
    }

    /// Renders it, and returns the device that did.
    ///
    /// # Errors
    /// If the program is missing or fails, or panels differ in size or are narrower than their labels.
    pub fn render(
        &self,
        project: &Project,
        programs: &Programs,
        sources: &mut Sources,
    ) -> Result<String> {
        let failed = || format!("{}:{}: {} is not made", self.page, self.line, self.file());
        let folder = Folder::temporary()?;
        let mut files = Vec::new();
        let mut device = String::new();
        for (index, shot) in self.shots.iter().enumerate() {
            files.push(folder.path().join(format!("{index}.png")));
            device = shot.render(programs, &files[index]).with_context(failed)?;
        }
        if files.len() > 1 {
            let open = |file| Ok(image::open(file)?.to_rgb8());
            let pictures = files.iter().map(open).collect::<Result<Vec<_>>>()?;
            self.side_by_side(pictures).with_context(failed)?.save(&files[0])?;
        }
        let hash = sources.of(project, &self.shots[0].chapter);
        let stamped = stamped(&files[0], &self.command, &hash, &device)?;
        let file = project.root.join(self.file());
        fs::create_dir_all(project.root.join("docs/images"))?;
        common::files::write_whole(&file, &stamped)?;
        Ok(device)
    }

    /// Its panels under their labels, as many in a row as a page has room for.
    fn side_by_side(&self, pictures: Vec<RgbImage>) -> Result<RgbImage> {
        let size = pictures[0].dimensions();
        ensure!(pictures.iter().all(|one| one.dimensions() == size), "its panels differ in size");
        let labels = self.shots.iter().map(|shot| shot.label.clone().unwrap_or_default());
        let mut panels = labels.zip(pictures.into_iter().map(Panel::Picture));
        let columns = (ROW / size.0).max(1) as usize;
        let rows = self.shots.chunks(columns).map(|row| panels.by_ref().take(row.len()).collect());
        sheet(size, &rows.collect::<Vec<_>>())
    }
}

/// What is out of date about a picture that says which command and which sources made it, if anything is.
pub fn stale(
    project: &Project,
    file: &str,
    command: &str,
    hash: &str,
    maker: &str,
) -> Option<String> {
    if !project.has(file) {
        return Some(format!("the picture {file} is missing"));
    }
    let Ok(stamp) = stamp(&project.root.join(file)) else {
        return Some(format!("the picture {file} is no PNG"));
    };
    match (stamp.get(COMMAND), stamp.get(SOURCES)) {
        (Some(made_by), _) if made_by != command => {
            Some(format!("the picture {file} was made by another command"))
        }
        (Some(_), Some(made_from)) if made_from == hash => None,
        (Some(_), Some(_)) => Some(format!("the picture {file} is older than {maker}")),
        _ => Some(format!("the picture {file} does not say what made it")),
    }
}

/// The bytes of a picture that says which command, sources and device made it.
///
/// # Errors
/// If the file is no PNG.
pub fn stamped(file: &Path, command: &str, hash: &str, device: &str) -> Result<Vec<u8>> {
    restamp(file, &[(COMMAND, command), (SOURCES, hash), (DEVICE, device)])
}

/// What a PNG says about itself.
fn stamp(file: &Path) -> Result<BTreeMap<String, String>> {
    let reader = png::Decoder::new(BufReader::new(File::open(file)?)).read_info()?;
    let texts = &reader.info().uncompressed_latin1_text;
    Ok(texts.iter().map(|text| (text.keyword.clone(), text.text.clone())).collect())
}

/// A PNG's bytes with other texts, packed as small as they go.
fn restamp(file: &Path, texts: &[(&str, &str)]) -> Result<Vec<u8>> {
    let mut reader = png::Decoder::new(BufReader::new(File::open(file)?)).read_info()?;
    let mut pixels = vec![0; reader.output_buffer_size().context("the picture is too large")?];
    let frame = reader.next_frame(&mut pixels)?;
    let mut bytes = BufWriter::new(Vec::new());
    let mut encoder = png::Encoder::new(&mut bytes, frame.width, frame.height);
    encoder.set_color(frame.color_type);
    encoder.set_depth(frame.bit_depth);
    encoder.set_compression(png::Compression::High);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    for (key, text) in texts {
        encoder.add_text_chunk((*key).to_owned(), (*text).to_owned())?;
    }
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&pixels[..frame.buffer_size()])?;
    writer.finish()?;
    bytes.flush()?;
    Ok(bytes.into_inner()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stamp_survives() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a.png");
        image::RgbImage::from_fn(5, 4, |x, y| image::Rgb([x as u8, y as u8, 7]))
            .save(&file)
            .unwrap();
        assert!(stamp(&file).unwrap().is_empty());
        let bytes = restamp(&file, &[(COMMAND, "cargo run"), (DEVICE, "Ö")]).unwrap();
        fs::write(&file, bytes).unwrap();
        let read = stamp(&file).unwrap();
        assert_eq!((&*read[COMMAND], &*read[DEVICE]), ("cargo run", "Ö"));
        assert_eq!(image::open(&file).unwrap().to_rgb8().get_pixel(4, 3).0, [4, 3, 7]);
    }
}
