//! A sample in a window: events in, pictures and panel out.
//!
//! One frame is in flight, and nothing is drawn while nothing changes: redraws are requested by input, by the
//! panel's animations, by a picture still to be sharpened or accumulated, and by edited shaders.

mod bookmarks;
mod compiler;
mod darkroom;
mod dots;
mod facts;
mod history;
mod keys;
mod lag;
mod navigation;
mod pace;
mod painter;
mod panel;
mod reload;
mod rows;
mod session;
mod shot;
mod stepped;
mod style;
mod transport;
mod view;
mod window_on_gpu;

use anyhow::{Context, Error, Result, anyhow};
use winit::application::ApplicationHandler;
use winit::event::{StartCause, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop, EventLoopProxy};
use winit::window::WindowId;

use self::session::Session;
use super::{Args, Program, RunHooks};
use crate::UsageError;
use crate::exit::compile_process;

/// The largest side of a window, in pixels: X11 uses signed 16-bit numbers.
const MOST_SIDE: u32 = 32_767;

/// Events sent to the event loop by other threads.
enum Wake {
    /// A file below `shaders/` was changed.
    Saved(String),
    /// The shaders are compiled, or the error.
    Compiled(Result<(), String>),
}

/// Opens a window for a sample and returns when it is closed.
///
/// # Errors
/// On wrong arguments ([`UsageError`]), without a display, if anything fails, or if validation reported a message.
pub fn open(program: &Program, args: &Args, hooks: &dyn RunHooks) -> Result<()> {
    if args.out.is_some() || !args.files.outputs.is_empty() {
        let hint = "--out and --report need --headless; in the window, F2 writes the picture";
        return Err(UsageError(hint.to_owned()).into());
    }
    let (width, height) = (args.size.width, args.size.height);
    if width.max(height) > MOST_SIDE {
        let most =
            format!("{width}x{height} is too large for a window: at most {MOST_SIDE} a side");
        return Err(UsageError(most).into());
    }
    log_if_asked();
    // An edited shader may crash the compiler, but must not close the window.
    compile_process::want();
    let events = EventLoop::with_user_event().build().map_err(|_| no_display())?;
    let proxy = events.create_proxy();
    let of = Of { program, args, hooks };
    let mut shows = Shows { of, proxy, session: None, outcome: Ok(()) };
    events.run_app(&mut shows).context("the window system failed")?;
    shows.outcome
}

/// The error for a missing or unusable display, and its remedy.
fn no_display() -> Error {
    let value = |name| std::env::var(name).ok().filter(|value| !value.is_empty());
    let asked = value("WAYLAND_DISPLAY").or_else(|| value("DISPLAY"));
    let why = asked.map_or_else(
        || "no display: set".to_owned(),
        |display| format!("no display at '{display}': check"),
    );
    anyhow!("{why} DISPLAY or WAYLAND_DISPLAY, or add --headless to render without a window")
}

/// `RUST_LOG=raybook=debug` logs every frame, `info` the longest delay; nothing is logged without it.
fn log_if_asked() {
    use tracing_subscriber::{filter::Targets, fmt, prelude::*};
    // An empty setting would enable all errors, and winit reports one in seven lines.
    let asked = std::env::var("RUST_LOG").ok().filter(|asked| !asked.is_empty());
    let Some(Ok(targets)) = asked.map(|asked| asked.parse::<Targets>()) else { return };
    let layer = fmt::layer().with_ansi(false).with_writer(std::io::stderr);
    // A program that has set up its own logger keeps it.
    let _ = tracing_subscriber::registry().with(layer.with_filter(targets)).try_init();
}

/// Arguments for opening a window.
#[derive(Clone, Copy)]
struct Of<'a> {
    program: &'a Program,
    args: &'a Args,
    hooks: &'a dyn RunHooks,
}

struct Shows<'a> {
    of: Of<'a>,
    proxy: EventLoopProxy<Wake>,
    /// Nothing before there is a window, and after it.
    session: Option<Session>,
    outcome: Result<()>,
}

impl Shows<'_> {
    /// Ends the window, also where its device is lost.
    fn fail(&mut self, events: &ActiveEventLoop, error: Error) {
        self.outcome = Err(error);
        events.exit();
    }
}

impl ApplicationHandler<Wake> for Shows<'_> {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        if self.session.is_some() {
            return;
        }
        match Session::new(events, self.of, self.proxy.clone()) {
            Ok(session) => {
                let session = self.session.insert(session);
                if let Err(error) = session.begin() {
                    self.fail(events, error);
                }
            }
            Err(error) => self.fail(events, error),
        }
    }

    fn new_events(&mut self, _: &ActiveEventLoop, cause: StartCause) {
        if let Some(session) = &mut self.session {
            session.wake(matches!(cause, StartCause::ResumeTimeReached { .. }));
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(session) = &mut self.session else { return };
        match event {
            WindowEvent::CloseRequested => events.exit(),
            WindowEvent::RedrawRequested => match session.draw(self.of.hooks) {
                Ok(true) => {}
                Ok(false) => events.exit(),
                Err(error) => self.fail(events, error),
            },
            event => session.take(&event),
        }
    }

    fn user_event(&mut self, _: &ActiveEventLoop, wake: Wake) {
        let Some(session) = &mut self.session else { return };
        match wake {
            Wake::Saved(path) => session.saved(&path),
            Wake::Compiled(result) => session.compiled(result),
        }
    }

    fn about_to_wait(&mut self, events: &ActiveEventLoop) {
        let next = self.session.as_mut().and_then(Session::sleep);
        events.set_control_flow(next.map_or(ControlFlow::Wait, ControlFlow::WaitUntil));
    }

    fn exiting(&mut self, _: &ActiveEventLoop) {
        // The surface must go before the connection to the window system does.
        let closed = self.session.take().map_or(Ok(()), Session::close);
        if self.outcome.is_ok() {
            self.outcome = closed;
        }
    }
}
