//! What lives as long as the window, and one frame of it.

use std::path::Path;
use std::time::{Duration, Instant};

use anyhow::{Context, Result};
use ash::vk;
use egui::{FullOutput, ViewportId};
use winit::dpi::PhysicalSize;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, EventLoopProxy};
use winit::raw_window_handle::{HasDisplayHandle, HasWindowHandle};
use winit::window::Window;

use super::facts::Facts;
use super::keys::Ask;
use super::lag::Lag;
use super::painter::Painter;
use super::panel::{Outcome, Panel};
use super::reload::Reload;
use super::rows::Hidden;
use super::view::{Stepped, View};
use super::{Wake, style};
use crate::app::args::Args;
use crate::app::headless::{check_size, check_validation};
use crate::app::{Controls, Sample, Setup, controls};
use crate::gpu::{Gpu, GpuOptions, Swapchain, WindowHandles};

/// How often the title is written anew while pictures come.
const TITLE: Duration = Duration::from_millis(500);

/// Everything that lives as long as the window. It is dropped in this order, the window last.
pub struct Session<S> {
    view: View<S>,
    painter: Painter,
    swapchain: Swapchain,
    panel: Panel,
    facts: Facts,
    reload: Reload,
    egui: egui_winit::State,
    args: Args,
    gpu: Gpu,
    hidden: bool,
    redraw_at: Option<Instant>,
    presented: u32,
    titled: Option<Instant>,
    lag: Lag,
    window: Window,
}

impl<S: Sample> Session<S> {
    /// Opens a window and makes the sample.
    ///
    /// # Errors
    /// If there is no such device or window, a control is set wrongly, or the sample cannot be made.
    pub fn new(
        events: &ActiveEventLoop,
        name: &str,
        args: &Args,
        proxy: EventLoopProxy<Wake>,
    ) -> Result<Self> {
        // Shown once there is something to show.
        let attributes = Window::default_attributes()
            .with_title(name)
            .with_visible(false)
            .with_inner_size(PhysicalSize::new(args.size.width, args.size.height));
        let window = events.create_window(attributes).context("cannot open a window")?;
        let handles = WindowHandles {
            display: window.display_handle().context("the window has no display")?.as_raw(),
            window: window.window_handle().context("the window has no handle")?.as_raw(),
        };
        let gpu = Gpu::new(&GpuOptions {
            requirements: S::requirements().window().compiler_figures_where_offered(),
            device: args.device.as_deref(),
            validate: args.validate,
            window: Some(handles),
            arithmetic: args.arithmetic,
        })?;
        check_size(&gpu, args.size)?;
        let setup = Setup::new(args);
        let mut sample = S::new(&gpu, &setup)?;
        setup.check()?;
        let mut panel = Panel::new(name);
        // The camera that the chapter chose is home, whatever `--set` makes of it.
        sample.controls(&mut Controls::new(&mut Hidden::new(&mut panel.navigation)));
        controls::set_all(&args.sets, |c| sample.controls(c))?;
        let swapchain = Swapchain::new(&gpu, handles)?;
        let context = egui::Context::default();
        style::apply(&context);
        let mut session = Self {
            view: View::new(&gpu, sample)?,
            painter: Painter::new(&gpu, &swapchain)?,
            swapchain,
            panel,
            facts: Facts {
                name: name.to_owned(),
                device: gpu.name.clone(),
                software: gpu.software,
                arithmetic: gpu.arithmetic,
                ..Facts::default()
            },
            reload: Reload::new(proxy),
            egui: egui_winit::State::new(
                context,
                ViewportId::ROOT,
                &window,
                Some(window.scale_factor() as f32),
                None,
                Some(gpu.limits.max_image_dimension as usize),
            ),
            args: args.clone(),
            gpu,
            hidden: false,
            redraw_at: None,
            presented: 0,
            titled: None,
            lag: Lag::default(),
            window,
        };
        // The first picture compiles shaders in the driver: nobody shall wait before a frozen window.
        while let Stepped::Part = session.view.step(args.size)? {}
        session.learn();
        session.window.set_visible(true);
        session.window.request_redraw();
        Ok(session)
    }

    /// The event loop goes on; `due` if it does because a frame is due.
    pub fn wake(&mut self, due: bool) {
        self.lag.wake();
        if due {
            self.window.request_redraw();
        }
    }

    /// Begins what is due, and returns when the event loop must go on without an event.
    pub fn sleep(&mut self) -> Option<Instant> {
        let now = Instant::now();
        let reload_at = self.reload.poll(now);
        if self.redraw_at.is_some_and(|at| at <= now) {
            self.redraw_at = None;
            self.window.request_redraw();
        }
        self.lag.sleep();
        [reload_at, self.redraw_at].into_iter().flatten().min()
    }

    /// Takes leave.
    ///
    /// # Errors
    /// If validation had something to say.
    pub fn close(self) -> Result<()> {
        let longest = self.lag.longest.as_millis();
        tracing::info!("{} frames; longest wait for a frame {longest} ms", self.presented);
        // Messages about what was never destroyed come when the device is.
        let validation = self.gpu.validation();
        drop(self);
        check_validation(&validation)
    }

    /// A file below `shaders/` was written.
    pub fn saved(&mut self, path: &str) {
        self.reload.saved(path, Instant::now());
    }

    /// Takes an event other than a redraw.
    pub fn take(&mut self, event: &WindowEvent) {
        match event {
            WindowEvent::Occluded(hidden) => self.hidden = *hidden,
            WindowEvent::DroppedFile(file) => self.open(file),
            WindowEvent::CursorMoved { .. }
            | WindowEvent::MouseInput { .. }
            | WindowEvent::MouseWheel { .. }
            | WindowEvent::Touch(_)
            | WindowEvent::KeyboardInput { .. } => self.lag.input(),
            _ => {}
        }
        let response = self.egui.on_window_event(&self.window, event);
        if response.repaint || matches!(event, WindowEvent::Occluded(_)) {
            self.window.request_redraw();
        }
    }

    /// One frame of the window; `false` if it was the last.
    ///
    /// # Errors
    /// If the sample, the device or the window system fails.
    pub fn draw(&mut self) -> Result<bool> {
        let size = self.window.inner_size();
        let wanted = vk::Extent2D { width: size.width, height: size.height };
        let extent = match self.swapchain.fit(wanted)? {
            Some(extent) if !self.hidden => extent,
            // An event tells when there is something to see again.
            _ => return Ok(true),
        };
        let (outcome, mut drawing) = self.panel();
        self.painter.textures(std::mem::take(&mut drawing.textures_delta))?;
        if outcome.changed {
            self.view.change();
        }
        if outcome.asked.contains(&Ask::Leave) {
            return Ok(false);
        }
        let area = self.area(extent, drawing.pixels_per_point);
        let stepped = self.view.step(area)?;
        self.learn();
        if let Some(written) = self.view.take_picture(&self.facts.name) {
            self.panel.tell(match written {
                Ok(path) => format!("wrote {}", path.display()),
                Err(error) => format!("{error:#}"),
            });
            self.redraw_at = Some(Instant::now());
        }
        let viewport = drawing.viewport_output.get(&ViewportId::ROOT);
        let panel_delay = viewport.map_or(Duration::MAX, |viewport| viewport.repaint_delay);
        self.present(extent, drawing)?;
        self.plan(&stepped, panel_delay);
        Ok(!self.args.frames_given || self.presented < self.args.frames)
    }

    /// The part of a window that the picture has: all, or what lies to the right of the panel.
    fn area(&self, window: vk::Extent2D, scale: f32) -> vk::Extent2D {
        let strip = self.panel.strip(window.width as f32 / scale) * scale;
        let width = window.width.saturating_sub(strip.ceil() as u32).max(1);
        vk::Extent2D { width, ..window }
    }

    /// Shows the panel, and answers the keys that ask something of the window.
    fn panel(&mut self) -> (Outcome, FullOutput) {
        let input = self.egui.take_egui_input(&self.window);
        let context = self.egui.egui_ctx().clone();
        let mut outcome = Outcome::default();
        let mut drawing = context.run_ui(input, |ui| {
            let sample = &mut self.view.sample;
            outcome.merge(self.panel.show(ui, &self.facts, &mut |c| sample.controls(c)));
        });
        let platform = std::mem::take(&mut drawing.platform_output);
        self.egui.handle_platform_output(&self.window, platform);
        if outcome.asked.contains(&Ask::Picture) {
            self.view.ask_picture();
        }
        if outcome.asked.contains(&Ask::Reload) {
            self.panel.tell("compiling shaders …".to_owned());
            self.reload.ask(Instant::now());
        }
        (outcome, drawing)
    }

    /// Puts picture and panel on the window.
    fn present(&mut self, extent: vk::Extent2D, drawing: FullOutput) -> Result<()> {
        let scale = drawing.pixels_per_point;
        let triangles = self.egui.egui_ctx().tessellate(drawing.shapes, scale);
        let area = self.area(extent, scale);
        let mut shown = false;
        if let Some(target) = self.swapchain.acquire()? {
            self.painter.paint(&self.view.image, (area, extent), (&triangles, scale), target)?;
            self.window.pre_present_notify();
            shown = self.swapchain.present(target)?;
            self.presented += 1;
            let waited = self.lag.present();
            tracing::debug!("presented; {} ms since the last", waited.as_millis());
        }
        if !shown {
            self.redraw_at = Some(Instant::now());
        }
        Ok(())
    }

    /// Notes what came of the frame, and when the next is due.
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
            self.window.set_title(&self.facts.title());
        }
        let counted = self.args.frames_given.then_some(now);
        let panel_at = now.checked_add(panel_delay);
        let times = [self.redraw_at, picture_at, counted, panel_at];
        self.redraw_at = times.into_iter().flatten().min();
    }

    /// Takes up shaders that were compiled beside, or shows why not.
    pub fn compiled(&mut self, result: Result<(), String>) {
        let start = Instant::now();
        let result = self.reload.compiled(result).and_then(|()| {
            self.remake().map_err(|error| {
                self.reload.refused();
                format!("{error:#}")
            })
        });
        if result.is_ok() {
            let seconds = start.elapsed().as_secs_f64();
            self.panel.tell(format!("shaders reloaded in {seconds:.1} s"));
        }
        self.panel.error = result.err();
        self.window.request_redraw();
    }

    /// Opens a file that was dropped on the window, as if `--scene` had named it.
    fn open(&mut self, file: &Path) {
        let args = Args { scene: Some(file.to_owned()), ..self.args.clone() };
        let setup = Setup::new(&args);
        let made = S::new(&self.gpu, &setup).and_then(|mut sample| {
            setup.check()?;
            self.panel.navigation.forget_home();
            sample.controls(&mut Controls::new(&mut Hidden::new(&mut self.panel.navigation)));
            self.view.replace(sample)
        });
        match made {
            Ok(()) => {
                self.args = args;
                self.panel.error = None;
            }
            Err(error) => self.panel.error = Some(format!("{error:#}")),
        }
        self.window.request_redraw();
    }

    /// Makes the sample anew and gives it the values that its controls had.
    fn remake(&mut self) -> Result<()> {
        let values = controls::list(|c| self.view.sample.controls(c));
        let mut sample = S::new(&self.gpu, &Setup::new(&self.args))?;
        self.panel.navigation.forget_home();
        sample.controls(&mut Controls::new(&mut Hidden::new(&mut self.panel.navigation)));
        for control in values {
            // A control may have gone, or take other values: then the new one stands.
            let _ = controls::set(&control.name, &control.value, |c| sample.controls(c));
        }
        self.view.replace(sample)
    }

    /// Watches the shaders of the pipelines that there are by now.
    fn learn(&mut self) {
        let statistics = self.gpu.statistics();
        if let Err(error) = self.reload.learn(&statistics.stages) {
            self.panel.error = Some(format!("{error:#}"));
        }
        self.facts.programs = statistics.executables;
        if let Some(complaint) = self.gpu.complaints().pop() {
            self.panel.error = Some(complaint);
        }
    }
}
