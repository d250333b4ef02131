//! The kind of an image file, from its first bytes: its name may say another one.

use anyhow::{Result, bail, ensure};

/// The bytes at the beginning that identify the kind.
pub(super) const HEAD: u64 = 24;

/// A kind that is read.
pub(super) enum Kind {
    Png,
    Jpeg,
}

impl Kind {
    /// The kind of a file that begins so.
    ///
    /// # Errors
    /// If it is another one; names it if that is known.
    pub fn of(head: &[u8]) -> Result<Self> {
        ensure!(!head.is_empty(), "is empty");
        let starts = |magic: &[u8]| head.starts_with(magic);
        let at =
            |start: usize, magic: &[u8]| head.get(start..).is_some_and(|b| b.starts_with(magic));
        let other = match () {
            () if starts(b"\x89PNG\r\n\x1a\n") => return Ok(Self::Png),
            () if starts(b"\xff\xd8") => return Ok(Self::Jpeg),
            // As a transfer in text mode, or a conversion of line ends, leaves it.
            () if at(1, b"PNG") => {
                bail!("is a PNG file whose first bytes are damaged; copy it again")
            }
            () if starts(b"BM") => "a BMP",
            () if starts(b"GIF8") => "a GIF",
            () if starts(b"RIFF") && at(8, b"WEBP") => "a WebP",
            () if starts(b"II*\0") || starts(b"MM\0*") => "a TIFF",
            () if starts(b"DDS ") => "a DDS",
            () if starts(b"\xabKTX") => "a KTX",
            () if starts(b"8BPS") => "a Photoshop",
            () if starts(b"\x76\x2f\x31\x01") => "an OpenEXR",
            () if starts(b"#?RADIANCE") || starts(b"#?RGBE") => "a Radiance",
            () if at(4, b"ftypavif") => "an AVIF",
            () if at(4, b"ftyphei") || at(4, b"ftypmif1") => "a HEIF",
            () if at(4, b"jP  ") => "a JPEG 2000",
            () if starts(b"qoif") => "a QOI",
            () if is_tga(head) => "a TGA",
            () if starts(b"<svg") || starts(b"<?xml") => "an SVG or XML",
            () if starts(b"<!DOCTYPE") || starts(b"<html") || starts(b"<!doctype") => {
                bail!("is a web page, not an image; download the image itself")
            }
            () if starts(b"version https://git-lfs") => {
                bail!("is a pointer of Git LFS, not an image; fetch the image by `git lfs pull`")
            }
            () => bail!("is neither a PNG nor a JPEG file; convert it to one of them"),
        };
        bail!("is {other} file, which is not read; convert it to PNG or JPEG")
    }
}

/// True for the header of a TGA file, which has no mark of its own: no or one colour map, a known kind of pixels
/// and of bits.
fn is_tga(head: &[u8]) -> bool {
    let &[_, map, kind, .., bits, _] = head.get(..18).unwrap_or_default() else { return false };
    map <= 1 && matches!(kind, 1..=3 | 9..=11) && matches!(bits, 8 | 15 | 16 | 24 | 32)
}
