//! The state that lives as long as the window.

mod frame;

use std::path::Path;
use std::time::Instant;

use anyhow::{Context, Result};
use winit::dpi::PhysicalSize;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, EventLoopProxy};
use winit::window::Window;

use super::facts::Facts;
use super::lag::Lag;
use super::panel::Panel;
use super::reload::Reload;
use super::rows::Hidden;
use super::stepped::Stepped;
use super::view::View;
use super::window_on_gpu::WindowOnGpu;
use super::{Of, Wake};
use crate::app::files::check_size;
use crate::app::{Args, Controls, Sample, Setup, controls};
use crate::gpu::Gpu;
use crate::output;

type Make = fn(&Gpu, &Setup) -> Result<Box<dyn Sample>>;

/// The objects that live as long as the device. Dropped in this order, the window last.
pub struct Session {
    view: View,
    panel: Panel,
    facts: Facts,
    reload: Reload,
    args: Args,
    /// Creates the sample.
    make: Make,
    hidden: bool,
    redraw_at: Option<Instant>,
    presented: u32,
    titled: Option<Instant>,
    lag: Lag,
    on_gpu: WindowOnGpu,
}

impl Session {
    /// Opens a window, still hidden, and creates the sample.
    ///
    /// # Errors
    /// If there is no such device or window, a control is set wrongly, or the sample cannot be created.
    pub fn new(events: &ActiveEventLoop, of: Of, proxy: EventLoopProxy<Wake>) -> Result<Self> {
        let Of { program, args, .. } = of;
        // Shown once there is a picture.
        let attributes = Window::default_attributes()
            .with_title(program.name)
            .with_visible(false)
            .with_inner_size(PhysicalSize::new(args.size.width, args.size.height));
        let window = events.create_window(attributes).context("cannot open a window")?;
        let on_gpu = WindowOnGpu::new(window, of)?;
        check_size(&on_gpu.gpu, args.size)?;
        let setup = Setup::new(args);
        let mut sample = (program.make)(&on_gpu.gpu, &setup)?;
        setup.check()?;
        let mut panel = Panel::new(program.name);
        // Home is the camera chosen by the chapter, whatever `--set` changes.
        sample.controls(&mut Controls::new(&mut Hidden::new(&mut panel.navigation)));
        controls::check(|c| sample.controls(c))?;
        controls::set_all(&args.sets, |c| sample.controls(c))?;
        let names = args.sets.iter().map(|(name, _)| &**name);
        output::warn(&controls::without_effect(names, |c| sample.controls(c)));
        let gpu = &on_gpu.gpu;
        Ok(Self {
            view: View::new(gpu, sample)?,
            panel,
            facts: Facts {
                name: program.name.to_owned(),
                device: gpu.name.clone(),
                software: gpu.software,
                arithmetic: gpu.driver_shim.name(),
                ..Facts::default()
            },
            reload: Reload::new(proxy),
            args: args.clone(),
            make: program.make,
            hidden: false,
            redraw_at: None,
            presented: 0,
            titled: None,
            lag: Lag::default(),
            on_gpu,
        })
    }

    /// Renders the first picture, and then shows the window. The first picture compiles shaders in the driver: the
    /// user should not have to wait before a frozen window.
    ///
    /// # Errors
    /// If the sample or the device fails.
    pub fn begin(&mut self) -> Result<()> {
        while let Stepped::Part = self.view.step(self.args.size)? {}
        self.learn();
        self.on_gpu.window.set_visible(true);
        self.on_gpu.window.request_redraw();
        Ok(())
    }

    /// The event loop wakes up; `due` if a frame is due.
    pub fn wake(&mut self, due: bool) {
        self.lag.wake();
        if due {
            self.on_gpu.window.request_redraw();
        }
    }

    /// Begins the work that is due, and returns when the event loop must wake up without an event.
    pub fn sleep(&mut self) -> Option<Instant> {
        let now = Instant::now();
        let reload_at = self.reload.poll(now);
        if self.redraw_at.is_some_and(|at| at <= now) {
            self.redraw_at = None;
            self.on_gpu.window.request_redraw();
        }
        self.lag.sleep();
        [reload_at, self.redraw_at].into_iter().flatten().min()
    }

    /// Ends the session.
    ///
    /// # Errors
    /// If validation reported a message.
    pub fn close(self) -> Result<()> {
        let (presented, longest) = (self.presented, self.lag.longest.as_millis());
        let pictures = self.view.pictures;
        tracing::info!(
            "{presented} frames of {pictures} pictures; longest wait for a frame {longest} ms"
        );
        let Self { view, on_gpu, .. } = self;
        drop(view);
        on_gpu.close()
    }

    /// A file below `shaders/` was changed.
    pub fn saved(&mut self, path: &str) {
        self.reload.saved(path, Instant::now());
    }

    /// Handles an event other than a redraw.
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
        if self.on_gpu.take(event) || matches!(event, WindowEvent::Occluded(_)) {
            self.on_gpu.window.request_redraw();
        }
    }

    /// Uses shaders compiled in the background, or shows why it cannot.
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
        self.on_gpu.window.request_redraw();
    }

    /// Opens a file dropped on the window, as if it were given by `--scene`.
    fn open(&mut self, file: &Path) {
        let args = Args { scene: Some(file.to_owned()), ..self.args.clone() };
        let setup = Setup::new(&args);
        let made = (self.make)(&self.on_gpu.gpu, &setup).and_then(|mut sample| {
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
        self.on_gpu.window.request_redraw();
    }

    /// Creates the sample again and restores the values of its controls.
    fn remake(&mut self) -> Result<()> {
        let values = controls::list(|c| self.view.sample.controls(c));
        let mut sample = (self.make)(&self.on_gpu.gpu, &Setup::new(&self.args))?;
        self.panel.navigation.forget_home();
        sample.controls(&mut Controls::new(&mut Hidden::new(&mut self.panel.navigation)));
        for control in &values {
            // A control may have gone, or take other values: then the new one stands.
            let _ = controls::set(&control.name, &control.value, |c| sample.controls(c));
        }
        self.view.replace(sample)
    }

    /// Watches the shaders of the current pipelines.
    fn learn(&mut self) {
        let statistics = self.on_gpu.gpu.take_statistics();
        if let Err(error) = self.reload.learn(&statistics.descs) {
            self.panel.error = Some(format!("{error:#}"));
        }
        if !statistics.descs.is_empty() {
            self.facts.programs = statistics.executables;
        }
        self.facts.warnings = statistics.warnings.into_iter().map(|(_, line)| line).collect();
        if let Some(refused) = self.view.refused() {
            self.panel.error = Some(refused);
        }
    }
}
