//! The controls as rows of the panel: a name, and the widget for its value.

use egui::emath::Numeric;
use egui::{ComboBox, DragValue, Grid, Response, Slider, SliderClamping, Ui};
use glam::Vec3;

use super::navigation::Navigation;
use super::{dots, style};
use crate::app::Playback;
use crate::app::chart::Chart;
use crate::app::controls::{Value, Visit};
use crate::scene::Camera;

/// The width of the column of names.
const NAMES: f32 = 96.0;
/// The width of a number beside its slider.
const NUMBER: f32 = 54.0;
/// The width of a row's widgets.
const WIDGETS: f32 = 186.0;

/// A slider with a larger range is logarithmic: otherwise all useful values would be at one end.
const WIDE: f32 = 5000.0;
/// Closer to 0 than this, a logarithmic slider is at 0.
const SMALLEST: f64 = 1e-3;

/// Shows each control as a row and moves the camera; used inside a grid of two columns.
pub struct Rows<'a> {
    /// The place for the rows.
    pub ui: &'a mut Ui,
    /// The camera input.
    pub navigation: &'a mut Navigation,
    /// True if any value has changed.
    pub changed: bool,
}

/// The grid of the rows.
pub fn grid(id: &str) -> Grid {
    Grid::new(id.to_owned()).num_columns(2).min_col_width(NAMES).spacing([10.0, 7.0])
}

impl Visit for Rows<'_> {
    fn visit(&mut self, name: &str, value: Value) -> bool {
        self.ui.colored_label(style::DIM, name);
        let changed = widget(self.ui, name, value);
        self.ui.end_row();
        self.changed |= changed;
        changed
    }

    fn note(&mut self, name: &str, text: &str) {
        self.ui.colored_label(style::DIM, name);
        self.ui.add(egui::Label::new(text).wrap());
        self.ui.end_row();
    }

    fn camera(&mut self, camera: &mut Camera) -> bool {
        let moved = self.navigation.apply(camera);
        let mut degrees = camera.fov_y as f32;
        let zoomed =
            self.visit("field of view", Value::Slider(&mut degrees, Camera::FIELD_OF_VIEW));
        if zoomed {
            camera.fov_y = f64::from(degrees);
        }
        let placed = self.visit("camera eye", Value::Point(&mut camera.eye))
            | self.visit("camera target", Value::Point(&mut camera.target));
        self.changed |= moved;
        moved | zoomed | placed
    }

    fn playback(&mut self, playback: &mut Playback) -> bool {
        let stepped = self.navigation.transport.apply(playback);
        let moved = self.visit("frame", Value::Integer(&mut playback.frame, 0..=playback.last));
        self.ui.label("");
        self.navigation.transport.buttons(self.ui, playback);
        self.ui.end_row();
        self.changed |= stepped;
        stepped | moved
    }

    fn chart(&mut self, chart: &Chart) {
        self.ui.colored_label(style::DIM, chart.name);
        dots::show(self.ui, chart, WIDGETS);
        self.ui.end_row();
    }
}

/// Navigation while the panel is hidden.
pub struct Hidden<'a> {
    /// The camera input.
    pub navigation: &'a mut Navigation,
    /// True if the camera has moved.
    pub changed: bool,
}

impl<'a> Hidden<'a> {
    /// No movement yet.
    pub fn new(navigation: &'a mut Navigation) -> Self {
        Self { navigation, changed: false }
    }
}

impl Visit for Hidden<'_> {
    fn visit(&mut self, _: &str, _: Value) -> bool {
        false
    }

    fn playback(&mut self, playback: &mut Playback) -> bool {
        let moved = self.navigation.transport.apply(playback);
        self.changed |= moved;
        moved
    }

    fn camera(&mut self, camera: &mut Camera) -> bool {
        let moved = self.navigation.apply(camera);
        self.changed |= moved;
        moved
    }
}

/// Shows a value; returns true if it was changed.
fn widget(ui: &mut Ui, name: &str, value: Value) -> bool {
    // The number beside a slider has a fixed width, so that the rows are aligned.
    ui.spacing_mut().interact_size.x = NUMBER;
    ui.spacing_mut().slider_width = WIDGETS - NUMBER - ui.spacing().item_spacing.x;
    match value {
        Value::Slider(number, range) => {
            let before = *number;
            let decimals = decimals(before, range.end() - range.start());
            let wide = range.end() - range.start() > WIDE;
            let slider = Slider::new(number, range).logarithmic(wide).smallest_positive(SMALLEST);
            let slider = slider.fixed_decimals(decimals);
            name_it(&ui.add(shown_as_is(slider)), name);
            *number != before
        }
        Value::Integer(number, range) => {
            let before = *number;
            let wide = (range.end() - range.start()) as f32 > WIDE;
            let slider = Slider::new(number, range).logarithmic(wide);
            name_it(&ui.add(shown_as_is(slider)), name);
            *number != before
        }
        Value::Checkbox(on) => {
            let before = *on;
            name_it(&ui.checkbox(on, ""), name);
            *on != before
        }
        Value::Color(color) => {
            let before = *color;
            name_it(&ui.color_edit_button_rgb(color.as_mut()), name);
            *color != before
        }
        Value::Choice(position, options) => {
            let before = *position;
            let shown = options.get(before as usize).copied().unwrap_or_default();
            let list = ComboBox::from_id_salt(name).width(WIDGETS).selected_text(shown);
            let response = list.show_ui(ui, |ui| {
                for (index, option) in options.iter().enumerate() {
                    ui.selectable_value(position, index as u32, *option);
                }
            });
            name_it(&response.response, name);
            *position != before
        }
        Value::Vector(vector, range) => {
            let before = *vector;
            let speed = (range.end() - range.start()) * 0.005;
            three(ui, name, vector.as_mut(), |drag| drag.range(range.clone()).speed(speed));
            *vector != before
        }
        Value::Direction(vector, range) => {
            let before = *vector;
            widget(ui, name, Value::Vector(vector, range));
            // Dragged through 0, it keeps its last direction.
            if *vector == Vec3::ZERO {
                *vector = before;
            }
            *vector != before
        }
        Value::Point(point) => {
            let before = *point;
            let speed = (point.length() * 0.005).max(1e-3);
            three(ui, name, point.as_mut(), |drag| drag.speed(speed).fixed_decimals(2));
            *point != before
        }
    }
}

/// Number of decimals for a number: three digits of the range's width, and at least two significant digits of the
/// number, because a small one would otherwise be shown as 0.
fn decimals(number: f32, width: f32) -> usize {
    let exponent = |value: f32| value.abs().log10().floor();
    let own = if number == 0.0 { 0.0 } else { 1.0 - exponent(number) };
    own.max(2.0 - exponent(width)).clamp(0.0, 6.0) as usize
}

/// A slider that rounds and clamps values dragged and typed, but not those set by a script.
fn shown_as_is(slider: Slider) -> Slider {
    slider.clamping(SliderClamping::Edits)
}

/// Three numbers side by side.
fn three<N: Numeric>(
    ui: &mut Ui,
    name: &str,
    parts: &mut [N; 3],
    shaped: impl Fn(DragValue) -> DragValue,
) {
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        for (part, axis) in parts.iter_mut().zip(["x", "y", "z"]) {
            let size = [(WIDGETS - 8.0) / 3.0, ui.spacing().interact_size.y];
            let response = ui.add_sized(size, shaped(DragValue::new(part)));
            name_it(&response, &format!("{name} {axis}"));
        }
    });
}

/// Gives screen readers and tests the name of a widget.
fn name_it(response: &Response, name: &str) {
    response.ctx.accesskit_node_builder(response.id, |node| node.set_label(name));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_small_number_does_not_read_as_zero() {
        assert_eq!(decimals(20.0, 90.0), 1);
        assert_eq!(decimals(0.0, 1.0), 2);
        assert_eq!(decimals(0.4, 1.0), 2);
        assert_eq!(decimals(1.0 / 512.0, 1.0), 4);
        assert_eq!(decimals(2.5, 2e6), 1);
        assert_eq!(decimals(-1e-30, 1.0), 6);
    }
}
