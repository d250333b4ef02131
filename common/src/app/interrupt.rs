//! The wish that a long render end early: Ctrl-C, or what a batch system sends before it kills.

use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use anyhow::{Context, Result};
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;

/// Listens from now on. The first signal is only noted, a second one ends the process at once.
pub struct Interrupt {
    came: Arc<AtomicBool>,
}

impl Interrupt {
    /// Listens for `SIGINT` and `SIGTERM`.
    ///
    /// # Errors
    /// If the system does not let it.
    pub fn listen() -> Result<Self> {
        let came = Arc::new(AtomicBool::new(false));
        for signal in [SIGINT, SIGTERM] {
            // In this order: the first signal finds the flag down.
            flag::register_conditional_shutdown(signal, 1, came.clone())
                .and_then(|_| flag::register(signal, came.clone()))
                .context("cannot listen for signals")?;
        }
        Ok(Self { came })
    }

    /// Whether a signal has come.
    pub fn came(&self) -> bool {
        self.came.load(Ordering::Relaxed)
    }
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
