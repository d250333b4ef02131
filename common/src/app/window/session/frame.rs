//! One frame of a window: the panel runs, the picture advances, both are shown, and the next frame is planned.

use std::time::{Duration, Instant};

use anyhow::Result;
use ash::vk;
use egui::{FullOutput, ViewportId};

use super::Session;
use crate::app::RunHooks;
use crate::app::window::keys::Ask;
use crate::app::window::panel::Outcome;
use crate::app::window::stepped::Stepped;
use crate::app::window::window_on_gpu::Presented;

/// Update interval of the title while pictures are rendered.
const TITLE: Duration = Duration::from_millis(500);

/// Number of attempts to draw a frame while the window keeps changing.
const TRIES: u32 = 3;

impl Session {
    /// One frame of the window; `false` if it was the last.
    ///
    /// # Errors
    /// If the sample, the device or the window system fails.
    pub fn draw(&mut self, hooks: &dyn RunHooks) -> Result<bool> {
        for _ in 0..TRIES {
            if let Some(go_on) = self.try_to_draw(hooks)? {
                return Ok(go_on);
            }
        }
        Ok(true)
    }

    /// As [`Session::draw`]; nothing if the window has changed meanwhile and cannot show it.
    fn try_to_draw(&mut self, hooks: &dyn RunHooks) -> Result<Option<bool>> {
        let extent = match self.on_gpu.fit()? {
            Some(extent) if !self.hidden => extent,
            // An event reports when it is visible again.
            _ => return Ok(Some(true)),
        };
        let (outcome, drawing) = self.panel()?;
        if outcome.changed {
            self.view.change();
        }
        if outcome.asked.contains(&Ask::Leave) {
            return Ok(Some(false));
        }
        if let Some(part) = outcome.clicked {
            let told = hooks.clicked(&mut || self.view.trace_pixel(part))?;
            told.into_iter().for_each(|told| self.panel.tell(told));
        }
        let area = self.area(extent, drawing.pixels_per_point);
        let stepped = self.view.step(area)?;
        self.learn();
        if let Some(written) = self.view.take_picture(&self.facts.name, self.args.development) {
            self.panel.tell(match written {
                Ok(path) => format!("wrote {}", path.display()),
                Err(error) => format!("{error:#}"),
            });
            self.redraw_at = Some(Instant::now());
        }
        let viewport = drawing.viewport_output.get(&ViewportId::ROOT);
        let panel_delay = viewport.map_or(Duration::MAX, |viewport| viewport.repaint_delay);
        let presented = self.present(extent, drawing)?;
        self.plan(&stepped, panel_delay);
        let go_on = !self.args.frames_given || self.presented < self.args.frames;
        Ok((presented != Presented::Lost).then_some(go_on))
    }

    /// The part of a window for the picture: all of it, or the part to the right of the panel.
    fn area(&self, window: vk::Extent2D, scale: f32) -> vk::Extent2D {
        let strip = self.panel.strip(window.width as f32 / scale) * scale;
        let width = window.width.saturating_sub(strip.ceil() as u32).max(1);
        vk::Extent2D { width, ..window }
    }

    /// Shows the panel, and executes the keys for the window.
    fn panel(&mut self) -> Result<(Outcome, FullOutput)> {
        let mut outcome = Outcome::default();
        let drawing = self.on_gpu.over(|ui| {
            let sample = &mut self.view.sample;
            outcome.merge(self.panel.show(ui, &self.facts, &mut |c| sample.controls(c)));
        })?;
        if outcome.asked.contains(&Ask::Picture) {
            self.view.ask_picture();
        }
        if outcome.asked.contains(&Ask::Reload) {
            self.panel.tell("compiling shaders …".to_owned());
            self.reload.ask(Instant::now());
        }
        Ok((outcome, drawing))
    }

    /// Draws picture and panel to the window.
    fn present(&mut self, extent: vk::Extent2D, drawing: FullOutput) -> Result<Presented> {
        let area = self.area(extent, drawing.pixels_per_point);
        let presented = self.on_gpu.present(extent, (&self.view.image, area), drawing)?;
        if let Presented::Shown | Presented::ShownStale = presented {
            self.presented += 1;
            let waited = self.lag.present();
            tracing::debug!("presented; {} ms since the last", waited.as_millis());
        }
        if presented != Presented::Shown {
            self.redraw_at = Some(Instant::now());
        }
        Ok(presented)
    }

    /// Records the result of the frame, and when the next is due.
    fn plan(&mut self, stepped: &Stepped, panel_delay: Duration) {
        let now = Instant::now();
        self.view.facts(&mut self.facts);
        let picture_at = match *stepped {
            Stepped::New { milliseconds, full, telling } => {
                let [width, height] = self.facts.rendered;
                let pixels = |[width, height]: [u32; 2]| f64::from(width) * f64::from(height);
                let part = pixels(self.facts.rendered) / pixels(self.facts.full);
                if telling {
                    self.panel.history.add(milliseconds / part, full);
                }
                tracing::debug!("{width}x{height}: {milliseconds:.1} ms");
                Some(now)
            }
            Stepped::Part => Some(now),
            Stepped::Kept(_) if self.view.plays() => Some(now),
            Stepped::Kept(until) => until,
        };
        let resting = picture_at.is_none();
        if self.titled.is_none_or(|at| resting || now > at + TITLE) {
            self.titled = Some(now);
            self.on_gpu.window.set_title(&self.facts.title());
        }
        let counted = self.args.frames_given.then_some(now);
        let panel_at = now.checked_add(panel_delay);
        let times = [self.redraw_at, picture_at, counted, panel_at];
        self.redraw_at = times.into_iter().flatten().min();
    }
}
