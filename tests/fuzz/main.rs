//! Inputs that nobody would write: none brings about a panic, a wait without an end, memory without a bound, a
//! message that is no line, or a file that is left behind.
//!
//! `cargo test --test fuzz` tries the same inputs on every machine, for about a minute. For longer, with other
//! ones: `FUZZ_SECONDS=3600 FUZZ_SEED=7 cargo test --test fuzz for_long -- --ignored --nocapture`.

mod functions;
mod long;
mod memory;
mod planted;
mod programs;

use fuzz::format::Reader;
use fuzz::session::Session;

/// Default seed of the random numbers; `FUZZ_SEED` sets another.
const SEED: u64 = 18;

/// Tries so many inputs; the first fault fails the test, and says how to bring it back.
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
