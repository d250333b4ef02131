//! The signals that ask a program to end: Ctrl-C, a closed terminal, or what a batch system sends before it kills.

/// A signal that has come.
#[cfg_attr(not(unix), allow(dead_code))]
pub struct Signal(i32);

impl Signal {
    /// Ends this process as the signal would have ended it.
    pub fn end(self) {
        #[cfg(unix)]
        let _ = signal_hook::low_level::emulate_default_handler(self.0);
    }
}

/// From now on, `heed` is called with each signal, in a separate thread, for as long as the process lives. If that
/// is impossible, and on systems other than Unix, signals end the process as usual.
#[cfg(unix)]
pub fn watch(heed: impl FnMut(Signal) + Send + 'static) {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    // What started this process may have asked it to live on: `nohup`, or a shell's `&`.
    let heeded = [SIGHUP, SIGINT, SIGTERM].into_iter().filter(|signal| !is_ignored(*signal));
    // Here, not in the thread, which may begin only after the first file has.
    let Ok(mut signals) = Signals::new(heeded) else { return };
    let watch = move || signals.forever().map(Signal).for_each(heed);
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
pub fn watch(_: impl FnMut(Signal) + Send + 'static) {}
