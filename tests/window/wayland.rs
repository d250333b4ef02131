//! A window on Wayland, with a compositor without a screen.

use std::process::{Child, Command, Stdio};

use run::layer::Layer;
use tempfile::TempDir;

use super::desk::wait;
use super::{alone, ended_well};

/// weston, and the folder of its socket; it is ended on drop.
struct Compositor {
    folder: TempDir,
    server: Child,
}

impl Compositor {
    const SOCKET: &str = "wayland-test";

    fn start() -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let mut command = Command::new("weston");
        command.args(["--backend=headless-backend.so", "--no-config", "--idle-time=0"]);
        command.arg(format!("--socket={}", Self::SOCKET)).env("XDG_RUNTIME_DIR", folder.path());
        command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
        let server = command
            .spawn()
            .unwrap_or_else(|error| panic!("no weston ({error}): run ./setup --tests"));
        let socket = folder.path().join(Self::SOCKET);
        wait("the compositor", || socket.exists().then_some(()));
        Self { folder, server }
    }
}

impl Drop for Compositor {
    fn drop(&mut self) {
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}

/// winit requests a frame callback before each present and draws nothing until it arrives; if the present
/// shows nothing, none arrives.
#[test]
fn a_present_that_shows_nothing_is_made_up_for_at_once() {
    let _alone = alone();
    let compositor = Compositor::start();
    for mood in ["suboptimal", "out-of-date=1", "out-of-date=3"] {
        let moods = Layer::display_faults(mood);
        let mut command = run::heeding("02_basic");
        command.args(["--validate", "--size", "480x300", "--frames", "12"]);
        command.env_remove("DISPLAY").env("WAYLAND_DISPLAY", Compositor::SOCKET);
        command.env("XDG_RUNTIME_DIR", compositor.folder.path()).envs(moods.environment());
        let sample = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn();
        let mut sample = sample.expect("the sample starts");
        wait("the end", || sample.try_wait().expect("its state is known"));
        ended_well(sample.wait_with_output().expect("its words can be read"));
    }
}
