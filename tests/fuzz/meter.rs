//! Counts and limits the memory allocated by a thread.

use std::cell::Cell;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

thread_local! {
    /// The bytes allocated by this thread; negative if it freed more of others' memory.
    static LIVE: Cell<isize> = const { Cell::new(0) };
    static MOST: Cell<isize> = const { Cell::new(isize::MAX) };
    static EXCEEDED: Cell<Option<&'static AtomicBool>> = const { Cell::new(None) };
}

/// From now on, this thread may allocate this many bytes; `exceeded` is set if it requests more.
pub fn allow(bytes: usize, exceeded: &'static AtomicBool) {
    LIVE.set(0);
    EXCEEDED.set(Some(exceeded));
    MOST.set(bytes as isize);
}

/// Removes the thread's limit.
pub fn allow_all() {
    MOST.set(isize::MAX);
}

/// Counts bytes that this thread allocates or frees.
///
/// A thread that requests more than its limit gets neither memory nor an error it could pass on: it sleeps
/// forever, and the waiting thread learns why. An input that takes all memory therefore does not end the
/// test.
pub fn count(bytes: isize) {
    // During a thread's destruction, the counter no longer exists.
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
