//! A sample's own plot in the panel.

use egui::{Align2, Color32, CornerRadius, FontId, Painter, Pos2, Rect, Sense, Ui, pos2, vec2};

use super::style;
use crate::app::chart::Chart;

const HEIGHT: f32 = 150.0;
/// Margins on the left and below, for the axes' labels.
const MARGIN: f32 = 26.0;
const GRID: Color32 = Color32::from_rgba_premultiplied(14, 14, 14, 14);

/// Draws a chart of this width.
pub fn show(ui: &mut Ui, chart: &Chart, width: f32) {
    let (response, painter) = ui.allocate_painter(vec2(width, HEIGHT), Sense::hover());
    painter.rect_filled(response.rect, CornerRadius::same(3), style::WELL);
    let area = Rect::from_min_max(
        response.rect.min + vec2(MARGIN, 28.0),
        response.rect.max - vec2(10.0, MARGIN),
    );
    axes(&painter, chart, area, response.rect);
    for dot in &chart.dots {
        let at = place(chart, area, dot.at);
        let color = if dot.is_shown { style::ACCENT } else { style::DIM };
        painter.circle_filled(at, if dot.is_shown { 4.5 } else { 3.0 }, color);
        // Towards the middle, so that no label leaves the plot.
        let (side, align) = if at.x > area.center().x {
            (-6.0, Align2::RIGHT_CENTER)
        } else {
            (6.0, Align2::LEFT_CENTER)
        };
        painter.text(at + vec2(side, -6.0), align, dot.label, FontId::proportional(11.0), color);
    }
    let Chart { x, y, .. } = chart;
    response.on_hover_text(format!("Right: {x}. Up: {y}."));
}

fn place(chart: &Chart, area: Rect, at: [f64; 2]) -> Pos2 {
    let [x, y] = [0, 1].map(|axis| {
        let (low, high) = chart.decades()[axis];
        ((at[axis].log10() - f64::from(low)) / f64::from(high - low)) as f32
    });
    pos2(area.left() + x * area.width(), area.bottom() - y * area.height())
}

fn axes(painter: &Painter, chart: &Chart, area: Rect, sheet: Rect) {
    let font = FontId::proportional(10.0);
    let [(left, right), (low, high)] = chart.decades();
    for exponent in left..=right {
        let x = place(chart, area, [10f64.powi(exponent), 1.0]).x;
        painter.vline(x, area.y_range(), (1.0, GRID));
        let at = pos2(x, area.bottom() + 2.0);
        painter.text(at, Align2::CENTER_TOP, power(exponent), font.clone(), style::DIM);
    }
    // As many labels as there is room for.
    let every = ((high - low) / 4).max(1) as usize;
    for exponent in (low..=high).step_by(every) {
        let y = place(chart, area, [1.0, 10f64.powi(exponent)]).y;
        painter.hline(area.x_range(), y, (1.0, GRID));
        let at = pos2(area.left() - 3.0, y);
        painter.text(at, Align2::RIGHT_CENTER, power(exponent), font.clone(), style::DIM);
    }
    let at = pos2(area.center().x, sheet.bottom() - 1.0);
    painter.text(at, Align2::CENTER_BOTTOM, chart.x, font.clone(), style::DIM);
    let at = pos2(sheet.left() + 4.0, sheet.top() + 3.0);
    painter.text(at, Align2::LEFT_TOP, chart.y, font, style::DIM);
}

fn power(exponent: i32) -> String {
    match exponent {
        -1..=3 => 10f64.powi(exponent).to_string(),
        _ => format!("1e{exponent}"),
    }
}
