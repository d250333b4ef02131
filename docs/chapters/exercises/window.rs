//! A chapter's window, opened by the tool.

use std::process::{Child, Command, Stdio};

use anyhow::{Context, Result};
use common::output::print;
use time_limit::Limit;

use crate::programs::child;

/// A chapter's window, closed on drop.
pub struct Window(Child);

impl Window {
    /// Opens the window by running a command.
    ///
    /// # Errors
    /// If it does not start.
    pub fn open(command: &mut Command) -> Result<Self> {
        let child = child::start(command.stdin(Stdio::null()).stdout(Stdio::null()));
        Ok(Self(child.context("the window does not open")?))
    }

    /// Waits until the reader closes it.
    ///
    /// # Errors
    /// If a signal requests termination, or waiting for the window fails.
    pub fn closed(mut self) -> Result<()> {
        if self.0.try_wait()?.is_none() {
            print("Close the window to end.\n")?;
        }
        child::wait(&mut self.0, Limit::NONE).map(drop)
    }
}

impl Drop for Window {
    fn drop(&mut self) {
        // It may have ended already.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Returns whether a window can be opened here.
pub fn has_display() -> bool {
    let set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    !cfg!(all(unix, not(target_os = "macos"))) || set("DISPLAY") || set("WAYLAND_DISPLAY")
}
