//! A window whose device was lost: it reports the loss on a new device, and offers to continue with it.

use std::time::{Duration, Instant};

use anyhow::{Error, Result};
use ash::vk;
use egui::{Align2, Area, Context, Id, Key, RichText, Ui, ViewportId};
use winit::event::WindowEvent;

use super::panel::Panel;
use super::style;
use super::window_on_gpu::{Presented, WindowOnGpu};
use crate::app::args::Args;
use crate::app::controls::Listed;
use crate::output;

/// The width of the lines, in points.
const WIDTH: f32 = 400.0;

/// The part of a session that survives the loss of its device.
pub struct Kept {
    /// The program's arguments, with the scene that was opened last.
    pub args: Args,
    /// Camera and bookmarks.
    pub panel: Panel,
    /// The values of all controls, including the camera.
    pub values: Vec<Listed>,
    /// Number of frames shown.
    pub presented: u32,
}

/// The user's choice.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Choice {
    /// No choice yet.
    #[default]
    None,
    /// Create the sample again.
    GoOn,
    /// Close the window.
    Leave,
}

/// A window without a sample.
pub struct Lost {
    /// The window, and the new device.
    pub on_gpu: WindowOnGpu,
    /// State to restore in the sample.
    pub kept: Kept,
    /// The error that ended the session.
    pub error: Error,
    redraw_at: Option<Instant>,
}

/// True if an error means that the device is lost, and everything created from it.
pub fn is_loss(error: &Error) -> bool {
    let lost = vk::Result::ERROR_DEVICE_LOST;
    error.chain().any(|cause| cause.downcast_ref::<vk::Result>() == Some(&lost))
}

impl Lost {
    /// Reports the loss, on the terminal and in the window, which it shows.
    pub fn new(on_gpu: WindowOnGpu, name: &str, kept: Kept, error: Error) -> Self {
        output::complain(&format!("warning: {error:#}; Enter in the window goes on, Esc leaves"));
        on_gpu.window.set_title(&format!("{name} · the device was lost"));
        // It is still hidden if the device was lost before the first picture.
        on_gpu.window.set_visible(true);
        on_gpu.window.request_redraw();
        Self { on_gpu, kept, error, redraw_at: None }
    }

    /// Handles an event other than a redraw.
    pub fn take(&mut self, event: &WindowEvent) {
        if self.on_gpu.take(event) {
            self.on_gpu.window.request_redraw();
        }
    }

    /// Requests a redraw if one is due, and returns the time of the next.
    pub fn sleep(&mut self) -> Option<Instant> {
        if self.redraw_at.is_some_and(|at| at <= Instant::now()) {
            self.redraw_at = None;
            self.on_gpu.window.request_redraw();
        }
        self.redraw_at
    }

    /// Shows the error and the choices.
    ///
    /// # Errors
    /// If the new device also fails.
    pub fn draw(&mut self) -> Result<Choice> {
        let Some(extent) = self.on_gpu.fit()? else { return Ok(Choice::None) };
        let (device, error) = (self.on_gpu.gpu.name.clone(), format!("{:#}", self.error));
        let mut choice = Choice::None;
        let drawing = self.on_gpu.over(|ui| {
            let made = sheet(ui.ctx(), &device, &error);
            if made != Choice::None {
                choice = made;
            }
        })?;
        let viewport = drawing.viewport_output.get(&ViewportId::ROOT);
        let delay = viewport.map_or(Duration::MAX, |viewport| viewport.repaint_delay);
        let shown = self.on_gpu.present(extent, None, drawing)?;
        let delay = if shown == Presented::Shown { delay } else { Duration::ZERO };
        self.redraw_at = Instant::now().checked_add(delay);
        Ok(choice)
    }
}

/// The error and two buttons, in the middle of the window.
fn sheet(context: &Context, device: &str, error: &str) -> Choice {
    let area = Area::new(Id::new("lost")).anchor(Align2::CENTER_CENTER, [0.0, 0.0]);
    let clicked = area.show(context, |ui| {
        style::sheet().inner_margin(22).show(ui, |ui| said(ui, device, error)).inner
    });
    let pressed = |key| context.input(|input| input.key_pressed(key));
    match clicked.inner {
        _ if pressed(Key::Enter) => Choice::GoOn,
        _ if pressed(Key::Escape) => Choice::Leave,
        clicked => clicked,
    }
}

fn said(ui: &mut Ui, device: &str, error: &str) -> Choice {
    ui.set_width((ui.ctx().content_rect().width() - 60.0).clamp(0.0, WIDTH));
    ui.label(RichText::new("The device was lost").heading());
    ui.label(RichText::new(device).small().color(style::DIM));
    ui.add_space(6.0);
    style::warning().show(ui, |ui| {
        ui.set_width(ui.available_width());
        ui.add(egui::Label::new(RichText::new(error).monospace()).wrap().selectable(true));
    });
    ui.add_space(6.0);
    ui.label("A new device is there. The scene is made again; camera and controls stay.");
    ui.add_space(6.0);
    ui.horizontal(|ui| {
        if ui.button("Go on  (Enter)").clicked() {
            Choice::GoOn
        } else if ui.button("Quit  (Esc)").clicked() {
            Choice::Leave
        } else {
            Choice::None
        }
    })
    .inner
}

#[cfg(test)]
mod tests {
    use egui::vec2;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    use super::*;

    /// The choice after an interaction with the sheet.
    fn chosen(by: impl FnOnce(&mut Harness<Choice>)) -> Choice {
        let mut harness = Harness::builder().with_size(vec2(640.0, 420.0)).build_ui_state(
            |ui, chosen: &mut Choice| match sheet(ui.ctx(), "a device", "an error") {
                Choice::None => {}
                made => *chosen = made,
            },
            Choice::None,
        );
        harness.run();
        by(&mut harness);
        harness.run();
        *harness.state()
    }

    #[test]
    fn a_key_or_a_button_chooses() {
        assert_eq!(chosen(|_| ()), Choice::None);
        assert_eq!(chosen(|harness| harness.key_press(Key::Enter)), Choice::GoOn);
        assert_eq!(chosen(|harness| harness.key_press(Key::Escape)), Choice::Leave);
        assert_eq!(chosen(|it| it.get_by_label("Go on  (Enter)").click()), Choice::GoOn);
        assert_eq!(chosen(|it| it.get_by_label("Quit  (Esc)").click()), Choice::Leave);
    }

    #[test]
    fn a_window_may_be_smaller_than_the_sheet_s_margins() {
        let harness = Harness::builder().with_size(vec2(1.0, 1.0));
        harness.build_ui(|ui| _ = sheet(ui.ctx(), "a device", "an error")).run();
    }

    #[test]
    fn a_loss_is_known_by_its_cause() {
        let lost = Error::from(vk::Result::ERROR_DEVICE_LOST).context("the device failed");
        assert!(is_loss(&lost) && !is_loss(&vk::Result::ERROR_OUT_OF_HOST_MEMORY.into()));
    }
}
