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
use panels::{Panel, sheet};

use crate::fault::Fault;
use crate::page::{Page, PictureMark};
use crate::program::Programs;
use crate::project::Project;
use crate::shader;
use crate::shot::Shot;

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

/// A hash of several parts, as text.
pub fn hash(parts: [&[u8]; 2]) -> String {
    format!("{:016x}", parts.into_iter().fold(FNV_OFFSET, fnv))
}

/// Hashes of what chapters' pictures are made from.
#[derive(Default)]
pub struct Sources(BTreeMap<String, String>);

impl Sources {
    /// The hash of a chapter's code, its shaders with all they include, and the world that it shows.
    ///
    /// Comments and blanks do not count, so that a better comment makes no picture stale.
    pub fn of(&mut self, project: &Project, chapter: &str) -> String {
        if let Some(known) = self.0.get(chapter) {
            return known.clone();
        }
        let mut files = project.files(&format!("samples/{chapter}"));
        let says = |word: &str| {
            files.iter().any(|file| project.read(file).is_ok_and(|text| text.contains(word)))
        };
        // A chapter that opens scene files shows what they hold; to the others they are nothing.
        let (scene, scene_files) = (says("common::scene"), says("Composition"));
        if let Some(chapter) = project.chapters.iter().find(|known| known.name == chapter) {
            files.extend(shader::own(project, chapter));
            files.extend(shader::shared(project, chapter).into_keys());
        }
        if scene {
            // Where the pieces stand and how the light falls is framework code.
            files.extend(project.files("common/src/scene"));
            let asset = |path: &String| {
                path.matches('/').count() == 2
                    || scene_files && path.starts_with("samples/assets/scenes/")
            };
            files.extend(project.files("samples/assets").into_iter().filter(asset));
        }
        // No picture shows what a unit test holds.
        files.retain(|file| !file.ends_with("/tests.rs"));
        let hash = of_files(project, &files);
        self.0.insert(chapter.to_owned(), hash.clone());
        hash
    }
}

/// A hash of files, comments and blanks left out.
pub fn of_files(project: &Project, files: &[String]) -> String {
    let mut hash = FNV_OFFSET;
    for file in files {
        hash = fnv(hash, file.as_bytes());
        match project.read(file) {
            Ok(text) => hash = essential(&text).fold(hash, |hash, line| fnv(hash, line.as_bytes())),
            Err(_) => hash = fnv(hash, &fs::read(project.root.join(file)).unwrap_or_default()),
        }
    }
    format!("{hash:016x}")
}

/// The lines that have an effect: no comments, no unit tests.
fn essential(text: &str) -> impl Iterator<Item = &str> {
    let lines = text.lines().take_while(|line| *line != "#[cfg(test)]").map(str::trim);
    lines.filter(|line| !line.is_empty() && !line.starts_with("//"))
}

// FNV-1a, 64 bits (Fowler, Noll, Vo): the same on every system and with every version of Rust.
const FNV_OFFSET: u64 = 0xcbf2_9ce4_8422_2325;

fn fnv(hash: u64, bytes: &[u8]) -> u64 {
    // A byte that no text holds ends each part.
    let bytes = bytes.iter().chain(&[0xff]);
    bytes.fold(hash, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3))
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
    fn comments_and_blanks_have_no_effect() {
        let lines = |text| essential(text).map(str::to_owned).collect::<Vec<_>>();
        let short = "a\nb // c\n";
        let long = "//! A.\na\n\n    // x\n    b // c\n#[cfg(test)]\nmod tests {}\n";
        assert_eq!(lines(short), lines(long));
    }

    #[test]
    fn the_hash_is_the_known_one() {
        // FNV-1a of "a" followed by the byte that ends a part.
        let a = 0xaf63_dc4c_8601_ec8c_u64;
        assert_eq!(fnv(FNV_OFFSET, b"a"), (a ^ 0xff).wrapping_mul(0x0100_0000_01b3));
    }

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
