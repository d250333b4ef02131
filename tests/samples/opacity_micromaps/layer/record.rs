//! Records of the layer: objects built, rules broken, and the words of `MICROMAPS`.

use std::collections::BTreeMap;
use std::fmt::Display;
use std::sync::{Mutex, MutexGuard, PoisonError};

use ash::vk::{self, Handle};

/// A micromap of the layer's own.
#[derive(Clone, Copy, Default)]
pub struct Micromap {
    /// Bytes that it has room for.
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
    /// A new micromap; no pointer of a driver's is so large.
    pub fn make(&mut self, size: u64) -> vk::AccelerationStructureKHR {
        self.made += 1;
        let handle = (1 << 62) + self.made;
        self.micromaps.insert(handle, Micromap { size, triangles: None });
        vk::AccelerationStructureKHR::from_raw(handle)
    }

    pub fn get(&mut self, handle: vk::AccelerationStructureKHR) -> Option<&mut Micromap> {
        self.micromaps.get_mut(&handle.as_raw())
    }

    /// Tests whether a handle is one of the layer's.
    pub fn has(&self, handle: u64) -> bool {
        self.micromaps.contains_key(&handle)
    }

    /// Removes a handle; true if it was one of the layer's.
    pub fn remove(&mut self, handle: u64) -> bool {
        self.micromaps.remove(&handle).is_some()
    }

    pub fn tell(&mut self, line: String) {
        self.lines.push(line);
    }

    /// Notes the rule if it is broken.
    pub fn hold(&mut self, is_kept: bool, rule: impl Display) {
        if !is_kept {
            self.lines.push(format!("broken {rule}"));
        }
    }

    /// Writes all to the file of `tell`, and forgets it.
    pub fn write(&mut self) {
        self.lines.push(format!("alive {}", self.micromaps.len()));
        let lines: String = self.lines.drain(..).map(|line| line + "\n").collect();
        if let Some(file) = word("tell") {
            // A test that finds no file fails.
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

/// The finest level that is taken.
pub fn finest() -> u32 {
    word("level").and_then(|level| level.parse().ok()).unwrap_or(3)
}
