//! The layer's records: built objects, violated rules, and the words of `MICROMAPS`.

use std::collections::BTreeMap;
use std::fmt::Display;
use std::sync::{Mutex, MutexGuard, PoisonError};

use ash::vk::{self, Handle};

/// One of the layer's own micromaps.
#[derive(Clone, Copy, Default)]
pub struct Micromap {
    /// Its capacity in bytes.
    pub size: u64,
    /// Its triangles, once it is built.
    pub triangles: Option<u32>,
}

#[derive(Default)]
pub struct Record {
    micromaps: BTreeMap<u64, Micromap>,
    made: u64,
    lines: Vec<String>,
}

static RECORD: Mutex<Record> =
    Mutex::new(Record { micromaps: BTreeMap::new(), made: 0, lines: Vec::new() });

pub fn record() -> MutexGuard<'static, Record> {
    RECORD.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Record {
    /// A new micromap, with a handle larger than any pointer of a driver.
    pub fn make(&mut self, size: u64) -> vk::AccelerationStructureKHR {
        self.made += 1;
        let handle = (1 << 62) + self.made;
        self.micromaps.insert(handle, Micromap { size, triangles: None });
        vk::AccelerationStructureKHR::from_raw(handle)
    }

    pub fn get(&mut self, handle: vk::AccelerationStructureKHR) -> Option<&mut Micromap> {
        self.micromaps.get_mut(&handle.as_raw())
    }

    /// Returns whether a handle belongs to the layer.
    pub fn has(&self, handle: u64) -> bool {
        self.micromaps.contains_key(&handle)
    }

    /// Removes a handle; returns whether it belonged to the layer.
    pub fn remove(&mut self, handle: u64) -> bool {
        self.micromaps.remove(&handle).is_some()
    }

    pub fn tell(&mut self, line: String) {
        self.lines.push(line);
    }

    /// Records the rule if it is violated.
    pub fn hold(&mut self, is_kept: bool, rule: impl Display) {
        if !is_kept {
            self.lines.push(format!("broken {rule}"));
        }
    }

    /// Writes everything to the file of `tell`, and clears it.
    pub fn write(&mut self) {
        self.lines.push(format!("alive {}", self.micromaps.len()));
        let lines: String = self.lines.drain(..).map(|line| line + "\n").collect();
        if let Some(file) = word("tell") {
            // If this fails, the test misses the file and fails.
            let _ = std::fs::write(file, lines);
        }
    }
}

/// The text after a word's equals sign.
fn word(name: &str) -> Option<String> {
    let words = std::env::var("MICROMAPS").unwrap_or_default();
    let mut words = words.split(',').filter_map(|word| word.split_once('='));
    words.find(|(known, _)| *known == name).map(|(_, value)| value.to_owned())
}

/// The finest supported level.
pub fn finest() -> u32 {
    word("level").and_then(|level| level.parse().ok()).unwrap_or(3)
}
