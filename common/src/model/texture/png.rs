//! PNG files.

use std::io::{BufReader, ErrorKind, Read, Seek, SeekFrom};

use anyhow::{Result, anyhow, bail, ensure};
use image::codecs::png::PngDecoder;
use image::{DynamicImage, ImageDecoder, ImageError};

use super::{TextureFile, check_sides};
use crate::model::limits::Limits;

/// Limit on memory for decoding besides the texels: a few rows, and profiles and texts, which are not used here. A
/// small file may contain a profile that unpacks to gigabytes; one that is larger is skipped.
pub(super) const BESIDE_BYTES: u64 = 16 << 20;

/// Decodes a PNG file.
pub(super) fn decode(
    mut file: BufReader<impl Read + Seek>,
    texture: &TextureFile,
    left: &mut u64,
    limits: &Limits,
) -> Result<DynamicImage> {
    let damaged = |what: &str| anyhow!("cannot be decoded, it is damaged or cut off: {what}");
    let size = check_chunks(&mut file).map_err(|what| damaged(&what.to_string()))?;
    // The decoder's error for a row that is too long does not name the limit.
    size.map_or(Ok(()), |size| check_sides(size, limits))?;

    // The decoder's own words speak of its insides.
    let broken = |error| match error {
        ImageError::Limits(_) => anyhow!(
            "has texts of more than {BESIDE_BYTES} bytes beside its texels; save it without"
        ),
        ImageError::IoError(error) if error.kind() == ErrorKind::UnexpectedEof => {
            damaged("it ends too soon")
        }
        ImageError::IoError(error) => anyhow!("cannot be read: {}", error.kind()),
        _ => damaged("its data contradict each other; save it again"),
    };
    let mut beside = image::Limits::default();
    beside.max_alloc = Some(BESIDE_BYTES);
    let decoder = PngDecoder::with_limits(file, beside).map_err(broken)?;
    texture.take(decoder.dimensions(), decoder.color_type(), 0, left, limits)?;
    DynamicImage::from_decoder(decoder).map_err(broken)
}

/// Checks that a PNG file begins as one and that its palette has whole colours, which the decoder assumes; returns
/// its width and height. Leaves the file at its start.
fn check_chunks(file: &mut BufReader<impl Read + Seek>) -> Result<Option<(u32, u32)>> {
    file.seek(SeekFrom::Start(8))?;
    let mut size = None;
    loop {
        let mut head = [0; 8];
        // The decoder reports truncated files.
        if file.read_exact(&mut head).is_err() {
            break;
        }
        let [a, b, c, d, kind @ ..] = head;
        let mut length = i64::from(u32::from_be_bytes([a, b, c, d]));
        ensure!(size.is_some() || &kind == b"IHDR", "its first chunk is not IHDR");
        match &kind {
            b"IHDR" if size.is_none() => {
                let mut sides = [0; 8];
                if file.read_exact(&mut sides).is_err() {
                    break;
                }
                let [a, b, c, d, e, f, g, h] = sides;
                size = Some((u32::from_be_bytes([a, b, c, d]), u32::from_be_bytes([e, f, g, h])));
                length -= 8;
            }
            b"PLTE" if length % 3 != 0 => {
                bail!("its palette has {length} bytes, no multiple of 3")
            }
            b"IDAT" | b"IEND" => break,
            _ => {}
        }
        file.seek_relative(length + 4)?;
    }
    file.rewind()?;
    Ok(size)
}
