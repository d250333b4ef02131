//! MeasuredRung time against the compiler's estimate, one panel a primitive.

use plotters::coord::Shift;
use plotters::prelude::*;

use crate::compiled::{DISAGREE, Pair, SHOWN};
use crate::drawing::{self, BLUE, Drawing, Drawn, GRID, ORANGE, TEXT, font};
use crate::measurement::{MeasuredRung, Measurement};

const PANEL: (u32, u32) = (320, 330);
const COLUMNS: usize = 5;
/// Pixels above the panels.
const HEAD: u32 = 114;
/// Labels of both axes.
const TICKS: [f64; 9] = [1.0, 1.5, 2.0, 3.0, 5.0, 10.0, 20.0, 50.0, 100.0];

/// The panels of a measurement.
pub struct Disagreement<'a> {
    title: String,
    compiler: &'a str,
    panels: Vec<Panel<'a>>,
}

struct Panel<'a> {
    primitive: &'static str,
    points: Vec<Point<'a>>,
}

struct Point<'a> {
    row: &'a MeasuredRung,
    /// MeasuredRung and estimated, each over the cheapest rung's.
    at: (f64, f64),
    /// The least and the most that a family's estimate is.
    span: (f64, f64),
    agrees: bool,
}

impl<'a> Disagreement<'a> {
    /// `None` without times, or without a compiler.
    pub fn new(measurement: &'a Measurement) -> Option<Self> {
        let mut panels: Vec<Panel> = Vec::new();
        for pair in measurement.pairs() {
            let agrees = pair.apart() <= DISAGREE;
            let Pair { row, time, estimate } = pair;
            let all = row.compiled_for.iter().map(|compiled| compiled.ratio);
            let span = (all.clone().fold(f64::INFINITY, f64::min), all.fold(0.0, f64::max));
            let point = Point { row, at: (time, estimate), span, agrees };
            match panels.last_mut().filter(|panel| panel.primitive == row.primitive) {
                Some(panel) => panel.points.push(point),
                None => panels.push(Panel { primitive: row.primitive, points: vec![point] }),
            }
        }
        let Measurement { device, date, .. } = measurement;
        let title = format!(
            "Time measured here against throughput estimated for AMD GPUs · {device} · {date}"
        );
        let compiler = measurement.compiler.as_deref()?;
        (!panels.is_empty()).then_some(Self { title, compiler, panels })
    }
}

impl Drawing for Disagreement<'_> {
    fn size(&self) -> (u32, u32) {
        let rows = self.panels.len().div_ceil(COLUMNS) as u32;
        (PANEL.0 * COLUMNS as u32, PANEL.1 * rows + HEAD)
    }

    fn draw<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>, scale: u32) -> Drawn<B> {
        let (head, body) = area.split_vertically(HEAD * scale);
        let compiler = self.compiler;
        let lines = [
            format!(
                "Right: time over the cheapest rung, measured on this device. Up: inverse throughput over \
                 the cheapest, as {compiler} estimates it for AMD GPUs; no time."
            ),
            format!(
                "A dot: {SHOWN}. Its line spans navi21, navi31 and gfx1201. On the diagonal both say the \
                 same; above it, the rung would be dearer on such a GPU than it is here."
            ),
            format!("Orange: the two are more than {DISAGREE} times apart."),
        ];
        let lines = lines.each_ref().map(String::as_str);
        drawing::head(&head, scale, &self.title, &lines)?;
        let rows = self.panels.len().div_ceil(COLUMNS);
        for (panel, area) in self.panels.iter().zip(body.split_evenly((rows, COLUMNS))) {
            panel.draw(&area, scale)?;
        }
        Ok(())
    }
}

impl Panel<'_> {
    /// Both axes end here, so that the diagonal is one.
    fn most(&self) -> f64 {
        let all = self.points.iter().map(|point| point.at.0.max(point.span.1));
        1.7 * all.fold(2.0, f64::max)
    }

    fn draw<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>, scale: u32) -> Drawn<B> {
        let font = |size: u32| font(size * scale);
        let (least, most) = (0.8, self.most());
        // A tick beyond the axis would be drawn all the same.
        let crowded = |tick: f64| most > 8.0 && [1.5, 3.0].contains(&tick);
        let ticks: Vec<f64> =
            TICKS.into_iter().filter(|&tick| tick < most && !crowded(tick)).collect();
        let axis = || (least..most).log_scale().with_key_points(ticks.clone());
        let mut chart = ChartBuilder::on(area)
            .margin(12 * scale)
            .caption(self.primitive, font(20))
            .x_label_area_size(40 * scale)
            .y_label_area_size(56 * scale)
            .build_cartesian_2d(axis(), axis())?;
        chart
            .configure_mesh()
            .bold_line_style(GRID)
            .light_line_style(TRANSPARENT)
            .axis_style(GRID)
            .label_style(font(14))
            .axis_desc_style(font(14))
            .x_desc("time, measured")
            .y_desc("inverse throughput, estimated")
            .x_label_formatter(&|x| format!("{x}"))
            .y_label_formatter(&|y| format!("{y}"))
            .draw()?;
        let diagonal = [(least, least), (most, most)];
        chart.draw_series(LineSeries::new(diagonal, TEXT.mix(0.35).stroke_width(scale)))?;
        for Point { at, span, agrees, .. } in &self.points {
            let color = if *agrees { BLUE } else { ORANGE };
            let line = [(at.0, span.0), (at.0, span.1)];
            chart.draw_series(LineSeries::new(line, color.mix(0.55).stroke_width(2 * scale)))?;
            chart.draw_series([Circle::new(*at, 5 * scale, color.filled())])?;
        }
        let (width, height) = (f64::from(PANEL.0 - 80), f64::from(PANEL.1 - 94));
        let whole = (most / least).ln();
        let dots = self
            .points
            .iter()
            .map(|Point { at, .. }| (width / whole * at.0.ln(), -height / whole * at.1.ln()));
        let offsets =
            drawing::label_offsets(&dots.collect::<Vec<_>>(), -height / whole * least.ln());
        for (point, offset) in self.points.iter().zip(offsets) {
            drawing::label(&mut chart, scale, point.at, point.row.rung, offset)?;
        }
        Ok(())
    }
}
