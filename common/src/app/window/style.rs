//! The panel's look: dark, quiet, one accent.

use egui::{
    Color32, Context, CornerRadius, FontFamily, FontId, Frame, Margin, Stroke, TextStyle, Visuals,
    vec2,
};

/// Background of the panel's own strip of the window: linear red, green, blue, alpha.
pub const BEHIND: [f32; 4] = [0.009, 0.009, 0.011, 1.0];

/// Colour of settings and measurements.
pub const ACCENT: Color32 = Color32::from_rgb(214, 168, 92);
/// Colour of explanations.
pub const DIM: Color32 = Color32::from_rgb(146, 150, 158);
/// Colour of main text.
pub const TEXT: Color32 = Color32::from_rgb(222, 224, 228);
/// Colour of errors.
pub const ERROR: Color32 = Color32::from_rgb(240, 110, 100);
/// Behind sliders and plots.
pub const WELL: Color32 = Color32::from_rgb(40, 43, 49);
const FILL: Color32 = Color32::from_rgb(24, 26, 30);

/// Applies the look to every widget.
pub fn apply(context: &Context) {
    context.set_theme(egui::Theme::Dark);
    context.all_styles_mut(|style| {
        let proportional = |size| FontId::new(size, FontFamily::Proportional);
        style.text_styles = [
            (TextStyle::Heading, proportional(17.0)),
            (TextStyle::Body, proportional(13.5)),
            (TextStyle::Button, proportional(13.5)),
            (TextStyle::Small, proportional(11.5)),
            (TextStyle::Monospace, FontId::new(12.0, FontFamily::Monospace)),
        ]
        .into();
        style.spacing.item_spacing = vec2(8.0, 6.0);
        style.spacing.slider_rail_height = 4.0;
        style.interaction.selectable_labels = false;
        let visuals = &mut style.visuals;
        *visuals = Visuals::dark();
        visuals.override_text_color = Some(TEXT);
        visuals.slider_trailing_fill = true;
        visuals.selection.bg_fill = ACCENT.gamma_multiply(0.55);
        visuals.selection.stroke = Stroke::new(1.0, TEXT);
        visuals.window_fill = FILL;
        visuals.panel_fill = FILL;
        visuals.extreme_bg_color = WELL;
        visuals.window_stroke = Stroke::new(1.0, Color32::from_white_alpha(20));
        let widgets = &mut visuals.widgets;
        for state in [&mut widgets.inactive, &mut widgets.hovered, &mut widgets.active] {
            state.corner_radius = CornerRadius::same(3);
        }
        widgets.inactive.bg_fill = Color32::from_rgb(58, 62, 70);
        widgets.inactive.weak_bg_fill = WELL;
        widgets.hovered.weak_bg_fill = Color32::from_rgb(54, 58, 66);
        widgets.noninteractive.bg_stroke = Stroke::new(1.0, Color32::from_white_alpha(16));
    });
}

/// A sheet over the picture.
pub fn sheet() -> Frame {
    Frame::new()
        .fill(FILL.gamma_multiply(0.93))
        .stroke(Stroke::new(1.0, Color32::from_white_alpha(20)))
        .corner_radius(CornerRadius::same(8))
        .inner_margin(Margin::symmetric(14, 12))
}

/// A box for errors.
pub fn warning() -> Frame {
    Frame::new()
        .fill(Color32::from_rgb(58, 24, 24))
        .stroke(Stroke::new(1.0, ERROR.gamma_multiply(0.6)))
        .corner_radius(CornerRadius::same(5))
        .inner_margin(Margin::same(9))
}
