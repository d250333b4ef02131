//! A texture: an image in its form for the device, and the files textures are read from.

mod heights;
mod jpeg;
mod kind;
mod png;

use std::collections::HashMap;
use std::io::{BufReader, Cursor, Read, Seek};
use std::path::{Path, PathBuf};

use anyhow::{Result, anyhow, ensure};
use image::ColorType;

use super::limits::Limits;
use super::text::{Named, note_opened, open};
use super::warnings::{self, Warnings};
use crate::gpu::Sampling;
pub(crate) use heights::{SLOPES_PER_UNIT, is_grey};
use kind::Kind;

/// An image of four bytes per texel.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// The file's path relative to the OBJ file's folder.
    pub name: String,
    /// Texels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Rows from top to bottom: four channels of 8 bits, or two half floats if these are `slopes`. Alpha is the
    /// file's; without an alpha channel it is the luminance if a material uses the file for opacity, and 255
    /// otherwise.
    pub rgba: Vec<u8>,
    /// True if RGB is sRGB encoded: for colours, but not for a file that is used only for opacity. Alpha is always
    /// linear.
    pub srgb: bool,
    /// True for x and y of normals whose z is 1, made from heights; a material's scale makes them as steep as the
    /// heights are.
    pub slopes: bool,
    /// Filter, and continuation beyond the edges.
    pub sampling: Sampling,
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
        let rgba = image.into_raw();
        let (srgb, sampling) = (true, Sampling::default());
        Ok(Self { name, width, height, rgba, srgb, slopes: false, sampling })
    }

    /// Reads a normal map of the project's own, a PNG file.
    ///
    /// # Errors
    /// If it is missing or not such a file.
    pub fn of_normals(path: &Path, name: String) -> Result<Self> {
        Ok(Self { srgb: false, ..Self::open(path, name)? })
    }
}

/// The remark about a normal map in grey.
pub(crate) const GREY_NORMALS: &str =
    "is grey, and a normal map has colours; perhaps these are heights, for map_Bump in an MTL file";

/// A remark about a texture that is shown, and its kind.
pub(crate) type Remark = (warnings::Kind, &'static str);

/// The use of a texture in a material.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Role {
    /// RGB.
    Color,
    /// Alpha.
    Opacity,
    /// Numbers in RGB, which are linear.
    Numbers,
    /// Normals in RGB, likewise.
    Normals,
    /// Heights in grey, of which normals are made.
    Heights,
}

/// The texture files named by materials.
///
/// One file is one texture even if it provides both colour and opacity: shaders read RGB for the former and alpha
/// for the latter, which sRGB encoding does not affect. Numbers are another texture, because colours are decoded.
#[derive(Default)]
pub(crate) struct TextureFiles {
    files: Vec<TextureFile>,
    /// By file and use; colour and opacity are one.
    indices: HashMap<(PathBuf, Role), usize>,
}

struct TextureFile {
    named: Named,
    /// The first statement naming it.
    place: String,
    color: bool,
    opacity: bool,
    /// The use, which is [`Role::Color`] for opacity also.
    role: Role,
}

impl Role {
    /// The kind of warning if there is no such texture.
    pub fn missing(self) -> warnings::Kind {
        match self {
            Self::Color | Self::Opacity => warnings::Kind::Texture,
            Self::Numbers => warnings::Kind::Numbers,
            Self::Normals | Self::Heights => warnings::Kind::NormalMap,
        }
    }
}

impl TextureFiles {
    /// Records a file and returns the position that its texture will have.
    pub fn add(&mut self, named: Named, role: Role, place: String) -> usize {
        let files = &mut self.files;
        let kept = if role == Role::Opacity { Role::Color } else { role };
        let index = *self.indices.entry((named.path.clone(), kept)).or_insert_with(|| {
            files.push(TextureFile { named, place, color: false, opacity: false, role: kept });
            files.len() - 1
        });
        files[index].color |= role == Role::Color;
        files[index].opacity |= role == Role::Opacity;
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
            let (place, shown) = (file.place.clone(), file.named.shown.clone());
            let role = file.role;
            match file.decode(&mut left, limits) {
                Ok((texture, remarks)) => {
                    for (kind, what) in remarks {
                        let first = || format!("{place}: the texture {shown}: {what}");
                        warnings.add_many(kind, 1, first);
                    }
                    textures.push(texture);
                    Some(textures.len() - 1)
                }
                Err(error) => {
                    let first = || format!("{place}: the texture {error}");
                    warnings.add_many(role.missing(), 1, first);
                    None
                }
            }
        };
        let positions = self.files.into_iter().map(decode).collect();
        (textures, positions)
    }
}

impl TextureFile {
    /// Decodes the file, subtracting its size from the remaining bytes; returns also what a user should know of it.
    fn decode(self, left: &mut u64, limits: &Limits) -> Result<(Texture, Vec<Remark>)> {
        let file = open(&self.named.path, &self.named.shown, limits.texture_bytes)?;
        let shown = self.named.shown.clone();
        let wrong = |what: anyhow::Error| anyhow!("{shown}: {what}");
        self.decode_from(file, left, limits).map_err(wrong)
    }

    /// Decodes bytes, as [`TextureFile::decode`] does those of the file.
    fn decode_from(
        self,
        file: impl Read + Seek,
        left: &mut u64,
        limits: &Limits,
    ) -> Result<(Texture, Vec<Remark>)> {
        let mut file = BufReader::new(file);
        let unread = |error: std::io::Error| anyhow!("cannot be read: {error}");
        let mut head = Vec::new();
        file.by_ref().take(kind::HEAD).read_to_end(&mut head).map_err(unread)?;
        file.rewind().map_err(unread)?;
        let (image, mut remarks) = match Kind::of(&head)? {
            Kind::Png => (png::decode(file, &self, left, limits)?, Vec::new()),
            Kind::Jpeg => jpeg::decode(file, &self, left, limits)?,
        };
        let (width, height) = (image.width(), image.height());
        let luminance = self.wants_luminance(image.color()).then(|| image.to_luma8());
        let mut rgba = image.into_rgba8().into_raw();
        for (texel, luminance) in
            rgba.chunks_exact_mut(4).zip(luminance.iter().flat_map(|luma| luma.as_raw()))
        {
            texel[3] = *luminance;
        }
        let is_grey = heights::is_grey(&rgba);
        let slopes = self.role == Role::Heights && is_grey;
        match self.role {
            Role::Heights if is_grey => heights::to_slopes(&mut rgba, width as usize),
            Role::Heights => {
                remarks.push((warnings::Kind::Colored, "has colours, and heights are grey"));
            }
            Role::Normals if is_grey => remarks.push((warnings::Kind::Grey, GREY_NORMALS)),
            _ => {}
        }
        let (name, srgb, sampling) = (self.named.name, self.color, Sampling::default());
        Ok((Texture { name, width, height, rgba, srgb, slopes, sampling }, remarks))
    }

    fn wants_luminance(&self, color: ColorType) -> bool {
        self.opacity && !color.has_alpha()
    }

    /// Takes the bytes of the texels, if they and `decoder` more, which decoding takes, are left.
    fn take(
        &self,
        (width, height): (u32, u32),
        color: ColorType,
        decoder: u64,
        left: &mut u64,
        limits: &Limits,
    ) -> Result<()> {
        let texels = u64::from(width) * u64::from(height);
        // The file's own data, perhaps 16 bits per channel, coexists with the 8 bits made from it.
        let decoded = u64::from(color.bytes_per_pixel()) * texels;
        let converted = if color == ColorType::Rgba8 { 0 } else { 4 * texels };
        // One byte of each texel: its luminance, or its height.
        let is_copied = self.wants_luminance(color) || self.role == Role::Heights;
        let luminance = if is_copied { texels } else { 0 };
        let need = decoder + decoded + converted + luminance;
        ensure!(
            need <= *left,
            "is {width} x {height} texels, which take {} to decode; all textures together may take {}, of \
             which {} are left",
            size(need),
            size(limits.texture_bytes),
            size(*left)
        );
        *left -= 4 * texels;
        Ok(())
    }
}

/// Decodes an image file for its colours, subtracting its size from the remaining bytes; returns also what a user should
/// know of it.
///
/// # Errors
/// If it is too large or cannot be decoded.
pub(crate) fn decode_file(
    named: Named,
    left: &mut u64,
    limits: &Limits,
) -> Result<(Texture, Vec<Remark>)> {
    of_color(named).decode(left, limits)
}

fn of_color(named: Named) -> TextureFile {
    TextureFile { named, place: String::new(), color: true, opacity: false, role: Role::Color }
}

/// Decodes an image within another file, as [`decode_file`] does.
///
/// # Errors
/// As [`decode_file`].
pub(crate) fn decode_bytes(
    bytes: &[u8],
    name: String,
    left: &mut u64,
    limits: &Limits,
) -> Result<(Texture, Vec<Remark>)> {
    let named = Named { name, ..Named::default() };
    of_color(named).decode_from(Cursor::new(bytes), left, limits)
}

/// A number of bytes, in a unit that is easy to read.
fn size(bytes: u64) -> String {
    match bytes {
        0..10_000_000 => format!("{bytes} bytes"),
        _ => format!("{} MB", bytes.div_ceil(1_000_000)),
    }
}

/// Checks the sides of an image.
fn check_sides((width, height): (u32, u32), limits: &Limits) -> Result<()> {
    let side = limits.texture_side;
    ensure!(
        width.max(height) <= side,
        "is {width} x {height} texels, at most {side} x {side} are read"
    );
    Ok(())
}

#[cfg(test)]
pub(crate) mod tests;
