//! Memory, counted by the thread that asks for it, and an end to it.

use std::cell::Cell;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

thread_local! {
    /// Bytes that this thread has, or minus those of others that it freed.
    static LIVE: Cell<isize> = const { Cell::new(0) };
    static MOST: Cell<isize> = const { Cell::new(isize::MAX) };
    static EXCEEDED: Cell<Option<&'static AtomicBool>> = const { Cell::new(None) };
}

/// From now on this thread may have so many bytes more than it has; `exceeded` is set when it asks for more.
pub fn allow(bytes: usize, exceeded: &'static AtomicBool) {
    LIVE.set(0);
    EXCEEDED.set(Some(exceeded));
    MOST.set(bytes as isize);
}

/// The thread may have as much as it likes again.
pub fn allow_all() {
    MOST.set(isize::MAX);
}

/// Takes note of bytes that this thread gets, or gives back.
///
/// A thread that asks for more than it may have gets nothing, and no error that it could pass on: it sleeps for
/// good, and whoever waits for it learns why. So an input that takes all memory ends no test.
pub fn count(bytes: isize) {
    // A thread that ends has no counter left.
    let live = LIVE.try_with(|live| {
        live.set(live.get().saturating_add(bytes));
        live.get()
    });
    if live.is_ok_and(|live| live > MOST.get()) {
        if let Some(exceeded) = EXCEEDED.get() {
            exceeded.store(true, Ordering::Release);
        }
        loop {
            std::thread::sleep(Duration::from_secs(3600));
        }
    }
}
