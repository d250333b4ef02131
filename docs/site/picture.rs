//! Pictures on the site: copied, cut into the panels of a sheet, or made small for the gallery.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};
use image::{DynamicImage, imageops};
use manuscript::project::Project;

use crate::color::escaped;

/// The part of a picture that is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Part {
    /// All of it, unchanged.
    Whole,
    /// The first of two panels under labels, side by side or one above the other.
    First,
    /// The second.
    Second,
    /// All of it, at most 480 pixels wide.
    Small,
    /// The first frame of a moving picture.
    Still,
}

/// The height of a label above its panel and the gap between panels, in pixels, as in `panels`, which makes
/// the sheets.
const LABEL: u32 = 22;
const GAP: u32 = 6;
/// The width of a picture in the gallery.
const SMALL: u32 = 480;

/// A picture of the site.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Picture {
    /// The file, from the project's root.
    pub from: String,
    /// The part shown.
    pub part: Part,
}

impl Picture {
    /// Its address, from the site's root.
    pub fn address(&self) -> String {
        let name = self.from.trim_start_matches("docs/");
        let (stem, extension) = name.rsplit_once('.').unwrap_or((name, ""));
        match self.part {
            Part::Whole => name.to_owned(),
            Part::First => format!("{stem}-first.{extension}"),
            Part::Second => format!("{stem}-second.{extension}"),
            Part::Small => format!("{stem}-small.{extension}"),
            Part::Still => format!("{stem}-still.{extension}"),
        }
    }

    /// Writes it below `folder`.
    ///
    /// # Errors
    /// If it cannot be read or written, or is not a sheet of two panels where one is needed.
    pub fn write(&self, root: &Path, folder: &Path) -> Result<()> {
        let (from, to) = (root.join(&self.from), folder.join(self.address()));
        fs::create_dir_all(to.parent().unwrap_or(folder))?;
        if self.part == Part::Whole {
            fs::copy(&from, &to).with_context(|| format!("cannot copy '{}'", self.from))?;
            return Ok(());
        }
        let picture = image::open(&from).with_context(|| format!("cannot read '{}'", self.from))?;
        let size = (picture.width(), picture.height());
        let cut = match self.part {
            Part::Whole => unreachable!("copied above"),
            Part::Still => picture.to_rgb8().into(),
            Part::Small if size.0 <= SMALL => picture,
            Part::Small => {
                let small = imageops::thumbnail(&picture, SMALL, size.1 * SMALL / size.0);
                DynamicImage::ImageRgba8(small).to_rgb8().into()
            }
            Part::First | Part::Second => {
                let [x, y, width, height] = panel(size, self.part == Part::Second);
                picture.crop_imm(x, y, width, height)
            }
        };
        cut.save(&to).with_context(|| format!("cannot write '{}'", to.display()))
    }

    /// The still version of a moving picture; `None` if it does not move.
    pub fn still(&self, root: &Path) -> Option<Self> {
        let bytes = fs::read(root.join(&self.from)).ok()?;
        // The chunk acTL precedes all pixels.
        let pixels = bytes.windows(4).position(|word| word == b"IDAT")?;
        let moves = bytes[..pixels].windows(4).any(|word| word == b"acTL");
        (moves && self.part == Part::Whole)
            .then(|| Self { from: self.from.clone(), part: Part::Still })
    }

    /// The picture as HTML, with its size, so that the page does not jump while it loads.
    pub fn html(&self, project: &Project, words: &str, lazy: bool) -> String {
        let (width, height) = size(&project.root.join(&self.from)).unwrap_or((0, 0));
        let size = match self.part {
            _ if width == 0 => String::new(),
            Part::Whole | Part::Small | Part::Still => {
                format!(" width=\"{width}\" height=\"{height}\"")
            }
            Part::First | Part::Second => {
                let [_, _, width, height] = panel((width, height), false);
                format!(" width=\"{width}\" height=\"{height}\"")
            }
        };
        let drawing = if self.from.ends_with(".svg") { " class=\"drawing\"" } else { "" };
        let lazy = if lazy { " loading=\"lazy\"" } else { "" };
        let alt = escaped(words).replace('|', "&#124;");
        let image = format!("<img src=\"{}\" alt=\"{alt}\"{drawing}{size}{lazy}>", self.address());
        // Readers who prefer less motion see the first frame.
        match self.still(&project.root) {
            Some(still) => format!(
                "<picture><source media=\"(prefers-reduced-motion: reduce)\" srcset=\"{}\">{image}</picture>",
                still.address()
            ),
            None => image,
        }
    }
}

/// The place of a panel on a sheet of two: left, top, width and height in pixels.
pub fn panel((width, height): (u32, u32), second: bool) -> [u32; 4] {
    let step = u32::from(second);
    // If the panels are side by side, the sheet is wider than three of them stacked.
    if width > 2 * height {
        let panel = (width - GAP) / 2;
        [step * (panel + GAP), LABEL, panel, height - LABEL]
    } else {
        let row = height / 2;
        [0, step * row + LABEL, width, row - LABEL]
    }
}

/// Width and height of a picture in pixels, from a PNG's header or an SVG's first tag.
pub fn size(path: &Path) -> Option<(u32, u32)> {
    let bytes = fs::read(path).ok()?;
    if bytes.starts_with(b"\x89PNG") {
        let word = |at: usize| Some(u32::from_be_bytes(bytes.get(at..at + 4)?.try_into().ok()?));
        return Some((word(16)?, word(20)?));
    }
    let text = String::from_utf8_lossy(&bytes[..bytes.len().min(1000)]).into_owned();
    let tag = &text[text.find("<svg")?..];
    let tag = &tag[..tag.find('>')?];
    let value =
        |key: &str| tag.split_once(&format!(" {key}=\""))?.1.split('"').next()?.parse().ok();
    Some((value("width")?, value("height")?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panels_are_cut_without_their_labels() {
        assert_eq!(panel((646, 222), false), [0, 22, 320, 200]);
        assert_eq!(panel((646, 222), true), [326, 22, 320, 200]);
        assert_eq!(panel((720, 524), true), [0, 284, 720, 240]);
    }
}
