//! Signals that request termination: Ctrl-C, a closed terminal, or a batch system's warning.

/// A received signal.
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
    // The parent may have requested that the process ignore it: `nohup`, or a shell's `&`.
    let heeded = [SIGHUP, SIGINT, SIGTERM].into_iter().filter(|signal| !is_ignored(*signal));
    // Here, not in the thread, which may start only after the first file has been written.
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

/// On other systems, signals end a process as usual.
#[cfg(not(unix))]
pub fn watch(_: impl FnMut(Signal) + Send + 'static) {}
