//! Faults in the variable `MINIMUM_LIMITS`, beyond narrow limits.

use std::fs;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::{memory, queues};

/// Returns whether the variable contains a word.
pub fn has(word: &str) -> bool {
    words().iter().any(|own| own == word)
}

/// The value after `word=` in the variable.
pub fn value(word: &str) -> Option<String> {
    words().iter().find_map(|own| Some(own.strip_prefix(word)?.strip_prefix('=')?.to_owned()))
}

/// Writes the counts, if they are requested.
pub fn tell() {
    let Some(file) = value("tell") else { return };
    let [device, host, both] = memory::counts();
    let told = format!("{} {device} {host} {both}", queues::submits());
    fs::write(&file, told).unwrap_or_else(|error| panic!("{file}: {error}"));
}

/// Returns whether the swapchain being created fails: the first one, with `out-of-date`.
pub fn first_swapchain_is_out_of_date() -> bool {
    static DONE: AtomicBool = AtomicBool::new(false);
    has("out-of-date") && !DONE.swap(true, Ordering::Relaxed)
}

fn words() -> Vec<String> {
    let words = std::env::var("MINIMUM_LIMITS").unwrap_or_default();
    words.split(',').map(str::to_owned).collect()
}
