//! A browser with one page open, whichever it is: Chromium, or Firefox where the tests run again in that.

use serde_json::Value;

use crate::FIREFOX;
use crate::chromium::Chromium;
use crate::firefox::{Firefox, Tab};
use crate::talk::Talk;

/// Differences between the browsers' protocols.
pub trait Engine {
    fn talk(&mut self) -> &mut Talk;
    /// Calls a method of the browser's protocol for the page, and gives its result.
    fn call(&mut self, method: &str, parameters: Value) -> Value;
    /// Begins to open an address.
    fn open(&mut self, address: &str);
    /// The event that a page is loaded.
    fn loaded(&self) -> &'static str;
    fn run(&mut self, script: &str) -> Value;
    fn size(&mut self, width: u32, height: u32, phone: bool);
    fn press(&mut self, key: &str, code: u32);
    fn drag(&mut self, way: &[[f64; 2]], by: Pointer);
    /// The page as base64 of a PNG: a part of it, or what is in view.
    fn shot(&mut self, part: Option<Value>) -> String;
}

/// The pointer that drags.
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

    /// Starts it as where there is no GPU that it would use.
    pub fn without_webgl() -> Self {
        if std::env::var_os(FIREFOX).is_some() {
            return Self(Box::new(Tab::alone(Firefox::without_webgl())));
        }
        Self::with(&["--disable-gpu", "--disable-3d-apis"])
    }

    /// Starts it with WebGL 2 by the system's OpenGL: without a GPU that is Mesa's llvmpipe.
    pub fn with_opengl() -> Self {
        Self::with(&["--use-angle=gl-egl", "--ignore-gpu-blocklist", "--enable-gpu"])
    }

    fn with(graphics: &[&str]) -> Self {
        match Tab::asked() {
            Some(tab) => Self(Box::new(tab)),
            None => Self(Box::new(Chromium::start(graphics))),
        }
    }

    /// Calls a method of Chromium's protocol, and gives its result.
    pub fn call(&mut self, method: &str, parameters: &Value) -> Value {
        self.0.call(method, parameters.clone())
    }

    /// Opens an address, waits until it is loaded, and gives everything that was told meanwhile.
    pub fn open(&mut self, address: &str) -> Vec<Value> {
        self.told();
        self.0.open(address);
        self.loaded(address)
    }

    /// Runs what leads to another page, such as a click on a link, and waits for that; what was told meanwhile.
    pub fn follow(&mut self, script: &str) -> Vec<Value> {
        self.told();
        self.run(script);
        self.loaded(script)
    }

    fn loaded(&mut self, doing: &str) -> Vec<Value> {
        let loaded = self.0.loaded();
        self.0.talk().wait(loaded, doing);
        // What the page's own scripts do last.
        self.run("new Promise(done => requestAnimationFrame(() => setTimeout(done)))");
        self.told()
    }

    /// Messages since the last call.
    pub fn told(&mut self) -> Vec<Value> {
        self.0.talk().told()
    }

    /// The value of an expression on the page; of a promise, what it becomes.
    pub fn run(&mut self, script: &str) -> Value {
        self.0.run(script)
    }

    /// Gives the page a size in CSS pixels.
    pub fn size(&mut self, width: u32, height: u32, phone: bool) {
        self.0.size(width, height, phone);
    }

    /// Presses a key and lets it go, such as `Tab` or `ArrowRight`.
    pub fn press(&mut self, key: &str, code: u32) {
        self.0.press(key, code);
    }

    /// Puts a pointer on a place in view, and moves it from there to others, the last of which is where it leaves.
    pub fn drag(&mut self, way: &[[f64; 2]], by: Pointer) {
        self.0.drag(way, by);
    }

    /// An element of the page as it is seen, as base64 of a PNG.
    pub fn part(&mut self, element: &str) -> String {
        let clip = self.run(&format!(
            "(box => ({{ x: box.x + scrollX, y: box.y + scrollY, width: box.width, height: box.height }}))\
             ({element}.getBoundingClientRect())"
        ));
        self.0.shot(Some(clip))
    }

    /// The page as it is seen, as base64 of a PNG.
    pub fn picture(&mut self) -> String {
        self.0.shot(None)
    }
}
