//! What a picture says of itself: a PNG carries its command, a hash of its sources and the device in tEXt chunks,
//! so that a picture that the code would no longer make is known without rendering it.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufReader, BufWriter, Write};
use std::path::Path;

use anyhow::{Context, Result};
use manuscript::project::Project;

const COMMAND: &str = "Command";
const SOURCES: &str = "Sources";
const DEVICE: &str = "Device";

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

/// What a PNG says about itself.
fn stamp(file: &Path) -> Result<BTreeMap<String, String>> {
    let reader = png::Decoder::new(BufReader::new(File::open(file)?)).read_info()?;
    let texts = &reader.info().uncompressed_latin1_text;
    Ok(texts.iter().map(|text| (text.keyword.clone(), text.text.clone())).collect())
}

/// The bytes of a picture that says which command, sources and device made it, packed as small as they go.
///
/// # Errors
/// If the file is no PNG.
pub fn stamped(file: &Path, command: &str, hash: &str, device: &str) -> Result<Vec<u8>> {
    let mut reader = png::Decoder::new(BufReader::new(File::open(file)?)).read_info()?;
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
    tell(&mut encoder, command, hash, device)?;
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

/// Lets a picture that is being written say which command, sources and device made it.
///
/// # Errors
/// If one of them has letters beyond Latin-1.
pub fn tell<W: Write>(
    encoder: &mut png::Encoder<'_, W>,
    command: &str,
    hash: &str,
    device: &str,
) -> Result<()> {
    for (key, text) in [(COMMAND, command), (SOURCES, hash), (DEVICE, device)] {
        encoder.add_text_chunk(key.to_owned(), text.to_owned())?;
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
        image::RgbImage::from_fn(5, 4, |x, y| image::Rgb([x as u8, y as u8, 7]))
            .save(&file)
            .unwrap();
        assert!(stamp(&file).unwrap().is_empty());
        let bytes = stamped(&file, "cargo run", "", "Ö").unwrap();
        fs::write(&file, bytes).unwrap();
        let read = stamp(&file).unwrap();
        assert_eq!((&*read[COMMAND], &*read[DEVICE]), ("cargo run", "Ö"));
        assert_eq!(image::open(&file).unwrap().to_rgb8().get_pixel(4, 3).0, [4, 3, 7]);
    }
}
