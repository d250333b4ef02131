//! Inputs that nobody would write: none causes a panic, an endless wait, unbounded memory, an invalid
//! message, or a file that is left behind.
//!
//! `cargo test --test fuzz` tries the same inputs on every machine, for about a minute. To try others for
//! longer: `FUZZ_SECONDS=3600 FUZZ_SEED=7 cargo test --test fuzz for_long -- --ignored --nocapture`.

mod functions;
mod long;
mod memory;
mod planted;
mod programs;

use fuzz::format::Reader;
use fuzz::session::Session;

/// Default seed of the random numbers; `FUZZ_SEED` sets another.
const SEED: u64 = 18;

/// Tries this many inputs; the first fault fails the test, with a message that says how to reproduce it.
#[track_caller]
fn tried<R: Reader>(mut session: Session<R>, count: usize) {
    let start = std::time::Instant::now();
    if let Err(found) = session.steps(count) {
        panic!("{}", found.keep());
    }
    let (inputs, answers) = session.told();
    println!("{inputs} inputs, {answers} answers, {:.1} s", start.elapsed().as_secs_f64());
    assert!(answers > 1, "whatever is tried, the answer is the same: this tests nothing");
}
