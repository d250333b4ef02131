//! The development of a picture: its exposure, and the curve that fits bright light into 8 bits.

use std::path::Path;

use anyhow::Result;

use super::{Format, Picture};

/// The way from linear light to a PNG and to the window. An EXR stays as it was rendered.
#[derive(Clone, Copy, Debug, PartialEq, clap::Args)]
#[group(skip)]
pub struct Development {
    /// Stops by which a PNG and the window are brighter than rendered: each doubles the light. An EXR stays as it is
    #[arg(long, value_name = "STOPS", default_value = "0", value_parser = stops, allow_hyphen_values = true)]
    pub exposure: f32,

    /// The curve by which a PNG and the window show bright light
    #[arg(long, value_name = "CURVE", value_enum, default_value_t = Tone::Clamp)]
    pub tone: Tone,
}

/// The light that a curve shows for linear light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum Tone {
    /// Light above 1 is shown as 1
    #[default]
    Clamp,
    /// Extended Reinhard by luminance, which keeps hues; a luminance of 4 is white
    Reinhard,
    /// Narkowicz's fit of the film curve of ACES, by channel: very bright colours fade to white
    Aces,
}

/// The luminance that [`Tone::Reinhard`] shows as white.
const WHITE: f32 = 4.0;

impl Default for Development {
    fn default() -> Self {
        Self { exposure: 0.0, tone: Tone::Clamp }
    }
}

impl Development {
    /// The developed picture; by default, the picture itself.
    pub fn of(self, mut picture: Picture) -> Picture {
        if self != Self::default() {
            let scale = self.exposure.exp2();
            for [r, g, b, _] in &mut picture.pixels {
                [*r, *g, *b] = self.tone.of([*r, *g, *b].map(|light| light * scale));
            }
        }
        picture
    }

    /// Writes a picture: developed as a PNG, as it is as an EXR.
    ///
    /// # Errors
    /// As [`Picture::save`].
    pub fn save(self, picture: Picture, path: &Path) -> Result<()> {
        let picture = if Format::of(path)? == Format::Png { self.of(picture) } else { picture };
        picture.save(path)
    }
}

impl Tone {
    /// The shown light, as `shown` in `develop.comp`.
    fn of(self, light: [f32; 3]) -> [f32; 3] {
        match self {
            Self::Clamp => light,
            // Reinhard et al., Photographic Tone Reproduction for Digital Images, SIGGRAPH 2002, equation 4.
            Self::Reinhard => {
                let [r, g, b] = light;
                let luminance = (0.2126 * r + 0.7152 * g + 0.0722 * b).clamp(0.0, 1e18);
                let scale = (1.0 + luminance / (WHITE * WHITE)) / (1.0 + luminance);
                light.map(|light| light * scale)
            }
            // Narkowicz, ACES Filmic Tone Mapping Curve, 2016. Above 1e4 it is at its end.
            Self::Aces => light.map(|light| {
                let x = light.clamp(0.0, 1e4);
                x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14)
            }),
        }
    }
}

fn stops(text: &str) -> Result<f32, String> {
    let number = text.parse().ok().filter(|stops: &f32| stops.abs() <= 32.0);
    number.ok_or_else(|| "stops are a number from -32 to 32".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture() -> Picture {
        let pixels = (0..64).map(|i| [0.1 * i as f32, 1.0, 1e-3 * i as f32, 1.0]).collect();
        Picture { width: 8, height: 8, pixels }
    }

    #[test]
    fn by_default_no_bit_changes() {
        let wild = Picture { width: 1, height: 1, pixels: vec![[f32::INFINITY, -1.0, -0.0, 1.0]] };
        for picture in [picture(), wild] {
            assert_eq!(Development::default().of(picture.clone()), picture);
        }
    }

    #[test]
    fn a_stop_doubles_the_light() {
        let brighter = Development { exposure: 1.0, ..Development::default() }.of(picture());
        for (one, other) in picture().pixels.iter().zip(&brighter.pixels) {
            assert_eq!([2.0 * one[0], 2.0 * one[1], 2.0 * one[2], one[3]], *other);
        }
    }

    #[test]
    fn curves_begin_at_black_rise_and_end_at_white() {
        for tone in [Tone::Reinhard, Tone::Aces] {
            let grey = |light: f32| tone.of([light; 3])[0];
            assert_eq!(grey(0.0), 0.0);
            let lights: Vec<f32> = (0..400).map(|i| 0.01 * i as f32).collect();
            assert!(lights.windows(2).all(|pair| grey(pair[0]) < grey(pair[1])), "{tone:?}");
        }
        // The values of the papers: the white point is shown as 1, and 1 as 0.8038.
        assert!((Tone::Reinhard.of([WHITE; 3])[0] - 1.0).abs() < 1e-6);
        assert!((Tone::Aces.of([1.0; 3])[0] - 2.54 / 3.16).abs() < 1e-6);
        assert!((0.99..1.05).contains(&Tone::Aces.of([f32::INFINITY; 3])[0]));
    }

    #[test]
    fn reinhard_keeps_the_hue() {
        let [r, g, b] = Tone::Reinhard.of([3.0, 1.5, 0.75]);
        assert!((r / g - 2.0).abs() < 1e-6 && (g / b - 2.0).abs() < 1e-6);
    }

    #[test]
    fn an_exr_keeps_every_bit() {
        let folder = tempfile::tempdir().unwrap();
        let [plain, developed] = ["a.exr", "b.exr"].map(|name| folder.path().join(name));
        picture().save(&plain).unwrap();
        let development = Development { exposure: 3.0, tone: Tone::Aces };
        development.save(picture(), &developed).unwrap();
        assert_eq!(std::fs::read(plain).unwrap(), std::fs::read(developed).unwrap());
    }

    #[test]
    fn stops_are_finite_numbers() {
        assert_eq!(stops("-1.5"), Ok(-1.5));
        for wrong in ["", "x", "nan", "inf", "33"] {
            assert!(stops(wrong).is_err(), "{wrong}");
        }
    }
}
