//! Requests to end early: Ctrl-C, a closed terminal, or the warning signal of a batch system. A long render saves
//! its progress; everything else ends at once and leaves no half-written file.

use std::fmt;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::files;

/// State of [`Interrupt::came`]: true if somebody waits for it, and true if a signal has come since.
static LISTENING: AtomicBool = AtomicBool::new(false);
static CAME: AtomicBool = AtomicBool::new(false);

/// While it exists, its owner is notified of the first signal; a second one ends the process at once.
pub struct Interrupt(());

impl Interrupt {
    /// Starts listening.
    pub fn listen() -> Self {
        LISTENING.store(true, Ordering::Relaxed);
        Self(())
    }

    /// True if a signal has come.
    pub fn came(&self) -> bool {
        CAME.load(Ordering::Relaxed)
    }
}

impl Drop for Interrupt {
    fn drop(&mut self) {
        LISTENING.store(false, Ordering::Relaxed);
    }
}

/// Handles signals for as long as the process lives.
pub fn watch() {
    signals::watch(|signal| {
        let first = !CAME.swap(true, Ordering::Relaxed);
        if first && LISTENING.load(Ordering::Relaxed) {
            return;
        }
        files::abandon();
        signal.end();
    });
}

/// The error for a stop on request, with the results saved: a program ends with exit code 3.
#[derive(Debug)]
pub struct Stopped(pub String);

impl fmt::Display for Stopped {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Stopped {}
