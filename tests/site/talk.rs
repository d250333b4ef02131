//! A conversation with a browser in JSON: numbered requests, their responses, and messages in between.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use serde_json::{Value, json};

/// The time limit of a response, on a busy machine.
pub const PATIENCE: Duration = time_limit::ASLEEP;

/// The transport of messages.
pub trait Wire {
    fn send(&mut self, message: &Value) -> Result<(), String>;
    /// The next message, or the reason why there is none.
    fn next(&mut self, patience: Duration) -> Result<Value, String>;
}

pub struct Talk {
    wire: Box<dyn Wire>,
    last: u64,
    told: VecDeque<Value>,
}

impl Talk {
    pub fn over(wire: impl Wire + 'static) -> Self {
        Self { wire: Box::new(wire), last: 0, told: VecDeque::new() }
    }

    /// Sends a request, and returns the result.
    pub fn ask(&mut self, question: Value) -> Value {
        let method = question["method"].clone();
        self.try_to_ask(question).unwrap_or_else(|error| panic!("{method}: {error}"))
    }

    /// The same for requests that may fail.
    pub fn try_to_ask(&mut self, mut question: Value) -> Result<Value, String> {
        self.last += 1;
        question["id"] = json!(self.last);
        self.wire.send(&question)?;
        let start = Instant::now();
        loop {
            let mut told = self.next(start)?;
            if told["id"] == question["id"] {
                let wrong = told.get("error").map(|_| told.to_string());
                return wrong.map_or_else(|| Ok(told["result"].take()), Err);
            }
            self.told.push_back(told);
        }
    }

    /// Waits for an event, unless it has been received already.
    pub fn wait(&mut self, event: &str, doing: &str) {
        let start = Instant::now();
        while !self.told.iter().any(|told| told["method"] == event) {
            let told = self.next(start).unwrap_or_else(|error| panic!("{doing}: {error}"));
            self.told.push_back(told);
        }
    }

    /// The messages since the last call.
    pub fn told(&mut self) -> Vec<Value> {
        self.told.drain(..).collect()
    }

    fn next(&mut self, start: Instant) -> Result<Value, String> {
        self.wire.next(PATIENCE.saturating_sub(start.elapsed()))
    }
}
