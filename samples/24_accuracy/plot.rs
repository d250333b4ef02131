//! Time against error, one panel a primitive.

use plotters::coord::Shift;
use plotters::prelude::*;

use crate::drawing::{self, BLUE, Drawing, Drawn, GRID, ORANGE, font};
use crate::ladder::Primitive;
use crate::measurement::{Errors, MeasuredRung, Measurement};

const PANEL: (u32, u32) = (400, 360);
const COLUMNS: usize = 4;
/// Pixels above the panels.
const HEAD: u32 = 92;
const FRONT: RGBColor = BLUE;
const BESIDE: RGBColor = ORANGE;

/// The panels of a measurement.
pub struct Plot<'a> {
    title: String,
    panels: Vec<Panel<'a>>,
}

struct Panel<'a> {
    primitive: &'static str,
    points: Vec<Point<'a>>,
}

/// One rung.
struct Point<'a> {
    row: &'a MeasuredRung,
    /// Time over the cheapest rung's.
    time: f64,
    /// On the home family: 99 of 100 rays are at least as good.
    home: f64,
    /// The same on the family where the rung is worst.
    worst: f64,
    is_on_front: bool,
}

/// More than one ray in a hundred is a false hit or a false miss: no error is as large.
const WRONG: f64 = 1e9;
const LEAST: f64 = 0.2;

/// 99 of 100 rays are at least as good. A false hit or miss is as bad as can be.
fn p99(errors: &Errors) -> f64 {
    if 100 * errors.wrong() > errors.rays { WRONG } else { errors.p99.clamp(LEAST, WRONG / 3.0) }
}

impl<'a> Plot<'a> {
    /// `None` without times.
    pub fn new(measurement: &'a Measurement) -> Option<Self> {
        let mut panels: Vec<Panel> = Vec::new();
        for row in &measurement.rungs {
            let Some(time) = row.time else { continue };
            // A ray that leaves a surface has no error but hit or miss: that is a table, not a plot.
            if row.primitive == Primitive::SecondaryOrigin.name() {
                continue;
            }
            let mut errors = row.errors.iter().filter(|errors| errors.way == "direct").map(p99);
            let home = errors.next().unwrap_or(LEAST);
            let worst = errors.fold(home, f64::max);
            let point = Point { row, time: time.ratio.median, home, worst, is_on_front: false };
            match panels.last_mut().filter(|panel| panel.primitive == row.primitive) {
                Some(panel) => panel.points.push(point),
                None => panels.push(Panel { primitive: row.primitive, points: vec![point] }),
            }
        }
        for panel in &mut panels {
            panel.find_front();
        }
        let title = format!(
            "What accuracy costs · {} · {} · {}",
            measurement.device, measurement.driver, measurement.date
        );
        (!panels.is_empty()).then_some(Self { title, panels })
    }
}

impl Drawing for Plot<'_> {
    fn size(&self) -> (u32, u32) {
        let rows = self.panels.len().div_ceil(COLUMNS) as u32;
        (PANEL.0 * COLUMNS as u32, PANEL.1 * rows + HEAD)
    }

    fn draw<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>, scale: u32) -> Drawn<B> {
        let (head, body) = area.split_vertically(HEAD * scale);
        let lines = [
            "Right is slower, up is worse. A dot: 99 of 100 rays of the home family are at least as good. \
             The line ends where they are on the hardest family.",
            "Blue: no other rung is both faster and better at home (Pareto front). At the top, more than \
             one ray in a hundred is a false hit or a false miss.",
        ];
        drawing::head(&head, scale, &self.title, &lines)?;
        let rows = self.panels.len().div_ceil(COLUMNS);
        for (panel, area) in self.panels.iter().zip(body.split_evenly((rows, COLUMNS))) {
            panel.draw(&area, scale)?;
        }
        Ok(())
    }
}

/// Labels of the time axis.
const TICKS: [f64; 9] = [1.0, 1.5, 2.0, 3.0, 5.0, 7.0, 10.0, 20.0, 50.0];

impl Panel<'_> {
    fn find_front(&mut self) {
        for i in 0..self.points.len() {
            let (time, home) = (self.points[i].time, self.points[i].home);
            self.points[i].is_on_front = self.points.iter().all(|other| {
                let better = other.home < home && other.time <= time
                    || other.home <= home && other.time < time;
                !better
            });
        }
    }

    fn draw<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>, scale: u32) -> Drawn<B> {
        let font = |size: u32| font(size * scale);
        let slowest = self.points.iter().map(|point| point.time).fold(2.0, f64::max);
        // A tick beyond the axis would be drawn all the same.
        let ticks = TICKS.into_iter().filter(|&tick| tick < slowest * 1.4).collect();
        let times = (0.85..slowest * 1.4).log_scale().with_key_points(ticks);
        let ticks = vec![1.0, 10.0, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, WRONG];
        let errors = (0.12..WRONG * 3.0).log_scale().with_key_points(ticks);
        let mut chart = ChartBuilder::on(area)
            .margin(12 * scale)
            .caption(self.primitive, font(20))
            .x_label_area_size(40 * scale)
            .y_label_area_size(66 * scale)
            .build_cartesian_2d(times, errors)?;
        let label = |y: &f64| match *y {
            y if y >= WRONG => "wrong".to_owned(),
            y if y >= 1000.0 => format!("1e{:.0}", y.log10()),
            y => format!("{y}"),
        };
        chart
            .configure_mesh()
            .bold_line_style(GRID)
            .light_line_style(TRANSPARENT)
            .axis_style(GRID)
            .label_style(font(14))
            .axis_desc_style(font(14))
            .x_desc("time over the cheapest")
            .y_desc("error of t, ULP")
            .y_label_formatter(&label)
            .x_label_formatter(&|x| format!("{x}"))
            .draw()?;
        let mut front: Vec<_> = self.points.iter().filter(|point| point.is_on_front).collect();
        front.sort_by(|a, b| a.time.total_cmp(&b.time));
        let steps = front.iter().map(|point| (point.time, point.home));
        chart.draw_series(LineSeries::new(steps, FRONT.mix(0.4).stroke_width(2 * scale)))?;
        for point in &self.points {
            let color = if point.is_on_front { FRONT } else { BESIDE };
            let Point { time, home, worst, .. } = *point;
            chart.draw_series(LineSeries::new(
                [(time, home), (time, worst)],
                color.mix(0.55).stroke_width(2 * scale),
            ))?;
            chart.draw_series([Circle::new((time, home), 5 * scale, color.filled())])?;
            if worst > home {
                let end = EmptyElement::at((time, worst))
                    + PathElement::new(
                        vec![(-4 * scale as i32, 0), (4 * scale as i32, 0)],
                        color.mix(0.8).stroke_width(2 * scale),
                    );
                chart.draw_series([end])?;
            }
        }
        let (width, height) = (f64::from(PANEL.0 - 90), f64::from(PANEL.1 - 100));
        let across = width / (slowest * 1.4 / 0.85).ln();
        let up = height / (WRONG * 3.0 / 0.12).ln();
        let dots = self.points.iter().map(|p| (across * p.time.ln(), -up * p.home.ln()));
        let offsets = drawing::label_offsets(&dots.collect::<Vec<_>>(), -up * 0.12f64.ln());
        for (point, offset) in self.points.iter().zip(offsets) {
            drawing::label(&mut chart, scale, (point.time, point.home), point.row.rung, offset)?;
        }
        Ok(())
    }
}
