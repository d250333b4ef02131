//! A browser without a window, asked through two pipes in the DevTools protocol.

use std::collections::VecDeque;
use std::io::{BufRead, BufReader, Write};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread;
use std::time::{Duration, Instant};

use serde_json::{Value, json};

/// How long an answer may take on a machine with much else to do.
const PATIENCE: Duration = patience::ASLEEP;
/// What the program may be called.
const NAMES: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];

/// Chromium with one page open.
pub struct Browser {
    child: Child,
    asked: ChildStdin,
    told: Receiver<Value>,
    events: VecDeque<Value>,
    session: Option<String>,
    last: u64,
    _profile: tempfile::TempDir,
}

impl Browser {
    /// Starts it.
    pub fn start() -> Self {
        Self::with(&["--disable-gpu"])
    }

    /// Starts it as where there is no GPU that it would use.
    pub fn without_webgl() -> Self {
        Self::with(&["--disable-gpu", "--disable-3d-apis"])
    }

    /// Starts it with WebGL 2 on the processor, by SwiftShader.
    pub fn with_webgl() -> Self {
        Self::with(&["--use-angle=swiftshader", "--enable-unsafe-swiftshader"])
    }

    fn with(graphics: &[&str]) -> Self {
        let found = |name: &&&str| {
            let probe = Command::new(name).arg("--version").stderr(Stdio::null()).output();
            probe.is_ok_and(|probe| probe.status.success())
        };
        let name = NAMES
            .iter()
            .find(found)
            .expect("no Chromium on the PATH: run ./setup, or install Google Chrome");
        let profile = tempfile::tempdir().expect("a temporary folder");
        // It reads from 3 and writes to 4.
        let mut child = Command::new("sh")
            .args(["-c", "exec \"$@\" 3<&0 4>&1 </dev/null >/dev/null 2>&1", "sh", name])
            .args(["--headless", "--remote-debugging-pipe", "--no-first-run"])
            .args(graphics)
            // Root has no sandbox, and the pages are our own.
            .args(["--no-sandbox", "--disable-dev-shm-usage", "--hide-scrollbars"])
            .args(["--disable-background-networking", "--disable-component-update"])
            .arg(format!("--user-data-dir={}", profile.path().display()))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .expect("sh starts");
        let asked = child.stdin.take().expect("a pipe");
        let mut answers = BufReader::new(child.stdout.take().expect("a pipe"));
        let (tell, told) = channel();
        thread::spawn(move || {
            let mut text = Vec::new();
            while answers.read_until(0, &mut text).is_ok_and(|length| length > 0) {
                text.pop();
                let Ok(value) = serde_json::from_slice(&text) else { break };
                text.clear();
                if tell.send(value).is_err() {
                    break;
                }
            }
        });
        let mut browser = Self {
            child,
            asked,
            told,
            events: VecDeque::new(),
            session: None,
            last: 0,
            _profile: profile,
        };
        let target = browser.call("Target.createTarget", &json!({ "url": "about:blank" }));
        let attach = json!({ "targetId": target["targetId"], "flatten": true });
        let attached = browser.call("Target.attachToTarget", &attach);
        browser.session = attached["sessionId"].as_str().map(str::to_owned);
        for domain in ["Page", "Runtime", "Log", "Network"] {
            browser.call(&format!("{domain}.enable"), &json!({}));
        }
        browser
    }

    /// Calls a method and gives its result.
    pub fn call(&mut self, method: &str, parameters: &Value) -> Value {
        self.last += 1;
        let mut message = json!({ "id": self.last, "method": method, "params": parameters });
        if let Some(session) = &self.session {
            message["sessionId"] = json!(session);
        }
        let mut text = message.to_string().into_bytes();
        text.push(0);
        self.asked.write_all(&text).expect("Chromium listens");
        let start = Instant::now();
        loop {
            let mut told = self.next(method, start);
            if told["id"] == json!(self.last) {
                assert!(told["error"].is_null(), "{method}: {}", told["error"]);
                return told["result"].take();
            }
            self.events.push_back(told);
        }
    }

    fn next(&self, doing: &str, start: Instant) -> Value {
        match self.told.recv_timeout(PATIENCE.saturating_sub(start.elapsed())) {
            Ok(told) => told,
            Err(RecvTimeoutError::Timeout) => panic!("{doing}: no answer for {PATIENCE:?}"),
            Err(RecvTimeoutError::Disconnected) => panic!("{doing}: Chromium has gone"),
        }
    }

    /// Opens an address, waits until it is loaded, and gives everything that was told meanwhile.
    pub fn open(&mut self, address: &str) -> Vec<Value> {
        self.events.clear();
        let opened = self.call("Page.navigate", &json!({ "url": address }));
        assert!(opened["errorText"].is_null(), "{address}: {}", opened["errorText"]);
        self.loaded(address)
    }

    /// Runs what leads to another page, such as a click on a link, and waits for that; what was told meanwhile.
    pub fn follow(&mut self, script: &str) -> Vec<Value> {
        self.events.clear();
        self.run(script);
        self.loaded(script)
    }

    fn loaded(&mut self, doing: &str) -> Vec<Value> {
        let start = Instant::now();
        let loaded = |event: &Value| event["method"] == "Page.loadEventFired";
        while !self.events.iter().any(loaded) {
            let told = self.next(doing, start);
            self.events.push_back(told);
        }
        // What the page's own scripts do last.
        self.run("new Promise(done => requestAnimationFrame(() => setTimeout(done)))");
        self.events.drain(..).collect()
    }

    /// What was told since.
    pub fn told(&mut self) -> Vec<Value> {
        self.events.drain(..).collect()
    }

    /// The value of an expression on the page; of a promise, what it becomes.
    pub fn run(&mut self, script: &str) -> Value {
        let parameters =
            json!({ "expression": script, "returnByValue": true, "awaitPromise": true });
        let mut result = self.call("Runtime.evaluate", &parameters);
        let wrong = &result["exceptionDetails"];
        assert!(wrong.is_null(), "{script}: {wrong}");
        result["result"]["value"].take()
    }

    /// Gives the page a size in CSS pixels.
    pub fn size(&mut self, width: u32, height: u32, phone: bool) {
        let size =
            json!({ "width": width, "height": height, "deviceScaleFactor": 1, "mobile": phone });
        self.call("Emulation.setDeviceMetricsOverride", &size);
    }

    /// Presses a key and lets it go, such as `Tab` or `ArrowRight`.
    pub fn press(&mut self, key: &str, code: u32) {
        for kind in ["rawKeyDown", "keyUp"] {
            let press =
                json!({ "type": kind, "key": key, "code": key, "windowsVirtualKeyCode": code });
            self.call("Input.dispatchKeyEvent", &press);
        }
    }

    /// An element of the page as it is seen, as base64 of a PNG.
    pub fn part(&mut self, element: &str) -> String {
        let clip = self.run(&format!(
            "(box => ({{ x: box.x + scrollX, y: box.y + scrollY, width: box.width, height: box.height, \
             scale: 1 }}))({element}.getBoundingClientRect())"
        ));
        let part = json!({ "format": "png", "clip": clip, "captureBeyondViewport": true });
        let shot = self.call("Page.captureScreenshot", &part);
        shot["data"].as_str().unwrap_or_default().to_owned()
    }

    /// The page as it is seen, as base64 of a PNG.
    pub fn picture(&mut self) -> String {
        let shot = self.call("Page.captureScreenshot", &json!({ "format": "png" }));
        shot["data"].as_str().unwrap_or_default().to_owned()
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
