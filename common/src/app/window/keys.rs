//! Every key and gesture of the window in one table, which the help overlay shows.

use egui::{Align2, Area, Context, Grid, Id, Key, RichText};

use super::style;

/// A command that a key gives the window.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ask {
    /// Show or hide the help overlay.
    Help,
    /// Write the picture to a file.
    Picture,
    /// Compile the shaders again.
    Reload,
    /// Show or hide the panel.
    Panel,
    /// Close the overlay, else the window.
    Leave,
}

/// The keys with a command for the window.
const ASKS: [(Key, Ask); 8] = [
    (Key::F1, Ask::Help),
    (Key::H, Ask::Help),
    (Key::Questionmark, Ask::Help),
    (Key::F2, Ask::Picture),
    (Key::P, Ask::Picture),
    (Key::F5, Ask::Reload),
    (Key::Tab, Ask::Panel),
    (Key::Escape, Ask::Leave),
];

const CAMERA: [(&str, &str); 9] = [
    ("left drag", "orbit"),
    ("right, middle or Shift drag", "pan"),
    ("wheel", "zoom"),
    ("Ctrl drag", "look around"),
    ("W A S D", "fly"),
    ("Q E", "fly down, up"),
    ("Shift", "fly faster"),
    ("R  Home", "the chapter's camera"),
    ("1 … 9", "bookmark · Ctrl stores"),
];

const WINDOW: [(&str, &str); 8] = [
    ("Space", "play, pause"),
    (",  .", "a frame back, forward"),
    ("F1  H  ?", "this help"),
    ("F2  P", "write the picture (PNG)"),
    ("F5", "reload shaders · also on save"),
    ("Ctrl click", "print a pixel's rays · --pixel click"),
    ("Tab", "panel"),
    ("Esc", "quit"),
];

/// The commands of all keys pressed since the last frame; a key pressed twice gives two.
pub fn asked(context: &Context) -> Vec<Ask> {
    context.input(|input| {
        let presses = |&(key, ask)| std::iter::repeat_n(ask, input.num_presses(key));
        ASKS.iter().flat_map(presses).collect()
    })
}

/// The overlay, in the middle of the picture.
pub fn help(context: &Context) {
    Area::new(Id::new("help")).anchor(Align2::CENTER_CENTER, [0.0, 0.0]).show(context, |ui| {
        style::sheet().inner_margin(22).show(ui, |ui| {
            ui.horizontal_top(|ui| {
                column(ui, "Camera", &CAMERA);
                ui.add_space(24.0);
                column(ui, "Window", &WINDOW);
            });
        });
    });
}

fn column(ui: &mut egui::Ui, title: &str, rows: &[(&str, &str)]) {
    ui.vertical(|ui| {
        ui.label(RichText::new(title).heading());
        ui.add_space(4.0);
        Grid::new(title).num_columns(2).spacing([18.0, 6.0]).show(ui, |ui| {
            for (key, what) in rows {
                ui.label(RichText::new(*key).color(style::ACCENT));
                ui.label(*what);
                ui.end_row();
            }
        });
    });
}
