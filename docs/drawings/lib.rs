//! The inks of all drawings and charts of the book, in the light and the dark scheme.
//!
//! A drawing contains the light colours, so that every viewer shows it. [`themed`] adds a style that replaces
//! them if the reader's scheme is dark. Inside an `<img>` that scheme is the one of the surrounding page
//! (Media Queries 5, section 12.5), so the book's own switch works as well.

pub mod map;
pub mod sheet;

use std::fmt::Write;

/// The use of an ink, which determines its contrast.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum For {
    /// The background of text and lines.
    Ground,
    /// Text, and lines that carry the meaning.
    Text,
    /// Lines, dots and areas that carry the meaning.
    Line,
    /// Grids, which may be faint.
    Grid,
}

/// A colour in the light and the dark scheme, as SVG writes it.
#[derive(Clone, Copy, Debug)]
pub struct Ink {
    /// Its colour in the file, and in the light scheme.
    pub light: &'static str,
    /// Its colour in the dark scheme.
    pub dark: &'static str,
    /// Its use.
    pub use_for: For,
}

/// Lines and arrows.
pub const LINE: &str = "#5b6b78";
/// Text next to a line.
pub const SOFT: &str = "#44535f";
/// Text.
pub const TEXT: &str = "#22303c";
/// The sheet.
pub const PAPER: &str = "#f7f8f9";
/// The reader's own code, and a choice.
pub const YOURS: &str = "#f2e3c6";
/// The device's work.
pub const DEVICE: &str = "#d8dee4";
/// A group of things; another.
pub const BLUE: &str = "#dcebf7";
/// See [`BLUE`].
pub const GREEN: &str = "#e2f0e0";
/// A card on the sheet.
pub const WHITE: &str = "#ffffff";
/// The outline of shapes.
pub const BROWN: &str = "#8a5a12";
/// An error.
pub const RED: &str = "#b3261e";
/// The outline of a second shape; of a third.
pub const LEAF: &str = "#3a7d44";
/// See [`LEAF`].
pub const SEA: &str = "#2f6f9f";
/// Lines that only guide the eye.
pub const FAINT: &str = "#c9d1d8";

/// All of them. Charts write theirs in capitals.
pub const INKS: &[Ink] = &[
    ink(PAPER, "#1c212d", For::Ground),
    ink(WHITE, "#2a3140", For::Ground),
    ink(YOURS, "#4d3f22", For::Ground),
    ink(DEVICE, "#3a4452", For::Ground),
    ink(BLUE, "#1f3d57", For::Ground),
    ink(GREEN, "#24452a", For::Ground),
    ink("#cfe3ee", "#23485c", For::Ground),
    ink("#f3d9a8", "#5a4414", For::Ground),
    ink(TEXT, "#e6e9ec", For::Text),
    ink(SOFT, "#c3ccd4", For::Text),
    ink(LINE, "#9fb0bf", For::Line),
    ink(BROWN, "#e0b060", For::Line),
    ink(RED, "#ff8a80", For::Line),
    ink(LEAF, "#7fcf8a", For::Line),
    ink(SEA, "#7cbcf0", For::Line),
    ink("#c2571a", "#ff9c5a", For::Line),
    ink("#9a6a1c", "#e0b25c", For::Line),
    ink(FAINT, "#4a5464", For::Grid),
    // The inks of charts.
    ink("#FFFFFF", "#1c212d", For::Ground),
    ink("#000000", "#e6e9ec", For::Text),
    ink("#3C3C3C", "#dadde0", For::Text),
    ink("#C87A00", "#f0ad3c", For::Line),
    ink("#0072B2", "#6db9ec", For::Line),
    ink("#009E73", "#3fcf9f", For::Line),
    ink("#C46B9D", "#e79cc6", For::Line),
    ink("#8C8C8C", "#9fb0bf", For::Line),
    ink("#E1E1E1", "#3a4150", For::Grid),
];

const fn ink(light: &'static str, dark: &'static str, use_for: For) -> Ink {
    Ink { light, dark, use_for }
}

/// The beginning and end of the style, by which it is found again.
const STYLE: [&str; 2] = ["<style>@media (prefers-color-scheme: dark) {", "}</style>\n"];

/// Adds the style with the dark colours to an SVG; repeating it changes nothing.
///
/// # Errors
/// If the text has no `<svg>`, or contains a colour that is not an ink.
pub fn themed(svg: &str) -> Result<String, String> {
    let mut text = svg.to_owned();
    if let Some(start) = text.find(STYLE[0]) {
        let end = text[start..].find(STYLE[1]).ok_or("the style of the inks does not end")?;
        text.replace_range(start..start + end + STYLE[1].len(), "");
    }
    let mut style = String::new();
    for property in ["fill", "stroke"] {
        let mut used: Vec<&str> = Vec::new();
        for rest in text.split(&format!(" {property}=\"")).skip(1) {
            let color = rest.split('"').next().unwrap_or_default();
            if color != "none" && !used.contains(&color) {
                used.push(color);
            }
        }
        used.sort_unstable();
        for color in used {
            let ink = INKS.iter().find(|ink| ink.light == color);
            let ink = ink.ok_or_else(|| format!("{property}=\"{color}\" is no ink"))?;
            write!(style, "[{property}=\"{color}\"]{{{property}:{}}}", ink.dark)
                .expect("a string takes it");
        }
    }
    let tag = text.find("<svg").ok_or("there is no <svg>")?;
    let end = tag + text[tag..].find('>').ok_or("the <svg> does not end")? + 1;
    let end = end + usize::from(text[end..].starts_with('\n'));
    text.insert_str(end, &format!("{}{style}{}", STYLE[0], STYLE[1]));
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The ratio that WCAG 2 defines.
    fn contrast(one: &str, other: &str) -> f64 {
        let luminance = |color: &str| {
            let part = |at: usize| {
                let value = u8::from_str_radix(&color[at..at + 2], 16).expect("six digits");
                let value = f64::from(value) / 255.0;
                if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
            };
            0.2126 * part(1) + 0.7152 * part(3) + 0.0722 * part(5)
        };
        let (one, other) = (luminance(one), luminance(other));
        (one.max(other) + 0.05) / (one.min(other) + 0.05)
    }

    #[test]
    fn inks_stand_out_by_light_and_by_dark() {
        let grounds = || INKS.iter().filter(|ink| ink.use_for == For::Ground);
        for ink in INKS {
            let least = match ink.use_for {
                For::Text => 4.5,
                For::Line => 3.0,
                For::Ground | For::Grid => continue,
            };
            for ground in grounds() {
                // Coloured lines are drawn on paper and cards; a test in Chromium checks the drawings
                // themselves.
                let paper = [PAPER, WHITE, "#FFFFFF"].contains(&ground.light);
                if ink.use_for == For::Line && !paper {
                    continue;
                }
                for (front, back) in [(ink.light, ground.light), (ink.dark, ground.dark)] {
                    let found = contrast(front, back);
                    assert!(found >= least, "{front} on {back}: {found:.2}");
                }
            }
        }
    }

    #[test]
    fn a_drawing_gets_its_inks_once() {
        let svg = "<svg width=\"9\">\n<path fill=\"none\" stroke=\"#5b6b78\"/>\n</svg>\n";
        let once = themed(svg).unwrap();
        assert!(once.contains("[stroke=\"#5b6b78\"]{stroke:#9fb0bf}"), "{once}");
        assert_eq!(themed(&once).unwrap(), once);
        let error = themed("<svg><path stroke=\"#123456\"/></svg>").unwrap_err();
        assert_eq!(error, "stroke=\"#123456\" is no ink");
    }
}
