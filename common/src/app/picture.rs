//! A rendered picture and its files: PNG for eyes, EXR for numbers.

use std::io::Cursor;
use std::path::Path;

use anyhow::{Context, Result};
use exr::prelude::{
    Blocks, Compression, Encoding, Image, Layer, LayerAttributes, LineOrder, SpecificChannels,
    Vec2, WritableImage,
};

use crate::UsageError;
use crate::files::write_whole;

/// Linear RGBA pixels, rows from top to bottom.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// `width × height` pixels.
    pub pixels: Vec<[f32; 4]>,
}

/// The formats that a picture can be written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// 8 bits per channel, sRGB, opaque.
    Png,
    /// 32-bit floats, linear and unclamped: exactly the bits that the shader wrote.
    Exr,
}

impl Format {
    /// The format that a file's extension names.
    ///
    /// # Errors
    /// If it names none.
    pub fn of(path: &Path) -> Result<Self, UsageError> {
        let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        match extension.as_str() {
            "png" => Ok(Self::Png),
            "exr" => Ok(Self::Exr),
            _ => Err(UsageError(format!(
                "cannot write '{}': a picture is .png or .exr",
                path.display()
            ))),
        }
    }
}

impl Picture {
    /// Writes the picture, whole or not at all; the same pixels give the same bytes.
    ///
    /// # Errors
    /// If the extension is unknown or the file cannot be written.
    pub fn save(&self, path: &Path) -> Result<()> {
        let bytes = match Format::of(path)? {
            Format::Png => self.png(),
            Format::Exr => self.exr(),
        };
        write_whole(path, &bytes.with_context(|| format!("cannot encode '{}'", path.display()))?)
    }

    /// A warning if pixels are not finite: a PNG shows them black or white.
    pub fn not_finite(&self) -> Option<String> {
        let is_wild = |pixel: &[f32; 4]| !pixel.iter().all(|part| part.is_finite());
        let first = self.pixels.iter().position(is_wild)?;
        let count = self.pixels.iter().filter(|pixel| is_wild(pixel)).count();
        let (x, y) = (first % self.width as usize, first / self.width as usize);
        let are = if count == 1 { "1 pixel is".to_owned() } else { format!("{count} pixels are") };
        Some(format!(
            "{are} not finite, the first at {x}, {y}: {:?}; a root of a negative number, a division by 0?",
            self.pixels[first]
        ))
    }

    /// The pixels as 8-bit sRGB.
    pub fn srgb(&self) -> Vec<u8> {
        self.pixels.iter().flat_map(|pixel| [0, 1, 2].map(|i| to_srgb(pixel[i]))).collect()
    }

    fn png(&self) -> Result<Vec<u8>> {
        let mut bytes = Cursor::new(Vec::new());
        let picture = image::RgbImage::from_raw(self.width, self.height, self.srgb());
        picture.context("it has too few pixels")?.write_to(&mut bytes, image::ImageFormat::Png)?;
        Ok(bytes.into_inner())
    }

    fn exr(&self) -> Result<Vec<u8>> {
        let width = self.width as usize;
        let pixel = |position: Vec2<usize>| {
            let [r, g, b, a] = self.pixels[position.y() * width + position.x()];
            (r, g, b, a)
        };
        // Fixed line order and a single thread, so that equal pictures give equal files.
        let encoding = Encoding {
            compression: Compression::ZIP16,
            blocks: Blocks::ScanLines,
            line_order: LineOrder::Increasing,
        };
        let layer = Layer::new(
            (width, self.height as usize),
            LayerAttributes::default(),
            encoding,
            SpecificChannels::rgba(pixel),
        );
        let mut bytes = Cursor::new(Vec::new());
        Image::from_layer(layer).write().non_parallel().to_buffered(&mut bytes)?;
        Ok(bytes.into_inner())
    }

    /// Reads an EXR that [`Picture::save`] wrote.
    ///
    /// # Errors
    /// If the file is missing or is not an RGBA picture.
    pub fn open_exr(path: &Path) -> Result<Self> {
        let image = exr::prelude::read_first_rgba_layer_from_file(
            path,
            |size, _| vec![vec![[0f32; 4]; size.width()]; size.height()],
            |rows: &mut Vec<Vec<[f32; 4]>>, at, (r, g, b, a): (f32, f32, f32, f32)| {
                rows[at.y()][at.x()] = [r, g, b, a];
            },
        )
        .with_context(|| format!("cannot read '{}'", path.display()))?;
        let size = image.layer_data.size;
        Ok(Self {
            width: size.width() as u32,
            height: size.height() as u32,
            pixels: image.layer_data.channel_data.pixels.concat(),
        })
    }
}

/// A linear value as an 8-bit sRGB one (IEC 61966-2-1); NaN becomes 0.
fn to_srgb(linear: f32) -> u8 {
    let x = linear.clamp(0.0, 1.0);
    let encoded = if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 };
    (encoded * 255.0 + 0.5) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gradient() -> Picture {
        let pixels = (0..64 * 40).map(|i| [i as f32 * 1e-3, -0.0, f32::INFINITY, 1.0]).collect();
        Picture { width: 64, height: 40, pixels }
    }

    #[test]
    fn the_same_pixels_give_the_same_bytes() {
        for _ in 0..20 {
            assert_eq!(gradient().exr().unwrap(), gradient().exr().unwrap());
            assert_eq!(gradient().png().unwrap(), gradient().png().unwrap());
        }
    }

    #[test]
    fn exr_keeps_every_bit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        gradient().save(&path).unwrap();
        let read = Picture::open_exr(&path).unwrap();
        let bits = |p: &Picture| p.pixels.iter().flatten().map(|x| x.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&read), bits(&gradient()));
    }

    #[test]
    fn pixels_that_are_not_finite_are_counted() {
        let mut picture = gradient();
        picture.pixels.iter_mut().for_each(|pixel| pixel[2] = 0.5);
        assert_eq!(picture.not_finite(), None);
        picture.pixels[64 * 3 + 5][0] = f32::NAN;
        assert!(
            picture
                .not_finite()
                .unwrap()
                .starts_with("1 pixel is not finite, the first at 5, 3: [NaN")
        );
        picture.pixels[64 * 3 + 4][1] = f32::NEG_INFINITY;
        assert!(
            picture
                .not_finite()
                .unwrap()
                .starts_with("2 pixels are not finite, the first at 4, 3: [")
        );
    }

    #[test]
    fn srgb_is_rounded_and_clamped() {
        let expected = [(0.0, 0), (1.0, 255), (2.0, 255), (-1.0, 0), (f32::NAN, 0), (0.214, 127)];
        for (linear, byte) in expected {
            assert_eq!(to_srgb(linear), byte, "{linear}");
        }
    }

    #[test]
    fn a_failed_write_leaves_nothing_behind() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("missing").join("a.png");
        let error = format!("{:#}", gradient().save(&target).unwrap_err());
        assert!(error.contains("cannot write") && error.contains("a.png"), "{error}");
        assert_eq!(folder.path().read_dir().unwrap().count(), 0);
        let error = gradient().save(&folder.path().join("a.jpg")).unwrap_err().to_string();
        assert!(error.contains(".png or .exr"), "{error}");
    }
}
