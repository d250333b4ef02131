//! Pictures side by side and in rows, each under a label, for comparison on a page.

use ab_glyph::{Font, FontRef, PxScale, ScaleFont, point};
use anyhow::{Context, Result, ensure};
use epaint_default_fonts::UBUNTU_LIGHT;
use image::{Rgb, RgbImage, imageops};

/// The height of a label above its panel, in pixels.
const LABEL: u32 = 22;
/// Pixels between panels.
const GAP: u32 = 6;
/// The height of the letters, in pixels.
const LETTERS: f32 = 17.0;
const PAPER: Rgb<u8> = Rgb([255; 3]);
const INK: Rgb<u8> = Rgb([40; 3]);

/// The content under a label.
pub enum Panel {
    /// A picture.
    Picture(RgbImage),
    /// The reason why there is no picture.
    Words(String),
}

/// Panels of one size in rows, from left to right, each under its label.
///
/// # Errors
/// If a label is wider than a panel, or the font is invalid.
pub fn sheet((width, height): (u32, u32), rows: &[Vec<(String, Panel)>]) -> Result<RgbImage> {
    let columns = rows.iter().map(|row| row.len() as u32).max().unwrap_or(0);
    let size =
        ((columns * (width + GAP)).saturating_sub(GAP), rows.len() as u32 * (LABEL + height));
    let mut sheet = RgbImage::from_pixel(size.0, size.1, PAPER);
    for (row, panels) in (0..).zip(rows) {
        let top = row * (LABEL + height);
        for (column, (label, panel)) in (0..).zip(panels) {
            let left = column * (width + GAP);
            let needed = write(&mut sheet, label, (left + 2, top + 1))?;
            ensure!(
                needed <= width as f32,
                "the label '{label}' is {needed:.0} pixels wide, its panel {width}"
            );
            match panel {
                Panel::Picture(picture) => {
                    imageops::replace(&mut sheet, picture, left.into(), (top + LABEL).into());
                }
                Panel::Words(words) => {
                    let grey = RgbImage::from_pixel(width, height, Rgb([225; 3]));
                    imageops::replace(&mut sheet, &grey, left.into(), (top + LABEL).into());
                    for (line, words) in (0..).zip(wrapped(words, width as usize / 8)) {
                        write(&mut sheet, &words, (left + 12, top + LABEL + 10 + line * 22))?;
                    }
                }
            }
        }
    }
    Ok(sheet)
}

/// Breaks a text into lines of at most `width` letters, at words.
fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        let last = lines.len() - 1;
        if !lines[last].is_empty() && lines[last].chars().count() + 1 + word.chars().count() > width
        {
            lines.push(word.to_owned());
        } else {
            let blank = if lines[last].is_empty() { "" } else { " " };
            lines[last].push_str(&format!("{blank}{word}"));
        }
    }
    lines
}

/// Writes a line of text whose top left corner is at `(x, y)`, and returns its width in pixels.
fn write(sheet: &mut RgbImage, text: &str, (x, y): (u32, u32)) -> Result<f32> {
    let font =
        FontRef::try_from_slice(UBUNTU_LIGHT).context("the font of the labels is no font")?;
    let scaled = font.as_scaled(PxScale::from(LETTERS));
    let mut pen = point(x as f32, y as f32 + scaled.ascent());
    for letter in text.chars() {
        let glyph = scaled.scaled_glyph(letter);
        let advance = scaled.h_advance(glyph.id);
        let placed = ab_glyph::Glyph { position: pen, ..glyph };
        pen.x += advance;
        let Some(outline) = scaled.outline_glyph(placed) else { continue };
        let corner = outline.px_bounds().min;
        outline.draw(|column, row, covered| {
            let (x, y) = (corner.x + column as f32, corner.y + row as f32);
            if let Some(pixel) = sheet.get_pixel_mut_checked(x as u32, y as u32) {
                let mixed =
                    |i: usize| f32::from(INK[i]) * covered + f32::from(pixel[i]) * (1.0 - covered);
                *pixel = Rgb([mixed(0) as u8, mixed(1) as u8, mixed(2) as u8]);
            }
        });
    }
    Ok(pen.x - x as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panels_lie_in_rows_under_their_labels() {
        let red = || Panel::Picture(RgbImage::from_pixel(30, 20, Rgb([200, 0, 0])));
        let rows = [
            vec![("a".to_owned(), red()), ("b".to_owned(), Panel::Words("c".to_owned()))],
            vec![("d".to_owned(), red())],
        ];
        let sheet = sheet((30, 20), &rows).unwrap();
        assert_eq!(sheet.dimensions(), (66, 84));
        assert_eq!(sheet.get_pixel(0, 41).0, [200, 0, 0]);
        assert_eq!(sheet.get_pixel(32, 41).0, [255; 3]);
        assert_eq!(sheet.get_pixel(36, 41).0, [225; 3]);
        assert_eq!(sheet.get_pixel(29, 83).0, [200, 0, 0]);
        assert_eq!(sheet.get_pixel(36, 83).0, [255; 3]);
        // The letters above the pictures.
        for top in [0, 42] {
            assert!((0..30).any(|x| (top..top + 22).any(|y| sheet.get_pixel(x, y)[0] < 128)));
        }
    }

    #[test]
    fn a_label_that_would_run_into_the_next_is_refused() {
        let row = vec![("wide".to_owned(), Panel::Picture(RgbImage::new(20, 20)))];
        let error = sheet((20, 20), &[row]).unwrap_err().to_string();
        assert!(error.starts_with("the label 'wide' is "), "{error}");
    }

    #[test]
    fn words_are_not_broken() {
        assert_eq!(wrapped("ab cd efghij k", 5), ["ab cd", "efghij", "k"]);
    }
}
