//! Two pictures side by side, each under a label: what a gallery of mistakes shows.

use ab_glyph::{Font, FontRef, PxScale, ScaleFont, point};
use anyhow::{Context, Result};
use epaint_default_fonts::UBUNTU_LIGHT;
use image::{Rgb, RgbImage, imageops};

/// Rows above a panel, for its label.
const LABEL: u32 = 22;
/// Columns between panels.
const GAP: u32 = 6;
/// The height of the letters, in pixels.
const LETTERS: f32 = 17.0;
const PAPER: Rgb<u8> = Rgb([255; 3]);
const INK: Rgb<u8> = Rgb([40; 3]);

/// What stands under a label.
pub enum Panel {
    /// A picture.
    Picture(RgbImage),
    /// Why there is none.
    Words(String),
}

/// Panels of one size, from left to right, each under its label.
///
/// # Errors
/// If the font of the panel is no font.
pub fn side_by_side((width, height): (u32, u32), panels: &[(String, Panel)]) -> Result<RgbImage> {
    let count = panels.len() as u32;
    let mut sheet =
        RgbImage::from_pixel(count * (width + GAP) - GAP.min(count * GAP), LABEL + height, PAPER);
    for (index, (label, panel)) in (0..).zip(panels) {
        let left = index * (width + GAP);
        write(&mut sheet, label, (left + 2, 1))?;
        match panel {
            Panel::Picture(picture) => {
                imageops::replace(&mut sheet, picture, left.into(), LABEL.into());
            }
            Panel::Words(words) => {
                let grey = RgbImage::from_pixel(width, height, Rgb([225; 3]));
                imageops::replace(&mut sheet, &grey, left.into(), LABEL.into());
                for (row, line) in (0..).zip(wrapped(words, width as usize / 8)) {
                    write(&mut sheet, &line, (left + 12, LABEL + 10 + row * 22))?;
                }
            }
        }
    }
    Ok(sheet)
}

/// Whole words in lines of at most `width` letters.
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

/// Writes a line of text whose top left corner is at `(x, y)`.
fn write(sheet: &mut RgbImage, text: &str, (x, y): (u32, u32)) -> Result<()> {
    let font = FontRef::try_from_slice(UBUNTU_LIGHT).context("the font of the panel is no font")?;
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
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panels_lie_side_by_side_under_their_labels() {
        let red = RgbImage::from_pixel(30, 20, Rgb([200, 0, 0]));
        let panels =
            [("a".to_owned(), Panel::Picture(red)), ("b".to_owned(), Panel::Words("c".to_owned()))];
        let sheet = side_by_side((30, 20), &panels).unwrap();
        assert_eq!(sheet.dimensions(), (66, 42));
        assert_eq!(sheet.get_pixel(0, 41).0, [200, 0, 0]);
        assert_eq!(sheet.get_pixel(32, 41).0, [255; 3]);
        assert_eq!(sheet.get_pixel(36, 41).0, [225; 3]);
        // The letter above the picture.
        assert!((0..30).any(|x| (0..22).any(|y| sheet.get_pixel(x, y)[0] < 128)));
    }

    #[test]
    fn words_are_not_broken() {
        assert_eq!(wrapped("ab cd efghij k", 5), ["ab cd", "efghij", "k"]);
    }
}
