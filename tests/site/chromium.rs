//! Chromium without a window, controlled through two pipes in the DevTools protocol.

use std::io::{BufRead, BufReader, Write};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::Duration;

use serde_json::{Value, json};

use crate::browser::{Engine, Pointer};
use crate::talk::{Talk, Wire};

/// The possible names of the program.
const NAMES: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];

/// The first of these programs that can be run.
pub fn found(names: &[&'static str]) -> Option<&'static str> {
    names.iter().copied().find(|name| {
        let probe = Command::new(name).arg("--version").stderr(Stdio::null()).output();
        probe.is_ok_and(|probe| probe.status.success())
    })
}

/// Chromium with one page open.
pub struct Chromium {
    child: Child,
    talk: Talk,
    session: Value,
    _profile: tempfile::TempDir,
}

/// Messages separated by zero bytes.
struct Pipes {
    asked: ChildStdin,
    told: Receiver<Value>,
}

impl Wire for Pipes {
    fn send(&mut self, message: &Value) -> Result<(), String> {
        let text = format!("{message}\0");
        self.asked.write_all(text.as_bytes()).map_err(|error| format!("Chromium: {error}"))
    }

    fn next(&mut self, patience: Duration) -> Result<Value, String> {
        self.told.recv_timeout(patience).map_err(|error| format!("Chromium: {error}"))
    }
}

impl Chromium {
    /// Starts it.
    pub fn start(graphics: &[&str]) -> Self {
        let name = found(&NAMES)
            .expect("no Chromium on the PATH: run ./setup --tests, or install Google Chrome");
        let profile = tempfile::tempdir().expect("a temporary folder");
        // It reads from descriptor 3 and writes to 4.
        let mut child = Command::new("sh")
            .args(["-c", "exec \"$@\" 3<&0 4>&1 </dev/null >/dev/null 2>&1", "sh", name])
            .args(["--headless", "--remote-debugging-pipe", "--no-first-run"])
            .args(graphics)
            // Root cannot use the sandbox, and the pages are our own.
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
        let talk = Talk::over(Pipes { asked, told });
        let mut browser = Self { child, talk, session: Value::Null, _profile: profile };
        let target = browser.call("Target.createTarget", json!({ "url": "about:blank" }));
        let attach = json!({ "targetId": target["targetId"], "flatten": true });
        browser.session = browser.call("Target.attachToTarget", attach)["sessionId"].take();
        for domain in ["Page", "Runtime", "Log", "Network"] {
            browser.call(&format!("{domain}.enable"), json!({}));
        }
        browser
    }
}

impl Engine for Chromium {
    fn talk(&mut self) -> &mut Talk {
        &mut self.talk
    }

    fn call(&mut self, method: &str, parameters: Value) -> Value {
        let mut question = json!({ "method": method, "params": parameters });
        if !self.session.is_null() {
            question["sessionId"] = self.session.clone();
        }
        self.talk.ask(question)
    }

    fn open(&mut self, address: &str) {
        let opened = self.call("Page.navigate", json!({ "url": address }));
        assert!(opened["errorText"].is_null(), "{address}: {}", opened["errorText"]);
    }

    fn loaded(&self) -> &'static str {
        "Page.loadEventFired"
    }

    fn run(&mut self, script: &str) -> Value {
        let parameters =
            json!({ "expression": script, "returnByValue": true, "awaitPromise": true });
        let mut result = self.call("Runtime.evaluate", parameters);
        let wrong = &result["exceptionDetails"];
        assert!(wrong.is_null(), "{script}: {wrong}");
        result["result"]["value"].take()
    }

    fn size(&mut self, width: u32, height: u32, phone: bool) {
        let size =
            json!({ "width": width, "height": height, "deviceScaleFactor": 1, "mobile": phone });
        self.call("Emulation.setDeviceMetricsOverride", size);
    }

    fn press(&mut self, key: &str, code: u32) {
        for kind in ["rawKeyDown", "keyUp"] {
            let press =
                json!({ "type": kind, "key": key, "code": key, "windowsVirtualKeyCode": code });
            self.call("Input.dispatchKeyEvent", press);
        }
    }

    fn drag(&mut self, way: &[[f64; 2]], by: Pointer) {
        let touch = json!({ "enabled": by == Pointer::Finger });
        self.call("Emulation.setTouchEmulationEnabled", touch);
        let [.., [x, y]] = *way else { panic!("no way") };
        let kinds = std::iter::once(("mousePressed", "touchStart"))
            .chain(std::iter::repeat(("mouseMoved", "touchMove")));
        let way = way.iter().zip(kinds).map(|([x, y], kind)| (*x, *y, kind));
        for (x, y, (mouse, touch)) in way.chain([(x, y, ("mouseReleased", "touchEnd"))]) {
            match by {
                Pointer::Mouse => {
                    let event = json!({ "type": mouse, "x": x, "y": y, "button": "left", "buttons": 1, "clickCount": 1 });
                    self.call("Input.dispatchMouseEvent", event);
                }
                Pointer::Finger => {
                    let fingers =
                        if touch == "touchEnd" { json!([]) } else { json!([{ "x": x, "y": y }]) };
                    let event = json!({ "type": touch, "touchPoints": fingers });
                    self.call("Input.dispatchTouchEvent", event);
                }
            }
        }
    }

    fn shot(&mut self, part: Option<Value>) -> String {
        let mut shot = json!({ "format": "png" });
        if let Some(mut clip) = part {
            clip["scale"] = json!(1);
            shot["clip"] = clip;
            shot["captureBeyondViewport"] = json!(true);
        }
        let shot = self.call("Page.captureScreenshot", shot);
        shot["data"].as_str().unwrap_or_default().to_owned()
    }
}

impl Drop for Chromium {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
