//! A sample in a window: events in, pictures and panel out.
//!
//! One frame is in flight, and nothing is drawn while nothing changes: a redraw is asked for by input,
//! by the panel's animations, by a picture that is to sharpen or accumulate, and by edited shaders.

mod bookmarks;
mod history;
mod keys;
mod navigation;
mod pace;
mod painter;
mod panel;
mod reload;
mod rows;
mod style;
mod view;

use std::time::{Duration, Instant};

use anyhow::{Context, Result, anyhow};
use ash::vk;
use egui::ViewportId;
use winit::application::ApplicationHandler;
use winit::dpi::PhysicalSize;
use winit::event::{StartCause, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop, EventLoopProxy};
use winit::raw_window_handle::{HasDisplayHandle, HasWindowHandle};
use winit::window::{Window, WindowId};

use self::keys::Ask;
use self::painter::Painter;
use self::panel::{Facts, Panel};
use self::reload::Reload;
use self::rows::Hidden;
use self::view::{Stepped, View};
use super::args::Args;
use super::headless::{check_size, check_validation};
use super::{Controls, Sample, Setup, controls};
use crate::gpu::{Gpu, GpuOptions, Swapchain, WindowHandles};
use crate::usage::Usage;

/// How often the title is written anew while pictures come.
const TITLE: Duration = Duration::from_millis(500);

/// What reaches the event loop from other threads.
enum Wake {
    /// A file below `shaders/` was written.
    Saved(String),
    /// The child has compiled the shaders, or says why it could not.
    Compiled(Result<(), String>),
}

/// Opens a window for a sample and returns when it is closed.
///
/// # Errors
/// On wrong arguments ([`Usage`]), without a display, if anything fails, or if validation had something
/// to say.
pub fn open<S: Sample>(name: &str, args: &Args) -> Result<()> {
    if args.out.is_some() || args.report.is_some() {
        let hint = "--out and --report go with --headless; in the window, F2 writes the picture";
        return Err(Usage(hint.to_owned()).into());
    }
    log_if_asked();
    let events = EventLoop::with_user_event().build().map_err(|_| no_display())?;
    let proxy = events.create_proxy();
    let mut program = Program::<S> { name, args, proxy, open: None, outcome: Ok(()) };
    events.run_app(&mut program).context("the window system failed")?;
    program.outcome
}

/// What is wrong with the display, and what to do.
fn no_display() -> anyhow::Error {
    let value = |name| std::env::var(name).ok().filter(|value| !value.is_empty());
    let asked = value("WAYLAND_DISPLAY").or_else(|| value("DISPLAY"));
    let why = asked.map_or_else(
        || "no display: set".to_owned(),
        |display| format!("no display at '{display}': check"),
    );
    anyhow!("{why} DISPLAY or WAYLAND_DISPLAY, or add --headless to render without a window")
}

/// `RUST_LOG=common=debug` tells of every frame, `info` of the longest wait; without it all is silent.
fn log_if_asked() {
    use tracing_subscriber::filter::{EnvFilter, LevelFilter};
    let filter = EnvFilter::builder().with_default_directive(LevelFilter::OFF.into());
    let log = tracing_subscriber::fmt().with_writer(std::io::stderr);
    // A program that has set up its own keeps it.
    let _ = log.with_env_filter(filter.from_env_lossy()).try_init();
}

struct Program<'a, S> {
    name: &'a str,
    args: &'a Args,
    proxy: EventLoopProxy<Wake>,
    open: Option<Open<'a, S>>,
    outcome: Result<()>,
}

/// Everything that lives as long as the window. It is dropped in this order, the window last.
struct Open<'a, S> {
    view: View<S>,
    painter: Painter,
    swapchain: Swapchain,
    panel: Panel,
    facts: Facts,
    reload: Reload,
    egui: egui_winit::State,
    args: &'a Args,
    gpu: Gpu,
    hidden: bool,
    redraw_at: Option<Instant>,
    presented: u32,
    titled: Option<Instant>,
    lag: Lag,
    window: Window,
}

impl<S: Sample> Program<'_, S> {
    fn check(&mut self, events: &ActiveEventLoop, result: Result<()>) {
        if let Err(error) = result {
            self.outcome = Err(error);
            events.exit();
        }
    }
}

impl<S: Sample> ApplicationHandler<Wake> for Program<'_, S> {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        if self.open.is_none() {
            let opened = Open::new(events, self.name, self.args, self.proxy.clone());
            let result = opened.map(|open| self.open = Some(open));
            self.check(events, result);
        }
    }

    fn new_events(&mut self, _: &ActiveEventLoop, cause: StartCause) {
        let Some(open) = &mut self.open else { return };
        open.lag.wake();
        if matches!(cause, StartCause::ResumeTimeReached { .. }) {
            open.window.request_redraw();
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(open) = &mut self.open else { return };
        match event {
            WindowEvent::CloseRequested => events.exit(),
            WindowEvent::RedrawRequested => {
                let result = open.draw().map(|go_on| {
                    if !go_on {
                        events.exit();
                    }
                });
                self.check(events, result);
            }
            event => open.take(&event),
        }
    }

    fn user_event(&mut self, _: &ActiveEventLoop, wake: Wake) {
        let Some(open) = &mut self.open else { return };
        match wake {
            Wake::Saved(path) => {
                open.reload.saved(&path, Instant::now());
            }
            Wake::Compiled(result) => open.compiled(result),
        }
    }

    fn about_to_wait(&mut self, events: &ActiveEventLoop) {
        let Some(open) = &mut self.open else { return };
        let now = Instant::now();
        let reload_at = open.reload.poll(now);
        if open.redraw_at.is_some_and(|at| at <= now) {
            open.redraw_at = None;
            open.window.request_redraw();
        }
        let next = [reload_at, open.redraw_at].into_iter().flatten().min();
        events.set_control_flow(next.map_or(ControlFlow::Wait, ControlFlow::WaitUntil));
        open.lag.sleep();
    }

    fn exiting(&mut self, _: &ActiveEventLoop) {
        // The surface must go before the connection to the window system does.
        let Some(open) = self.open.take() else { return };
        if self.outcome.is_ok() {
            self.outcome = check_validation(&open.gpu);
        }
        let longest = open.lag.longest.as_millis();
        tracing::info!("{} frames; longest wait for a frame {longest} ms", open.presented);
    }
}

impl<'a, S: Sample> Open<'a, S> {
    fn new(
        events: &ActiveEventLoop,
        name: &str,
        args: &'a Args,
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
            requirements: S::requirements().window(),
            device: args.device.as_deref(),
            validate: args.validate,
            window: Some(handles),
        })?;
        check_size(&gpu, args.size)?;
        let setup = Setup::new(args);
        let mut sample = S::new(&gpu, &setup)?;
        setup.check()?;
        let mut panel = Panel::new(name);
        // The camera that the chapter chose is home, whatever `--set` makes of it.
        sample.controls(&mut Controls::new(&mut Hidden::new(&mut panel.navigation)));
        for (control, value) in &args.sets {
            controls::set(control, value, |c| sample.controls(c))?;
        }
        let mut reload = Reload::new(proxy);
        reload.learn(&gpu.statistics().stages)?;
        let swapchain = Swapchain::new(&gpu, handles)?;
        let context = egui::Context::default();
        style::apply(&context);
        let open = Self {
            view: View::new(&gpu, sample)?,
            painter: Painter::new(&gpu, &swapchain)?,
            swapchain,
            panel,
            facts: Facts {
                name: name.to_owned(),
                device: gpu.name.clone(),
                software: gpu.software,
                ..Facts::default()
            },
            reload,
            egui: egui_winit::State::new(
                context,
                ViewportId::ROOT,
                &window,
                Some(window.scale_factor() as f32),
                None,
                Some(gpu.limits.max_image_dimension as usize),
            ),
            args,
            gpu,
            hidden: false,
            redraw_at: None,
            presented: 0,
            titled: None,
            lag: Lag::default(),
            window,
        };
        open.window.set_visible(true);
        open.window.request_redraw();
        Ok(open)
    }

    /// Takes an event other than a redraw.
    fn take(&mut self, event: &WindowEvent) {
        match event {
            WindowEvent::Occluded(hidden) => self.hidden = *hidden,
            WindowEvent::CursorMoved { .. }
            | WindowEvent::MouseInput { .. }
            | WindowEvent::MouseWheel { .. }
            | WindowEvent::Touch(_)
            | WindowEvent::KeyboardInput { .. } => {
                self.view.input();
                self.lag.input();
            }
            _ => {}
        }
        let response = self.egui.on_window_event(&self.window, event);
        if response.repaint || matches!(event, WindowEvent::Occluded(_)) {
            self.window.request_redraw();
        }
    }

    /// One frame of the window; `false` if it was the last.
    fn draw(&mut self) -> Result<bool> {
        let size = self.window.inner_size();
        let wanted = vk::Extent2D { width: size.width, height: size.height };
        let extent = match self.swapchain.fit(wanted)? {
            Some(extent) if !self.hidden => extent,
            // An event tells when there is something to see again.
            _ => return Ok(true),
        };
        let input = self.egui.take_egui_input(&self.window);
        let context = self.egui.egui_ctx().clone();
        let mut outcome = panel::Outcome::default();
        let mut output = context.run_ui(input, |ui| {
            let sample = &mut self.view.sample;
            outcome.merge(self.panel.show(ui, &self.facts, &mut |c| sample.controls(c)));
        });
        self.egui.handle_platform_output(&self.window, output.platform_output);
        self.painter.textures(std::mem::take(&mut output.textures_delta))?;
        if outcome.changed {
            self.view.change();
        }
        for ask in &outcome.asked {
            match ask {
                Ask::Leave => return Ok(false),
                Ask::Picture => self.view.ask_picture(),
                Ask::Reload => {
                    self.panel.tell("compiling shaders …".to_owned());
                    self.reload.ask(Instant::now());
                }
                Ask::Help | Ask::Panel => {}
            }
        }
        let stepped = self.view.step(extent, outcome.hands)?;
        if let Some(written) = self.view.take_picture(&self.facts.name) {
            self.panel.tell(match written {
                Ok(path) => format!("wrote {}", path.display()),
                Err(error) => format!("{error:#}"),
            });
            self.redraw_at = Some(Instant::now());
        }
        let triangles = context.tessellate(output.shapes, output.pixels_per_point);
        if let Some(target) = self.swapchain.acquire()? {
            let panel = (&*triangles, output.pixels_per_point);
            self.painter.paint(&self.view.image, extent, panel, target)?;
            self.window.pre_present_notify();
            self.swapchain.present(target)?;
            self.presented += 1;
            let waited = self.lag.present();
            tracing::debug!("presented; {} ms since the last", waited.as_millis());
        } else {
            self.redraw_at = Some(Instant::now());
        }
        let viewport = output.viewport_output.get(&ViewportId::ROOT);
        self.plan(&stepped, viewport.map_or(Duration::MAX, |viewport| viewport.repaint_delay));
        Ok(!self.args.frames_given || self.presented < self.args.frames)
    }

    /// Notes what came of the frame, and when the next is due.
    fn plan(&mut self, stepped: &Stepped, panel_delay: Duration) {
        let now = Instant::now();
        self.view.facts(&mut self.facts);
        let picture_at = match *stepped {
            Stepped::New { milliseconds, full } => {
                let [width, height] = self.facts.rendered;
                let pixels = |[width, height]: [u32; 2]| f64::from(width) * f64::from(height);
                let part = pixels(self.facts.rendered) / pixels(self.facts.full);
                self.panel.history.add(milliseconds / part, full);
                tracing::debug!("{width}x{height}: {milliseconds:.1} ms");
                Some(now)
            }
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

    /// Takes up shaders that a child has compiled, or shows why not.
    fn compiled(&mut self, result: Result<(), String>) {
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

    /// Makes the sample anew and gives it the values that its controls had.
    fn remake(&mut self) -> Result<()> {
        let values = controls::list(|c| self.view.sample.controls(c));
        let mut sample = S::new(&self.gpu, &Setup::new(self.args))?;
        self.panel.navigation.forget_home();
        sample.controls(&mut Controls::new(&mut Hidden::new(&mut self.panel.navigation)));
        for control in values {
            // A control may have gone, or take other values: then the new one stands.
            let _ = controls::set(&control.name, &control.value, |c| sample.controls(c));
        }
        self.reload.learn(&self.gpu.statistics().stages)?;
        self.view.replace(sample);
        Ok(())
    }
}

/// How long someone waits for the picture that answers their input.
///
/// Input that came while a frame was drawn is seen after it, so it is taken to have come right after
/// the frame before: the longest wait is an upper bound.
#[derive(Default)]
struct Lag {
    longest: Duration,
    awake: Option<Instant>,
    asleep: Option<Instant>,
    pending: bool,
}

impl Lag {
    fn sleep(&mut self) {
        self.asleep = Some(Instant::now());
    }

    fn wake(&mut self) {
        let now = Instant::now();
        let slept = self.asleep.take().is_some_and(|at| now - at > Duration::from_millis(2));
        if slept && !self.pending {
            self.awake = Some(now);
        }
    }

    fn input(&mut self) {
        self.pending = true;
    }

    fn present(&mut self) -> Duration {
        let now = Instant::now();
        let waited = self.awake.map_or(Duration::ZERO, |awake| now - awake);
        if self.pending {
            self.longest = self.longest.max(waited);
        }
        (self.awake, self.pending) = (Some(now), false);
        waited
    }
}
