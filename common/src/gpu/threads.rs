//! Threads of a driver that computes on the processor.

use std::num::NonZero;
use std::sync::Mutex;
use std::thread::{self, Builder};

use anyhow::{Context, Result};

/// The most that Mesa's driver starts to trace with, and one for its queue.
const MOST: usize = 32 + 1;

/// Fails if the system starts no more threads: such a driver starts one a processor when its device is opened,
/// and waits forever for those that there are not.
///
/// # Errors
/// Then, with what to do.
pub fn ensure_threads() -> Result<()> {
    let wanted = thread::available_parallelism().map_or(1, NonZero::get) + 1;
    // All of them wait here, so that they are there at the same time.
    let gate = Mutex::new(());
    thread::scope(|scope| {
        let _closed = gate.lock();
        for _ in 0..wanted.min(MOST) {
            let wait = || drop(gate.lock());
            Builder::new()
                .stack_size(1 << 16)
                .spawn_scoped(scope, wait)
                .context("it needs threads, and the system starts no more (ulimit -u)")?;
        }
        Ok(())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_system_that_starts_threads_is_told_so() {
        ensure_threads().unwrap();
    }
}
