//! The result of a step of the view.

use std::time::Instant;

/// The result of a step of the view.
pub enum Stepped {
    /// A new picture, and what the device took for it.
    New {
        /// Device time.
        milliseconds: f64,
        /// True if it has full size.
        full: bool,
        /// True if the time is that of tracing alone: the first picture also includes compilation.
        telling: bool,
    },
    /// Bands of the next picture; the last one stays until it is whole.
    Part,
    /// The last picture still shows how things stand; something may be due then.
    Kept(Option<Instant>),
}
