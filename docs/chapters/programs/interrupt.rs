//! The end that a signal asks for: Ctrl-C, a closed terminal, `kill`. What waits asks [`asked`] and gives up, so
//! that windows are closed and temporary folders removed on the way out.

use std::sync::OnceLock;

use anyhow::{Result, bail};
use common::exit::Interrupt;

static INTERRUPT: OnceLock<Interrupt> = OnceLock::new();

/// From here on the first signal ends what waits, and not the whole process at once.
pub fn listen() {
    INTERRUPT.get_or_init(Interrupt::listen);
}

/// Fails if a signal has asked for the end.
///
/// # Errors
/// In one line.
pub fn asked() -> Result<()> {
    if INTERRUPT.get().is_some_and(Interrupt::came) {
        bail!("stopped by a signal");
    }
    Ok(())
}
