//! A picture's stamp: the command, device and driver that made it, in tEXt chunks of its PNG.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufReader, BufWriter, Write};
use std::path::Path;

use anyhow::{Context, Result};
use image::RgbImage;
use manuscript::project::Project;

const COMMAND: &str = "Command";
const DEVICE: &str = "Device";
const DRIVER: &str = "Driver";

/// The device that rendered a picture, and its driver.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Maker {
    /// The device's name.
    pub device: String,
    /// The driver, as its maker names it.
    pub driver: String,
}

impl Maker {
    /// The maker named in a sample's report.
    pub fn of(report: &serde_json::Value) -> Self {
        let text = |key: &str| report[key].as_str().unwrap_or("unknown").to_owned();
        Self { device: text("device"), driver: text("driver") }
    }
}

/// A picture of a page, read from its PNG.
pub struct Stored {
    /// The command that made it; empty if unknown.
    pub command: String,
    /// The device that ran it.
    pub maker: Maker,
    /// Its frames: one, unless the picture moves.
    pub frames: Vec<RgbImage>,
}

impl Stored {
    /// Reads a PNG, with all frames of a moving picture.
    ///
    /// # Errors
    /// If the file is missing or not a PNG of 8 bits.
    pub fn open(file: &Path) -> Result<Self> {
        let mut decoder = png::Decoder::new(BufReader::new(File::open(file)?));
        decoder.set_transformations(png::Transformations::EXPAND | png::Transformations::ALPHA);
        let mut reader = decoder.read_info()?;
        let mut texts = texts(&reader);
        let mut pixels = vec![0; reader.output_buffer_size().context("the picture is too large")?];
        let channels = reader.output_color_type().0.samples();
        let control = reader.info().animation_control().copied();
        let mut frames = Vec::new();
        for _ in 0..control.map_or(1, |control| control.num_frames) {
            let frame = reader.next_frame(&mut pixels)?;
            let colors = pixels[..frame.buffer_size()].chunks(channels);
            let colors =
                colors.flat_map(|c| if channels < 3 { [c[0]; 3] } else { [c[0], c[1], c[2]] });
            let frame = RgbImage::from_raw(frame.width, frame.height, colors.collect());
            frames.push(frame.context("not 8 bits a channel")?);
        }
        let mut text = |key| texts.remove(key).unwrap_or_default();
        let (command, device, driver) = (text(COMMAND), text(DEVICE), text(DRIVER));
        Ok(Self { command, maker: Maker { device, driver }, frames })
    }
}

/// The fault of a picture that this command should have made, if it has one. This does not run the command.
pub fn fault(project: &Project, file: &str, command: &str) -> Option<String> {
    if !project.has(file) {
        return Some(format!("the picture {file} is missing"));
    }
    let opened = || anyhow::Ok(texts(&decoder(&project.root.join(file))?));
    let Ok(texts) = opened() else { return Some(format!("the picture {file} is no PNG")) };
    match texts.get(COMMAND) {
        Some(made_by) if made_by == command => None,
        Some(_) => Some(format!("the picture {file} was made by another command")),
        None => Some(format!("the picture {file} does not say what made it")),
    }
}

type Reader = png::Reader<BufReader<File>>;

fn decoder(file: &Path) -> Result<Reader> {
    Ok(png::Decoder::new(BufReader::new(File::open(file)?)).read_info()?)
}

fn texts(reader: &Reader) -> BTreeMap<String, String> {
    let texts = &reader.info().uncompressed_latin1_text;
    texts.iter().map(|text| (text.keyword.clone(), text.text.clone())).collect()
}

/// Stores a PNG as a page's picture, with its stamp and packed as small as possible, and returns whether that
/// changed the file: one with the same pixels, command and device is left unchanged.
///
/// # Errors
/// If `made` is not a PNG, or the picture cannot be written.
pub fn store(
    project: &Project,
    file: &str,
    made: &Path,
    command: &str,
    maker: &Maker,
) -> Result<bool> {
    let path = project.root.join(file);
    let new = Stored::open(made)?;
    let is_same = Stored::open(&path)
        .is_ok_and(|old| old.command == command && old.maker == *maker && old.frames == new.frames);
    if !is_same {
        std::fs::create_dir_all(path.parent().unwrap_or(&project.root))?;
        common::files::write_whole(&path, &stamped(made, command, maker)?)?;
    }
    Ok(!is_same)
}

/// The bytes of a picture with its stamp, packed as small as possible.
fn stamped(file: &Path, command: &str, maker: &Maker) -> Result<Vec<u8>> {
    let mut reader = decoder(file)?;
    let mut pixels = vec![0; reader.output_buffer_size().context("the picture is too large")?];
    let animation = reader.info().animation_control().copied();
    let (width, height) = reader.info().size();
    let (color, depth) = reader.output_color_type();
    let mut bytes = BufWriter::new(Vec::new());
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(color);
    encoder.set_depth(depth);
    encoder.set_compression(png::Compression::High);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    if let Some(control) = animation {
        encoder.set_animated(control.num_frames, control.num_plays)?;
        encoder.set_blend_op(png::BlendOp::Over)?;
    }
    tell(&mut encoder, command, maker)?;
    let mut writer = encoder.write_header()?;
    for _ in 0..animation.map_or(1, |control| control.num_frames) {
        let size = reader.next_frame(&mut pixels)?.buffer_size();
        if let Some(frame) = reader.info().frame_control().filter(|_| animation.is_some()) {
            writer.reset_frame_position()?;
            writer.set_frame_dimension(frame.width, frame.height)?;
            writer.set_frame_position(frame.x_offset, frame.y_offset)?;
            writer.set_frame_delay(frame.delay_num, frame.delay_den)?;
        }
        writer.write_image_data(&pixels[..size])?;
    }
    writer.finish()?;
    bytes.flush()?;
    Ok(bytes.into_inner()?)
}

/// Writes the stamp into a picture that is being encoded.
///
/// # Errors
/// If a text contains letters beyond Latin-1.
pub fn tell<W: Write>(
    encoder: &mut png::Encoder<'_, W>,
    command: &str,
    maker: &Maker,
) -> Result<()> {
    for (key, text) in [(COMMAND, command), (DEVICE, &maker.device), (DRIVER, &maker.driver)] {
        if !text.is_empty() {
            encoder.add_text_chunk(key.to_owned(), text.to_owned())?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn a_stamp_survives() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a.png");
        let picture = RgbImage::from_fn(5, 4, |x, y| image::Rgb([x as u8, y as u8, 7]));
        picture.save(&file).unwrap();
        assert_eq!(Stored::open(&file).unwrap().command, "");
        let maker = Maker { device: "Ö".to_owned(), driver: "d 1".to_owned() };
        let bytes = stamped(&file, "cargo run", &maker).unwrap();
        fs::write(&file, bytes).unwrap();
        let read = Stored::open(&file).unwrap();
        assert_eq!(
            (&*read.command, read.maker, &read.frames[..]),
            ("cargo run", maker, &[picture][..])
        );
    }
}
