//! An X server without a screen, a sample's window on it, and simulated keyboard and mouse input.

use std::ffi::OsString;
use std::fs::File;
use std::io::{IoSlice, Read};
use std::os::fd::AsFd;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use image::{Rgb, RgbImage};
use tempfile::TempDir;
use time_limit::ASLEEP;
use x11rb::connection::{Connection, RequestConnection};
use x11rb::protocol::xproto::{
    self, AtomEnum, ClientMessageEvent, ConfigureWindowAux, ConnectionExt, EventMask, ImageFormat,
    InputFocus, MapState,
};
use x11rb::rust_connection::RustConnection;

use crate::xvfb;

/// A sample in a window on its own server; both are ended on drop.
pub struct Desk {
    /// The current folder of the sample, which receives its pictures.
    pub folder: TempDir,
    sample: Option<Child>,
    server: Child,
    x: RustConnection,
    root: u32,
    window: u32,
    /// The number of bits of a colour.
    bits: u32,
}

/// Calls `look` until it returns something.
///
/// # Panics
/// If it never does, with `what`.
pub fn wait<T>(what: &str, mut look: impl FnMut() -> Option<T>) -> T {
    let start = Instant::now();
    loop {
        if let Some(found) = look() {
            return found;
        }
        assert!(start.elapsed() < ASLEEP, "waited {ASLEEP:?} for {what}");
        std::thread::sleep(Duration::from_millis(5));
    }
}

impl Desk {
    /// Opens a sample with arguments and environment, and waits until its window shows a picture.
    pub fn open(name: &str, arguments: &[&str], environment: &[(&str, &Path)]) -> Self {
        let desk = Self::begin(name, arguments, environment);
        desk.wait_for_a_picture();
        desk
    }

    /// Waits until its window shows a picture.
    pub fn wait_for_a_picture(&self) {
        wait("a picture", || {
            let shown = self.shown();
            let (width, height) = shown.dimensions();
            (shown.get_pixel(width - 1, 0) != shown.get_pixel(width - 1, height - 1)).then_some(())
        });
    }

    /// The same, and waits until there is a window.
    pub fn begin(name: &str, arguments: &[&str], environment: &[(&str, &Path)]) -> Self {
        Self::begin_by(run::heeding(name), arguments, environment)
    }

    /// The same for any program.
    pub fn begin_by(command: Command, arguments: &[&str], environment: &[(&str, &Path)]) -> Self {
        Self::begin_on(xvfb::start(&[]), command, arguments, environment)
    }

    /// The same on this server.
    pub fn begin_on(
        (server, display): (Child, String),
        mut command: Command,
        arguments: &[&str],
        environment: &[(&str, &Path)],
    ) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        command.args(arguments).current_dir(folder.path()).env("DISPLAY", &display);
        command.env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET");
        command.envs(environment.iter().copied()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let sample = command.spawn().expect("the sample starts");
        let (x, screen) = RustConnection::connect(Some(&display)).expect("the server answers");
        let screen = &x.setup().roots[screen];
        let bits = if screen.root_depth == 30 { 10 } else { 8 };
        let root = screen.root;
        let mut desk = Self { folder, sample: Some(sample), server, x, root, window: 0, bits };
        desk.window = wait("a window", || desk.find_window());
        desk.focus();
        desk
    }

    fn find_window(&mut self) -> Option<u32> {
        let sample = self.sample.as_mut().expect("the sample runs");
        if sample.try_wait().expect("its state is known").is_some() {
            panic!("it has ended instead of opening a window: {}", self.errors());
        }
        let tree = self.x.query_tree(self.root).unwrap().reply().unwrap();
        tree.children.into_iter().find(|&window| {
            let Ok(attributes) = self.x.get_window_attributes(window).unwrap().reply() else {
                return false;
            };
            attributes.map_state == MapState::VIEWABLE && !self.title(window).is_empty()
        })
    }

    fn title(&self, window: u32) -> String {
        let (name, string) = (AtomEnum::WM_NAME, AtomEnum::ANY);
        let cookie = self.x.get_property(false, window, name, string, 0, 1024).unwrap();
        cookie.reply().map_or_else(|_| String::new(), |p| String::from_utf8_lossy(&p.value).into())
    }

    /// The output of a sample that ends by itself.
    fn last_words(&self) -> String {
        let stderr = self.sample.as_ref().and_then(|sample| sample.stderr.as_ref());
        let stderr = stderr.expect("piped").as_fd().try_clone_to_owned().expect("a descriptor");
        let mut text = String::new();
        File::from(stderr).read_to_string(&mut text).expect("it is text");
        text
    }

    fn errors(&mut self) -> String {
        let mut text = String::new();
        let stderr = self.sample.as_mut().and_then(|sample| sample.stderr.as_mut());
        stderr.expect("piped").read_to_string(&mut text).expect("it is text");
        text
    }

    /// There is no window manager to give the window the keyboard.
    fn focus(&self) {
        self.x.set_input_focus(InputFocus::POINTER_ROOT, self.window, x11rb::CURRENT_TIME).unwrap();
        self.x.sync();
    }

    /// The content of the window.
    pub fn shown(&self) -> RgbImage {
        let Ok(size) = self.x.get_geometry(self.window).unwrap().reply() else {
            panic!("the window is gone: {}", self.last_words())
        };
        let (width, height) = (size.width, size.height);
        let format = ImageFormat::Z_PIXMAP;
        let image = self.x.get_image(format, self.window, 0, 0, width, height, u32::MAX).unwrap();
        // While the window is being resized there is no such image: try again later.
        let Ok(image) = image.reply() else { return RgbImage::new(width.into(), height.into()) };
        let pixels = image.data.chunks_exact(4).map(|pixel| {
            let word = u32::from_le_bytes([pixel[0], pixel[1], pixel[2], pixel[3]]);
            // The upper 8 bits of each colour; blue is in the lowest bits.
            Rgb([2, 1, 0].map(|place| (word >> ((place + 1) * self.bits - 8)) as u8))
        });
        let mut shown = RgbImage::new(width.into(), height.into());
        shown.pixels_mut().zip(pixels).for_each(|(to, from)| *to = from);
        shown
    }

    /// Presses F2 and returns the picture written by the sample, and its file.
    pub fn picture(&self) -> (RgbImage, PathBuf) {
        let pictures = || {
            let files = self.folder.path().read_dir().expect("the folder is there");
            files
                .map(|file| file.expect("it can be listed").path())
                .filter(|path| path.extension().is_some_and(|extension| extension == "png"))
        };
        let before: Vec<PathBuf> = pictures().collect();
        self.key(KEY_F2);
        let file = wait("a written picture", || pictures().find(|path| !before.contains(path)));
        (image::open(&file).expect("a whole PNG").to_rgb8(), file)
    }

    /// Presses and releases a key, by its symbol.
    pub fn key(&self, symbol: u32) {
        let code = self.code(symbol);
        self.fake(xproto::KEY_PRESS_EVENT, code, 0, 0);
        self.fake(xproto::KEY_RELEASE_EVENT, code, 0, 0);
    }

    /// Clicks a place with Ctrl held.
    pub fn click_with_control(&self, (x, y): (i16, i16)) {
        let code = self.code(KEY_CONTROL);
        self.point(x, y);
        self.fake(xproto::KEY_PRESS_EVENT, code, 0, 0);
        self.button(true);
        self.button(false);
        self.fake(xproto::KEY_RELEASE_EVENT, code, 0, 0);
    }

    /// The code of the key with this symbol.
    fn code(&self, symbol: u32) -> u8 {
        let setup = self.x.setup();
        let (first, last) = (setup.min_keycode, setup.max_keycode);
        let map = self.x.get_keyboard_mapping(first, last - first + 1).unwrap().reply().unwrap();
        let symbols = map.keysyms.chunks(map.keysyms_per_keycode.into());
        let index = symbols.into_iter().position(|row| row.first() == Some(&symbol));
        first + index.expect("the keyboard has the key") as u8
    }

    /// Moves the pointer to a position in the window.
    pub fn point(&self, x: i16, y: i16) {
        let cookie = self.x.translate_coordinates(self.window, self.root, x, y).unwrap();
        let at = cookie.reply().expect("the window is there");
        self.fake(xproto::MOTION_NOTIFY_EVENT, 0, at.dst_x, at.dst_y);
    }

    /// Presses or releases the left button.
    pub fn button(&self, down: bool) {
        let event = if down { xproto::BUTTON_PRESS_EVENT } else { xproto::BUTTON_RELEASE_EVENT };
        self.fake(event, 1, 0, 0);
    }

    /// Drags from one position to another, in steps as small as a hand's.
    pub fn drag(&self, from: (i16, i16), to: (i16, i16), steps: i16) {
        self.point(from.0, from.1);
        self.button(true);
        for step in 1..=steps {
            let part = f32::from(step) / f32::from(steps);
            let between = |a: i16, b: i16| a + (f32::from(b - a) * part).round() as i16;
            self.point(between(from.0, to.0), between(from.1, to.1));
            std::thread::sleep(Duration::from_millis(8));
        }
        self.button(false);
    }

    /// One `FakeInput` of the XTEST extension, which the server treats like a real device's.
    fn fake(&self, event: u8, detail: u8, x: i16, y: i16) {
        let extension = self.x.extension_information("XTEST").unwrap().expect("Xvfb has XTEST");
        let mut request = [0; 36];
        (request[0], request[1], request[4], request[5]) =
            (extension.major_opcode, 2, event, detail);
        request[2..4].copy_from_slice(&9u16.to_ne_bytes());
        request[24..26].copy_from_slice(&x.to_ne_bytes());
        request[26..28].copy_from_slice(&y.to_ne_bytes());
        self.x.send_request_without_reply(&[IoSlice::new(&request)], Vec::new()).unwrap();
        self.x.sync();
    }

    /// Gives the window another size.
    pub fn resize(&self, width: u32, height: u32) {
        let size = ConfigureWindowAux::new().width(width).height(height);
        self.x.configure_window(self.window, &size).unwrap();
        self.x.sync();
    }

    /// Unmaps the window, like a window manager that minimises it, or maps it again.
    pub fn map(&self, mapped: bool) {
        if mapped {
            self.x.map_window(self.window).unwrap();
        } else {
            self.x.unmap_window(self.window).unwrap();
        }
        self.x.sync();
        if mapped {
            wait("the window", || self.x.get_window_attributes(self.window).ok()?.reply().ok());
            self.focus();
        }
    }

    /// Closes the window through the protocol used by window managers.
    pub fn close(&self) {
        let atom = |name: &[u8]| self.x.intern_atom(false, name).unwrap().reply().unwrap().atom;
        let (protocols, delete) = (atom(b"WM_PROTOCOLS"), atom(b"WM_DELETE_WINDOW"));
        let data = [delete, x11rb::CURRENT_TIME, 0, 0, 0];
        let event = ClientMessageEvent::new(32, self.window, protocols, data);
        self.x.send_event(false, self.window, EventMask::NO_EVENT, event).unwrap();
        self.x.sync();
    }

    /// Kills the server, as if the user's session had crashed.
    pub fn kill_server(&mut self) {
        self.server.kill().expect("it runs");
        self.server.wait().expect("it ends");
    }

    /// Destroys the window, like a faulty client.
    pub fn destroy(&self) {
        self.x.destroy_window(self.window).unwrap();
        self.x.sync();
    }

    /// The sample's process.
    pub fn id(&self) -> u32 {
        self.sample.as_ref().expect("the sample runs").id()
    }

    /// The sample's processor time, in ticks of the system's clock.
    pub fn worked(&self) -> u64 {
        let text = std::fs::read_to_string(format!("/proc/{}/stat", self.id())).expect("it runs");
        // The program's name, in brackets, may contain anything; the user time is the 12th word after it.
        let (_, words) = text.rsplit_once(") ").expect("a name in brackets");
        let words: Vec<&str> = words.split(' ').collect();
        words[11..13].iter().map(|ticks| ticks.parse::<u64>().expect("a number")).sum()
    }

    /// Waits until the sample has ended, and returns its status and output.
    pub fn end(self) -> Output {
        self.end_with(|| ()).0
    }

    /// The same, with access to the folder before it is removed.
    pub fn end_with<T>(mut self, look: impl FnOnce() -> T) -> (Output, T) {
        let sample = self.sample.as_mut().expect("the sample runs");
        wait("the end", || sample.try_wait().expect("its state is known"));
        let sample = self.sample.take().expect("the sample runs");
        (sample.wait_with_output().expect("its words can be read"), look())
    }
}

/// The single line with which a sample refuses to open a window.
pub fn refusal(name: &str, arguments: &[&str], environment: &[(&str, OsString)]) -> String {
    run::refusal(outcome(name, arguments, environment)).1
}

/// The result of a sample that closes its window by itself.
pub fn outcome(name: &str, arguments: &[&str], environment: &[(&str, OsString)]) -> Output {
    outcome_with(name, arguments, environment, |_| {})
}

/// The same, with `act` called with the number of its process.
pub fn outcome_with(
    name: &str,
    arguments: &[&str],
    environment: &[(&str, OsString)],
    then: impl FnOnce(u32),
) -> Output {
    outcome_on(xvfb::start(&[]), name, arguments, environment, then)
}

/// The same on this server.
pub fn outcome_on(
    (mut server, display): (Child, String),
    name: &str,
    arguments: &[&str],
    environment: &[(&str, OsString)],
    then: impl FnOnce(u32),
) -> Output {
    let mut command: Command = run::heeding(name);
    command.args(arguments).env("DISPLAY", &display);
    command.env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET");
    command.envs(environment.iter().map(|(name, value)| (name, value)));
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn();
    let child = child.expect("the sample starts");
    then(child.id());
    let output = child.wait_with_output().expect("its words can be read");
    let _ = server.kill();
    let _ = server.wait();
    output
}

impl Drop for Desk {
    fn drop(&mut self) {
        for child in self.sample.iter_mut().chain([&mut self.server]) {
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}

trait Sync {
    /// Returns after the server has processed all requests.
    fn sync(&self);
}

impl Sync for RustConnection {
    fn sync(&self) {
        self.get_input_focus().unwrap().reply().expect("the server answers");
    }
}

/// F1.
pub const KEY_F1: u32 = 0xffbe;
/// F2.
pub const KEY_F2: u32 = 0xffbf;
/// F5.
pub const KEY_F5: u32 = 0xffc2;
/// Escape.
pub const KEY_ESCAPE: u32 = 0xff1b;
/// Tab.
pub const KEY_TAB: u32 = 0xff09;
/// The key Ctrl.
const KEY_CONTROL: u32 = 0xffe3;
/// Home.
pub const KEY_HOME: u32 = 0xff50;
/// The space bar.
pub const KEY_SPACE: u32 = 0x20;
/// The comma.
pub const KEY_COMMA: u32 = 0x2c;
/// The full stop.
pub const KEY_PERIOD: u32 = 0x2e;
