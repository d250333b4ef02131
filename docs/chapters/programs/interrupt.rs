//! Termination requested by a signal: Ctrl-C, a closed terminal, `kill`. Code that waits checks [`asked`] and
//! gives up, so that windows are closed and temporary folders removed.

use std::sync::OnceLock;

use anyhow::{Result, bail};
use common::exit::Interrupt;

static INTERRUPT: OnceLock<Interrupt> = OnceLock::new();

/// From here on, the first signal ends a wait instead of the whole process.
pub fn listen() {
    INTERRUPT.get_or_init(Interrupt::listen);
}

/// Fails if a signal has requested termination.
///
/// # Errors
/// In one line.
pub fn asked() -> Result<()> {
    if INTERRUPT.get().is_some_and(Interrupt::came) {
        bail!("stopped by a signal");
    }
    Ok(())
}
