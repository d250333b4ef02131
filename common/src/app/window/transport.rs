//! Control of an animation: play, pause and step, by keys and by buttons.

use egui::{Button, InputState, Key, Modifiers, Ui};

use crate::app::Playback;

/// Animation input since the last frame of the window.
#[derive(Default)]
pub struct Transport {
    toggles: bool,
    steps: i32,
}

impl Transport {
    /// Reads the keys, so that a focused button does not also react to them.
    pub fn keys(&mut self, input: &mut InputState) {
        self.toggles ^= input.consume_key(Modifiers::NONE, Key::Space);
        self.steps += input.count_and_consume_key(Modifiers::NONE, Key::Period) as i32;
        self.steps -= input.count_and_consume_key(Modifiers::NONE, Key::Comma) as i32;
    }

    /// Applies the input; returns true if the frame has changed.
    pub fn apply(&mut self, playback: &mut Playback) -> bool {
        let Self { toggles, steps } = std::mem::take(self);
        let before = playback.frame;
        if toggles {
            playback.toggle();
        }
        if steps != 0 {
            playback.step(steps);
        }
        playback.frame != before
    }

    /// The buttons.
    pub fn buttons(&mut self, ui: &mut Ui, playback: &Playback) {
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 4.0;
            let mut is_pressed =
                |text: &str, tip: &str| ui.add(Button::new(text)).on_hover_text(tip).clicked();
            if is_pressed("⏴", "a frame back  ,") {
                self.steps -= 1;
            }
            if is_pressed(if playback.playing { "⏸  pause" } else { "▶  play" }, "Space") {
                self.toggles ^= true;
            }
            if is_pressed("⏵", "a frame forward  .") {
                self.steps += 1;
            }
        });
    }
}
