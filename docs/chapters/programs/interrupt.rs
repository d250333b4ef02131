//! The end that a signal asks for: Ctrl-C, a closed terminal, `kill`. What waits asks [`asked`] and gives up, so
//! that windows are closed and temporary folders removed on the way out.

use std::sync::atomic::{AtomicBool, Ordering};

use anyhow::{Result, bail};

static ASKED: AtomicBool = AtomicBool::new(false);

/// From here on a signal ends what waits, and not the whole process at once.
///
/// Where a signal is handled or ignored already, as `nohup` has it, all stays as it is.
pub fn on_signal() {
    let _ = ctrlc::try_set_handler(|| ASKED.store(true, Ordering::Relaxed));
}

/// Fails if a signal has asked for the end.
///
/// # Errors
/// In one line.
pub fn asked() -> Result<()> {
    if ASKED.load(Ordering::Relaxed) {
        bail!("stopped by a signal");
    }
    Ok(())
}
