//! The moving picture at the head of the README: what chapters 02 to 25 render, one after the other.

use anyhow::{Context, Result};
use color_quant::NeuQuant;
use common::files::write_whole;
use image::RgbaImage;
use image::imageops::FilterType;
use manuscript::fault::Fault;
use manuscript::project::{Project, README};
use png::{ColorType, Compression, Encoder};

use super::stamp::{self, Maker};

/// The file of the tour.
pub const FILE: &str = "docs/images/tour.png";
/// The command that makes it.
pub const COMMAND: &str = "cargo chapters tour";
const SIZE: [u32; 2] = [400, 250];
/// The time of each picture, in hundredths of a second: with fewer than three changes a second, nobody is
/// in danger from flashes (WCAG 2.2, criterion 2.3.1).
const DELAY: u16 = 36;

/// The pictures that it shows, in order.
fn frames(project: &Project) -> Vec<String> {
    let shown = |number: &str| ("02"..="25").contains(&number);
    let chapters = project.chapters.iter().filter(|chapter| shown(chapter.number()));
    let mut files: Vec<String> = chapters.map(|chapter| chapter.picture()).collect();
    files.sort_unstable();
    files
}

/// True if the README shows it.
pub fn is_shown(project: &Project) -> bool {
    project.read(README).is_ok_and(|readme| readme.contains(FILE))
}

/// The fault of the tour, if the README shows it and it has one.
pub fn check(project: &Project) -> Option<Fault> {
    let readme = project.read(README).unwrap_or_default();
    let line = readme.lines().position(|line| line.contains(FILE))? + 1;
    let what = stamp::fault(project, FILE, COMMAND)?;
    Some(Fault::new(README, line, what, format!("run: {COMMAND}")))
}

/// Makes it, and says how many pictures it shows, and how many bytes it has.
///
/// # Errors
/// If a chapter's picture cannot be read, or the moving one not be written.
pub fn make(project: &Project) -> Result<String> {
    let bytes = bytes(project)?;
    write_whole(&project.root.join(FILE), &bytes)?;
    Ok(format!("{FILE}: {} pictures, {} bytes\n", frames(project).len(), bytes.len()))
}

/// Its bytes, from the chapters' pictures as they are.
///
/// # Errors
/// If one cannot be read.
pub fn bytes(project: &Project) -> Result<Vec<u8>> {
    let files = frames(project);
    animated(&files.iter().map(|file| frame(project, file)).collect::<Result<Vec<_>>>()?)
}

fn frame(project: &Project, file: &str) -> Result<RgbaImage> {
    let picture = image::open(project.root.join(file)).with_context(|| file.to_owned())?;
    let [width, height] = SIZE;
    Ok(picture.resize_exact(width, height, FilterType::Lanczos3).into_rgba8())
}

/// The frames in 256 colors, played once; whoever shows no moving pictures shows the last one.
fn animated(frames: &[RgbaImage]) -> Result<Vec<u8>> {
    /// Every so many pixels are asked which colors there should be.
    const EVERY: i32 = 7;
    let all: Vec<u8> = frames.iter().flat_map(|frame| frame.as_raw()).copied().collect();
    let colors = NeuQuant::new(EVERY, 256, &all);
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, SIZE[0], SIZE[1]);
    encoder.set_color(ColorType::Indexed);
    encoder.set_palette(colors.color_map_rgb());
    encoder.set_compression(Compression::High);
    encoder.set_animated(frames.len() as u32, 1)?;
    encoder.set_frame_delay(DELAY, 100)?;
    encoder.set_sep_def_img(true)?;
    stamp::tell(&mut encoder, COMMAND, &Maker::default())?;
    let mut writer = encoder.write_header()?;
    for frame in frames.last().into_iter().chain(frames) {
        let indices: Vec<u8> =
            frame.pixels().map(|pixel| colors.index_of(&pixel.0) as u8).collect();
        writer.write_image_data(&indices)?;
    }
    writer.finish()?;
    Ok(bytes)
}
