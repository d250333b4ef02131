//! Charts and labelled panels for the pages.
//!
//! A chapter draws in tests that are ignored by default: they have the built program, its pictures and the
//! CPU's copy of the mathematics, and a user who only runs a sample need not build a plotting library.

use std::fs;
use std::ops::Range;
use std::path::PathBuf;

use common::app::Picture;
use image::{RgbImage, imageops};
use panels::{Panel, sheet};
use plotters::coord::Shift;
use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, ValueFormatter};
use plotters::prelude::*;
use plotters::style::{FontStyle, register_font};

use super::root;

/// Colours that the colour-blind can tell apart (Okabe and Ito 2008), two of them darker, so that all have
/// contrast on white. `drawings::INKS` has the dark scheme.
const COLORS: [RGBColor; 5] = [
    RGBColor(60, 60, 60),
    RGBColor(200, 122, 0),
    RGBColor(0, 114, 178),
    RGBColor(0, 158, 115),
    RGBColor(196, 107, 157),
];
const GRID: RGBColor = RGBColor(225, 225, 225);
/// A line from a dot to its name.
const LEADER: RGBColor = RGBColor(140, 140, 140);
/// The font for the names of dots.
const SMALL: (&str, i32) = ("sans-serif", 15);

/// A chart: two axes and the series drawn between them.
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

/// Points of one series; a series without a name is not in the legend.
#[derive(Default)]
pub struct Series<'a> {
    pub name: &'a str,
    pub points: Vec<[f64; 2]>,
    /// Labels of the points, if each has its own name.
    pub names: Vec<&'a str>,
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
    // An SVG contains text, but its width is only known from a font.
    register_font("sans-serif", FontStyle::Normal, epaint_default_fonts::UBUNTU_LIGHT)
        .unwrap_or_else(|_| panic!("the font of the panel is no font"));
    let area = SVGBackend::new(&path, (width * charts.len() as u32, height)).into_drawing_area();
    area.fill(&WHITE).expect("the SVG can be written");
    for (area, chart) in area.split_evenly((1, charts.len())).iter().zip(charts) {
        draw_one(area, chart).expect("the chart can be drawn");
    }
    area.present().expect("the SVG can be written");
    drop(area);
    let themed = fs::read_to_string(&path).map(|text| drawings::themed(&text));
    let themed =
        themed.expect("the SVG can be read").unwrap_or_else(|what| panic!("{name}: {what}"));
    fs::write(&path, themed).expect("the SVG can be written");
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
        // Half of the last number extends beyond the axis.
        .margin_right(24)
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
    let (columns, rows) = area.get_pixel_range();
    let origin = (columns.start, rows.start);
    for (series, color) in series.iter().zip(COLORS) {
        let points = || series.points.iter().map(|&[a, b]| (a, b));
        if series.line {
            context.draw_series(LineSeries::new(points(), color.stroke_width(2)))?;
        }
        let places: Vec<_> = points().map(|at| context.backend_coord(&at)).collect();
        let corners = beside(&places, &series.names, context.plotting_area().get_pixel_range());
        for ((&name, &dot), corner) in series.names.iter().zip(&places).zip(corners) {
            let style = TextStyle::from(SMALL).color(&color);
            let here = |(x, y): (i32, i32)| (x - origin.0, y - origin.1);
            if let Some(near) = leader(dot, corner, name) {
                let line = vec![here(dot), here(near)];
                area.draw(&PathElement::new(line, LEADER))?;
            }
            area.draw_text(name, &style, here(corner))?;
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
            .position(free_corner(chart))
            .background_style(WHITE.mix(0.9))
            .label_font(font)
            .draw()?;
    }
    Ok(())
}

/// The corner where the legend hides no point, preferably the upper right one.
fn free_corner(Chart { x, y, series, .. }: &Chart) -> SeriesLabelPosition {
    let part = |axis: &Axis, value: f64| {
        let Range { start, end } = axis.range();
        let [start, value, end] = [start, value, end].map(|value| axis.place(value));
        (value - start) / (end - start)
    };
    let is_free = |corner: fn([f64; 2]) -> bool| {
        let points = series.iter().flat_map(|series| &series.points);
        !points.into_iter().any(|&[a, b]| corner([part(x, a), part(y, b)]))
    };
    let upper_right = is_free(|[right, up]| right > 0.35 && up > 0.68);
    if !upper_right && is_free(|[right, up]| right < 0.65 && up < 0.32) {
        SeriesLabelPosition::LowerLeft
    } else {
        SeriesLabelPosition::UpperRight
    }
}

/// The top left corners of names near their dots, not covering a dot or another name and inside `area` if
/// there is room; places close to the dot are tried first.
fn beside(dots: &[(i32, i32)], names: &[&str], area: (Range<i32>, Range<i32>)) -> Vec<(i32, i32)> {
    let font = FontDesc::from(SMALL);
    let mut taken: Vec<[i32; 4]> = dots.iter().map(|(x, y)| [x - 4, y - 4, x + 4, y + 4]).collect();
    let mut corners = Vec::new();
    for (name, (x, y)) in names.iter().zip(dots) {
        let (width, height) = font.box_size(name).expect("a font that is registered");
        let (width, height) = (width as i32, height as i32);
        let places = (0..12).flat_map(|ring: i32| {
            let steps = move || (-ring..=ring).map(|step| 8 * step);
            let ends = [-8 * ring, 8 * ring];
            let aside = steps().flat_map(move |up| ends.map(|right| (right, up)));
            let above = steps().flat_map(move |right| ends.map(|up| (right, up)));
            let corner = move |(right, up): (i32, i32)| {
                let left = match right.signum() {
                    0 if ring > 1 => x - width / 2,
                    -1 => x - 7 - width + right,
                    _ => x + 7 + right,
                };
                (left, y - height / 2 + up)
            };
            let beside = [(x + 7, y - height / 2), (x - 7 - width, y - height / 2)];
            beside.into_iter().chain(aside.chain(above).map(corner))
        });
        let free = |&(left, top): &(i32, i32)| {
            let [right, bottom] = [left + width, top + height];
            let is_inside = area.0.contains(&left) && area.0.contains(&right);
            is_inside
                && (area.1.contains(&top) && area.1.contains(&bottom))
                && !taken.iter().any(|b| left < b[2] && b[0] < right && top < b[3] && b[1] < bottom)
        };
        let corner = places.clone().find(free).unwrap_or((x + 7, y - height / 2));
        // A little more, so that two names do not run together.
        taken.push([corner.0 - 6, corner.1, corner.0 + width + 6, corner.1 + height]);
        corners.push(corner);
    }
    corners
}

/// The place of a box closest to a point, and whether it is far enough away to need a line.
fn leader((x, y): (i32, i32), (left, top): (i32, i32), name: &str) -> Option<(i32, i32)> {
    let (width, height) = FontDesc::from(SMALL).box_size(name).ok()?;
    let near = (x.clamp(left - 2, left + width as i32 + 2), y.clamp(top, top + height as i32));
    let far = (near.0 - x).pow(2) + (near.1 - y).pow(2) > 10 * 10;
    far.then_some(near)
}

/// A picture, or a part of it, under a label.
pub struct Shown<'a> {
    pub label: String,
    pub picture: &'a Picture,
    /// Left, top, width and height in pixels: the same width and height for all pictures drawn together.
    pub area: [u32; 4],
}

impl<'a> Shown<'a> {
    /// A row of whole pictures.
    pub fn row(pictures: &'a [(String, Picture)]) -> Vec<Self> {
        let whole = |(label, picture): &'a (String, Picture)| {
            let area = [0, 0, picture.width, picture.height];
            Self { label: label.clone(), picture, area }
        };
        pictures.iter().map(whole).collect()
    }
}

/// Draws pictures in rows, each pixel enlarged to a square of `zoom` by `zoom`, into a PNG in `docs/images`.
pub fn draw_panels(name: &str, zoom: u32, rows: &[Vec<Shown>]) {
    let [_, _, width, height] = rows[0][0].area;
    let panel = |shown: &Shown| {
        let crop = enlarged(shown.picture, shown.area, zoom);
        assert_eq!(shown.area[2..], [width, height], "{}", shown.label);
        (shown.label.clone(), Panel::Picture(crop))
    };
    let rows: Vec<Vec<_>> = rows.iter().map(|row| row.iter().map(panel).collect()).collect();
    let sheet = sheet((width * zoom, height * zoom), &rows);
    let sheet = sheet.unwrap_or_else(|error| panic!("{name}: {error}"));
    sheet.save(file(name)).expect("the PNG can be written");
}

fn enlarged(picture: &Picture, [left, top, width, height]: [u32; 4], zoom: u32) -> RgbImage {
    let whole = RgbImage::from_raw(picture.width, picture.height, picture.srgb())
        .expect("a picture has three bytes per pixel");
    let crop = imageops::crop_imm(&whole, left, top, width, height).to_image();
    imageops::resize(&crop, width * zoom, height * zoom, imageops::FilterType::Nearest)
}
