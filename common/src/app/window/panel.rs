//! The panel over the picture: measurements, controls, errors.

use std::time::{Duration, Instant};

use egui::{
    Align, Align2, Area, Button, Context, Event, Id, InputState, Layout, PointerButton, Response,
    RichText, ScrollArea, Sense, Ui,
};

use super::compiler;
use super::facts::{Facts, rays};
use super::history::History;
use super::keys::{self, Ask};
use super::navigation::Navigation;
use super::rows::{self, Hidden, Rows};
use super::style;
use crate::app::Controls;

/// The distance of the panel from the window's edges, and its width unless a name is long.
const MARGIN: f32 = 12.0;
const WIDTH: f32 = 292.0;
/// Windows at least this wide, in points, show the panel beside the picture; in others it covers it.
const WIDE: f32 = 900.0;
/// In windows narrower than this, in points, it would leave little of the picture: there it opens on request.
const NARROW: f32 = 600.0;
/// Time for which a note is shown.
const MOMENT: Duration = Duration::from_secs(4);

/// The result of a frame of the panel.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outcome {
    /// A control has changed or the camera has moved.
    pub changed: bool,
    /// Keys with a command for the window, in order.
    pub asked: Vec<Ask>,
    /// The position at which the picture was clicked with Ctrl held, as fractions of its width and height.
    pub clicked: Option<[f32; 2]>,
}

impl Outcome {
    /// Adds the results of another pass over the same frame.
    pub fn merge(&mut self, other: Self) {
        self.changed |= other.changed;
        self.asked.extend(other.asked);
        self.clicked = other.clicked.or(self.clicked);
    }
}

/// The panel's own state.
pub struct Panel {
    /// Camera navigation.
    pub navigation: Navigation,
    /// The latest device times.
    pub history: History,
    /// The shader error, until it is fixed.
    pub error: Option<String>,
    note: Option<(String, Instant)>,
    /// The user's choice; before that, the width of the window decides.
    shown: Option<bool>,
    help: bool,
    width: f32,
    /// The bottom of the panel in the last frame, including its margin, in points.
    end: f32,
}

impl Panel {
    /// The panel of the chapter `name`.
    pub fn new(name: &str) -> Self {
        Self {
            navigation: Navigation::new(name),
            history: History::default(),
            error: None,
            note: None,
            shown: None,
            help: false,
            width: WIDTH,
            end: 0.0,
        }
    }

    /// Width of the strip that belongs to the panel, in points: the picture is to the right of it.
    pub fn strip(&self, window: f32) -> f32 {
        if self.is_shown(window) && window >= WIDE { self.end } else { 0.0 }
    }

    fn is_shown(&self, window: f32) -> bool {
        self.shown.unwrap_or(window >= NARROW)
    }

    /// Shows a message for a moment, such as the name of a written file.
    pub fn tell(&mut self, note: String) {
        self.note = Some((note, Instant::now() + MOMENT));
    }

    /// One frame: reads keys and drags, shows everything, and lets `declare` show the controls.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        facts: &Facts,
        declare: &mut dyn FnMut(&mut Controls),
    ) -> Outcome {
        let context = ui.ctx().clone();
        let mut outcome = Outcome::default();
        let mut place = ui.max_rect();
        let window = place.width();
        place.min.x += self.strip(window);
        let picture = ui.interact(place, Id::new("picture"), Sense::drag());
        context.input(|input| self.navigation.drag(&picture, input));
        outcome.clicked = context.input(|input| clicked(&picture, input));
        // While a number is being typed, keys are its digits.
        if !context.text_edit_focused() {
            context.input(|input| self.navigation.keys(input));
            context.input_mut(|input| self.navigation.transport.keys(input));
            outcome.asked = keys::asked(&context);
            outcome.asked.retain(|ask| !self.answer(*ask, window));
        }
        let shown = self.is_shown(window);
        outcome.changed = if shown {
            self.sheet(&context, facts, declare)
        } else {
            let mut hidden = Hidden::new(&mut self.navigation);
            declare(&mut Controls::new(&mut hidden));
            hidden.changed
        };
        match (shown, self.shown) {
            (false, _) if self.error.is_some() => self.alone(&context),
            (false, None) => self.folded(&context),
            _ => {}
        }
        if self.help {
            keys::help(&context);
        }
        outcome
    }

    /// Executes a key's command for the panel itself; `false` if it is for the window.
    fn answer(&mut self, ask: Ask, window: f32) -> bool {
        match ask {
            Ask::Help => self.help = !self.help,
            Ask::Panel => self.shown = Some(!self.is_shown(window)),
            Ask::Leave if self.help => self.help = false,
            _ => return false,
        }
        true
    }

    fn sheet(
        &mut self,
        context: &Context,
        facts: &Facts,
        declare: &mut dyn FnMut(&mut Controls),
    ) -> bool {
        // A panel higher than the window scrolls.
        let room = context.content_rect().height() - 2.0 * (MARGIN + 14.0);
        let area = Area::new(Id::new("panel")).anchor(Align2::LEFT_TOP, [MARGIN, MARGIN]);
        let shown = area.show(context, |ui| {
            // Otherwise it would keep the height it had before an error or a control appeared.
            ui.set_max_height(context.content_rect().height());
            style::sheet().show(ui, |ui| {
                ui.set_width(self.width);
                let scroll = ScrollArea::vertical().max_height(room).show(ui, |ui| {
                    self.measured(ui, facts);
                    self.warning(ui);
                    ui.separator();
                    let changed = self.controls(ui, declare);
                    self.footer(ui);
                    changed
                });
                scroll.inner
            })
        });
        self.end = shown.response.rect.right() + MARGIN;
        shown.inner.inner
    }

    fn measured(&self, ui: &mut Ui, facts: &Facts) {
        ui.horizontal(|ui| {
            ui.label(RichText::new(&facts.name).heading());
            if facts.software {
                ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                    let tag = RichText::new("software driver").small().color(style::ACCENT);
                    ui.label(tag).on_hover_text("Traced on the CPU: a graphics card is far faster");
                });
            }
        });
        ui.add(egui::Label::new(RichText::new(&facts.device).small().color(style::DIM)).truncate());
        ui.add_space(2.0);
        let [width, height] = facts.rendered;
        let percent = 100.0 * f64::from(width) / f64::from(facts.full[0].max(1));
        let size = if facts.rendered == facts.full {
            format!("{width} × {height}")
        } else {
            format!("{width} × {height}   {percent:.0} %")
        };
        let mut lines = vec![("GPU time".to_owned(), format!("{:.1} ms", facts.milliseconds))];
        let parts = facts.parts.iter();
        lines.extend(parts.map(|(name, time)| (format!("   {name}"), format!("{time:.2} ms"))));
        lines.push(("primary rays".to_owned(), rays(facts.rays())));
        lines.push(("picture".to_owned(), size));
        let accumulated = facts.accumulated.map(|count| count.to_string());
        lines.extend(accumulated.map(|count| ("accumulated".to_owned(), count)));
        rows::grid("measured").spacing([10.0, 3.0]).show(ui, |ui| {
            for (name, value) in lines {
                ui.colored_label(style::DIM, name);
                ui.label(value);
                ui.end_row();
            }
        });
        for warning in &facts.warnings {
            let text = RichText::new(warning).small().color(style::ERROR);
            ui.add(egui::Label::new(text).wrap().selectable(true));
        }
        ui.add_space(2.0);
        self.history.show(ui);
        compiler::show(ui, &facts.programs);
    }

    fn warning(&self, ui: &mut Ui) {
        let Some(error) = &self.error else { return };
        style::warning().show(ui, |ui| {
            ui.set_width(ui.available_width());
            ui.label(RichText::new("The last good picture stays").small().color(style::ERROR));
            let text = RichText::new(error).monospace();
            ui.add(egui::Label::new(text).wrap().selectable(true));
        });
    }

    /// The button in place of the panel where there is no room, until the user opens it or presses Tab.
    fn folded(&mut self, context: &Context) {
        let area = Area::new(Id::new("folded")).anchor(Align2::LEFT_TOP, [MARGIN / 2.0; 2]);
        area.show(context, |ui| {
            let text = RichText::new("Panel (Tab)").small();
            if ui.add(Button::new(text).fill(style::WELL.gamma_multiply(0.8))).clicked() {
                self.shown = Some(true);
            }
        });
    }

    /// The warning, if there is no panel to show it.
    fn alone(&self, context: &Context) {
        let area = Area::new(Id::new("warning")).anchor(Align2::LEFT_TOP, [MARGIN, MARGIN]);
        area.show(context, |ui| {
            ui.set_width(WIDTH);
            self.warning(ui);
        });
    }

    fn controls(&mut self, ui: &mut Ui, declare: &mut dyn FnMut(&mut Controls)) -> bool {
        let navigation = &mut self.navigation;
        let grid = rows::grid("controls").show(ui, |ui| {
            let mut rows = Rows { ui, navigation, changed: false };
            declare(&mut Controls::new(&mut rows));
            rows.changed
        });
        // The part above the rows ends where they end.
        self.width = grid.response.rect.width().max(WIDTH);
        grid.inner
    }

    fn footer(&self, ui: &mut Ui) {
        ui.separator();
        let now = Instant::now();
        let text = match &self.note {
            Some((note, end)) if now < *end => {
                ui.ctx().request_repaint_after(*end - now);
                note
            }
            _ => "F1 keys · F2 picture · F5 shaders · Tab panel",
        };
        ui.label(RichText::new(text).small().color(style::DIM));
    }
}

/// The position at which the picture is clicked with Ctrl held, as fractions of its width and height.
fn clicked(picture: &Response, input: &InputState) -> Option<[f32; 2]> {
    // The key may have been released by the end of the frame.
    let released = |event: &Event| match event {
        Event::PointerButton { pos, button: PointerButton::Primary, pressed: false, modifiers } => {
            Some(*pos).filter(|_| modifiers.command)
        }
        _ => None,
    };
    let at = input.events.iter().find_map(released);
    let at = at.filter(|_| input.pointer.primary_clicked() && picture.contains_pointer())?;
    let part = (at - picture.rect.min) / picture.rect.size();
    Some([part.x, part.y])
}

#[cfg(test)]
mod tests;
