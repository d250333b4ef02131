//! Firefox, controlled through a socket in the protocol WebDriver BiDi.
//!
//! Without a window it has no WebGL 2, so it draws to an X server without a screen, with llvmpipe. It starts
//! once: the tests that have passed in Chromium run again in a separate process, each in a tab of it.

use std::env;
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::channel;
use std::thread;
use std::time::Duration;

use serde_json::{Value, json};
use tempfile::TempDir;
use tungstenite::WebSocket;
use tungstenite::protocol::Role;

use crate::browser::{Engine, Pointer};
use crate::chromium::found;
use crate::talk::{PATIENCE, Talk, Wire};
use crate::{FIREFOX, xvfb};

/// The possible names of the program.
const NAMES: [&str; 2] = ["firefox-esr", "firefox"];
/// Frames are drawn as fast as possible instead of sixty per second.
const PREFERENCES: &str = "user_pref(\"layout.frame_rate\", 0);\n";

/// Firefox and its X server; both are ended on drop.
pub struct Firefox {
    child: Child,
    server: Option<Child>,
    /// The address and port on which it listens.
    host: String,
    _profile: TempDir,
}

impl Firefox {
    /// Starts it with WebGL 2.
    pub fn start() -> Self {
        let (server, display) = xvfb::start(&[]);
        Self::with(Some(server), |command| {
            command.env("DISPLAY", &display).env("MOZ_X11_EGL", "1");
        })
    }

    /// Starts it without a window.
    pub fn without_webgl() -> Self {
        Self::with(None, |command| {
            command.arg("--headless");
        })
    }

    fn with(server: Option<Child>, graphics: impl Fn(&mut Command)) -> Self {
        let name = found(&NAMES).expect("no Firefox on the PATH: run ./setup --tests");
        let profile = tempfile::tempdir().expect("a temporary folder");
        fs::write(profile.path().join("user.js"), PREFERENCES).expect("it can be written");
        let mut command = Command::new(name);
        command.args(["--no-remote", "--remote-debugging-port", "0", "--profile"]);
        command.arg(profile.path());
        command.env("LIBGL_ALWAYS_SOFTWARE", "1").env_remove("WAYLAND_DISPLAY");
        // Root must not use another user's home, as set in a container.
        command.env("HOME", profile.path());
        graphics(&mut command);
        command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::piped());
        let mut child = command.spawn().expect("Firefox starts");
        let lines = BufReader::new(child.stderr.take().expect("piped")).lines();
        let (tell, told) = channel();
        // Read to the end, so that it can continue writing.
        thread::spawn(move || lines.map_while(Result::ok).for_each(|line| drop(tell.send(line))));
        // From here on, it is ended on drop.
        let mut firefox = Self { child, server, host: String::new(), _profile: profile };
        let mut said = Vec::new();
        while firefox.host.is_empty() {
            let line = told.recv_timeout(PATIENCE);
            let line = line.unwrap_or_else(|error| panic!("Firefox: {error}: {said:?}"));
            match line.split_once("listening on ws://") {
                Some((_, host)) => firefox.host = host.to_owned(),
                None => said.push(line),
            }
        }
        firefox
    }

    /// Runs tests of this program again, in it. Returns their output, and whether all have passed.
    pub fn again(&self, arguments: &[&str], environment: &[(&str, &Path)]) -> (String, bool) {
        let output = Command::new(env::current_exe().expect("this program"))
            .args(arguments)
            .arg("--test-threads=1")
            .env(FIREFOX, &self.host)
            .envs(environment.iter().copied())
            .output()
            .expect("it starts");
        let [out, err] = [&output.stdout, &output.stderr].map(|text| String::from_utf8_lossy(text));
        (format!("{out}{err}"), output.status.success())
    }
}

impl Drop for Firefox {
    fn drop(&mut self) {
        for child in std::iter::once(&mut self.child).chain(&mut self.server) {
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}

/// A tab of Firefox, without data from other tabs.
pub struct Tab {
    talk: Talk,
    user: Value,
    context: Value,
    _firefox: Option<Firefox>,
}

impl Tab {
    /// A tab of the Firefox in which these tests run, if there is one.
    pub fn asked() -> Option<Self> {
        Some(Self::of(&env::var(FIREFOX).ok()?, None))
    }

    /// The only tab of a Firefox, which is ended with it.
    pub fn alone(firefox: Firefox) -> Self {
        Self::of(&firefox.host.clone(), Some(firefox))
    }

    fn of(host: &str, firefox: Option<Firefox>) -> Self {
        let talk = Talk::over(Socket::open(host));
        let mut tab = Self { talk, user: Value::Null, context: Value::Null, _firefox: firefox };
        // Only one session at a time is allowed.
        tab.call("session.new", json!({ "capabilities": {} }));
        let events = [
            "browsingContext.load",
            "log.entryAdded",
            "network.beforeRequestSent",
            "network.fetchError",
        ];
        tab.call("session.subscribe", json!({ "events": events }));
        // A new user has not yet chosen a theme.
        tab.user = tab.call("browser.createUserContext", json!({}))["userContext"].take();
        let open = json!({ "type": "tab", "userContext": tab.user });
        tab.context = tab.call("browsingContext.create", open)["context"].take();
        tab
    }
}

impl Engine for Tab {
    fn talk(&mut self) -> &mut Talk {
        &mut self.talk
    }

    fn call(&mut self, method: &str, parameters: Value) -> Value {
        self.talk.ask(json!({ "method": method, "params": parameters }))
    }

    fn open(&mut self, address: &str) {
        let open = json!({ "context": self.context, "url": address, "wait": "complete" });
        self.call("browsingContext.navigate", open);
    }

    fn loaded(&self) -> &'static str {
        "browsingContext.load"
    }

    fn run(&mut self, script: &str) -> Value {
        // The protocol's own encoding of values cannot represent all results of a figure, so they are sent as
        // text.
        let text = json!(script);
        let expression = format!("(async () => JSON.stringify(await (0, eval)({text})))()");
        let target = json!({ "context": self.context });
        let parameters =
            json!({ "expression": expression, "target": target, "awaitPromise": true });
        let result = self.call("script.evaluate", parameters);
        let wrong = &result["exceptionDetails"];
        assert!(wrong.is_null(), "{script}: {wrong}");
        let text = result["result"]["value"].as_str();
        text.map_or(Value::Null, |text| serde_json::from_str(text).expect("JSON"))
    }

    fn size(&mut self, width: u32, height: u32, _: bool) {
        let size = json!({ "width": width, "height": height });
        let parameters =
            json!({ "context": self.context, "viewport": size, "devicePixelRatio": 1 });
        self.call("browsingContext.setViewport", parameters);
    }

    fn press(&mut self, key: &str, _: u32) {
        let value = match key {
            "Tab" => '\u{e004}',
            "Enter" => '\u{e007}',
            "ArrowLeft" => '\u{e012}',
            "ArrowUp" => '\u{e013}',
            "ArrowRight" => '\u{e014}',
            "ArrowDown" => '\u{e015}',
            _ => panic!("the key {key}"),
        };
        let press = ["keyDown", "keyUp"].map(|kind| json!({ "type": kind, "value": value }));
        let keys = json!({ "type": "key", "id": "keys", "actions": press });
        self.call("input.performActions", json!({ "context": self.context, "actions": [keys] }));
    }

    fn drag(&mut self, way: &[[f64; 2]], by: Pointer) {
        let kind = if by == Pointer::Mouse { "mouse" } else { "touch" };
        let mut moves = way.iter().map(|[x, y]| json!({ "type": "pointerMove", "x": x, "y": y }));
        let mut actions: Vec<_> = moves.next().into_iter().collect();
        actions.push(json!({ "type": "pointerDown", "button": 0 }));
        actions.extend(moves);
        actions.push(json!({ "type": "pointerUp", "button": 0 }));
        let parameters = json!({ "pointerType": kind });
        let pointer =
            json!({ "type": "pointer", "id": kind, "parameters": parameters, "actions": actions });
        self.call("input.performActions", json!({ "context": self.context, "actions": [pointer] }));
    }

    fn shot(&mut self, part: Option<Value>) -> String {
        let mut shot = json!({ "context": self.context });
        if let Some(mut clip) = part {
            clip["type"] = json!("box");
            shot["clip"] = clip;
            shot["origin"] = json!("document");
        }
        let shot = self.call("browsingContext.captureScreenshot", shot);
        shot["data"].as_str().unwrap_or_default().to_owned()
    }
}

impl Drop for Tab {
    fn drop(&mut self) {
        for (method, parameters) in [
            ("browser.removeUserContext", json!({ "userContext": self.user })),
            ("session.end", json!({})),
        ] {
            let _ = self.talk.try_to_ask(json!({ "method": method, "params": parameters }));
        }
    }
}

struct Socket(WebSocket<TcpStream>);

impl Socket {
    fn open(host: &str) -> Self {
        let mut stream = TcpStream::connect(host).expect("Firefox listens");
        let ask = format!(
            "GET /session HTTP/1.1\r\nHost: {host}\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n\
             Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n"
        );
        stream.write_all(ask.as_bytes()).expect("Firefox listens");
        let mut head = Vec::new();
        // The rest does not belong to the header.
        while !head.ends_with(b"\r\n\r\n") {
            let mut byte = [0];
            stream.read_exact(&mut byte).expect("Firefox answers");
            head.extend(byte);
        }
        let head = String::from_utf8_lossy(&head);
        assert!(head.starts_with("HTTP/1.1 101 "), "{host}: {head}");
        Self(WebSocket::from_raw_socket(stream, Role::Client, None))
    }
}

impl Wire for Socket {
    fn send(&mut self, message: &Value) -> Result<(), String> {
        self.0.send(message.to_string().into()).map_err(|error| format!("Firefox: {error}"))
    }

    fn next(&mut self, patience: Duration) -> Result<Value, String> {
        let patience = patience.max(Duration::from_millis(1)); // none would mean no end
        self.0.get_ref().set_read_timeout(Some(patience)).expect("it can be set");
        let message = self.0.read().map_err(|error| format!("Firefox: {error}"))?;
        let text = message.to_text().map_err(|error| format!("Firefox: {error}"))?;
        serde_json::from_str(text).map_err(|error| format!("Firefox: {error}: {text}"))
    }
}
