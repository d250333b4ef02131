//! JPEG files (ITU-T T.81).

use std::io::{BufReader, Cursor, Read};

use anyhow::{Context, Result, anyhow, bail, ensure};
use image::codecs::jpeg::JpegDecoder;
use image::metadata::Orientation;
use image::{DynamicImage, ImageDecoder};

use super::{Remark, TextureFile, check_sides};
use crate::model::limits::Limits;
use crate::model::warnings::Kind;

/// The longest side of the blocks that are decoded together, in texels: 4 times a transform of 8.
const BLOCK: u64 = 32;

/// Bytes of the coefficients of a texel in a progressive file, which are all kept: two for each of four channels.
const COEFFICIENTS: u64 = 2 * 4;

/// Decodes a JPEG file, and turns it as it says; returns also what a user should know of it.
pub(super) fn decode(
    mut file: BufReader<impl Read>,
    texture: &TextureFile,
    left: &mut u64,
    limits: &Limits,
) -> Result<(DynamicImage, Vec<Remark>)> {
    let mut bytes = Vec::new();
    file.read_to_end(&mut bytes).map_err(|error| anyhow!("cannot be read: {}", error.kind()))?;
    let frame = Frame::of(&bytes)?;
    let Frame { width, height, .. } = frame;
    check_sides((width, height), limits)?;
    // The decoder's own words speak of its insides.
    let broken = |_| {
        anyhow!("cannot be decoded, it is damaged or of a rare kind; save it again as JPEG or PNG")
    };
    // The file, and the decoder's copies of its profiles.
    let copies = 3 * bytes.len() as u64;
    let is_whole = bytes[frame.scan..].windows(2).any(|pair| pair == END);
    let blocks = (u64::from(width) + BLOCK) * (u64::from(height) + BLOCK);
    let coefficients = if frame.is_progressive { COEFFICIENTS * blocks } else { 0 };
    let mut decoder = JpegDecoder::new(Cursor::new(bytes)).map_err(broken)?;
    ensure!(
        decoder.dimensions() == (width, height),
        "cannot be decoded, it has two sizes; save it again as JPEG or PNG"
    );
    let orientation = decoder.orientation().map_err(broken)?;
    let is_turned = orientation != Orientation::NoTransforms;
    // A turn by a quarter needs room for both.
    let turned =
        u64::from(decoder.color_type().bytes_per_pixel()) * u64::from(width) * u64::from(height);
    let decoding = copies + coefficients + if is_turned { turned } else { 0 };
    texture.take((width, height), decoder.color_type(), decoding, left, limits)?;
    let mut image = DynamicImage::from_decoder(decoder).map_err(broken)?;
    image.apply_orientation(orientation);
    let cut = (Kind::Cut, "has no end mark, and so is cut off; copy it again");
    let turn =
        (Kind::Turned, "says in its EXIF data that it does not stand upright; save it upright");
    let remarks = [(!is_whole).then_some(cut), is_turned.then_some(turn)];
    Ok((image, remarks.into_iter().flatten().collect()))
}

/// The mark at the end of an image.
const END: [u8; 2] = [0xff, 0xd9];

/// The header of a JPEG image.
struct Frame {
    width: u32,
    height: u32,
    is_progressive: bool,
    /// The byte at which its data begin.
    scan: usize,
}

impl Frame {
    /// Reads the segments before the data.
    fn of(bytes: &[u8]) -> Result<Self> {
        let mut frame = None;
        let mut at = 2;
        loop {
            let cut = || "cannot be decoded, it is damaged or cut off: it ends in its header";
            let &[mark, kind, a, b] = bytes.get(at..at + 4).with_context(cut)? else {
                bail!(cut());
            };
            if mark != 0xff || matches!(kind, 0 | 0xff) {
                // Filling between segments.
                at += 1;
                continue;
            }
            let length = usize::from(u16::from_be_bytes([a, b]));
            match kind {
                // Marks without a length.
                0x01 | 0xd0..=0xd8 => at += 2,
                0xd9 => bail!("cannot be decoded, it is damaged: it has no image"),
                0xda => {
                    let (width, height, is_progressive) =
                        frame.context("cannot be decoded, it is damaged: its size is missing")?;
                    ensure!(
                        width > 0 && height > 0,
                        "is {width} x {height} texels, and so has none"
                    );
                    return Ok(Self { width, height, is_progressive, scan: at });
                }
                0xc0..=0xc2 => {
                    let &[bits, a, b, c, d] = bytes.get(at + 4..at + 9).with_context(cut)? else {
                        bail!(cut());
                    };
                    ensure!(
                        bits == 8,
                        "is a JPEG file of {bits} bits per channel, which is not read; save it with 8"
                    );
                    let [height, width] =
                        [[a, b], [c, d]].map(|side| u16::from_be_bytes(side).into());
                    frame = Some((width, height, kind == 0xc2));
                    at += 2 + length;
                }
                0xc3 | 0xc5..=0xc7 | 0xc9..=0xcb | 0xcd..=0xcf => bail!(
                    "is a lossless, hierarchical or arithmetic-coded JPEG file, which is not read; save it as \
                     a usual JPEG or as PNG"
                ),
                _ => at += 2 + length,
            }
        }
    }
}

#[cfg(test)]
mod tests;
