//! A picture of all directions: an EXR file, which is untrusted.

use std::path::Path;

use anyhow::Result;

use super::exr_file::{self, ExrFile};

/// Light from all directions: row 0 is up, and the middle column looks along -z, with x at its right.
#[derive(Clone, Debug, PartialEq)]
pub struct Panorama {
    /// Texels per row, all around.
    pub width: u32,
    /// Rows, from above to below.
    pub height: u32,
    /// Linear radiance, `width × height` times: finite, and not negative.
    pub texels: Vec<[f32; 3]>,
}

/// The brightest light that is kept, so that no sum over a picture is infinite.
const BRIGHTEST: f32 = 1e18;

impl Panorama {
    /// Reads a file, and returns also what a user should know of it.
    ///
    /// # Errors
    /// One line, if it is missing, too large, or not such a file.
    pub fn open(path: &Path) -> Result<(Self, Vec<String>)> {
        let (bytes, name) = exr_file::bytes(path)?;
        Self::decode(&bytes, &name)
    }

    fn decode(bytes: &[u8], name: &str) -> Result<(Self, Vec<String>)> {
        let ExrFile { width, height, texels } = ExrFile::decode(bytes, name)?;
        Ok(Self { width, height, texels }.cleaned(name))
    }

    /// The picture without what is no light, and a line about it.
    fn cleaned(mut self, name: &str) -> (Self, Vec<String>) {
        let mut warnings = Vec::new();
        let (width, height) = (self.width, self.height);
        if width != 2 * height {
            warnings.push(format!(
                "{name}: is {width} x {height} texels, stretched over all directions; a sky is twice as wide as high"
            ));
        }
        let is_light = |value: &f32| (0.0..=BRIGHTEST).contains(value);
        let is_bright = |value: &f32| value.is_finite() && *value > BRIGHTEST;
        let (mut black, mut dimmed) = (Vec::new(), Vec::new());
        for (index, texel) in self.texels.iter_mut().enumerate() {
            if texel.iter().all(is_light) {
                continue;
            }
            let is_dimmed = texel.iter().all(|value| is_light(value) || is_bright(value));
            let list = if is_dimmed { &mut dimmed } else { &mut black };
            list.push((index, *texel));
            *texel = if is_dimmed { texel.map(|value| value.min(BRIGHTEST)) } else { [0.0; 3] };
        }
        for (list, what) in [
            (black, "negative, infinite or no number, so it is black".to_owned()),
            (dimmed, format!("above {BRIGHTEST:e}, so it is dimmed to that")),
        ] {
            if let Some((index, texel)) = list.first() {
                let (x, y) = (index % width as usize, index / width as usize);
                let count = list.len();
                warnings
                    .push(format!("{name}: texel {x}, {y} is {texel:?}: {what} ({count} in all)"));
            }
        }
        (self, warnings)
    }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;
    use crate::app::Picture;

    /// The bytes of an EXR file.
    fn file(width: u32, height: u32, texel: impl Fn(u32) -> [f32; 3]) -> Vec<u8> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        let pixel = |i| {
            let [r, g, b] = texel(i);
            [r, g, b, 1.0]
        };
        let pixels = (0..width * height).map(pixel).collect();
        Picture { width, height, pixels }.save(&path).unwrap();
        std::fs::read(path).unwrap()
    }

    fn error(bytes: &[u8]) -> String {
        let error = format!("{:#}", Panorama::decode(bytes, "a.exr").unwrap_err());
        assert!(!error.contains('\n') && error.starts_with("a.exr: "), "{error}");
        error
    }

    #[test]
    fn texels_are_read_to_the_bit() {
        let texel = |i: u32| [i as f32 * 0.1, 1e5, 1e-30];
        let (read, warnings) = Panorama::decode(&file(64, 32, texel), "a.exr").unwrap();
        assert_eq!((read.width, read.height, warnings.len()), (64, 32, 0));
        assert_eq!(read.texels, (0..64 * 32).map(texel).collect::<Vec<_>>());
    }

    #[test]
    fn what_is_no_light_is_black_and_counted() {
        let wrong = [f32::NAN, f32::INFINITY, -1.0, -0.0];
        let bytes = file(8, 4, |i| [1.0, wrong.get(i as usize).copied().unwrap_or(2.0), 3.0]);
        let (read, warnings) = Panorama::decode(&bytes, "a.exr").unwrap();
        assert_eq!(read.texels[0], [0.0; 3]);
        assert_eq!(read.texels[2], [0.0; 3]);
        assert_eq!(read.texels[4], [1.0, 2.0, 3.0]);
        assert_eq!(
            warnings,
            [
                "a.exr: texel 0, 0 is [1.0, NaN, 3.0]: negative, infinite or no number, so it is black (3 in all)"
            ]
        );
    }

    #[test]
    fn too_bright_a_texel_keeps_some_light() {
        let bytes = file(8, 4, |i| if i == 9 { [2e18, 0.0, 1.0] } else { [1.0; 3] });
        let (read, warnings) = Panorama::decode(&bytes, "a.exr").unwrap();
        assert_eq!(read.texels[9], [1e18, 0.0, 1.0]);
        let line =
            "a.exr: texel 1, 1 is [2e18, 0.0, 1.0]: above 1e18, so it is dimmed to that (1 in all)";
        assert_eq!(warnings, [line]);
    }

    /// A file whose table of rows names the first row again and again, and no other.
    #[test]
    fn a_file_that_leaves_out_rows_is_refused() {
        use exr::prelude::{Encoding, Image, SpecificChannels, WritableImage};
        let channels = SpecificChannels::rgb(|_| (1.0f32, 2.0f32, 3.0f32));
        let image = Image::from_encoded_channels((8, 4), Encoding::UNCOMPRESSED, channels);
        let mut bytes = Cursor::new(Vec::new());
        image.write().to_buffered(&mut bytes).unwrap();
        let mut bytes = bytes.into_inner();
        // Rows are the last part of the file, each with its number, its size, and 8 texels of 12 bytes; before them
        // there is the table.
        let table = bytes.len() - 4 * (8 + 8 * 12) - 4 * 8;
        let first: [u8; 8] = bytes[table..table + 8].try_into().unwrap();
        assert_eq!(u64::from_le_bytes(first), table as u64 + 32);
        (1..4).for_each(|row| bytes[table + 8 * row..][..8].copy_from_slice(&first));
        assert!(error(&bytes).contains("leaves out some of its 8 x 4 texels"), "{}", error(&bytes));
    }

    #[test]
    fn another_shape_has_a_warning() {
        for (width, height) in [(1, 1), (3, 3)] {
            let (_, warnings) = Panorama::decode(&file(width, height, |_| [1.0; 3]), "a").unwrap();
            assert!(warnings[0].contains("twice as wide as high"), "{warnings:?}");
        }
    }

    #[test]
    fn a_file_of_another_kind_is_refused() {
        for bytes in [&b""[..], b"\x89PNG\r\n", b"P3 1 1", b"\xff\xd8\xff"] {
            assert!(error(bytes).contains("is not an EXR file"));
        }
    }

    #[test]
    fn a_file_cut_off_anywhere_is_refused() {
        let bytes = file(32, 16, |i| [i as f32; 3]);
        for end in (4..bytes.len()).step_by(7) {
            error(&bytes[..end]);
        }
    }

    #[test]
    fn no_changed_byte_is_a_panic() {
        let bytes = file(16, 8, |i| [i as f32; 3]);
        for at in 4..bytes.len() {
            for change in [0xff, 0x80, 0x01] {
                let mut bytes = bytes.clone();
                bytes[at] ^= change;
                let _ = Panorama::decode(&bytes, "a.exr");
            }
        }
    }

    #[test]
    fn a_size_is_checked_before_it_is_believed() {
        let mut bytes = file(16, 8, |_| [1.0; 3]);
        let name = b"dataWindow\0box2i\0";
        let at = bytes.windows(name.len()).position(|it| it == name).unwrap() + name.len() + 4;
        for (last, right) in [(1u32 << 20, 16), (16000, 16000), (i32::MAX as u32, i32::MAX as u32)]
        {
            bytes[at + 8..at + 12].copy_from_slice(&last.to_le_bytes());
            bytes[at + 12..at + 16].copy_from_slice(&right.to_le_bytes());
            error(&bytes);
        }
    }
}
