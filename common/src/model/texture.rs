//! A texture: an image in its form for the device, and the PNG files textures are read from.

use std::collections::HashMap;
use std::fmt::Display;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow, ensure};
use image::codecs::png::PngDecoder;
use image::{ColorType, DynamicImage, ImageDecoder, ImageError};

use super::limits::Limits;
use super::text::{Named, note_opened, open};
use super::warnings::{Kind, Warnings};

/// Limit on memory for decoding besides the texels: a few rows, and profiles and texts, which are not used here. A
/// small file may contain a profile that unpacks to gigabytes; one that is larger is skipped.
const BESIDE_BYTES: u64 = 16 << 20;

/// An image of 8 bits per channel.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// The file's path relative to the OBJ file's folder.
    pub name: String,
    /// Texels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Four bytes per texel, rows from top to bottom. Alpha is the file's; without an alpha channel it is the
    /// luminance if a material uses the file for opacity, and 255 otherwise.
    pub rgba: Vec<u8>,
    /// True if RGB is sRGB encoded: for colours, but not for a file that is used only for opacity. Alpha is always
    /// linear.
    pub srgb: bool,
}

impl Texture {
    /// Reads one of the project's own PNG files, which has colours and an alpha channel.
    ///
    /// # Errors
    /// If it is missing or not such a file.
    pub(crate) fn open(path: &Path, name: String) -> Result<Self> {
        let image = image::open(path)?.into_rgba8();
        note_opened([path]);
        let (width, height) = image.dimensions();
        Ok(Self { name, width, height, rgba: image.into_raw(), srgb: true })
    }
}

/// The use of a texture in a material.
pub(crate) enum Role {
    /// RGB.
    Color,
    /// Alpha.
    Opacity,
}

/// The texture files named by materials.
///
/// One file is one texture even if it provides both colour and opacity: shaders read RGB for the former and alpha
/// for the latter, which sRGB encoding does not affect.
#[derive(Default)]
pub(crate) struct TextureFiles {
    files: Vec<TextureFile>,
    indices: HashMap<PathBuf, usize>,
}

struct TextureFile {
    named: Named,
    /// The first statement naming it.
    place: String,
    color: bool,
    opacity: bool,
}

impl TextureFiles {
    /// Records a file and returns the position that its texture will have.
    pub fn add(&mut self, named: Named, role: Role, place: String) -> usize {
        let files = &mut self.files;
        let index = *self.indices.entry(named.path.clone()).or_insert_with(|| {
            files.push(TextureFile { named, place, color: false, opacity: false });
            files.len() - 1
        });
        match role {
            Role::Color => files[index].color = true,
            Role::Opacity => files[index].opacity = true,
        }
        index
    }

    /// Decodes all of them, in order, and returns the texture of each file. One that cannot be decoded, or is too
    /// large in addition to those before it, causes a warning with the line that names it.
    pub fn load(
        self,
        limits: &Limits,
        warnings: &mut Warnings,
    ) -> (Vec<Texture>, Vec<Option<usize>>) {
        let mut left = limits.texture_bytes;
        let mut textures = Vec::new();
        let decode = |file: TextureFile| {
            let place = file.place.clone();
            match file.decode(&mut left, limits) {
                Ok(texture) => {
                    textures.push(texture);
                    Some(textures.len() - 1)
                }
                Err(error) => {
                    let first = || format!("{place}: the texture {error}");
                    warnings.add_many(Kind::Texture, 1, first);
                    None
                }
            }
        };
        let positions = self.files.into_iter().map(decode).collect();
        (textures, positions)
    }
}

impl TextureFile {
    /// Decodes the file, subtracting its size from the remaining bytes.
    fn decode(self, left: &mut u64, limits: &Limits) -> Result<Texture> {
        let shown = &self.named.shown;
        let mut file = BufReader::new(open(&self.named.path, shown, limits.texture_bytes)?);
        let unread = || format!("{shown}: cannot be read");
        let mut head = Vec::new();
        file.by_ref().take(24).read_to_end(&mut head).with_context(unread)?;
        let is_png = head.starts_with(b"\x89PNG\r\n\x1a\n");
        ensure!(is_png, "{shown}: is not a PNG file; convert it to one");
        let damaged = |what: &dyn Display| {
            anyhow!("{shown}: cannot be decoded, it is damaged or cut off: {what}")
        };
        check_palette(&mut file).map_err(|error| damaged(&error))?;
        // The decoder's error for a row that is too long does not name the limit.
        if let [.., a, b, c, d, e, f, g, h] = head[8..]
            && head.len() == 24
        {
            let [width, height] = [[a, b, c, d], [e, f, g, h]].map(u32::from_be_bytes);
            let side = limits.texture_side;
            ensure!(
                width.max(height) <= side,
                "{shown}: is {width} x {height} texels, at most {side} x {side} are read"
            );
        }

        let broken = |error| match error {
            ImageError::Limits(_) => anyhow!(
                "{shown}: has texts of more than {BESIDE_BYTES} bytes beside its texels; save it without"
            ),
            error => damaged(&error),
        };
        let mut beside = image::Limits::default();
        beside.max_alloc = Some(BESIDE_BYTES);
        let decoder = PngDecoder::with_limits(file, beside).map_err(broken)?;
        let (width, height) = decoder.dimensions();
        let texels = u64::from(width) * u64::from(height);
        let (color, decoded) = (decoder.color_type(), decoder.total_bytes());
        let wants_luminance = self.opacity && !color.has_alpha();
        // The file's own data, perhaps 16 bits per channel, coexists with the 8 bits made from it.
        let converted = if color == ColorType::Rgba8 { 0 } else { 4 * texels };
        let need = decoded + converted + if wants_luminance { texels } else { 0 };
        ensure!(
            need <= *left,
            "{shown}: is {width} x {height} texels, which take {need} bytes to decode; all textures \
             together may take {}, of which {left} are left",
            limits.texture_bytes
        );
        *left -= 4 * texels;
        let image = DynamicImage::from_decoder(decoder).map_err(broken)?;

        let luminance = wants_luminance.then(|| image.to_luma8());
        let mut rgba = image.into_rgba8().into_raw();
        for (texel, luminance) in
            rgba.chunks_exact_mut(4).zip(luminance.iter().flat_map(|luma| luma.as_raw()))
        {
            texel[3] = *luminance;
        }
        Ok(Texture { name: self.named.name, width, height, rgba, srgb: self.color })
    }
}

/// Checks that a PNG file begins as one and that its palette has whole colours, which the decoder assumes. Leaves
/// the file at its start.
fn check_palette(file: &mut BufReader<impl Read + Seek>) -> Result<()> {
    file.seek(SeekFrom::Start(8))?;
    let mut is_first = true;
    loop {
        let mut head = [0; 8];
        // The decoder reports truncated files.
        if file.read_exact(&mut head).is_err() {
            break;
        }
        let [a, b, c, d, kind @ ..] = head;
        let length = u32::from_be_bytes([a, b, c, d]);
        ensure!(!is_first || &kind == b"IHDR", "its first chunk is not IHDR");
        is_first = false;
        match &kind {
            b"PLTE" => ensure!(length % 3 == 0, "its palette has {length} bytes, no multiple of 3"),
            b"IDAT" | b"IEND" => break,
            _ => {}
        }
        file.seek_relative(i64::from(length) + 4)?;
    }
    file.rewind()?;
    Ok(())
}

#[cfg(test)]
pub(crate) mod tests;
