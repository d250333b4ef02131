//! A sheet: an SVG drawing in the common style.

use std::fmt::Write;

use crate::themed;
pub use crate::{
    BLUE, BROWN, DEVICE, FAINT, GREEN, LEAF, LINE, PAPER, RED, SEA, SOFT, TEXT, WHITE, YOURS,
};

/// A point, in pixels from the top left corner.
pub type Point = [f64; 2];

/// The point of a text that its coordinates mark.
#[derive(Clone, Copy)]
pub enum Anchor {
    /// Its left end.
    Start,
    /// Its middle.
    Middle,
    /// Its right end.
    End,
}

use Anchor::*;

/// A drawing in progress.
pub struct Sheet {
    text: String,
}

impl Sheet {
    /// An empty sheet with a heading.
    pub fn new([width, height]: [u32; 2], heading: &str) -> Self {
        let mut sheet = Self { text: String::new() };
        sheet.put(&format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" \
             width=\"{width}\" height=\"{height}\" font-family=\"Helvetica, Arial, sans-serif\" \
             font-size=\"12.5\" fill=\"{TEXT}\">"
        ));
        sheet.put(&format!(
            "<defs><marker id=\"arrow\" viewBox=\"0 0 10 10\" refX=\"9\" refY=\"5\" markerWidth=\"8\" \
             markerHeight=\"8\" orient=\"auto-start-reverse\"><path d=\"M0 1 10 5 0 9z\" \
             fill=\"{LINE}\"/></marker></defs>"
        ));
        sheet.put(&format!(
            "<rect width=\"{width}\" height=\"{height}\" rx=\"8\" fill=\"{PAPER}\"/>"
        ));
        sheet.put(&format!(
            "<text x=\"24\" y=\"34\" font-size=\"16\" font-weight=\"bold\">{}</text>",
            escaped(heading)
        ));
        sheet
    }

    /// The file's text.
    pub fn svg(mut self) -> String {
        self.put("</svg>");
        themed(&self.text).expect("a sheet takes inks alone")
    }

    fn put(&mut self, element: &str) {
        writeln!(self.text, "{element}").expect("a string takes it");
    }

    /// A line of text.
    pub fn say(&mut self, at: Point, anchor: Anchor, text: &str) {
        self.write(at, anchor, "", text);
    }

    /// A line of text beside something.
    pub fn note(&mut self, at: Point, anchor: Anchor, text: &str) {
        self.write(at, anchor, &format!(" fill=\"{SOFT}\""), text);
    }

    /// A line of text in bold, in the usual size.
    pub fn strong(&mut self, at: Point, anchor: Anchor, text: &str) {
        self.write(at, anchor, " font-weight=\"bold\"", text);
    }

    /// A heading in bold.
    pub fn title(&mut self, at: Point, anchor: Anchor, text: &str) {
        self.write(at, anchor, " font-size=\"14\" font-weight=\"bold\"", text);
    }

    fn write(&mut self, [x, y]: Point, anchor: Anchor, style: &str, text: &str) {
        let anchor = match anchor {
            Start => "",
            Middle => " text-anchor=\"middle\"",
            End => " text-anchor=\"end\"",
        };
        let text = escaped(text);
        self.put(&format!("<text x=\"{x:.1}\" y=\"{y:.1}\"{anchor}{style}>{text}</text>"));
    }

    /// A box with a title, which may be empty, and lines of text in its middle.
    pub fn card(
        &mut self,
        [x, y]: Point,
        [w, h]: [f64; 2],
        fill: &str,
        title: &str,
        lines: &[&str],
    ) {
        self.put(&format!(
            "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{w:.1}\" height=\"{h:.1}\" rx=\"5\" \
             fill=\"{fill}\" stroke=\"{LINE}\"/>"
        ));
        let rows = lines.len() + usize::from(!title.is_empty());
        let mut at = [x + w / 2.0, y + h / 2.0 - (rows as f64 - 1.0) * 9.5 + 4.5];
        if !title.is_empty() {
            self.title(at, Middle, title);
            at[1] += 19.0;
        }
        for line in lines {
            self.say(at, Middle, line);
            at[1] += 19.0;
        }
    }

    /// An arrow through points.
    pub fn arrow(&mut self, points: &[Point]) {
        self.path(
            points,
            &format!("stroke=\"{LINE}\" stroke-width=\"1.6\" marker-end=\"url(#arrow)\""),
        );
    }

    /// A dashed arrow through points.
    pub fn dashed_arrow(&mut self, points: &[Point]) {
        self.path(
            points,
            &format!(
                "stroke=\"{LINE}\" stroke-width=\"1.6\" stroke-dasharray=\"5 4\" \
                 marker-end=\"url(#arrow)\""
            ),
        );
    }

    /// A line through points.
    pub fn line(&mut self, points: &[Point], color: &str, width: f64) {
        self.path(points, &format!("stroke=\"{color}\" stroke-width=\"{width}\""));
    }

    /// A dashed line through points.
    pub fn dashes(&mut self, points: &[Point], color: &str, width: f64) {
        self.path(
            points,
            &format!("stroke=\"{color}\" stroke-width=\"{width}\" stroke-dasharray=\"4 4\""),
        );
    }

    fn path(&mut self, points: &[Point], style: &str) {
        let points = points.iter().map(|[x, y]| format!("{x:.1} {y:.1}")).collect::<Vec<_>>();
        self.put(&format!("<path d=\"M{}\" fill=\"none\" {style}/>", points.join(" L")));
    }

    /// A filled polygon.
    pub fn polygon(&mut self, points: &[Point], fill: &str, stroke: &str) {
        let points = points.iter().map(|[x, y]| format!("{x:.1},{y:.1}")).collect::<Vec<_>>();
        let points = points.join(" ");
        self.put(&format!(
            "<polygon points=\"{points}\" fill=\"{fill}\" stroke=\"{stroke}\" stroke-width=\"1.6\"/>"
        ));
    }

    /// A disk.
    pub fn dot(&mut self, [x, y]: Point, radius: f64, fill: &str) {
        self.put(&format!(
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius:.1}\" fill=\"{fill}\"/>"
        ));
    }

    /// A circle.
    pub fn circle(&mut self, [x, y]: Point, radius: f64, fill: &str, stroke: &str) {
        self.put(&format!(
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius:.1}\" fill=\"{fill}\" \
             fill-opacity=\"0.6\" stroke=\"{stroke}\" stroke-width=\"1.4\"/>"
        ));
    }
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;")
}
