//! Charts and enlarged crops for the pages.
//!
//! A chapter that has something to draw does it in tests that are ignored unless asked for: there the
//! program is built, its pictures can be read, and the CPU's copy of the mathematics is at hand; and
//! whoever only runs a sample need not build a plotting library.

use std::ops::Range;
use std::path::PathBuf;

use common::app::Picture;
use image::{RgbImage, imageops};
use plotters::coord::Shift;
use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, ValueFormatter};
use plotters::prelude::*;
use plotters::style::{FontStyle, register_font};

use super::root;

/// Colours that the colour-blind can tell apart (Okabe and Ito 2008).
const COLORS: [RGBColor; 5] = [
    RGBColor(60, 60, 60),
    RGBColor(230, 159, 0),
    RGBColor(0, 114, 178),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
];
const GRID: RGBColor = RGBColor(225, 225, 225);

/// A chart: two axes and what is drawn between them.
pub struct Chart<'a> {
    pub title: &'a str,
    pub x: Axis<'a>,
    pub y: Axis<'a>,
    pub series: Vec<Series<'a>>,
}

/// An axis from the first to the last of its ticks.
#[derive(Clone, Copy)]
pub struct Axis<'a> {
    pub label: &'a str,
    pub ticks: &'a [f64],
    pub logarithmic: bool,
}

/// Points that belong together; those without a name are not in the legend.
pub struct Series<'a> {
    pub name: &'a str,
    pub points: Vec<[f64; 2]>,
    pub line: bool,
    pub dots: bool,
}

impl Axis<'_> {
    fn place(&self, value: f64) -> f64 {
        if self.logarithmic { value.ln() } else { value }
    }
}

impl Ranged for Axis<'_> {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, (low, high): (i32, i32)) -> i32 {
        let Range { start, end } = self.range();
        let part = (self.place(*value) - self.place(start)) / (self.place(end) - self.place(start));
        low + (part * f64::from(high - low)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, _: Hint) -> Vec<f64> {
        self.ticks.to_vec()
    }

    fn range(&self) -> Range<f64> {
        self.ticks[0]..self.ticks[self.ticks.len() - 1]
    }
}

impl ValueFormatter<f64> for Axis<'_> {
    fn format(value: &f64) -> String {
        value.to_string()
    }
}

/// The file of a picture that a page shows.
pub fn file(name: &str) -> PathBuf {
    root().join("docs/images").join(name)
}

/// Draws charts side by side, each `width` by `height`, into an SVG in `docs/images`.
pub fn draw(name: &str, (width, height): (u32, u32), charts: &[Chart]) {
    let path = file(name);
    // An SVG holds text, but where that ends only a font can say.
    register_font("sans-serif", FontStyle::Normal, epaint_default_fonts::UBUNTU_LIGHT)
        .unwrap_or_else(|_| panic!("the font of the panel is no font"));
    let area = SVGBackend::new(&path, (width * charts.len() as u32, height)).into_drawing_area();
    area.fill(&WHITE).expect("the SVG can be written");
    for (area, chart) in area.split_evenly((1, charts.len())).iter().zip(charts) {
        draw_one(area, chart).expect("the chart can be drawn");
    }
    area.present().expect("the SVG can be written");
}

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

fn draw_one<'a>(
    area: &Area<'a>,
    chart: &Chart,
) -> Result<(), DrawingAreaErrorKind<<SVGBackend<'a> as DrawingBackend>::ErrorType>> {
    let Chart { title, x, y, series } = chart;
    let font = ("sans-serif", 15);
    let mut context = ChartBuilder::on(area)
        .margin(12)
        .caption(title, ("sans-serif", 17))
        .x_label_area_size(if x.label.is_empty() { 24 } else { 42 })
        .y_label_area_size(if y.label.is_empty() { 34 } else { 66 })
        .build_cartesian_2d(*x, *y)?;
    context
        .configure_mesh()
        .light_line_style(GRID)
        .bold_line_style(GRID)
        .axis_style(GRID)
        .x_desc(x.label)
        .y_desc(y.label)
        .label_style(font)
        .draw()?;
    for (series, color) in series.iter().zip(COLORS) {
        let points = || series.points.iter().map(|&[a, b]| (a, b));
        if series.line {
            context.draw_series(LineSeries::new(points(), color.stroke_width(2)))?;
        }
        let dots = points().filter(|_| series.dots);
        let dots = context.draw_series(dots.map(|at| Circle::new(at, 3, color.filled())))?;
        if !series.name.is_empty() {
            let sample =
                move |(x, y)| Rectangle::new([(x, y - 2), (x + 16, y + 2)], color.filled());
            dots.label(series.name).legend(sample);
        }
    }
    if series.iter().any(|series| !series.name.is_empty()) {
        context
            .configure_series_labels()
            .position(SeriesLabelPosition::UpperRight)
            .background_style(WHITE.mix(0.9))
            .label_font(font)
            .draw()?;
    }
    Ok(())
}

/// Writes crops of pictures, enlarged so that every pixel is a square, in rows, into a PNG.
///
/// A crop is a picture and the left, top, width and height of what is shown of it.
pub fn crops(name: &str, zoom: u32, rows: &[Vec<(&Picture, [u32; 4])>]) {
    const GAP: u32 = 6;
    let rows: Vec<Vec<RgbImage>> = rows
        .iter()
        .map(|row| row.iter().map(|(picture, crop)| enlarged(picture, *crop, zoom)).collect())
        .collect();
    let width = |row: &Vec<RgbImage>| row.iter().map(|crop| crop.width() + GAP).sum::<u32>() - GAP;
    let height: u32 = rows.iter().map(|row| row[0].height() + GAP).sum::<u32>() - GAP;
    let mut sheet = RgbImage::from_pixel(width(&rows[0]), height, image::Rgb([255; 3]));
    let mut top = 0;
    for row in &rows {
        let mut left = 0;
        for crop in row {
            imageops::replace(&mut sheet, crop, left, top);
            left += i64::from(crop.width() + GAP);
        }
        top += i64::from(row[0].height() + GAP);
    }
    sheet.save(file(name)).expect("the PNG can be written");
}

fn enlarged(picture: &Picture, [left, top, width, height]: [u32; 4], zoom: u32) -> RgbImage {
    let whole = RgbImage::from_raw(picture.width, picture.height, picture.srgb())
        .expect("a picture has three bytes a pixel");
    let crop = imageops::crop_imm(&whole, left, top, width, height).to_image();
    imageops::resize(&crop, width * zoom, height * zoom, imageops::FilterType::Nearest)
}
