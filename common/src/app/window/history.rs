//! The latest device times, and their plot.

use std::collections::VecDeque;

use egui::{Align2, Color32, CornerRadius, FontId, Rect, Sense, Ui, pos2, vec2};

use super::style;

/// Number of stored times, one bar each.
const LENGTH: usize = 96;
const HEIGHT: f32 = 44.0;

/// Milliseconds that full pictures took or would have taken, the newest last.
#[derive(Default)]
pub struct History {
    times: VecDeque<Time>,
}

struct Time {
    milliseconds: f64,
    measured: bool,
}

impl History {
    /// Adds the time of a full picture: measured, or estimated from a smaller one.
    pub fn add(&mut self, milliseconds: f64, measured: bool) {
        if self.times.len() == LENGTH {
            self.times.pop_front();
        }
        self.times.push_back(Time { milliseconds, measured });
    }

    /// Bars from the right, bright for full pictures, with the scale above them.
    pub fn show(&self, ui: &mut Ui) {
        let (response, painter) =
            ui.allocate_painter(vec2(ui.available_width(), HEIGHT), Sense::hover());
        let area = response.rect;
        painter.rect_filled(area, CornerRadius::same(3), style::WELL);
        let top = ceiling(self.times.iter().map(|time| time.milliseconds).fold(0.0, f64::max));
        let bar = area.width() / LENGTH as f32;
        // The upper quarter is reserved for the scale's label.
        let room = area.height() * 0.75;
        for (age, time) in self.times.iter().rev().enumerate() {
            let height = (room * (time.milliseconds / top) as f32).max(1.0);
            let right = area.right() - age as f32 * bar;
            let rect = Rect::from_min_max(
                pos2(right - bar + 0.5, area.bottom() - height),
                pos2(right, area.bottom()),
            );
            let color =
                if time.measured { style::ACCENT } else { style::ACCENT.gamma_multiply(0.45) };
            painter.rect_filled(rect, CornerRadius::ZERO, color);
        }
        let line = area.bottom() - room;
        painter.hline(area.x_range(), line, (1.0, Color32::from_white_alpha(18)));
        let (font, label) = (FontId::proportional(10.0), format!("{top} ms"));
        painter.text(
            pos2(area.left() + 4.0, line - 1.0),
            Align2::LEFT_BOTTOM,
            label,
            font,
            style::DIM,
        );
        response.on_hover_text("GPU time of a full picture; dim: estimated from a smaller one");
    }
}

/// The next of 1, 2, 5, 10, … at or above `milliseconds`.
fn ceiling(milliseconds: f64) -> f64 {
    let power = 10f64.powf(milliseconds.max(0.1).log10().floor());
    let steps = [1.0, 2.0, 5.0, 10.0].map(|step| step * power);
    let found = steps.into_iter().find(|&step| step >= milliseconds).unwrap_or(10.0 * power);
    // Powers below one are not exact, but the label should be.
    (found * 10.0).round() / 10.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scale_is_a_round_number() {
        let expected =
            [(0.0, 0.1), (0.3, 0.5), (1.0, 1.0), (3.0, 5.0), (66.0, 100.0), (325.0, 500.0)];
        for (milliseconds, top) in expected {
            assert_eq!(ceiling(milliseconds), top, "{milliseconds}");
        }
    }

    #[test]
    fn only_the_newest_are_kept() {
        let mut history = History::default();
        (0..LENGTH + 5).for_each(|i| history.add(i as f64, true));
        assert_eq!((history.times.len(), history.times[0].milliseconds), (LENGTH, 5.0));
    }
}
