//! What came of a step of the view.

use std::time::Instant;

/// What came of a step of the view.
pub enum Stepped {
    /// A new picture, and what the device took for it.
    New {
        /// Device time.
        milliseconds: f64,
        /// Whether it is full size.
        full: bool,
        /// Whether that was the time of tracing alone: the first picture also compiles.
        telling: bool,
    },
    /// Bands of the next picture; the last one stays until it is whole.
    Part,
    /// The last picture still shows how things stand; something may be due then.
    Kept(Option<Instant>),
}
