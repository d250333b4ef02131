//! Threads of a driver that runs on the CPU.

use std::fs;
use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::thread::{self, Builder};
use std::time::{Duration, Instant};

use anyhow::{Context, Result};

/// The most threads with which Mesa's driver starts to trace, and one for its queue.
const MOST: usize = 32 + 1;

/// Longer than the system takes to release a thread that has ended.
const FORGOTTEN: Duration = Duration::from_secs(1);

/// Fails if the system cannot start more threads: such a driver starts one per processor when its device is
/// opened, and waits forever for any that failed to start.
///
/// # Errors
/// States what to do.
pub fn ensure_threads() -> Result<()> {
    let wanted = thread::available_parallelism().map_or(1, NonZero::get) + 1;
    // All of them wait here, so that they exist at the same time.
    let gate = Mutex::new(());
    let ended: Vec<_> = thread::scope(|scope| {
        let closed = gate.lock();
        let wait = || {
            drop(gate.lock());
            fs::read_link("/proc/thread-self").ok()
        };
        let start = |_| {
            Builder::new()
                .stack_size(1 << 16)
                .spawn_scoped(scope, wait)
                .context("it needs threads, and the system starts no more (ulimit -u)")
        };
        let started = (0..wanted.min(MOST)).map(start).collect::<Result<Vec<_>>>()?;
        drop(closed);
        Ok::<_, anyhow::Error>(
            started.into_iter().filter_map(|thread| thread.join().ok()?).collect(),
        )
    })?;
    // Linux wakes the joining thread a moment before it releases the joined one, which counts until then.
    let (start, system) = (Instant::now(), Path::new("/proc"));
    let is_left = |thread: &PathBuf| system.join(thread).exists();
    while ended.iter().any(is_left) && start.elapsed() < FORGOTTEN {
        thread::yield_now();
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_system_that_starts_threads_is_told_so() {
        ensure_threads().unwrap();
    }
}
