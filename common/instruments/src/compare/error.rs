//! `--against`: the error of each value's picture, beside its time.

use std::path::Path;

use anyhow::{Result, bail};
use ash::vk;
use common::UsageError;
use common::app::{Bands, Picture, Progress, Run, controls};
use common::model::ExrFile;
use common::model::text::shown;
use common::output;
use serde::Serialize;

use super::Comparison;

/// Added to the square of the reference, so that black pixels do not decide the relative error. The value is that of
/// F. Rousselle and others, *Adaptive Sampling and Reconstruction using Greedy Error Minimization*, 2011.
const FLOOR: f64 = 0.01;

/// The error of a picture, over all pixels and the channels red, green and blue.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PictureError {
    /// Number of frames the picture has accumulated.
    pub frames: u32,
    /// The root of the mean squared difference.
    pub rmse: f64,
    /// The same, of differences relative to the reference: the root of the mean of `(p - r)² / (r² + 0.01)`.
    pub relative: f64,
}

/// The picture that others are compared with.
#[derive(Clone, Debug)]
pub struct Reference {
    name: String,
    file: ExrFile,
}

impl Reference {
    /// Reads a reference for pictures of this size.
    ///
    /// # Errors
    /// One line, if the file cannot be read, has another size, or has pixels that are not finite.
    pub fn open(path: &Path, size: vk::Extent2D) -> Result<Self> {
        let name = shown(path).to_string();
        let file = ExrFile::open(path)?;
        if [file.width, file.height] != [size.width, size.height] {
            return Err(UsageError(format!(
                "--against {name}: has {}x{} pixels and the picture has {}x{}; render both with one --size",
                file.width, file.height, size.width, size.height
            ))
            .into());
        }
        let wild = file.texels.iter().position(|pixel| !pixel.iter().all(|part| part.is_finite()));
        if let Some(index) = wild {
            let (x, y) = (index % file.width as usize, index / file.width as usize);
            let pixel = file.texels[index];
            bail!("{name}: pixel {x}, {y} is {pixel:?}; a reference has finite pixels");
        }
        Ok(Self { name, file })
    }

    /// The error of a picture that has accumulated this many frames.
    pub fn error(&self, picture: &Picture, frames: u32) -> PictureError {
        let (mut squares, mut relative) = (0.0, 0.0);
        for (pixel, expected) in picture.pixels.iter().zip(&self.file.texels) {
            for (shown, expected) in pixel.iter().zip(expected) {
                let (shown, expected) = (f64::from(*shown), f64::from(*expected));
                let square = (shown - expected) * (shown - expected);
                squares += square;
                relative += square / (expected * expected + FLOOR);
            }
        }
        let root = |sum: f64| (sum / (3 * self.file.texels.len()) as f64).sqrt();
        PictureError { frames, rmse: root(squares), relative: root(relative) }
    }

    /// Renders the frames of each value again, and compares the picture after 1, 2, 4, 8, … and all of them, and after
    /// those that fit into the time of the fastest value. What moves by playback stands still.
    ///
    /// # Errors
    /// If the sample or the device fails.
    pub fn compare(&self, run: &mut Run, comparison: &mut Comparison) -> Result<()> {
        let Comparison { control, rounds, values, .. } = comparison;
        let mut progress = Progress::new(u64::from(*rounds) * values.len() as u64, "frames");
        let least = values.iter().map(|it| it.ratio.median).fold(f64::INFINITY, f64::min);
        for measured in values {
            let value = &measured.value;
            controls::set_beside(&run.args.sets, control, value, |c| run.sample.controls(c))?;
            run.sample.forget();
            let fit = f64::from(*rounds) * least / measured.ratio.median;
            let equal = (fit as u32).clamp(1, *rounds);
            let mut bands = Bands::default();
            for frames in 1..=*rounds {
                run.time(&mut bands, frames - 1)?;
                if frames.is_power_of_two() || [*rounds, equal].contains(&frames) {
                    measured.errors.push(self.error(&run.picture()?, frames));
                }
                progress.step();
            }
            measured.frames_in_equal_time = Some(equal);
            let wild = run.picture()?.not_finite();
            output::warn(wild.map(|what| format!("{control}={value}: {what}")).as_slice());
        }
        comparison.reference = Some(self.name.clone());
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: vk::Extent2D = vk::Extent2D { width: 2, height: 1 };

    fn picture(pixels: [[f32; 3]; 2]) -> Picture {
        let pixels = pixels.map(|[r, g, b]| [r, g, b, 1.0]).to_vec();
        Picture { width: SIZE.width, height: SIZE.height, pixels }
    }

    fn opened(pixels: [[f32; 3]; 2], size: vk::Extent2D) -> Result<Reference> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("reference.exr");
        picture(pixels).save(&path).unwrap();
        Reference::open(&path, size)
    }

    #[test]
    fn errors_are_roots_of_mean_squares() {
        let reference = opened([[0.0, 1.0, 2.0], [0.0; 3]], SIZE).unwrap();
        let error = reference.error(&picture([[0.5, 1.0, 2.5], [0.0; 3]]), 7);
        assert_eq!(error.frames, 7);
        assert!((error.rmse - (0.5f64 / 6.0).sqrt()).abs() < 1e-12, "{error:?}");
        let relative = ((0.25f64 / 0.01 + 0.25 / 4.01) / 6.0).sqrt();
        assert!((error.relative - relative).abs() < 1e-12, "{error:?}");
        let same = reference.error(&picture([[0.0, 1.0, 2.0], [0.0; 3]]), 1);
        assert_eq!((same.rmse, same.relative), (0.0, 0.0));
    }

    #[test]
    fn a_reference_has_the_size_of_the_picture_and_numbers() {
        let wide = vk::Extent2D { width: 4, height: 1 };
        let error = opened([[0.0; 3]; 2], wide).unwrap_err();
        assert!(error.is::<UsageError>(), "{error}");
        assert!(error.to_string().contains("has 2x1 pixels and the picture has 4x1"), "{error}");
        let error = opened([[0.0; 3], [0.0, f32::NAN, 1.0]], SIZE).unwrap_err().to_string();
        assert!(error.contains("pixel 1, 0 is [0.0, NaN, 1.0]"), "{error}");
    }
}
