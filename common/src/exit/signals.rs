//! The wish that a program end early: Ctrl-C, a closed terminal, or what a batch system sends before it
//! kills. A long render saves what it has; everything else ends at once and leaves no half-written file.

use std::fmt;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::files;

/// State of [`Interrupt::came`]: true if somebody waits for it, and true if a signal has come since.
static LISTENING: AtomicBool = AtomicBool::new(false);
static CAME: AtomicBool = AtomicBool::new(false);

/// Whoever holds it is told of the first signal; a second one ends the process at once.
pub struct Interrupt(());

impl Interrupt {
    /// Listens from now on.
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

/// Takes up signals for as long as the process lives.
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

/// The error that means "asked to stop, and what was done is saved": a program ends with exit code 3.
#[derive(Debug)]
pub struct Stopped(pub String);

impl fmt::Display for Stopped {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Stopped {}
