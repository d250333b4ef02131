//! The result of a step of the view.

use std::time::Instant;

/// The result of a step of the view.
pub enum Stepped {
    /// A new picture, and its device time.
    New {
        /// Device time.
        milliseconds: f64,
        /// True if it has full size.
        full: bool,
        /// True if the time is that of tracing alone: the first picture also includes compilation.
        telling: bool,
    },
    /// Bands of the next picture; the last one is shown until it is complete.
    Part,
    /// The last picture is up to date; the next step may be due then.
    Kept(Option<Instant>),
}
