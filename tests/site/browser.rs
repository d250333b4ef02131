//! A browser with one page open: Chromium, or Firefox if the tests run again in that.

use serde_json::Value;

use crate::FIREFOX;
use crate::chromium::Chromium;
use crate::firefox::{Firefox, Tab};
use crate::talk::Talk;

/// The part of a browser that depends on its protocol.
pub trait Engine {
    fn talk(&mut self) -> &mut Talk;
    /// Calls a method of the browser's protocol for the page, and returns its result.
    fn call(&mut self, method: &str, parameters: Value) -> Value;
    /// Starts loading an address.
    fn open(&mut self, address: &str);
    /// The name of the event for a loaded page.
    fn loaded(&self) -> &'static str;
    fn run(&mut self, script: &str) -> Value;
    fn size(&mut self, width: u32, height: u32, phone: bool);
    fn press(&mut self, key: &str, code: u32);
    fn drag(&mut self, way: &[[f64; 2]], by: Pointer);
    /// A screenshot as base64 of a PNG: a part of the page, or the visible area.
    fn shot(&mut self, part: Option<Value>) -> String;
}

/// The dragging pointer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pointer {
    Mouse,
    Finger,
}

/// A browser with one page open.
pub struct Browser(Box<dyn Engine>);

impl Browser {
    /// Starts it.
    pub fn start() -> Self {
        Self::with(&["--disable-gpu"])
    }

    /// Starts it with WebGL 2 on the processor: Chromium by SwiftShader, Firefox by llvmpipe.
    pub fn with_webgl() -> Self {
        Self::with(&["--use-angle=swiftshader", "--enable-unsafe-swiftshader"])
    }

    /// Starts it as on a machine without a usable GPU.
    pub fn without_webgl() -> Self {
        if std::env::var_os(FIREFOX).is_some() {
            return Self(Box::new(Tab::alone(Firefox::without_webgl())));
        }
        Self::with(&["--disable-gpu", "--disable-3d-apis"])
    }

    /// Starts it with WebGL 2 on the system's OpenGL, which without a GPU is Mesa's llvmpipe.
    pub fn with_opengl() -> Self {
        Self::with(&["--use-angle=gl-egl", "--ignore-gpu-blocklist", "--enable-gpu"])
    }

    fn with(graphics: &[&str]) -> Self {
        match Tab::asked() {
            Some(tab) => Self(Box::new(tab)),
            None => Self(Box::new(Chromium::start(graphics))),
        }
    }

    /// Calls a method of Chromium's protocol, and returns its result.
    pub fn call(&mut self, method: &str, parameters: &Value) -> Value {
        self.0.call(method, parameters.clone())
    }

    /// Opens an address, waits until it is loaded, and returns all messages meanwhile.
    pub fn open(&mut self, address: &str) -> Vec<Value> {
        self.told();
        self.0.open(address);
        self.loaded(address)
    }

    /// Runs a script that leads to another page, such as a click on a link, waits for that, and returns all
    /// messages meanwhile.
    pub fn follow(&mut self, script: &str) -> Vec<Value> {
        self.told();
        self.run(script);
        self.loaded(script)
    }

    fn loaded(&mut self, doing: &str) -> Vec<Value> {
        let loaded = self.0.loaded();
        self.0.talk().wait(loaded, doing);
        // The last thing the page's own scripts do.
        self.run("new Promise(done => requestAnimationFrame(() => setTimeout(done)))");
        self.told()
    }

    /// The messages since the last call.
    pub fn told(&mut self) -> Vec<Value> {
        self.0.talk().told()
    }

    /// The value of an expression on the page; for a promise, its result.
    pub fn run(&mut self, script: &str) -> Value {
        self.0.run(script)
    }

    /// Sets the page's size in CSS pixels.
    pub fn size(&mut self, width: u32, height: u32, phone: bool) {
        self.0.size(width, height, phone);
    }

    /// Presses and releases a key, such as `Tab` or `ArrowRight`.
    pub fn press(&mut self, key: &str, code: u32) {
        self.0.press(key, code);
    }

    /// Presses a pointer at a visible place, and moves it from there to others; it is released at the last.
    pub fn drag(&mut self, way: &[[f64; 2]], by: Pointer) {
        self.0.drag(way, by);
    }

    /// A screenshot of an element of the page, as base64 of a PNG.
    pub fn part(&mut self, element: &str) -> String {
        let clip = self.run(&format!(
            "(box => ({{ x: box.x + scrollX, y: box.y + scrollY, width: box.width, height: box.height }}))\
             ({element}.getBoundingClientRect())"
        ));
        self.0.shot(Some(clip))
    }

    /// A screenshot of the page, as base64 of a PNG.
    pub fn picture(&mut self) -> String {
        self.0.shot(None)
    }
}
