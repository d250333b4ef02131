//! The picture "Same price": four things by the textbook and by ours, each with its time and its wrong pixels.
//!
//! A pixel is wrong if it differs from a reference by more than [`FAR_OFF`]. The reference is a picture
//! without the error: two floats, the same scene at the origin, or many rays per pixel.

use std::path::Path;

use anyhow::{Context, Result, bail};
use common::app::Picture;
use common::files::{NewFolder, write_whole};
use image::{ImageFormat, RgbImage};
use panels::{Panel, sheet};
use time_limit::Limit;

use crate::pictures::downscale;
use crate::programs::child;
use crate::programs::command_line::quoted;
use crate::programs::interrupt;
use crate::programs::program::Programs;
use crate::values::given;

/// Size of a tile.
const SIZE: (u32, u32) = (234, 234);
/// Difference in a channel of 8-bit sRGB beyond which a pixel is wrong: visible to the eye.
const FAR_OFF: u8 = 16;

/// A column of the picture.
struct Tile {
    chapter: &'static str,
    /// Controls of all its pictures.
    sets: &'static [&'static str],
    /// The control, its value for the textbook, and its value for ours.
    control: &'static str,
    values: [&'static str; 2],
    /// Controls of the reference, and the factor by which it is wider and higher than a tile.
    reference: &'static [&'static str],
    wider: u32,
}

const TILES: [Tile; 4] = [
    Tile {
        chapter: "24_accuracy",
        sets: &["show=picture", "primitive=sphere", "distance=10000"],
        control: "rung",
        values: ["textbook", "stable"],
        reference: &["rung=two-float"],
        wider: 1,
    },
    Tile {
        chapter: "18_swept_spheres",
        sets: &["scene=one", "distance=10000"],
        control: "rung",
        values: ["textbook", "stable"],
        reference: &["rung=two-float"],
        wider: 1,
    },
    Tile {
        chapter: "39_far_from_origin",
        sets: &["far=4000000", "camera eye=0,3.2,11", "camera target=0,2.3,0", "field of view=17"],
        control: "coordinates",
        values: ["world", "camera-relative"],
        reference: &["far=0", "coordinates=camera-relative"],
        wider: 1,
    },
    Tile {
        chapter: "43_filtered_checker",
        sets: &[
            "square=0.1",
            "plane reflection=0",
            "camera eye=-3.4,1.6,7.2",
            "camera target=0.2,0.62,0",
        ],
        control: "checker",
        values: ["point", "filtered"],
        reference: &["checker=point"],
        wider: 16,
    },
];

/// The programs that draw it.
pub fn programs() -> [&'static str; TILES.len()] {
    TILES.map(|tile| tile.chapter)
}

/// Draws the picture into a file; returns the contents of its tiles as text.
///
/// # Errors
/// If a program fails, or the file cannot be written.
pub fn draw(programs: &Programs, rounds: u32, device: Option<&str>, file: &Path) -> Result<String> {
    let folder = NewFolder::temporary()?;
    let artist = Artist { programs, rounds, device, folder: folder.path() };
    let (mut rows, mut told) = ([Vec::new(), Vec::new()], String::new());
    for tile in &TILES {
        let reference = artist.picture(tile, tile.reference, tile.wider)?;
        let times = artist.times(tile)?;
        interrupt::asked()?;
        let names = ["textbook", "ours"];
        for (((row, name), value), milliseconds) in
            rows.iter_mut().zip(names).zip(tile.values).zip(times)
        {
            let picture = artist.picture(tile, &[&format!("{}={value}", tile.control)], 1)?;
            let wrong = wrong(&picture, &reference);
            let label = format!("{name}: {milliseconds:.1} ms, {wrong} wrong");
            told.push_str(&format!("{} {value}: {label}\n", tile.chapter));
            row.push((label, Panel::Picture(picture)));
        }
    }
    let mut bytes = std::io::Cursor::new(Vec::new());
    sheet(SIZE, &rows)?.write_to(&mut bytes, ImageFormat::Png)?;
    write_whole(file, bytes.get_ref())?;
    Ok(told)
}

struct Artist<'a> {
    programs: &'a Programs<'a>,
    rounds: u32,
    device: Option<&'a str>,
    folder: &'a Path,
}

impl Artist<'_> {
    fn arguments(&self, tile: &Tile, more: &[&str], (width, height): (u32, u32)) -> Vec<String> {
        let size = format!("{width}x{height}");
        let mut arguments = vec!["--headless", "--size", &size];
        arguments.extend(tile.sets.iter().chain(more).flat_map(|set| ["--set", set]));
        arguments.extend(self.device.into_iter().flat_map(|device| ["--device", device]));
        arguments.into_iter().map(str::to_owned).collect()
    }

    /// A picture of a tile's size, rendered this many times wider and higher and then averaged over squares
    /// of pixels.
    fn picture(&self, tile: &Tile, more: &[&str], wider: u32) -> Result<RgbImage> {
        let file = self.folder.join("tile.exr");
        let mut command = self.programs.built(tile.chapter)?;
        command.args(self.arguments(tile, more, (SIZE.0 * wider, SIZE.1 * wider)));
        let ended = child::run(command.arg("--out").arg(&file), Limit::NONE)?;
        if let Some(why) = ended.failed() {
            bail!("{}: {why}", tile.chapter);
        }
        let picture = downscale::shrunk(&Picture::open_exr(&file)?, wider);
        let pixels = RgbImage::from_raw(picture.width, picture.height, picture.srgb());
        pixels.context("a picture has three bytes for each pixel")
    }

    /// Milliseconds of both values, timed alternately.
    fn times(&self, tile: &Tile) -> Result<[f64; 2]> {
        let mut arguments = self.arguments(tile, &[], SIZE);
        arguments.extend(["--frames".to_owned(), self.rounds.to_string(), "--compare".to_owned()]);
        arguments.push(format!("{}={}", tile.control, tile.values.join("|")));
        let command = format!("cargo run --bin {} -- {}", tile.chapter, quoted(&arguments));
        let mut given = given::run(self.programs, &command)?;
        let (_, record) = given.pop_first().context("it gives nothing")?;
        let [textbook, ours] =
            tile.values.map(|value| record.value(&format!("{}.ms", value.replace(' ', "-"))));
        Ok([textbook.context("a time")?, ours.context("a time")?])
    }
}

/// The number of pixels that differ by more than [`FAR_OFF`] in a channel.
fn wrong(picture: &RgbImage, reference: &RgbImage) -> usize {
    let differs = |(a, b): &(&image::Rgb<u8>, &image::Rgb<u8>)| {
        a.0.iter().zip(b.0).any(|(a, b)| a.abs_diff(b) > FAR_OFF)
    };
    picture.pixels().zip(reference.pixels()).filter(differs).count()
}

#[cfg(test)]
mod tests {
    use image::Rgb;

    use super::*;

    #[test]
    fn a_pixel_is_wrong_if_one_channel_is_far_off() {
        let reference = RgbImage::from_pixel(4, 1, Rgb([100, 100, 100]));
        let mut picture = reference.clone();
        picture.put_pixel(1, 0, Rgb([116, 84, 100]));
        picture.put_pixel(2, 0, Rgb([100, 100, 117]));
        picture.put_pixel(3, 0, Rgb([83, 100, 100]));
        assert_eq!(wrong(&picture, &reference), 2);
    }
}
