//! The moving picture of the README: the heading pictures of all chapters, each under its name for a second.

use anyhow::{Context, Result};
use color_quant::NeuQuant;
use common::files::write_whole;
use image::imageops::FilterType;
use image::{DynamicImage, RgbaImage};
use manuscript::fault::Fault;
use manuscript::project::{Chapter, Project, README};
use panels::{Panel, sheet};
use png::{ColorType, Compression, Encoder};

use super::stamp::{self, Maker};

/// The file of the tour.
pub const FILE: &str = "docs/images/tour.png";
/// The command that makes it.
pub const COMMAND: &str = "cargo chapters tour";
/// The size of a chapter's picture in it, without the name above.
const PICTURE: (u32, u32) = (400, 250);
/// The time of each picture, in hundredths of a second.
const DELAY: u16 = 100;

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

/// Makes it, and reports how many pictures and bytes it has.
///
/// # Errors
/// If a chapter's picture cannot be read, or the moving one cannot be written.
pub fn make(project: &Project) -> Result<String> {
    let bytes = bytes(project)?;
    write_whole(&project.root.join(FILE), &bytes)?;
    Ok(format!("{FILE}: {} pictures, {} bytes\n", project.chapters.len(), bytes.len()))
}

/// Its bytes, from the chapters' pictures as they are.
///
/// # Errors
/// If one cannot be read.
pub fn bytes(project: &Project) -> Result<Vec<u8>> {
    let mut chapters: Vec<_> = project.chapters.iter().collect();
    chapters.sort_unstable_by_key(|chapter| chapter.number());
    let frame = |chapter: &&Chapter| frame(project, chapter);
    animated(&chapters.iter().map(frame).collect::<Result<Vec<_>>>()?)
}

/// A chapter's picture under its name.
fn frame(project: &Project, chapter: &Chapter) -> Result<RgbaImage> {
    let file = chapter.picture();
    let picture = image::open(project.root.join(&file)).context(file)?;
    let picture = picture.resize_exact(PICTURE.0, PICTURE.1, FilterType::Lanczos3).into_rgb8();
    let framed = sheet(PICTURE, &[vec![(chapter.heading(), Panel::Picture(picture))]])?;
    Ok(DynamicImage::ImageRgb8(framed).into_rgba8())
}

/// The frames in 256 colors, played once; programs that do not show moving pictures show the last one.
fn animated(frames: &[RgbaImage]) -> Result<Vec<u8>> {
    /// The palette is chosen from one pixel in this many.
    const EVERY: i32 = 7;
    let all: Vec<u8> = frames.iter().flat_map(|frame| frame.as_raw()).copied().collect();
    let colors = NeuQuant::new(EVERY, 256, &all);
    let mut bytes = Vec::new();
    let mut encoder = Encoder::new(&mut bytes, frames[0].width(), frames[0].height());
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
