//! The wish that a program end early: Ctrl-C, a closed terminal, or what a batch system sends before it
//! kills. A long render saves what it has; everything else ends at once and leaves no half-written file.

use std::fmt;
use std::sync::atomic::{AtomicBool, Ordering};

#[cfg(unix)]
use common::files;

/// Whether somebody waits for [`Interrupt::came`], and whether a signal has come since.
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

    /// Whether a signal has come.
    pub fn came(&self) -> bool {
        CAME.load(Ordering::Relaxed)
    }
}

impl Drop for Interrupt {
    fn drop(&mut self) {
        LISTENING.store(false, Ordering::Relaxed);
    }
}

/// Takes up signals for as long as the process lives. Where that cannot be done they end it, as ever.
#[cfg(unix)]
pub fn watch() {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    // What started this process may have asked it to live on: `nohup`, or a shell's `&`.
    let heeded = [SIGHUP, SIGINT, SIGTERM].into_iter().filter(|signal| !is_ignored(*signal));
    // Here, not in the thread, which may begin only after the first file has.
    let Ok(mut signals) = Signals::new(heeded) else { return };
    let watch = move || {
        for signal in signals.forever() {
            let first = !CAME.swap(true, Ordering::Relaxed);
            if first && LISTENING.load(Ordering::Relaxed) {
                continue;
            }
            files::abandon();
            let _ = signal_hook::low_level::emulate_default_handler(signal);
        }
    };
    let _ = std::thread::Builder::new().name("signals".to_owned()).spawn(watch);
}

#[cfg(unix)]
fn is_ignored(signal: i32) -> bool {
    let mut now = std::mem::MaybeUninit::<libc::sigaction>::uninit();
    // SAFETY: no new action is given, and the present one is read only if it was written.
    unsafe {
        libc::sigaction(signal, std::ptr::null(), now.as_mut_ptr()) == 0
            && now.assume_init().sa_sigaction == libc::SIG_IGN
    }
}

/// Elsewhere the system ends a process as ever.
#[cfg(not(unix))]
pub fn watch() {}

/// The error that means "asked to stop, and what was done is saved": a program ends with exit code 3.
#[derive(Debug)]
pub struct Stopped(pub String);

impl fmt::Display for Stopped {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Stopped {}
