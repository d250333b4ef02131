//! A drawing that is SVG for pages and PNG for talks, and what all drawings share.

use anyhow::{Context, Result, anyhow};
use plotters::coord::Shift;
use plotters::coord::combinators::{LogCoord, WithKeyPoints};
use plotters::prelude::*;
use plotters::style::{FontStyle, TextStyle, register_font};

// Colours that the colour-blind can tell apart (Okabe and Ito 2008).
pub const BLUE: RGBColor = RGBColor(0, 114, 178);
pub const ORANGE: RGBColor = RGBColor(230, 159, 0);
pub const GRID: RGBColor = RGBColor(228, 228, 228);
pub const TEXT: RGBColor = RGBColor(40, 40, 40);

/// The result of drawing on a backend.
pub type Drawn<B> = Result<(), DrawingAreaErrorKind<<B as DrawingBackend>::ErrorType>>;

/// Something that can be drawn at any scale.
pub trait Drawing {
    /// Width and height in units, which are the pixels of the SVG.
    fn size(&self) -> (u32, u32);

    /// Draws on a white area of `scale` pixels a unit.
    fn draw<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>, scale: u32) -> Drawn<B>;

    /// As SVG.
    ///
    /// # Errors
    /// If it cannot be drawn.
    fn svg(&self) -> Result<String> {
        let mut text = String::new();
        self.present(&SVGBackend::with_string(&mut text, self.size()).into_drawing_area(), 1)?;
        Ok(text)
    }

    /// As PNG, twice as large.
    ///
    /// # Errors
    /// If it cannot be drawn or encoded.
    fn png(&self) -> Result<Vec<u8>> {
        let scale = 2;
        let (width, height) = (self.size().0 * scale, self.size().1 * scale);
        let mut pixels = vec![0; 3 * width as usize * height as usize];
        let canvas = BitMapBackend::with_buffer(&mut pixels, (width, height)).into_drawing_area();
        self.present(&canvas, scale)?;
        drop(canvas);
        let image =
            image::RgbImage::from_raw(width, height, pixels).context("the size is right")?;
        let mut bytes = std::io::Cursor::new(Vec::new());
        image.write_to(&mut bytes, image::ImageFormat::Png)?;
        Ok(bytes.into_inner())
    }

    /// Draws on white, in the panel's own font.
    ///
    /// # Errors
    /// If it cannot be drawn.
    fn present<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>, scale: u32) -> Result<()> {
        register_font("sans-serif", FontStyle::Normal, epaint_default_fonts::UBUNTU_LIGHT)
            .map_err(|_| anyhow!("the plot's font cannot be read"))?;
        area.fill(&WHITE)
            .and_then(|()| self.draw(area, scale))
            .and_then(|()| area.present())
            .map_err(|error| anyhow!("cannot draw the plot: {error}"))
    }
}

/// The font of all words.
pub fn font(size: u32) -> TextStyle<'static> {
    ("sans-serif", size).into_font().color(&TEXT)
}

/// A title, and lines that say how to read what is below.
pub fn head<B: DrawingBackend>(
    area: &DrawingArea<B, Shift>,
    scale: u32,
    title: &str,
    lines: &[&str],
) -> Drawn<B> {
    let at = |y: u32| (16 * scale as i32, (y * scale) as i32);
    area.draw_text(title, &font(20 * scale), at(10))?;
    for (line, y) in lines.iter().zip((38..).step_by(22)) {
        area.draw_text(line, &font(15 * scale), at(y))?;
    }
    Ok(())
}

/// Offsets of the labels: to the right of each dot, as near as other dots, other labels and the axis at `bottom`
/// leave room. All in pixels, y downwards.
pub fn label_offsets(dots: &[(f64, f64)], bottom: f64) -> Vec<(i32, i32)> {
    let places = (0..20).flat_map(|x| (-28..12).map(move |y| (10 + 4 * x, -6 + 4 * y)));
    let mut places: Vec<(i32, i32)> = places.collect();
    places.sort_by_key(|(x, y)| x * x + (y + 6) * (y + 6));
    let mut taken: Vec<(f64, f64)> = Vec::new();
    let mut offsets = Vec::new();
    for &(x, y) in dots {
        let free = |(dx, dy): (i32, i32)| {
            let (left, top) = (x + f64::from(dx), y + f64::from(dy));
            let is_off_labels =
                taken.iter().all(|&(a, b)| (a - left).abs() >= 30.0 || (b - top).abs() >= 16.0);
            // A label is some 26 wide and 14 high, and a dot 5 around.
            let is_off_dots = dots.iter().all(|&(a, b)| {
                a < left - 4.0 || a > left + 30.0 || b < top - 16.0 || b > top + 8.0
            });
            is_off_labels && is_off_dots && top + 4.0 < bottom
        };
        let place = places.iter().copied().find(|&place| free(place)).unwrap_or((10, -6));
        taken.push((x + f64::from(place.0), y + f64::from(place.1)));
        offsets.push(place);
    }
    offsets
}

/// A dot's name at an offset from it, with a line that leads there.
pub fn label<B: DrawingBackend>(
    chart: &mut ChartContext<B, LogLog>,
    scale: u32,
    dot: (f64, f64),
    name: &str,
    offset: (i32, i32),
) -> Drawn<B> {
    let (x, y) = (offset.0 * scale as i32, offset.1 * scale as i32);
    let label = EmptyElement::at(dot)
        + PathElement::new(vec![(0, 0), (x, y)], TEXT.mix(0.25).stroke_width(scale))
        + Text::new(name.to_owned(), (x + 2, y - 12 * scale as i32), font(16 * scale));
    chart.draw_series([label])?;
    Ok(())
}

/// Two logarithmic axes with labels of our own.
type LogLog = Cartesian2d<Axis, Axis>;
type Axis = WithKeyPoints<LogCoord<f64>>;
